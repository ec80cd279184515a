/* quantities: what the case wants probes to write. */
#include "case_private.h"
#include <stdio.h>
#include <string.h>
#include <strings.h>

#define ROW(id, word, has) [id] = {word, has},
#define HISTORY_ROW(id, has, name, nc, unit, doc) {name, has},
static const struct {
  const char *word;
  unsigned    has; /* fields any of which it needs */
} quantity[QUANTITY_COUNT] = {CL_QUANTITIES(ROW)[QUANTITY_HISTORY] =
                                  CL_SKELETON_HISTORY(HISTORY_ROW) CL_QUANTITIES_BEHIND(ROW)};

/* The quantity of this name, QUANTITY_COUNT if there is none. */
static int Find(const char *word)
{
  int q = 0;

  while (q < QUANTITY_COUNT && strcasecmp(quantity[q].word, word))
    q++;
  return q;
}

static void Add(Reader *r, Case *c, const char *word)
{
  const int q          = Find(word);
  char      words[256] = "";

  if (q == QUANTITY_COUNT) {
    for (int k = 0; k < QUANTITY_COUNT; k++)
      snprintf(words + strlen(words), sizeof(words) - strlen(words), "%s%s", k ? ", " : "", quantity[k].word);
    ReaderError(r, "output_quantities", word, "must be all or a list of %s", words);
    return;
  }
  if (!(c->scene.fields.has & quantity[q].has)) {
    if (!(quantity[q].has & HAS_ALL)) {
      ReaderError(r, "output_quantities", quantity[q].word,
                  quantity[q].has == HAS_PLASTIC ? "needs a material with a plasticity_law"
                                                 : "needs a material whose skeleton has it");
      return;
    }
    FieldsWords(quantity[q].has, words);
    ReaderError(r, "output_quantities", quantity[q].word, "needs %s, which is not among the fields of the scene (%s)",
                words, c->fields_wanted);
    return;
  }
  c->quantities |= 1u << q;
}

void CaseQuantities(Reader *r, Case *c)
{
  List list;

  c->quantities = 0;
  if (!strcasecmp(c->quantities_wanted, "all"))
    return;
  ListCreate(c->quantities_wanted, &list);
  for (PetscInt i = 0; i < list.n; i++)
    Add(r, c, list.item[i]);
  ListDestroy(&list);
}
