/* csv: a function of time from a column of a file.  Its first line names the columns with their units, "time [h], sea
   [kPa]"; the first column is the time.  Lines that begin with # are skipped.  The path is beside the case file. */
#include "case_private.h"
#include <ctype.h>
#include <libgen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef struct {
  Reader     *r;
  const char *shown, *name; /* of the key, of the file */
  const Key  *key;
  PetscInt    column;
  char        unit[2][64]; /* of the time, of the values */
} Table;

/* "name [unit]": the name, and the unit behind it. */
static void SplitHeading(const char *item, char name[64], char unit[64])
{
  const char *open = strchr(item, '['), *close = open ? strchr(open, ']') : NULL;
  int         n = open ? (int)(open - item) : (int)strlen(item);

  while (n > 0 && isspace((unsigned char)item[n - 1]))
    n--;
  snprintf(name, 64, "%.*s", n, item);
  unit[0] = '\0';
  if (close)
    snprintf(unit, 64, "%.*s", (int)(close - open - 1), open + 1);
}

/* The columns of the time and of the values; false: one error was added. */
static bool ReadHeading(Table *t, const List *heading, const char *wanted)
{
  char name[64], all[256] = "";

  t->column = -1;
  for (PetscInt i = 0; i < heading->n; i++) {
    char unit[64];

    SplitHeading(heading->item[i], name, unit);
    snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s", i ? ", " : "", name);
    if (i == 0)
      strcpy(t->unit[0], unit);
    else if (wanted ? !strcasecmp(name, wanted) : i == 1) {
      t->column = i;
      strcpy(t->unit[1], unit);
    }
  }
  if (t->column > 0)
    return true;
  ReaderError(t->r, t->shown, t->name, "its first line has no column %s (it has: %s)", wanted ? wanted : "of values",
              all);
  return false;
}

/* The number of a cell with the unit of its column. */
static bool ReadCell(const Table *t, PetscInt line, const char *cell, int which, double *value)
{
  const char *unit = which ? t->key->unit : "s", *range = which ? t->key->range : "";
  char        text[160], why[CASE_WHY];

  snprintf(text, sizeof text, "%.80s%s%s", cell, *t->unit[which] ? " " : "", t->unit[which]);
  if (!QuantityParse(text, unit, value, why))
    ReaderError(t->r, t->shown, t->name, "line %d: '%s' %s", (int)line, text, why);
  else if (!RangeHolds(range, *value))
    ReaderError(t->r, t->shown, t->name, "line %d: '%s' is out of range, allowed: %s %s", (int)line, text, range, unit);
  else
    return true;
  return false;
}

static bool ReadRow(const Table *t, PetscInt line, const List *row, Schedule *s)
{
  double time, value;

  if (row->n <= t->column) {
    ReaderError(t->r, t->shown, t->name, "line %d has %d values; column %d is wanted", (int)line, (int)row->n,
                (int)t->column + 1);
    return false;
  }
  if (!ReadCell(t, line, row->item[0], 0, &time) || !ReadCell(t, line, row->item[t->column], 1, &value))
    return false;
  if (s->n && time <= s->t[s->n - 1]) {
    ReaderError(t->r, t->shown, t->name, "line %d: its times must ascend", (int)line);
    return false;
  }
  s->t[s->n]   = time;
  s->y[s->n++] = value;
  return true;
}

static bool ReadLines(Table *t, char *text, const char *wanted, Schedule *s)
{
  PetscInt line = 0;
  bool     ok = true, heading = true;
  size_t   rows = 1;

  for (const char *p = text; *p; p++)
    rows += *p == '\n';
  s->t = calloc(rows, sizeof *s->t);
  s->y = calloc(rows, sizeof *s->y);
  for (char *p = text, *next; ok && p; p = next) {
    List list;

    next = strchr(p, '\n');
    if (next)
      *next++ = '\0';
    line++;
    if (!p[strspn(p, " \t\r")] || *p == '#')
      continue;
    p[strcspn(p, "\r")] = '\0';
    ListCreate(p, &list);
    ok      = heading ? ReadHeading(t, &list, wanted) : ReadRow(t, line, &list, s);
    heading = false;
    ListDestroy(&list);
  }
  if (ok && !s->n)
    ReaderError(t->r, t->shown, t->name, "has no rows");
  return ok && s->n;
}

PetscErrorCode ScheduleCsv(Reader *r, const char *shown, const char *text, const Key *k, Schedule *s, bool *ok)
{
  Table t = {.r = r, .shown = shown, .key = k};
  char  folder[PETSC_MAX_PATH_LEN], path[2 * PETSC_MAX_PATH_LEN], why[CASE_WHY], *rows;
  List  list;

  PetscFunctionBeginUser;
  ListCreate(text, &list);
  t.name = list.n ? list.item[0] : "";
  *ok    = list.n == 1 || list.n == 2;
  if (*ok) {
    snprintf(folder, sizeof folder, "%s", r->file);
    snprintf(path, sizeof path, "%s%s%s", *t.name == '/' ? "" : dirname(folder), *t.name == '/' ? "" : "/", t.name);
    PetscCall(ReaderText(r, path, &rows, why));
    *ok = rows != NULL;
    if (!rows)
      ReaderError(r, shown, t.name, "%s: %s", path, why);
    else
      *ok = ReadLines(&t, rows, list.n == 2 ? list.item[1] : NULL, s);
    free(rows);
  } else
    ReaderError(r, shown, text, "needs a file, and the name of its column if that is not the second: [FILE, COLUMN]");
  ListDestroy(&list);
  PetscFunctionReturn(PETSC_SUCCESS);
}
