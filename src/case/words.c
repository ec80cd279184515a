/* words: what values are made of: lists, words of a choice, names, numbers with a unit. */
#include "case_private.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* What stands between the brackets of "[a, b]", as a case file has it; the text itself without them. */
static char *Inside(char *text)
{
  char *open = text + strspn(text, " \t"), *close = strrchr(text, ']');

  if (*open != '[' || !close || close[1 + strspn(close + 1, " \t")] || strpbrk(open + 1, "[]") != close)
    return text;
  *close = 0;
  return open + 1;
}

void ListCreate(const char *text, List *list)
{
  char *p;

  list->n    = 0;
  list->text = strdup(text);
  list->item = calloc(strlen(text) + 1, sizeof *list->item);
  for (p = Inside(list->text); *p;) {
    char *end = p + strcspn(p, ","), *stop = end;
    bool  last = !*end;
    while (isspace((unsigned char)*p) && p < end)
      p++;
    while (stop > p && isspace((unsigned char)stop[-1]))
      stop--;
    list->item[list->n++] = p;
    *stop                 = 0;
    if (last)
      break;
    p = end + 1;
  }
}

void ListDestroy(List *list)
{
  free(list->text);
  free(list->item);
}

static void WordsJoin(const char *const *word, char *out, size_t size)
{
  *out = 0;
  for (; *word; word++)
    snprintf(out + strlen(out), size - strlen(out), "%s%s", *out ? " | " : "", *word);
}

const char *const *KeyWords(const Key *k)
{
  static const char *const yes_no[] = {"yes", "no", NULL};

  if (k->kind == KEY_LAW)
    return k->law->types();
  if (k->choices)
    return k->choices;
  return k->kind == KEY_BOOL ? yes_no : NULL;
}

void WordError(Reader *r, const char *shown, const char *text, const char *const *words)
{
  char allowed[256], nearest[64];

  WordsJoin(words, allowed, sizeof allowed);
  if (WordNearest(text, words, nearest, sizeof nearest))
    ReaderError(r, shown, text, "must be one of %s; did you mean %s?", allowed, nearest);
  else
    ReaderError(r, shown, text, "must be one of %s", allowed);
}

void KeyMissing(Reader *r, const char *option, const Key *k)
{
  char allowed[256] = "";

  if (KeyWords(k))
    WordsJoin(KeyWords(k), allowed, sizeof allowed);
  ReaderError(r, option, NULL, "is missing%s%s%s%s%s%s%s%s%s%s%s", *k->doc ? " (" : "", k->doc, *k->doc ? ")" : "",
              *k->unit ? ", in " : "", k->unit, *k->range ? ", range " : "", k->range, *allowed ? ", one of " : "",
              allowed, k->when ? "; required when " : "", k->when ? k->when : "");
}

bool RealRead(Reader *r, const char *shown, const char *text, const char *unit, const char *range, double *value)
{
  char why[CASE_WHY];

  if (!QuantityParse(text, unit, value, why)) {
    ReaderError(r, shown, text, "%s", why);
    return false;
  }
  if (RangeHolds(range, *value))
    return true;
  ReaderError(r, shown, text, "is out of range, allowed: %s%s%s", range, *unit ? " " : "", unit);
  return false;
}

bool YesNoRead(const char *text, bool *value)
{
  static const char *const word[2][4] = {{"no", "false", "off", "0"}, {"yes", "true", "on", "1"}};

  for (int v = 0; v < 2; v++) {
    for (int i = 0; i < 4; i++) {
      if (strcasecmp(text, word[v][i]))
        continue;
      *value = v;
      return true;
    }
  }
  return false;
}

bool KeyName(Reader *r, const Case *c, const char *shown, const char *text, const Key *k, PetscInt *value)
{
  const char *all = k->word ? k->word : k->kind == KEY_NAME ? k->def : NULL, *word[258]; /* all, none */
  PetscInt    n   = 0;

  if (all && !strcasecmp(text, all)) {
    *value = -1;
    return true;
  }
  for (PetscInt i = 0; i < *GroupCount(c, k->names) && n < 256; i++) {
    word[n++] = GroupInstance(c, k->names, i);
    if (strcasecmp(text, word[n - 1]))
      continue;
    *value = i;
    return true;
  }
  if (all)
    word[n++] = all;
  word[n] = NULL;
  if (n)
    WordError(r, shown, text, word);
  else
    ReaderError(r, shown, text, "no %s is listed in %s", case_group[k->names].noun, case_group[k->names].list);
  return false;
}
