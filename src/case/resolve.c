/* resolve: writes the case in SI, every key of the table at its value, such that reading it gives the same doubles; and
   prints the table itself. */
#include "case_private.h"
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void WriteText(FILE *f, const char *text)
{
  fputc('\'', f);
  for (; *text; text++) {
    if (*text == '\'')
      fputc('\'', f);
    fputc(*text, f);
  }
  fputc('\'', f);
}

/* The shortest text that reads back as the same double. */
static void WriteNumber(FILE *f, double value)
{
  char text[32];

  for (int digits = 15; digits <= 17; digits++) {
    snprintf(text, sizeof text, "%.*g", digits, value);
    if (strtod(text, NULL) == value)
      break;
  }
  fputs(text, f);
}

static void WriteReal(FILE *f, const Key *k, double value)
{
  if (isinf(value) && k->word)
    fputs(k->word + (*k->word == '-'), f);
  else {
    WriteNumber(f, value);
    fprintf(f, "%s%s", *k->unit ? " " : "", k->unit);
  }
}

static void WriteReals(FILE *f, const Key *k, const double *value, PetscInt n)
{
  if (n != 1)
    fputc('[', f);
  for (PetscInt i = 0; i < n; i++) {
    if (i)
      fputs(", ", f);
    WriteReal(f, k, value[i]);
  }
  if (n != 1)
    fputc(']', f);
}

static void WriteWaves(FILE *f, const Key *k, const Schedule *s)
{
  fputs("{sine: [", f);
  WriteReal(f, k, s->y[0]);
  for (PetscInt i = 0; i < s->nwave; i++) {
    fputs(", ", f);
    WriteNumber(f, s->wave[i].amplitude);
    fprintf(f, " %s, ", ScheduleDifference(k));
    WriteNumber(f, s->wave[i].period);
    fputs(" s, ", f);
    WriteNumber(f, s->wave[i].begin);
    fputs(" s", f);
  }
  fputs("]}", f);
}

static void WriteSchedule(FILE *f, const Key *k, const Schedule *s)
{
  if (s->nwave) {
    WriteWaves(f, k, s);
    return;
  }
  if (s->n == 1) {
    WriteReal(f, k, s->y[0]);
    return;
  }
  fprintf(f, "{%s: [", s->steps ? "piecewise" : "table");
  for (PetscInt i = 0; i < s->n; i++) {
    if (i)
      fputs(", ", f);
    WriteNumber(f, s->t[i]);
    fputs(" s, ", f);
    WriteReal(f, k, s->y[i]);
  }
  fputs("]}", f);
}

static void WritePoints(FILE *f, const Key *k, const Points *points)
{
  fputc('[', f);
  for (PetscInt i = 0; i < points->n; i++) {
    fputs(i ? ", " : "", f);
    WriteReals(f, k, points->x + 2 * i, 2);
  }
  fputc(']', f);
}

/* The name that an instance refers to by its place in the case's list; a stage's own list of conditions is shorter. */
static const char *Referred(const Case *c, Group g, PetscInt i)
{
  return g == GROUP_BC ? c->scene.listed[i].name : GroupInstance(c, g, i);
}

static void WriteNames(FILE *f, const Case *c, const Key *k, const Names *names)
{
  fputc('[', f);
  for (PetscInt i = 0; i < names->n; i++)
    fprintf(f, "%s%s", i ? ", " : "", Referred(c, k->names, names->i[i]));
  fputc(']', f);
}

bool KeyEmpty(const Key *k, const char *instance)
{
  const char *place = instance + k->offset;

  switch (k->kind) {
  case KEY_SCHEDULE:
    return ((const Schedule *)place)->n == 0;
  case KEY_POINTS:
    return ((const Points *)place)->n == 0;
  case KEY_NAMES:
    return ((const Names *)place)->n == 0;
  case KEY_REAL:
    return k->shape && isinf(*(const double *)place);
  default:
    return false;
  }
}

void KeyWrite(FILE *f, const Case *c, const Key *k, const char *instance)
{
  const char *place = instance + k->offset;

  switch (k->kind) {
  case KEY_REAL:
    WriteReals(f, k, (const double *)place, k->count);
    break;
  case KEY_INT:
    for (int i = 0; i < k->count; i++)
      fprintf(f, "%s%d", i ? ", " : k->count > 1 ? "[" : "", (int)((const PetscInt *)place)[i]);
    fputs(k->count > 1 ? "]" : "", f);
    break;
  case KEY_BOOL:
    if (k->choices)
      fputs(k->choices[*(const bool *)place], f);
    else
      fputs(*(const bool *)place ? "yes" : "no", f);
    break;
  case KEY_TEXT:
    WriteText(f, place);
    break;
  case KEY_CHOICE:
    fputs(k->choices[*(const int *)place - k->first], f);
    break;
  case KEY_LAW:
    fputs(k->law->get((const Material *)instance), f);
    break;
  case KEY_NAME: {
    PetscInt i = *(const PetscInt *)place;
    fputs(i >= 0 ? Referred(c, k->names, i) : k->word ? k->word : k->def, f);
    break;
  }
  case KEY_NAMES:
    WriteNames(f, c, k, (const Names *)place);
    break;
  case KEY_POINTS:
    WritePoints(f, k, (const Points *)place);
    break;
  case KEY_REALS:
    WriteReals(f, k, c->times, c->ntimes);
    break;
  case KEY_SCHEDULE:
    WriteSchedule(f, k, (const Schedule *)place);
    break;
  }
}

static void WriteInstance(FILE *f, const Case *c, Group g, const char *instance, const char *indent)
{
  for (const Key *k = case_group[g].key; k->name; k++) {
    if (k->like || !KeyApplies(k, g, instance) || !KeyActs(k, c, instance) || !KeyKnown(k, g, c, instance))
      continue;
    if (KeyEmpty(k, instance))
      continue;
    fprintf(f, "%s%s: ", indent, k->name);
    KeyWrite(f, c, k, instance);
    fputc('\n', f);
  }
}

static void WriteGroup(FILE *f, const Case *c, Group g)
{
  const GroupInfo *info = &case_group[g];
  PetscInt         n    = *GroupCount(c, g);

  fprintf(f, "\n%s: [", info->list);
  for (PetscInt i = 0; i < n; i++)
    fprintf(f, "%s%s", i ? ", " : "", GroupInstance(c, g, i));
  fputs("]\n", f);
  if (n)
    fprintf(f, "%.*s:\n", (int)strlen(info->prefix) - 1, info->prefix);
  for (PetscInt i = 0; i < n; i++) {
    fprintf(f, "  %s:\n", GroupInstance(c, g, i));
    WriteInstance(f, c, g, GroupInstance(c, g, i), "    ");
  }
}

PetscErrorCode CaseWriteResolved(const Case *c, FILE *f)
{
  char full[PATH_MAX];

  PetscFunctionBeginUser;
  fprintf(f, "# The case as it ran, in SI units with every default; itself a case.  Written by clathra from\n# %s\n",
          realpath(c->file, full) ? full : c->file);
  WriteInstance(f, c, GROUP_CASE, (const char *)c, "");
  for (Group g = GROUP_MATERIAL; g < GROUP_COUNT; g++)
    WriteGroup(f, c, g);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CaseText(const Case *c, PetscErrorCode (*write)(const Case *c, FILE *out), char **text, size_t *size)
{
  FILE *f = open_memstream(text, size);

  PetscFunctionBeginUser;
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  PetscCall(write(c, f));
  PetscCheck(fclose(f) == 0, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- the list of keys */
static void PrintKind(FILE *out, const Key *k)
{
  static const char *const kind[] = {"number", "integer",  "yes, no", "text",   "word", "law",
                                     "name",   "schedule", "list",    "points", "names"};
  const char *const       *word   = k->kind == KEY_LAW ? k->law->types() : k->choices;

  if (word)
    for (int i = 0; word[i]; i++)
      fprintf(out, "%s%s", i ? ", " : "", word[i]);
  else
    fputs(kind[k->kind], out);
  if ((k->kind == KEY_REAL || k->kind == KEY_INT) && k->count > 1)
    fprintf(out, " x %d", k->count);
}

static void PrintTypes(FILE *out, const Key *k)
{
  const char *comma = "";

  if (!k->types)
    return;
  fputs(" (types: ", out);
  for (int kind = BC_NONE + 1; kind < BC_COUNT; kind++) {
    if (!(k->types >> kind & 1u))
      continue;
    fprintf(out, "%s%s", comma, cl_condition[kind].word);
    comma = ", ";
  }
  fputc(')', out);
}

static void PrintKey(FILE *out, Group g, const Key *k)
{
  const char *at = k->def ? strchr(k->def, '@') : NULL;

  if (g == GROUP_CASE)
    fprintf(out, "| `%s` | ", k->name);
  else
    fprintf(out, "| `%s<name>_%s` | ", case_group[g].prefix, k->name);
  PrintKind(out, k);
  fprintf(out, " | %s | %s | ", k->unit, *k->range ? k->range : "");
  if (!k->def)
    fputs("**required**", out);
  else if (at)
    fprintf(out, "%.*s times %s", (int)(at - k->def - 1), k->def, at + 1);
  else
    fputs(k->def, out);
  if (k->when)
    fprintf(out, "%s**required** when %s", k->def && *k->def ? "; " : "", k->when);
  fprintf(out, " | %s", k->doc);
  PrintTypes(out, k);
  if (k->by) {
    char words[64];

    IntegratorsWords(k->by, words);
    fprintf(out, " (%s)", words);
  }
  fputs(" |\n", out);
}

PetscErrorCode CasePrintKeys(FILE *out)
{
  PetscFunctionBeginUser;
  fputs(
      "Nested maps of a case file join to one name: `mat: {sand: {porosity: 0.3}}` is the key `mat_sand_porosity`, "
      "and\n"
      "`-mat_sand_porosity 0.3` on the command line replaces it. A quantity carries a unit that measures the same as\n"
      "the SI unit below. A schedule is a value, or one of `{table: [t0, v0, t1, v1, ...]}` (linear between times),\n"
      "`{ramp: [v0, v1, t0, t1]}`, `{rate: [v0, rate, t0, t1]}` (from v0 at t0 until t1),\n"
      "`{piecewise: [t0, v0, t1, v1, ...]}` (each value holds until the next time), `{sine: [mean, amplitude, period,\n"
      "begin, ...]}` (one or more waves, zero and rising at their begin) and `{csv: [FILE, COLUMN]}` (a file beside\n"
      "the case whose first line names its columns with units: `time [h], sea [kPa]`; the first is the time, COLUMN\n"
      "by default the second). YAML's anchors and merge keys repeat keys: `sand: &sand {...}`, `clay: {<<: *sand,\n"
      "porosity: 0.5}`. A list of names on the command line (`-probes a,b`) replaces the file's. Times are in s, min,\n"
      "h, d, weeks, months (a twelfth of a year) and a (365.25 d), or those words in full.\n\n",
      out);
  for (Group g = GROUP_CASE; g < GROUP_COUNT; g++) {
    const GroupInfo *info = &case_group[g];
    fprintf(out, "%s### %s\n\n", g ? "\n" : "", info->doc);
    if (info->list)
      fprintf(out, "`%s`: the list of their names%s.\n\n", info->list,
              info->required ? ", **required**" : "; may be left out");
    fputs("| key | kind | SI unit | range | default | meaning |\n|---|---|---|---|---|---|\n", out);
    for (const Key *k = info->key; k->name; k++)
      PrintKey(out, g, k);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
