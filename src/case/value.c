/* value: reads one key of the table into its place, by kind. */
#include "case_private.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static bool KeyReal(Reader *r, const char *shown, const char *text, const Key *k, double *value)
{
  const char *end;
  char        full[128];

  if (k->plain && *shown == '-' && NumberParse(text, value, &end) && !*end) {
    snprintf(full, sizeof full, "%.60s %s", text, k->unit);
    return RealRead(r, shown, full, k->unit, k->range, value);
  }
  if (k->word && !strcasecmp(text, k->word + (*k->word == '-'))) {
    *value = *k->word == '-' ? -INFINITY : INFINITY;
    return true;
  }
  return RealRead(r, shown, text, k->unit, k->range, value);
}

static bool KeyInt(Reader *r, const char *shown, const char *text, const Key *k, PetscInt *value)
{
  char *end;
  long  n;

  if (k->word && !strcasecmp(text, k->word)) {
    *value = 0;
    return true;
  }
  errno = 0;
  n     = strtol(text, &end, 10);
  if (end == text || *end) {
    ReaderError(r, shown, text, "must be a whole number without a unit");
    return false;
  }
  if (errno || !RangeHolds(k->range, (double)n)) {
    ReaderError(r, shown, text, "is out of range, allowed: %s", k->range);
    return false;
  }
  *value = (PetscInt)n;
  return true;
}

/* A list with a number for each axis of the other program. */
static const char *OtherAxes(PetscInt n, int count)
{
  if (count != CL_DIM || n != 5 - CL_DIM)
    return "";
  return CL_DIM == 2 ? "; three axes are clathra3d's" : "; this is clathra3d, two axes are clathra's";
}

static void KeyNumbers(Reader *r, const char *shown, const char *text, const Key *k, char *place)
{
  List list;

  ListCreate(text, &list);
  if (list.n != k->count)
    ReaderError(r, shown, text, "has %d value%s, needs %d%s%s%s", (int)list.n, list.n == 1 ? "" : "s", k->count,
                *k->unit ? ", e.g. in " : "", k->unit, OtherAxes(list.n, k->count));
  else
    for (PetscInt i = 0; i < list.n; i++) {
      bool ok = k->kind == KEY_INT ? KeyInt(r, shown, list.item[i], k, (PetscInt *)place + i)
                                   : KeyReal(r, shown, list.item[i], k, (double *)place + i);
      if (!ok)
        break;
    }
  ListDestroy(&list);
}

static void KeyBool(Reader *r, const char *shown, const char *text, const Key *k, bool *value)
{
  if (!k->choices && YesNoRead(text, value))
    return;
  for (int v = 0; k->choices && v < 2; v++) {
    if (strcasecmp(text, k->choices[v]))
      continue;
    *value = v;
    return;
  }
  WordError(r, shown, text, KeyWords(k));
}

static void KeyText(Reader *r, const char *shown, const char *text, const Key *k, char *value)
{
  if (k->choices) {
    for (int i = 0; k->choices[i]; i++) {
      if (strcasecmp(text, k->choices[i]))
        continue;
      snprintf(value, (size_t)k->count, "%s", k->choices[i]);
      return;
    }
    WordError(r, shown, text, k->choices);
    return;
  }
  for (const char *p = text; *p; p++) {
    if ((unsigned char)*p >= 0x20)
      continue;
    ReaderError(r, shown, NULL, "holds a line break or a control character");
    return;
  }
  if (k->def && *k->def && (!strcmp(text, "~") || !strcmp(text, "null")))
    ReaderError(r, shown, text, "is no value");
  else if (strlen(text) >= (size_t)k->count)
    ReaderError(r, shown, text, "is longer than %d characters", k->count - 1);
  else
    strcpy(value, text);
}

static void KeyChoice(Reader *r, const char *shown, const char *text, const Key *k, int *value)
{
  for (int i = 0; k->choices[i]; i++) {
    if (strcasecmp(text, k->choices[i]))
      continue;
    *value = k->first + i;
    return;
  }
  WordError(r, shown, text, k->choices);
}

/* output_times: ascending */
static PetscErrorCode KeyReals(Reader *r, const char *shown, const char *text, const Key *k, PetscInt *n,
                               double **values)
{
  List list;

  PetscFunctionBeginUser;
  ListCreate(text, &list);
  if (list.n)
    PetscCall(PetscCalloc1(list.n, values));
  for (*n = 0; *n < list.n; (*n)++) {
    double *v = *values + *n;
    if (!RealRead(r, shown, list.item[*n], k->unit, k->range, v))
      break;
    if (*n && v[0] <= v[-1]) {
      ReaderError(r, shown, list.item[*n], "the times must ascend");
      break;
    }
  }
  ListDestroy(&list);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "0.05 @retention_p0": that multiple of a key above in the same group */
static bool DefaultReference(Group g, const char *instance, const Key *k, double *value)
{
  const char *at = k->def ? strchr(k->def, '@') : NULL;

  if (!at)
    return false;
  for (const Key *other = case_group[g].key; other != k; other++) {
    if (strcmp(other->name, at + 1))
      continue;
    *value = strtod(k->def, NULL) * *(const double *)(instance + other->offset);
    return true;
  }
  return false;
}

static PetscErrorCode KeyStore(Reader *r, Case *c, const char *shown, const char *text, const Key *k, char *instance)
{
  char *place = instance + k->offset;

  PetscFunctionBeginUser;
  switch (k->kind) {
  case KEY_REAL:
  case KEY_INT:
    KeyNumbers(r, shown, text, k, place);
    break;
  case KEY_BOOL:
    KeyBool(r, shown, text, k, (bool *)place);
    break;
  case KEY_TEXT:
    KeyText(r, shown, text, k, place);
    break;
  case KEY_CHOICE:
    KeyChoice(r, shown, text, k, (int *)place);
    break;
  case KEY_LAW:
    if (!k->law->set((Material *)instance, text))
      WordError(r, shown, text, k->law->types());
    break;
  case KEY_NAME:
    (void)KeyName(r, c, shown, text, k, (PetscInt *)place);
    break;
  case KEY_NAMES:
    PetscCall(KeyNames(r, c, shown, text, k, (Names *)place));
    break;
  case KEY_POINTS:
    PetscCall(KeyPoints(r, shown, text, k, (Points *)place));
    break;
  case KEY_REALS:
    PetscCall(KeyReals(r, shown, text, k, &c->ntimes, (double **)place));
    break;
  case KEY_SCHEDULE:
    break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode KeyRead(Reader *r, Case *c, Group g, PetscInt i, const Key *k)
{
  char       *instance = GroupInstance(c, g, i), option[256];
  const char *text;
  Found       f;

  PetscFunctionBeginUser;
  KeyOption(option, sizeof option, g, instance, k->name);
  if (k->kind == KEY_SCHEDULE) {
    PetscCall(ScheduleRead(r, option, k, instance, (Schedule *)(instance + k->offset)));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (k->kind == KEY_LAW) /* conditions of other keys look at it, whatever becomes of this one */
    k->law->set((Material *)instance, k->def ? k->def : k->law->types()[0]);
  PetscCall(KeyFind(r, c, g, i, k, &f));
  text = f.text;
  if (!KeyApplies(k, g, instance)) {
    if (f.found && f.own && g == GROUP_REGION)
      ReaderError(r, f.shown, text, "is not a key of a region without particles (material: none)");
    else if (f.found && f.own)
      ReaderError(r, f.shown, text, "is not a key of a boundary of type %s", cl_condition[((Bc *)instance)->type].word);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!f.found) {
    if (!KeyNeeded(k, c) && !k->def)
      PetscFunctionReturn(PETSC_SUCCESS);
    if (KeyNeeded(k, c) && (k->needed ? k->needed(instance) : !k->def))
      KeyMissing(r, option, k);
    else if (!k->kept && !DefaultReference(g, instance, k, (double *)(instance + k->offset)))
      PetscCall(KeyStore(r, c, f.shown, k->def, k, instance));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!text && k->kind == KEY_BOOL && !f.from_file && !k->choices)
    text = "yes";
  if (!text && k->def && !*k->def)
    text = "";
  if (text)
    PetscCall(KeyStore(r, c, f.shown, text, k, instance));
  else
    ReaderError(r, f.shown, NULL, "has no value");
  PetscFunctionReturn(PETSC_SUCCESS);
}
