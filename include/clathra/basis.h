/* basis: weights and gradients of a particle's domain, as tensor products. */
#pragma once

#include "clathra/scene.h"
#include "clathra/grid.h"

enum { CL_NODES = CL_DIM == 2 ? 9 : 27 }; /* nodes a particle can reach: 3 per axis */

/* Of a cell: a domain edge so close to a grid line lies on it; a thinner sliver drowns in round-off. */
#define BASIS_SNAP 1e-6

/* A place in cells, on the grid line that it all but lies on. */
static inline double BasisSnap(double s)
{
  const double line = rint(s);

  return fabs(s - line) < BASIS_SNAP ? line : s;
}

/* The domain along one axis in cells: [lo, hi], clipped at the grid's edge, and the length that gradients are divided
 * by, in cells. */
typedef struct {
  double lo, hi, length;
} BasisDomain;

/* The same where cells differ, with the widths of the two cells it may lie in, its own and that of gradients, m (301).
 */
typedef struct {
  double lo, hi, width[2], length, gradient_length;
} BasisSpan;

/* Of a cell: the thinnest half-length, that of ten particles along a cell (374). */
#define BASIS_THINNEST 0.05

/* Half-length that a domain acts with: a longer one would reach four nodes, and what a motion has made thin has slivers
   that bound the explicit step (150), so it is widened, but not over the edge of the grid, which is `room` away (374);
   all in m. */
static inline double BasisHalfLength(BasisType type, double l, double h, double room)
{
  const double thinnest = BASIS_THINNEST * h < room ? BASIS_THINNEST * h : room;
  const double r        = type == BASIS_CPGIMP && l < thinnest ? thinnest : l;

  return r < 0.5 * h ? r : 0.5 * h;
}

/* Domain of a particle at x with half length l (m) along an axis of so many cells of width h (m) from `lower` on, cut
   where it would leave the grid. */
static inline BasisDomain BasisDomainOf(BasisType type, double x, double l, double lower, double h, double cells)
{
  const double s = (x - lower) / h, room = s < cells - s ? s : cells - s;
  const double r = BasisHalfLength(type, l, h, room * h) / h, from = BasisSnap(s - r), to = BasisSnap(s + r);
  const bool   clipped = (s >= 0.0) & (s <= cells) & ((from < 0.0) | (to > cells));
  const double lo = (clipped & (from < 0.0)) ? 0.0 : from, hi = (clipped & (to > cells)) ? cells : to;

  return (BasisDomain){lo, hi, clipped ? hi - lo : 2.0 * r};
}

/* (3), (301) for a domain in two cells of widths w0, w1, without branches: the kernels of src/explicit take it for many
   particles at once.  a, b: edges of the domain from the first node on, in cells, 0 <= a < 1, a < b <= 2; length: its
   own, in the unit of the widths.  Equal cells: w0 = w1 = 1 and length b - a. */
static inline void BasisAverage(double a, double b, double w0, double w1, double length, double gradient_length,
                                double S[3], double dS[3])
{
  const bool   third = b > 1.0;
  const double a1 = 1.0 - a, b1 = third ? 0.0 : 1.0 - b, b2 = 2.0 - b, over = third ? b - 1.0 : 0.0;

  S[0]  = w0 * ((1.0 - 0.5 * b1 * b1) - (1.0 - 0.5 * a1 * a1)) / length;
  S[1]  = ((third ? 0.5 * (w0 + w1) - w1 * (0.5 * b2 * b2) : w0 * (0.5 * b * b)) - w0 * (0.5 * a * a)) / length;
  S[2]  = w1 * (0.5 * over * over) / length;
  dS[0] = (b1 - a1) / gradient_length;
  dS[1] = (1.0 - fabs(b - 1.0) - (1.0 - a1)) / gradient_length;
  dS[2] = (third ? 1.0 - b2 : 0.0) / gradient_length;
}

/* Which of the two cells behind the first node of a stencil holds a particle: 0 or 1; s its place in cells, first the
   node, cells those of the grid along the axis. */
static inline int BasisCell(double s, double first, double cells)
{
  return floor(BasisSnap(s)) > first && first + 1.0 < cells;
}

/* One axis: nodes base, base+1, base+2; docs/equations.md (3), (4). */
typedef struct {
  PetscInt base;
  double   S[3], dS[3]; /* -, 1/m */
} Axis;

typedef struct {
  Axis   axis[CL_DIM];
  double hoop[3];      /* (29) about an axis: weights of u_r/r, 1/m; times r they are the plain weights of (3) */
  double r;            /* radius of the domain's middle, m; 0 in the plane */
  int    cell[CL_DIM]; /* the particle's cell from base on, 0 or 1 along each axis */
} Stencil;

/* x, l in m.  A domain that reaches over the grid's edge (fixed half-lengths under compression) is clipped there. */
void BasisAxis(BasisType type, double x, double l, const GridLines *line, Axis *a);
/* The same for the radius: averages weighted with r (29); also the weights hoop of u_r/r (1/m) and the radius r of the
   middle (m). */
void BasisRadius(BasisType type, double x, double l, const GridLines *line, Axis *a, double hoop[3], double *r);
/* Hat functions at a point: a surface face along its normal; x in m. */
void BasisHat(double x, const GridLines *line, Axis *a);

/* Half-length that a domain acts with at x, m (302), (374). */
double BasisReach(BasisType type, const GridLines *line, double x, double l);
/* The domain where cells differ. */
BasisSpan BasisSpanOf(BasisType type, const GridLines *line, double x, double l);

/* The particle's cell along an axis, from its first node on. */
static inline int BasisCellAt(const GridLines *line, double x, const Axis *a)
{
  return BasisCell(LinesPlace(line, x), (double)a->base, (double)line->cells);
}

/* Where a linear function takes the weights' value, m: the particle's centre, about an axis the ring's centroid. */
double AxisCentroid(const Axis *a, const GridLines *line);

/* The part of a domain in each of the two cells behind its first node, along one axis: its share of the domain; that
   times the mean over it of the hat function of the cell's second node; and the length that weights have over that of
   gradients, which differ where an edge lies on a line that it is BASIS_SNAP from. */
typedef struct {
  double share[2], at[2], whole;
} AxisParts;

/* S, dS: weights of a domain along the axis (dS in 1/m); h0, h1: widths of the two cells, m. */
static inline AxisParts AxisPartsOf(const double S[3], const double dS[3], double h0, double h1)
{
  AxisParts a = {.whole = dS[2] * h1 - dS[0] * h0};

  a.share[0] = -dS[0] * h0 / a.whole;
  a.share[1] = dS[2] * h1 / a.whole;
  a.at[0]    = a.share[0] - S[0];
  a.at[1]    = S[2];
  return a;
}

enum {
  CELL_MEAN    = 1 << CL_DIM,                            /* means over a cell of products of hats, one factor an axis */
  CELL_MOMENTS = CL_DIM == 2 ? 2 * CELL_MEAN : CELL_MEAN /* about an axis those over r beside them */
};

/* What a domain's part in cell c has of mean k: bit d of c says in which of the two cells along axis d it lies, bit d
   of k whether the hat function of the cell's second node along d is a factor. */
static inline double PartMoment(const AxisParts a[CL_DIM], int c, int k)
{
  double part = 1.0;

  for (int d = 0; d < CL_DIM; d++)
    part *= k >> d & 1 ? a[d].at[c >> d & 1] : a[d].share[c >> d & 1];
  return part;
}

/* Mean over the material in a cell of the gradients of its nodes' functions (88), 1/m; bit d of a node's number says
   whether it is the second along axis d; hoop: of N/r, about an axis only. */
typedef struct {
  double Q[CL_CORNERS][CL_DIM], hoop[CL_CORNERS];
} CellMean;

/* moment: sums over the parts in the cell of V PartMoment, m^3, moment[0] > 0 (about an axis behind them those over
   the radius, m^2); h: widths of the cell, m. */
void CellMeanOf(const double moment[CELL_MOMENTS], const double h[CL_DIM], bool axisymmetric, CellMean *c);

/* Parts of a stencil's domain along the axes, and the cells that it lies in, by the local active numbers of their first
   nodes, with its shares in them; -1 where it has none, or the cell is beyond the grid's padding. */
void StencilCells(const Stencil *s, const Grid *g, const NodeMap *map, AxisParts part[CL_DIM],
                  PetscInt cell[CL_CORNERS], double share[CL_CORNERS]);
/* About an axis: the parts along r of the domain over r, 1/m, from those of the domain (`whole` is not set). */
AxisParts StencilRing(const Stencil *s, const Grid *g, const AxisParts *radial);

/* Those nodes of a stencil that carry a weight or a gradient, x running fastest: how far each is from the first one
   along each axis, 0 to 2; returns how many. */
int StencilNodes(const Stencil *s, int k[CL_NODES][CL_DIM]);
/* Local active numbers of the nodes, their weights S and gradients G (1/m), and about an axis (r > 0) H (1/m), the
   weights of u_r/r; returns how many (nodes of zero weight and gradient are left out). */
int StencilExpand(const Stencil *s, const Grid *g, const NodeMap *map, PetscInt node[CL_NODES], double S[CL_NODES],
                  double G[CL_NODES][CL_DIM], double H[CL_NODES]);
