/* spacing: the lines of the grid from sizes of its cells; docs/equations.md (304), (305).
     x: 0.5 m                            equal cells
     x: [0.05 m, 2 m, growth 1.15]       from the lower end: first size, largest size, ratio of neighbours at most
     x: {table: [0 m, 0.5 m, 4 m, 0.05 m, 10 m, 1 m]}   places, which are lines, and sizes there */
#include "case_private.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define FIT 1e-9 /* of a length: as good as equal */
#define MOST 100000

typedef struct {
  Reader     *r;
  const char *key; /* of the spacing */
  double      lower, upper;
  PetscInt    cells; /* made so far */
  double     *place; /* [MOST + 1] */
} Making;

#define FAIL(...) ReaderError(m->r, m->key, NULL, __VA_ARGS__)

static bool Add(Making *m, double place)
{
  if (m->cells >= MOST) {
    FAIL("makes more than %d cells", MOST);
    return false;
  }
  m->place[++m->cells] = place;
  return true;
}

/* Equal cells. */
static bool Equal(Making *m, double size)
{
  const double length = m->upper - m->lower, n = rint(length / size);

  if (n < 1.0 || fabs(n * size - length) > 1e-6 * size) {
    const double below = fmax(floor(length / size), 1.0);

    FAIL("cells of %g m do not fill %g m from grid_lower to grid_upper; nearest: %.9g m, %.9g m", size, length,
         length / below, length / (below + 1.0));
    return false;
  }
  for (double k = 1.0; k <= n; k++) {
    if (!Add(m, k == n ? m->upper : m->lower + k * length / n))
      return false;
  }
  return true;
}

/* Length of n cells (304). */
static double Length(double first, double largest, double growth, PetscInt n)
{
  double sum = 0.0, size = first;

  for (PetscInt k = 0; k < n; k++, size = fmin(size * growth, largest))
    sum += size;
  return sum;
}

/* (304): as few cells as the growth allows, which is then lowered until they fit. */
static bool Grow(Making *m, double first, double largest, double growth)
{
  const double length = m->upper - m->lower;
  double       sum = 0.0, size = first, low = 1.0, high = growth;
  PetscInt     n = 0;

  for (; sum < length * (1.0 - FIT); n++, size = fmin(size * growth, largest)) {
    if (n >= MOST) {
      FAIL("makes more than %d cells", MOST);
      return false;
    }
    sum += size;
  }
  if ((double)n * first > length * (1.0 + FIT)) {
    FAIL("%d cells of at least %g m are longer than the grid, %g m, and %d are shorter: give another first size",
         (int)n, first, length, (int)n - 1);
    return false;
  }
  for (int k = 0; k < 200 && sum > length * (1.0 + FIT); k++) {
    const double mid = 0.5 * (low + high);

    if (Length(first, largest, mid, n) > length)
      high = mid;
    else
      low = mid;
  }
  growth = sum > length * (1.0 + FIT) ? 0.5 * (low + high) : growth;
  sum    = 0.0;
  size   = first;
  for (PetscInt k = 1; k <= n; k++, size = fmin(size * growth, largest)) {
    sum += size;
    if (!Add(m, k == n ? m->upper : m->lower + sum))
      return false;
  }
  return true;
}

/* (305): from a to b, with cells of about h there. */
static bool Between(Making *m, const double a[2], const double b[2])
{
  const double length = b[0] - a[0], ratio = b[1] / a[1], slope = b[1] - a[1];
  const bool   equal = fabs(slope) <= FIT * a[1];
  const double n     = fmax(1.0, ceil((equal ? length / a[1] : length / slope * log(ratio)) - 1e-6));

  for (double k = 1.0; k <= n; k++) {
    const double x = equal ? k / n : a[1] * (pow(ratio, k / n) - 1.0) / slope;

    if (!Add(m, k == n ? b[0] : a[0] + x * length))
      return false;
  }
  return true;
}

static bool TakeTable(Making *m, const List *list)
{
  const double slack = FIT * (m->upper - m->lower);
  double       a[2]  = {0.0, 0.0}, b[2];

  if (list->n < 4 || list->n % 2) {
    FAIL("has %d values, needs pairs: place, size of the cells there, from grid_lower to grid_upper", (int)list->n);
    return false;
  }
  for (PetscInt i = 0; i < list->n; i += 2, a[0] = b[0], a[1] = b[1]) {
    const double end = i ? m->upper : m->lower;

    if (!RealRead(m->r, m->key, list->item[i], "m", "", &b[0]) ||
        !RealRead(m->r, m->key, list->item[i + 1], "m", "(0,1e6]", &b[1]))
      return false;
    if ((i == 0 || i + 2 == list->n) && fabs(b[0] - end) > slack) {
      FAIL("must go from grid_lower to grid_upper, %g..%g m, and has %g m there", m->lower, m->upper, b[0]);
      return false;
    }
    if (i && b[0] <= a[0]) {
      FAIL("its places must ascend (%g m after %g m)", b[0], a[0]);
      return false;
    }
    if (i == 0 || i + 2 == list->n)
      b[0] = end;
    if (i && !Between(m, a, b))
      return false;
  }
  return true;
}

static bool TakeSizes(Making *m, const List *list)
{
  double      first, largest, growth;
  const char *word = "growth";

  if (list->n == 1)
    return RealRead(m->r, m->key, list->item[0], "m", "(0,1e6]", &first) && Equal(m, first);
  if (list->n != 3) {
    FAIL("has %d values, needs one size, or the first size, the largest and the growth: [0.05 m, 2 m, growth 1.15]",
         (int)list->n);
    return false;
  }
  const char *third = list->item[2];
  if (!strncasecmp(third, word, strlen(word)))
    third += strlen(word) + strspn(third + strlen(word), " ");
  if (!RealRead(m->r, m->key, list->item[0], "m", "(0,1e6]", &first) ||
      !RealRead(m->r, m->key, list->item[1], "m", "(0,1e6]", &largest) ||
      !RealRead(m->r, m->key, third, "", "[1,2]", &growth))
    return false;
  if (first > largest) {
    FAIL("its first size is above the largest (%g m > %g m); a grid that is fine at its upper end has a table", first,
         largest);
    return false;
  }
  if (growth == 1.0)
    largest = first;
  return Grow(m, first, largest, growth);
}

/* No cell more than LINES_MOST times as wide as the next. */
static bool Gentle(const Making *m, bool *equal)
{
  double least = INFINITY, most = 0.0;

  for (PetscInt i = 1; i <= m->cells; i++) {
    const double h = m->place[i] - m->place[i - 1], next = i < m->cells ? m->place[i + 1] - m->place[i] : h;

    least = fmin(least, h);
    most  = fmax(most, h);
    if (fmax(h, next) > LINES_MOST * (1.0 + FIT) * fmin(h, next)) {
      FAIL("makes cells of %g m and %g m side by side at %g m: more than %g times as wide; lower the growth, or give "
           "sizes "
           "that lie closer",
           h, next, m->place[i], LINES_MOST);
      return false;
    }
  }
  *equal = most - least <= FIT * least;
  return true;
}

/* Are the cells that grid_cells names those? */
static void Count(Reader *r, Scene *c, int d, PetscInt cells)
{
  if (c->cells[d] && c->cells[d] != cells)
    FAIL_AT(GROUP_CASE, "", "grid_cells", "names %d cells along %c, but the spacing makes %d: auto takes those",
            (int)c->cells[d], "xyz"[d], (int)cells);
  c->cells[d] = cells;
}

/* The table's values, from "{table: [...]}" in one word, as the command line gives it, or its own key; NULL: there is
 * none. */
static const char *TableOf(const Scene *c, int d, char inner[SPACING])
{
  int form;

  if (c->table[d][0] || c->spacing[d][0] != '{')
    return c->table[d][0] ? c->table[d] : NULL;
  form = FormInBraces(c->spacing[d], inner);
  return form > 0 && !strcmp(case_schedule_form[form], "_table") ? inner : NULL;
}

static PetscErrorCode TakeAxis(Reader *r, Scene *c, int d)
{
  const bool  own = c->table[d][0];
  char        key[32], inner[SPACING];
  const char *table = TableOf(c, d, inner);
  Making      m     = {.r = r, .key = key, .lower = c->lower[d], .upper = c->upper[d]};
  List        list;
  bool        equal = true;

  PetscFunctionBeginUser;
  snprintf(key, sizeof key, "grid_spacing_%c%s", "xyz"[d], own ? "_table" : "");
  if (own && c->spacing[d][0])
    FAIL_AT(GROUP_CASE, "", key, "and grid_spacing_%c are two ways to say the same: give one", "xyz"[d]);
  PetscCall(PetscMalloc1(MOST + 1, &m.place));
  m.place[0] = m.lower;
  ListCreate(table ? table : c->spacing[d], &list);
  if ((table ? TakeTable(&m, &list) : TakeSizes(&m, &list)) && Gentle(&m, &equal)) {
    Count(r, c, d, m.cells);
    if (!equal)
      PetscCall(LinesCreate(m.cells, m.place, &c->line[d]));
  }
  ListDestroy(&list);
  PetscCall(PetscFree(m.place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CaseSpacing(Reader *r, Scene *c)
{
  const PetscInt before = r->nerror;

  PetscFunctionBeginUser;
  for (int d = 0; d < CL_DIM && !r->bad[GROUP_CASE] && c->upper[d] > c->lower[d]; d++) {
    if (c->spacing[d][0] || c->table[d][0])
      PetscCall(TakeAxis(r, c, d));
    else if (!c->cells[d])
      FAIL_AT(GROUP_CASE, "", "grid_cells", "is auto along %c, which needs grid_spacing_%c", "xyz"[d], "xyz"[d]);
  }
  r->bad[GROUP_CASE] |= r->nerror > before;
  for (int d = 0; d < CL_DIM; d++)
    c->cells[d] = PetscMax(c->cells[d], 1); /* what else is wrong is said of some grid */
  PetscFunctionReturn(PETSC_SUCCESS);
}
