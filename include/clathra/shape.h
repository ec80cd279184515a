/* shape: which points a region of the case holds, where its particles are, and the surface they make.  Pure functions
   of the case; every rank gets the same. */
#pragma once

#include "clathra/scene.h"

/* Places for the particles of a region, i < n: from from + (first + i) spacing to as much of i + 1, m.  Where the
   grid's cells differ, in cells from its first line on, and from (first + i) spacing, but that the first begins at from
   and the last ends at to. */
typedef struct {
  PetscInt  first[CL_DIM], n[CL_DIM];
  double    from[CL_DIM], spacing[CL_DIM], to[CL_DIM];
  GridLines line[CL_DIM];
} Lattice;

/* A region that is to be cut out of others and holds no particles? */
static inline bool RegionEmpty(const Region *r)
{
  return r->material < 0;
}

/* A box that nothing is cut out of, and which its particles fill exactly? */
static inline bool RegionWhole(const Region *r)
{
  return r->shape == SHAPE_BOX && r->minus.n == 0;
}

/* Bounds of the shape inside `lower` and `upper` as given (infinite where not), which they replace. */
void RegionBound(const Scene *c, Region *r);
/* Does the region hold x (m), without what `minus` takes away?  A point on an edge that two regions share belongs to
   one of them. */
bool RegionHolds(const Scene *c, PetscInt region, const double x[]);
/* The region with particles that holds x (m); -1: there is none. */
PetscInt RegionAt(const Scene *c, const double x[]);
/* ... or does its boundary pass within `slack` (m, along each axis)? */
bool RegionReaches(const Scene *c, PetscInt region, const double x[], const double slack[]);
/* Greatest coordinate (m) along a direction in the region, or a little more. */
double RegionHighest(const Region *r, const double direction[]);
/* The highest (sign 1) or lowest (-1) point of a region, on the vertical through the origin, m; with gravity. */
void RegionExtreme(const Scene *c, const Region *g, double sign, double x[CL_DIM]);
/* Height of the highest point of the regions, m; 0 without gravity. */
double SceneTop(const Scene *c);
/* Height of their lowest point, m; 0 without gravity. */
double SceneFoot(const Scene *c);
/* A height that a key gives, m; infinite, which stands for its word: the top. */
double SceneDatum(const Scene *c, double datum);

/* A box is cut into whole spacings: ppc per cell where it follows the grid, the nearest number elsewhere; other shapes,
   and boxes where cells differ, take the places of a regular filling of the grid's cells. */
void RegionLattice(const Scene *c, PetscInt region, Lattice *lattice);
/* Width along axis d of the place that holds x, m. */
double LatticeWidth(const Lattice *lattice, int d, double x);
/* Centre of place ij, m; is there a particle? */
bool RegionPlace(const Scene *c, PetscInt region, const Lattice *lattice, const PetscInt ij[], double x[]);
/* Bits 1 << Side of those sides of the particle at place ij beyond which no region has a particle. */
PetscInt RegionFaces(const Scene *c, PetscInt region, const Lattice *lattice, const PetscInt ij[]);

/* Area vector of the true surface that a face stands for, per area of its own (dimensionless): n/(|n_x| + |n_y|) with
   the outward normal n of the boundary between its particle, initially at x, and the next place; on boxes that of the
   side. */
void FaceNormal(const Scene *c, PetscInt region, const double x[], int side, double n[]);
/* Is the face one of those that a meter, or a condition written as one, names?  A line takes the faces whose normal,
   drawn LINE_REACH particle spacings out and in from the centre of the initial face, meets it. */
#define LINE_REACH 0.6
#define BcFaces(b)                                                                                                     \
  ((Meter){.side = (b)->side, .region = (b)->region, .from = (b)->from, .to = (b)->to, .along = (b)->along, .well = -1})
/* x: centre of the initial face, m; side: SIDE_... of the particle, SIDE_COUNT of a well, which no
   side names; region: its region. */
bool FaceNamed(const Scene *c, const Meter *m, PetscInt region, const double x[], int side);
