/* Unequal lines: their table of places, and which cell holds a place; docs/equations.md (300). */
#include "clathra/lines.h"

#define GUESSES 16 /* a cell, at most */

/* Equal parts of the axis, as many as the narrowest cell fits in. */
static PetscErrorCode Guess(GridLines *a)
{
  const double parts = ceil((a->upper - a->lower) / a->h);

  PetscFunctionBeginUser;
  a->nguess = (PetscInt)fmin(parts, (double)(GUESSES * a->cells));
  PetscCall(PetscMalloc1(a->nguess, &a->guess));
  for (PetscInt k = 0, i = 0; k < a->nguess; k++) {
    while (a->x[i + 1] <= a->lower + (double)k * (a->upper - a->lower) / (double)a->nguess)
      i++;
    a->guess[k] = i;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LinesCreate(PetscInt cells, const double place[], GridLines *a)
{
  double *x;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(cells + 1 + 2 * LINES_PAD, &x));
  *a = (GridLines){.cells = cells, .lower = place[0], .upper = place[cells], .h = INFINITY, .x = x + LINES_PAD};
  for (PetscInt i = 0; i <= cells; i++) {
    a->x[i] = place[i];
    if (i)
      a->h = fmin(a->h, place[i] - place[i - 1]);
  }
  for (PetscInt i = 1; i <= LINES_PAD; i++) {
    a->x[-i]        = a->lower - (double)i * (place[1] - place[0]);
    a->x[cells + i] = a->upper + (double)i * (place[cells] - place[cells - 1]);
  }
  PetscCall(Guess(a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LinesDestroy(GridLines *a)
{
  double *x = a->x ? a->x - LINES_PAD : NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(a->guess));
  a->x = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt LinesFind(const GridLines *a, double x)
{
  const double part = (x - a->lower) / (a->upper - a->lower) * (double)a->nguess;
  PetscInt     i    = a->guess[part > 0.0 ? (PetscInt)fmin(part, (double)(a->nguess - 1)) : 0];

  while (i < a->cells + LINES_PAD - 1 && x >= a->x[i + 1])
    i++;
  while (i > -LINES_PAD && x < a->x[i])
    i--;
  return i;
}

double LinesLeastAt(const GridLines *a, double x)
{
  if (!a->x)
    return a->h;
  const PetscInt i = PetscMin(PetscMax(LinesFind(a, x), 0), a->cells - 1);

  return fmin(LinesLess(a, i), LinesLess(a, i + 1));
}

double LinesWidest(const GridLines *a)
{
  double h = a->h;

  for (PetscInt i = 0; a->x && i < a->cells; i++)
    h = fmax(h, LinesWidth(a, i));
  return h;
}

double LinesPlaceUnequal(const GridLines *a, double x)
{
  const PetscInt i = LinesFind(a, x);

  return (double)i + (x - a->x[i]) / LinesWidth(a, i);
}

double LinesFromUnequal(const GridLines *a, double s)
{
  const PetscInt i = LinesKnown(a, (PetscInt)floor(s));

  return a->x[i] + (s - (double)i) * LinesWidth(a, i);
}
