/* idle: keys of the file or the command line that do nothing in this scene. */
#include "case_private.h"
#include <stdio.h>
#include <stdlib.h>

#define SHOWN 12

/* Why a key does nothing. */
static void Why(const Key *k, const Scene *c, char why[CASE_WHY])
{
  const unsigned lacks = k->has && !(c->fields.has & k->has)     ? k->has
                         : k->also && !(c->fields.has & k->also) ? k->also
                                                                 : 0;
  char           words[64];

  if (lacks) {
    FieldsWords(lacks, words);
    snprintf(why, CASE_WHY, "no %s", words);
  } else
    snprintf(why, CASE_WHY, "it acts when %s", k->idle);
}

PetscErrorCode CaseIdle(Reader *r, const Case *c)
{
  char    *text, why[CASE_WHY];
  size_t   size;
  FILE    *f = open_memstream(&text, &size);
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  for (Group g = GROUP_CASE; g < GROUP_STAGE; g++) {
    for (PetscInt i = 0; i < (g == GROUP_CASE ? 1 : *GroupCount(c, g)); i++) {
      for (const Key *k = case_group[g].key; k->name; k++) {
        const char *instance = GroupInstance(c, g, i);
        Found       at;

        if (k->kind == KEY_SCHEDULE || k->like || !KeyApplies(k, g, instance) || KeyActs(k, c, instance))
          continue;
        PetscCall(KeyFind(r, c, g, i, k, &at));
        if (!at.found || !at.own)
          continue;
        Why(k, &c->scene, why);
        if (n++ < SHOWN)
          fprintf(f, "%s%s (%s)", n > 1 ? ", " : "", at.shown, why);
      }
    }
  }
  if (n > SHOWN)
    fprintf(f, " and %d more", (int)(n - SHOWN));
  fclose(f);
  if (n)
    PetscCall(PetscFPrintf(r->comm, stderr, "%s: note: %d key%s nothing in this scene (%s): %s\n", r->file, (int)n,
                           n > 1 ? "s do" : " does", c->fields_wanted, text));
  free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}
