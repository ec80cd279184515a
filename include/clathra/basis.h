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
  Axis   axis[CL_DIM];
  double hoop[3]; /* (29) about an axis: weights of u_r/r, 1/m; times r they are the plain weights of (3) */
  double r;       /* radius of the domain's middle, m; 0 in the plane */
} Stencil;

/* x, l in m; h the cell size, lower the grid's lower corner and cells their number along this axis.  A domain that
   reaches over the grid's edge (fixed half-lengths under compression) is clipped there. */
void BasisAxis(BasisType type, double x, double l, double lower, double h, PetscInt cells, Axis *a);
/* The same for the radius: averages weighted with r (29); also the weights of u_r/r and the radius of the middle. */
void BasisRadius(BasisType type, double x, double l, double lower, double h, PetscInt cells, Axis *a, double hoop[3],
                 double *r);
/* Hat functions at a point: a surface face along its normal. */
void BasisHat(double x, double lower, double h, Axis *a);

/* Where a linear function takes the weights' value, m: the particle's centre, about an axis the ring's centroid. */
double AxisCentroid(const Axis *a, double lower, double h);

/* Local active numbers of the nodes, their weights and gradients, and about an axis (r > 0) H, the weights of u_r/r;
   returns how many (nodes of zero weight and gradient are left out). */
int StencilExpand(const Stencil *s, const Grid *g, const NodeMap *map, PetscInt node[CL_NODES], double S[CL_NODES],
                  double G[CL_NODES][CL_DIM], double H[CL_NODES]);
