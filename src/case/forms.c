/* forms: the ways to write a function of time.
     key: 3 MPa                                constant
     key: {table: [t0, v0, t1, v1, ...]}       straight lines between the points; also [[t0, v0], [t1, v1], ...]
     key: {ramp: [v0, v1, t0, t1]}             from v0 at t0 to v1 at t1
     key: {rate: [v0, rate, t0, t1]}           from v0 at t0 with this rate until t1
     key: {piecewise: [t0, v0, t1, v1, ...]}   each value holds until the next time; pairs as above
     key: {sine: [mean, amplitude, period, begin, ...]}   waves (267)
     key: {csv: [FILE, COLUMN]}                straight lines between the rows of a file (csv.c)
   On the command line -key_ramp "v0, v1, t0, t1" or -key "{ramp: [v0, v1, t0, t1]}".
   Before the first time the first value holds, after the last time the last. */
#include "case_private.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { FORM_CONSTANT = 0, FORM_TABLE, FORM_RAMP, FORM_RATE, FORM_PIECEWISE, FORM_SINE, FORM_CSV };

static void SchedulePoint(Schedule *s, double t, double y)
{
  s->t[s->n]   = t;
  s->y[s->n++] = y;
}

static bool ScheduleTable(Reader *r, const char *shown, const List *list, const Key *k, Schedule *s)
{
  double t, y;

  if (list->n < 2 || list->n % 2) {
    ReaderError(r, shown, NULL, "has %d values, needs pairs: time, value, time, value, ...", (int)list->n);
    return false;
  }
  for (PetscInt i = 0; i < list->n; i += 2) {
    if (!RealRead(r, shown, list->item[i], "s", "", &t) ||
        !RealRead(r, shown, list->item[i + 1], k->unit, k->range, &y))
      return false;
    if (s->n && t <= s->t[s->n - 1]) {
      ReaderError(r, shown, list->item[i], "the times must ascend (use piecewise for jumps)");
      return false;
    }
    SchedulePoint(s, t, y);
  }
  return true;
}

static bool ScheduleRamp(Reader *r, const char *shown, const List *list, const Key *k, bool rate, Schedule *s)
{
  double v0, v1, t0, t1;
  char   unit[64];

  if (list->n != 4) {
    ReaderError(r, shown, NULL, "has %d values, needs 4: first value, %s, begin, end", (int)list->n,
                rate ? "rate" : "last value");
    return false;
  }
  snprintf(unit, sizeof unit, "%s/s", strcmp(k->unit, "degC") ? k->unit : "K");
  if (!RealRead(r, shown, list->item[0], k->unit, k->range, &v0))
    return false;
  if (!RealRead(r, shown, list->item[1], rate ? unit : k->unit, rate ? "" : k->range, &v1))
    return false;
  if (!RealRead(r, shown, list->item[2], "s", "", &t0) || !RealRead(r, shown, list->item[3], "s", "", &t1))
    return false;
  if (t1 <= t0) {
    ReaderError(r, shown, list->item[3], "must end after it begins");
    return false;
  }
  if (rate)
    v1 = v0 + v1 * (t1 - t0);
  if (!isfinite(v1) || !RangeHolds(k->range, v1)) {
    ReaderError(r, shown, list->item[1], "leads to a last value of %g %s, out of range %s", v1, k->unit, k->range);
    return false;
  }
  SchedulePoint(s, t0, v0);
  SchedulePoint(s, t1, v1);
  return true;
}

/* (267): mean, then amplitude, period and begin of each wave. */
static bool ScheduleWaves(Reader *r, const char *shown, const List *list, const Key *k, Schedule *s)
{
  const bool short_form = list->n == 3; /* one that begins at 0 */
  double     mean;

  if (!short_form && (list->n < 4 || list->n % 3 != 1)) {
    ReaderError(r, shown, NULL, "has %d values, needs the mean, and amplitude, period and begin of each wave",
                (int)list->n);
    return false;
  }
  if (!RealRead(r, shown, list->item[0], k->unit, k->range, &mean))
    return false;
  SchedulePoint(s, 0, mean);
  s->wave = calloc((size_t)list->n, sizeof *s->wave);
  for (PetscInt i = 1; i < list->n; i += 3) {
    Wave *w = &s->wave[s->nwave++];

    if (!RealRead(r, shown, list->item[i], ScheduleDifference(k), "", &w->amplitude) ||
        !RealRead(r, shown, list->item[i + 1], "s", "(0,inf)", &w->period) ||
        (!short_form && !RealRead(r, shown, list->item[i + 2], "s", "", &w->begin)))
      return false;
  }
  for (int sign = -1; sign <= 1; sign += 2) {
    const double end = mean + sign * ScheduleSwing(s);

    if (RangeHolds(k->range, end))
      continue;
    ReaderError(r, shown, NULL, "its waves may reach %g %s, out of range %s", end, k->unit, k->range);
    return false;
  }
  return true;
}

/* A word where a key takes a number or one word of its own: what it takes, and whether the word is a key beside it. */
static void NoSuchWord(Reader *r, const char *shown, const char *text, const Key *k)
{
  const Key *beside = case_group[GROUP_BC].key;

  while (beside->name && (beside->kind != KEY_BOOL || beside->choices || strcasecmp(beside->name, text)))
    beside++;
  if (beside->name)
    ReaderError(r, shown, text,
                "must be a number and a unit, e.g. 1 %s, a function of time or the word %s; %s is a key of its own: "
                "%s: yes in place of %s",
                k->unit, k->word, beside->name, beside->name, k->name);
  else
    ReaderError(r, shown, text, "must be a number and a unit, e.g. 1 %s, a function of time or the word %s", k->unit,
                k->word);
}

static bool ScheduleParse(Reader *r, const char *shown, const char *text, const Key *k, int form, Schedule *s)
{
  List   list;
  bool   ok;
  double y = 0;

  ListCreate(text, &list);
  s->t = calloc((size_t)list.n + 2, sizeof *s->t);
  s->y = calloc((size_t)list.n + 2, sizeof *s->y);
  if (form == FORM_CONSTANT) {
    ok = true;
    if (k->word && !strcasecmp(text, k->word))
      y = INFINITY; /* as for numbers: what the word stands for */
    else if (k->word && isalpha((unsigned char)*text)) {
      NoSuchWord(r, shown, text, k);
      ok = false;
    } else
      ok = RealRead(r, shown, text, k->unit, k->range, &y);
    SchedulePoint(s, 0, y);
  } else if (form == FORM_TABLE || form == FORM_PIECEWISE)
    ok = ScheduleTable(r, shown, &list, k, s);
  else if (form == FORM_SINE)
    ok = ScheduleWaves(r, shown, &list, k, s);
  else
    ok = ScheduleRamp(r, shown, &list, k, form == FORM_RATE, s);
  s->steps = form == FORM_PIECEWISE;
  if (s->n == 1) { /* a single point is a constant */
    s->steps = false;
    s->t[0]  = 0;
  }
  ListDestroy(&list);
  return ok;
}

/* The numbers of a list up to the brace that ends the form, without the brackets that pair them; false if more than
   that follows. */
static bool ListInBraces(const char *p, char *inner)
{
  for (; *p && *p != '}'; p++) {
    if (*p != '[' && *p != ']')
      *inner++ = *p;
  }
  *inner = 0;
  return *p && !p[1 + strspn(p + 1, " ")];
}

int FormInBraces(const char *text, char *inner)
{
  const char *p = text + 1 + strspn(text + 1, " ");

  for (int f = FORM_TABLE; case_schedule_form[f]; f++) {
    const char  *name = case_schedule_form[f] + 1; /* without _ */
    const size_t n = strlen(name), colon = n + strspn(p + PetscMin(n, strlen(p)), " ");

    if (strncasecmp(p, name, n) || p[colon] != ':')
      continue;
    return ListInBraces(p + colon + 1, inner) ? f : -1;
  }
  return -1;
}

/* A value of the command line may be a form in braces. */
static PetscErrorCode ScheduleGiven(Reader *r, const char *shown, const char *text, const Key *k, int form, Schedule *s)
{
  char *inner = strdup(text);
  bool  ok    = true;

  PetscFunctionBeginUser;
  if (form == FORM_CONSTANT && *text == '{') {
    form = FormInBraces(text, inner);
    if (form < 0)
      ReaderError(r, shown, text,
                  "is no function of time: {table: [t0, v0, t1, v1, ...]}, {ramp: [v0, v1, t0, t1]}, {rate: ...}, "
                  "{piecewise: ...}, {sine: [mean, amplitude, period, begin]}, {csv: [FILE, COLUMN]}");
  }
  for (char *q = inner; (form == FORM_TABLE || form == FORM_PIECEWISE) && *q; q++)
    *q = *q == ';' ? ',' : *q; /* pairs of the file */
  if (form == FORM_CSV)
    PetscCall(ScheduleCsv(r, shown, inner, k, s, &ok));
  else if (form >= 0)
    (void)ScheduleParse(r, shown, inner, k, form, s);
  free(inner);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ScheduleRead(Reader *r, const char *option, const Key *k, const void *instance, Schedule *s)
{
  char        name[300], shown[301];
  const char *text = NULL, *value;
  int         form = -1, n[2] = {0, 0}; /* forms given on the command line, in the file */
  bool        found, from_file;

  PetscFunctionBeginUser;
  snprintf(shown, sizeof shown, "%s", option);
  for (int f = 0; case_schedule_form[f]; f++) {
    snprintf(name, sizeof name, "%s%s", option, case_schedule_form[f]);
    PetscCall(ReaderFind(r, name, &value, &found, &from_file));
    if (!found || (from_file && n[0]))
      continue; /* the command line replaces the file's whatever their forms */
    n[from_file]++;
    form = f;
    text = value;
    snprintf(shown, sizeof shown, "%s%s", from_file ? "" : "-", name);
  }
  if (form >= 0 && !KeyApplies(k, GROUP_BC, instance)) {
    ReaderError(r, shown, text, "is not a key of a boundary of type %s",
                cl_condition[((const Bc *)instance)->type].word);
  } else if (n[0] > 1 || (!n[0] && n[1] > 1)) {
    ReaderError(r, shown, text, "%s is given in two forms; choose one", option);
  } else if (form >= 0) {
    if (text)
      PetscCall(ScheduleGiven(r, shown, text, k, form, s));
    else
      ReaderError(r, shown, NULL, "has no value");
  } else if (KeyApplies(k, GROUP_BC, instance)) {
    if (k->needed ? k->needed(instance) : !k->def)
      KeyMissing(r, option, k);
    else if (*k->def)
      ScheduleParse(r, option, k->def, k, FORM_CONSTANT, s);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
