/* idle: keys of the file or the command line that do nothing in this scene, or by its integrator. */
#include "case_private.h"
#include <stdio.h>
#include <stdlib.h>

#define SHOWN 12

void IntegratorsWords(unsigned by, char text[64])
{
  char *end = text;

  *text = '\0';
  for (Integrator i = 0; i < INTEGRATOR_COUNT; i++) {
    if (by & IntegratorKinds(i))
      end += snprintf(end, 64 - (size_t)(end - text), "%s%s", end > text ? ", " : "", case_integrator[i]);
  }
}

/* auto takes no steps of hybrid where hybrid does not know the scene. */
static bool Knows(const Case *c, unsigned by)
{
  return by & IntegratorKinds(c->integrator) & (CaseNeedsImplicit(c) ? ~(unsigned)BY_EXPLICIT : ~0u);
}

bool KeyKnown(const Key *k, Group g, const Case *c, const void *instance)
{
  bool known = !k->by;

  if (g == GROUP_STAGE)
    return known || Knows(&((const CaseStage *)instance)->c, k->by);
  for (PetscInt i = 0; i < PetscMax(c->nstage, 1); i++)
    known = known || Knows(CaseInStage(c, i), k->by);
  return known;
}

/* Why a key does nothing. */
static void Why(const Key *k, const Case *c, bool known, char why[CASE_WHY])
{
  const unsigned has   = c->scene.fields.has;
  const unsigned lacks = k->has && !(has & k->has) ? k->has : k->also && !(has & k->also) ? k->also : 0;
  char           words[64];

  if (!known) {
    const char *hybrid = k->by & IntegratorKinds(c->integrator) ? CaseNeedsImplicit(c) : NULL;

    IntegratorsWords(k->by, words);
    snprintf(why, CASE_WHY, "it acts with %s%s%s", words, hybrid ? "; hybrid does not know " : "",
             hybrid ? hybrid : "");
  } else if (lacks) {
    FieldsWords(lacks, words);
    snprintf(why, CASE_WHY, "no %s", words);
  } else
    snprintf(why, CASE_WHY, "it acts when %s", k->idle);
}

PetscErrorCode CaseIdle(Reader *r, const Case *c)
{
  static const Key newton = {.by = BY_IMPLICIT}; /* each of the options of Newton's method */

  char    *text, *all, why[CASE_WHY];
  size_t   size;
  FILE    *f = open_memstream(&text, &size);
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  IntegratorsWords(newton.by, why);
  PetscCall(PetscOptionsGetAll(NULL, &all));
  for (const char *at = all; !KeyKnown(&newton, GROUP_CASE, c, NULL) && (at = strstr(at, "-newton_")); at++)
    fprintf(f, "%s%.*s (it acts with %s)", n++ ? ", " : "", (int)strcspn(at, " "), at, why);
  PetscCall(PetscFree(all));
  for (Group g = GROUP_CASE; g < GROUP_COUNT; g++) {
    for (PetscInt i = 0; i < (g == GROUP_CASE ? 1 : *GroupCount(c, g)); i++) {
      for (const Key *k = case_group[g].key; k->name; k++) {
        const char *instance = GroupInstance(c, g, i);
        const bool  known    = KeyKnown(k, g, c, instance);
        Found       at;

        if (k->kind == KEY_SCHEDULE || k->like || !KeyApplies(k, g, instance) || (known && KeyActs(k, c, instance)))
          continue;
        PetscCall(KeyFind(r, c, g, i, k, &at));
        if (!at.found || !at.own)
          continue;
        Why(k, c, known, why);
        if (n++ < SHOWN)
          fprintf(f, "%s%s (%s)", n > 1 ? ", " : "", at.shown, why);
      }
    }
  }
  if (n > SHOWN)
    fprintf(f, " and %d more", (int)(n - SHOWN));
  fclose(f);
  if (n)
    PetscCall(FindingSayOf(r->comm, FINDING_IDLE_KEYS, r->file, NULL, "%d key%s nothing in this scene (%s): %s", (int)n,
                           n > 1 ? "s do" : " does", c->fields_wanted, text));
  free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}
