/* basis: weights and gradients of a particle's domain, as tensor products. */
#pragma once

#include "clathra/case.h"
#include "clathra/grid.h"

#define CL_NODES 9 /* nodes a particle can reach: 3 per axis */

/* One axis: nodes base, base+1, base+2; docs/equations.md (3), (4). */
typedef struct {
  PetscInt base;
  double   S[3], dS[3]; /* -, 1/m */
} Axis;

typedef struct {
  Axis axis[CL_DIM];
} Stencil;

/* x, l in m; h the cell size, lower the grid's lower corner and cells their number along this axis.  A domain that
   reaches over the grid's edge (fixed half-lengths under compression) is clipped there. */
void BasisAxis(BasisType type, double x, double l, double lower, double h, PetscInt cells, Axis *a);
/* Hat functions at a point: a surface face along its normal. */
void BasisHat(double x, double lower, double h, Axis *a);

/* Local active numbers of the nodes, their weights and gradients; returns how many (nodes of zero weight and
   gradient are left out). */
int StencilExpand(const Stencil *s, const Grid *g, const NodeMap *map, PetscInt node[CL_NODES], double S[CL_NODES],
                  double G[CL_NODES][CL_DIM]);
