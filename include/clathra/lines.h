/* lines: the lines of the background grid along one axis, equally spaced or not.  Pure data, the same on every rank.
   Units: places and widths in m, places in cells dimensionless. */
#pragma once

#include "clathra/base.h"

#define LINES_PAD 4    /* lines known beyond either end, as far apart as the last two */
#define LINES_MOST 2.0 /* ratio of neighbouring cells */

typedef struct {
  PetscInt cells;
  double   lower, upper;
  double   h;              /* width of every cell, of the narrowest where they differ, m */
  double  *x;              /* [-LINES_PAD, cells + LINES_PAD] places, m; NULL: equally spaced */
  PetscInt nguess, *guess; /* first cell of each of nguess equal parts */
} GridLines;

/* Equally spaced. */
static inline GridLines LinesEqual(double lower, double upper, PetscInt cells)
{
  return (GridLines){.cells = cells, .lower = lower, .upper = upper, .h = (upper - lower) / (double)cells};
}

/* From cells + 1 places that ascend; of a.x and a.guess LinesDestroy. */
PetscErrorCode LinesCreate(PetscInt cells, const double place[], GridLines *a);
/* Frees x and guess; nothing for equal cells. */
PetscErrorCode LinesDestroy(GridLines *a);

/* The nearest of the cells that are known. */
static inline PetscInt LinesKnown(const GridLines *a, PetscInt i)
{
  return PetscMin(PetscMax(i, -LINES_PAD), a->cells + LINES_PAD - 1);
}

/* Place of line i, and width of the cell to its right, m. */
static inline double LinesAt(const GridLines *a, PetscInt i)
{
  return a->x ? a->x[PetscMin(PetscMax(i, -LINES_PAD), a->cells + LINES_PAD)] : a->lower + (double)i * a->h;
}

/* Width of the cell to the right of line i, of the nearest known one beyond the ends, m. */
static inline double LinesWidth(const GridLines *a, PetscInt i)
{
  const PetscInt k = LinesKnown(a, i);

  return a->x ? a->x[k + 1] - a->x[k] : a->h;
}

/* Mean of the cells on both sides of line i, and the smaller of them, m. */
static inline double LinesAround(const GridLines *a, PetscInt i)
{
  return a->x ? 0.5 * (LinesWidth(a, i - 1) + LinesWidth(a, i)) : a->h;
}

/* The smaller of the cells on both sides of line i, m. */
static inline double LinesLess(const GridLines *a, PetscInt i)
{
  return a->x ? fmin(LinesWidth(a, i - 1), LinesWidth(a, i)) : a->h;
}

/* Cell of a place of unequal lines, also beyond their ends as far as lines are known there. */
PetscInt LinesFind(const GridLines *a, double x);

/* Width of the cell at x, of the smallest of it and its two neighbours, and the largest of all, m. */
static inline double LinesWidthAt(const GridLines *a, double x)
{
  return a->x ? LinesWidth(a, LinesFind(a, x)) : a->h;
}
/* Width of the smallest of the cell at x (m) and its two neighbours, m. */
double LinesLeastAt(const GridLines *a, double x);
/* Width of the largest cell, m. */
double LinesWidest(const GridLines *a);

/* (300): a place in cells from the first line on, and back. */
double LinesPlaceUnequal(const GridLines *a, double x);
/* The place (m) that lies s cells from the first line on; unequal lines. */
double LinesFromUnequal(const GridLines *a, double s);

/* A place (m) in cells from the first line on. */
static inline double LinesPlace(const GridLines *a, double x)
{
  return a->x ? LinesPlaceUnequal(a, x) : (x - a->lower) / a->h;
}

/* The place (m) that lies s cells from the first line on. */
static inline double LinesFrom(const GridLines *a, double s)
{
  return a->x ? LinesFromUnequal(a, s) : a->lower + s * a->h;
}

/* ---------------------------------------------------------------- boxes of cells or nodes */
/* Place of ij in an array over a box of nodes (or cells, ranks) from `lower` on, x running fastest. */
static inline PetscInt BoxPlace(const PetscInt lower[CL_DIM], const PetscInt size[CL_DIM], const PetscInt ij[CL_DIM])
{
  PetscInt at = 0;

  for (int d = CL_DIM - 1; d >= 0; d--)
    at = at * size[d] + ij[d] - lower[d];
  return at;
}

/* What stands at such a place. */
static inline void BoxAt(const PetscInt lower[CL_DIM], const PetscInt size[CL_DIM], PetscInt at, PetscInt ij[CL_DIM])
{
  for (int d = 0; d < CL_DIM; at /= size[d++])
    ij[d] = lower[d] + at % size[d];
}

/* How many places a box has. */
static inline PetscInt BoxSize(const PetscInt size[CL_DIM])
{
  PetscInt n = 1;

  for (int d = 0; d < CL_DIM; d++)
    n *= size[d];
  return n;
}

/* Is ij in the box? */
static inline bool BoxHolds(const PetscInt lower[CL_DIM], const PetscInt size[CL_DIM], const PetscInt ij[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++) {
    if (ij[d] < lower[d] || ij[d] >= lower[d] + size[d])
      return false;
  }
  return true;
}
