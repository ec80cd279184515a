/* nearest: option names of the key table, and which of them a misspelt one was meant to be. */
#include "case_private.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const char *const case_schedule_form[] = {"", "_table", "_ramp", "_rate", "_piecewise", "_sine", "_csv", NULL};

bool KeyApplies(const Key *k, Group g, const void *instance)
{
  if (g == GROUP_REGION)
    return k->shape || ((const Region *)instance)->material >= 0;
  return g != GROUP_BC || !k->types || (k->types & (1u << ((const Bc *)instance)->type));
}

void KeyOption(char *option, size_t size, Group g, const char *instance, const char *key)
{
  if (g == GROUP_CASE)
    snprintf(option, size, "%s", key);
  else
    snprintf(option, size, "%s%s_%s", case_group[g].prefix, instance, key);
}

bool RangeHolds(const char *range, double value)
{
  double low, high;
  char  *comma;

  if (!*range)
    return true;
  low  = strtod(range + 1, &comma);
  high = strtod(comma + 1, NULL);
  if (range[0] == '[' ? value < low : value <= low)
    return false;
  return range[strlen(range) - 1] == ']' ? value <= high : value < high;
}

static char Lower(char c)
{
  return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

int EditDistance(const char *a, const char *b)
{
  int row[256], nb = (int)strnlen(b, 255);

  for (int j = 0; j <= nb; j++)
    row[j] = j;
  for (int i = 0; a[i]; i++) {
    int diagonal = row[0];
    row[0]       = i + 1;
    for (int j = 0; j < nb; j++) {
      int change = diagonal + (Lower(a[i]) != Lower(b[j]));
      diagonal   = row[j + 1];
      row[j + 1] = PetscMin(change, PetscMin(row[j], diagonal) + 1);
    }
  }
  return row[nb];
}

bool WordNearest(const char *word, const char *const *list, char *nearest, size_t size)
{
  int best = 1 + PetscMax(2, (int)strlen(word) / 3);

  *nearest = 0;
  for (; *list; list++) {
    int d = EditDistance(word, *list);
    if (d >= best)
      continue;
    best = d;
    snprintf(nearest, size, "%s", *list);
  }
  return *nearest;
}

typedef struct {
  const char *name;
  char       *nearest;
  size_t      size;
  int         best;
} Search;

static void SearchTry(Search *s, const char *candidate)
{
  int d = EditDistance(s->name, candidate);

  if (d >= s->best)
    return;
  s->best = d;
  snprintf(s->nearest, s->size, "%s", candidate);
}

static void SearchKeys(Search *s, Group g, const char *instance)
{
  char option[256], form[300];

  for (const Key *k = case_group[g].key; k->name; k++) {
    KeyOption(option, sizeof option, g, instance, k->name);
    SearchTry(s, option);
    if (k->kind != KEY_SCHEDULE)
      continue;
    for (int f = 1; case_schedule_form[f]; f++) {
      snprintf(form, sizeof form, "%s%s", option, case_schedule_form[f]);
      SearchTry(s, form);
    }
  }
}

bool KeyNearest(const Case *c, const char *name, char *nearest, size_t size)
{
  Search s = {name, nearest, size, 1 + PetscMax(2, (int)PetscMin(strlen(name), 60) / 5)};

  *nearest = 0;
  SearchKeys(&s, GROUP_CASE, "");
  for (Group g = GROUP_MATERIAL; g < GROUP_COUNT; g++) {
    SearchTry(&s, case_group[g].list);
    for (PetscInt i = 0; i < *GroupCount(c, g); i++)
      SearchKeys(&s, g, GroupInstance(c, g, i));
  }
  return *nearest;
}

/* Does the option name end in "_<key>" of this group?  *length is what stands before that. */
static bool EndsInKey(Group g, const char *name, size_t *length)
{
  char end[128];

  for (const Key *k = case_group[g].key; k->name; k++) {
    for (int f = 0; case_schedule_form[f] && (f == 0 || k->kind == KEY_SCHEDULE); f++) {
      size_t n = strlen(name), e;
      snprintf(end, sizeof end, "_%s%s", k->name, case_schedule_form[f]);
      e = strlen(end);
      if (n > e && !strcasecmp(name + n - e, end)) {
        *length = n - e;
        return true;
      }
    }
  }
  return false;
}

bool KeyUnlisted(const Case *c, const char *name, Group *group, char *instance, size_t size)
{
  for (Group g = GROUP_MATERIAL; g < GROUP_COUNT; g++) {
    size_t skip   = strlen(case_group[g].prefix), length;
    bool   listed = false;
    if (strncasecmp(name, case_group[g].prefix, skip))
      continue;
    for (PetscInt i = 0; i < *GroupCount(c, g); i++) {
      size_t n = strlen(GroupInstance(c, g, i));
      listed |= !strncasecmp(name + skip, GroupInstance(c, g, i), n) && name[skip + n] == '_';
    }
    if (listed || !EndsInKey(g, name, &length) || length <= skip)
      continue;
    snprintf(instance, size, "%.*s", (int)(length - skip), name + skip);
    *group = g;
    return true;
  }
  return false;
}

/* Options of other owners share some first words: -mat_mumps_... is PETSc's, -stepper_... -output_... -checkpoint_...
   may have keys the case does not know. */
static bool SharedPrefix(const char *name)
{
  static const char *const shared[] = {"stepper_", "output_", "checkpoint_", NULL};

  for (int i = 0; shared[i]; i++)
    if (!strncasecmp(name, shared[i], strlen(shared[i])))
      return true;
  return false;
}

static bool PrefixOwned(const Case *c, const char *name)
{
  char  word[64];
  Group g;

  if (SharedPrefix(name))
    return false;
  for (const Key *k = case_group[GROUP_CASE].key; k->name; k++) {
    size_t n = strcspn(k->name, "_");
    if (!strncasecmp(name, k->name, n) && (name[n] == '_' || !name[n]))
      return true;
  }
  for (g = GROUP_MATERIAL; g < GROUP_COUNT; g++) {
    if (!strcasecmp(name, case_group[g].list))
      return true;
    if (g != GROUP_MATERIAL && !strncasecmp(name, case_group[g].prefix, strlen(case_group[g].prefix)))
      return true;
    for (PetscInt i = 0; i < *GroupCount(c, g); i++) {
      char prefix[160];
      snprintf(prefix, sizeof prefix, "%s%s_", case_group[g].prefix, GroupInstance(c, g, i));
      if (!strncasecmp(name, prefix, strlen(prefix)))
        return true;
    }
  }
  return KeyUnlisted(c, name, &g, word, sizeof word);
}

/* The program's own, under the names of groups of keys. */
static bool OfTheRun(const char *name)
{
  return !strcasecmp(name, "time_limit") || !strcasecmp(name, "checkpoint_wall");
}

bool KeyOwned(const Case *c, const char *name)
{
  char nearest[256];

  if (OfTheRun(name))
    return false;
  if (PrefixOwned(c, name))
    return true;
  if (SharedPrefix(name))
    return KeyNearest(c, name, nearest, sizeof nearest) && EditDistance(name, nearest) <= 1;
  return strlen(name) >= 8 && KeyNearest(c, name, nearest, sizeof nearest) && EditDistance(name, nearest) <= 2;
}
