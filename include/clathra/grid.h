/* grid: the background grid, its distribution over ranks, and the numbering of active nodes. */
#pragma once

#include "clathra/lines.h"

/* Grid of rectangles between lines of either axis.  The owner of node (i,j) owns cell (i,j), the one to its right and
   above. Local node arrays are padded by two nodes on every side, also outside the grid (never active there). */
typedef struct {
  MPI_Comm    comm;
  PetscMPIInt rank, size;
  GridLines   line[CL_DIM];
  double      lower[CL_DIM]; /* m */
  PetscInt    cells[CL_DIM];
  DM          da; /* nodes; box stencil of width 2 */
  PetscInt    nproc[CL_DIM];
  PetscInt   *start[CL_DIM];          /* first node of each column/row of ranks, and the end */
  PetscInt    xs[CL_DIM], xm[CL_DIM]; /* owned nodes */
  PetscInt    gs[CL_DIM], gm[CL_DIM]; /* padded local range: gs = xs - 2, gm = xm + 4 */
  PetscInt    shared;                 /* how often it was shared out: whatever follows the layout is of one such time */
} Grid;

/* Can a grid of so many cells be shared among so many ranks?  GridCreate fails if not. */
bool GridFits(PetscMPIInt size, const PetscInt cells[]);
/* The lines stay the caller's, who keeps them as long as the grid; GridCreate makes equal cells. */
PetscErrorCode GridCreateOn(MPI_Comm comm, const GridLines line[CL_DIM], Grid *g);
/* A grid of equal cells between two corners (m), shared among the ranks.  Collective. */
PetscErrorCode GridCreate(MPI_Comm comm, const double lower[], const double upper[], const PetscInt cells[], Grid *g);
/* Frees the layout; the lines stay their owner's.  Collective. */
PetscErrorCode GridDestroy(Grid *g);
/* Takes a way to share `size` ranks among the axes, with the nodes along its seams; may end the search by an error. */
typedef PetscErrorCode GridShareFn(const PetscInt nproc[], double seam, void *ctx);
/* Gives `take` every way that leaves a rank three nodes along an axis. */
PetscErrorCode GridShares(PetscMPIInt size, const PetscInt cells[], GridShareFn *take, void *ctx);
/* Borders along an axis of so many cells, start[nproc + 1], that part the load of its columns of cells (NULL: the same
   in each) as evenly as whole columns and three nodes a rank allow. */
void GridEvenBorders(PetscInt cells, const PetscInt *load, PetscInt nproc, PetscInt *start);
/* Of all ranks the struct whose first member, a double, is largest; bytes: its size.  Collective. */
PetscErrorCode GridShareLargest(MPI_Comm comm, void *largest, size_t bytes);
/* Are these borders of all ranks, with three nodes for each along a shared axis? */
bool GridSound(const Grid *g, const PetscInt nproc[], PetscInt *const start[]);
/* Shares the grid out anew, start[CL_DIM][nproc + 1] being the first nodes of the boxes of ranks and the end:
   particles, numbering and whatever else follows the layout are to be made anew by the caller.  Collective. */
PetscErrorCode GridShare(Grid *g, const PetscInt nproc[], PetscInt *const start[]);
/* ... in equal boxes with the least seams.  Collective. */
PetscErrorCode GridShareEvenly(Grid *g);
/* The rank that would own a cell with these borders. */
PetscMPIInt GridBoxOwner(const PetscInt nproc[], PetscInt *const start[], const PetscInt cell[]);
/* Cell of a point x (m); false outside the grid.  Points on the upper edge belong to the last cell. */
bool GridCell(const Grid *g, const double x[], PetscInt cell[]);
/* The rank that owns a cell, as its lower left node is owned. */
PetscMPIInt GridCellOwner(const Grid *g, const PetscInt cell[]);

/* Place of a node, m. */
static inline double GridNode(const Grid *g, int d, PetscInt i)
{
  return LinesAt(&g->line[d], i);
}

/* Square of the largest wave number that the grid carries, 1/m^2: anywhere, and near a place. */
static inline double GridHighest2(const Grid *g)
{
  double k2 = 0.0;

  for (int d = 0; d < CL_DIM; d++)
    k2 += 4.0 / PetscSqr(g->line[d].h);
  return k2;
}

/* The same of the smallest of the cell at x (m) and its neighbours, 1/m^2. */
static inline double GridHighest2At(const Grid *g, const double x[CL_DIM])
{
  double k2 = 0.0;

  for (int d = 0; d < CL_DIM; d++)
    k2 += 4.0 / PetscSqr(LinesLeastAt(&g->line[d], x[d]));
  return k2;
}

/* Place of node ij in arrays over this rank's nodes and ghosts. */
static inline PetscInt GridPadded(const Grid *g, const PetscInt ij[CL_DIM])
{
  return BoxPlace(g->gs, g->gm, ij);
}

/* How many places these have. */
static inline PetscInt GridPaddedSize(const Grid *g)
{
  return BoxSize(g->gm);
}

#define CL_NODE_DOUBLES 40 /* of a node in one exchange, at most but for blocks */

/* Active nodes: owned ones first (they are a Vec's local part), then ghosts. */
typedef struct {
  PetscInt  n_owned, n_local;             /* active nodes: owned, owned + ghost */
  PetscInt  n_global, first;              /* over all ranks; global number of the first owned one */
  PetscInt *index;                        /* padded node -> local active number, -1 if inactive */
  PetscInt (*ij)[CL_DIM];                 /* local active number -> grid node */
  PetscInt    *global;                    /* local active number -> global number */
  PetscSF      sf;                        /* ghosts -> owners */
  MPI_Datatype unit[CL_NODE_DOUBLES + 1]; /* nc doubles, made on demand */
  MPI_Datatype block;                     /* of more than those: in_block, one number the map's life long */
  PetscInt     in_block;
} NodeMap;

/* Numbers the nodes whose flag (padded array) is set on any rank; *changed tells whether the map is a new one.
   Collective. */
PetscErrorCode NodeMapUpdate(const Grid *g, const unsigned char *flag, NodeMap *map, bool *changed);
/* Frees the numbering; the map can be updated anew afterwards.  Collective. */
PetscErrorCode NodeMapDestroy(NodeMap *map);
/* a: n_local x nc, in any unit.  Adds the ghosts' values to their owners and gives every rank the sum. */
PetscErrorCode NodeMapSum(NodeMap *map, double *a, PetscInt nc);
/* Adds ghosts to owners only; a: n_local x nc, in any unit. */
PetscErrorCode NodeMapReduce(NodeMap *map, double *a, PetscInt nc);
/* Gives ghosts their owners' values; a: n_local x nc, in any unit. */
PetscErrorCode NodeMapBroadcast(NodeMap *map, double *a, PetscInt nc);

/* Local active number of node ij; -1: inactive, or not known to this rank. */
static inline PetscInt NodeMapAt(const Grid *g, const NodeMap *map, const PetscInt ij[CL_DIM])
{
  return BoxHolds(g->gs, g->gm, ij) ? map->index[GridPadded(g, ij)] : -1;
}

/* A field at the nodes of a map. */
typedef struct {
  const double *value; /* [n_local], of any unit; a node where it is not finite has none */
  const double *flow;  /* [n_local][CL_DIM]: the way it is carried, of which only signs count */
  double        least; /* what differences to both sides together have to exceed to be seen */
  bool          bends; /* every bend counts, not those alone that the next node has the other way */
} NodalField;

/* Of a node along an axis: how much the field alternates there, 0 to 1 (440); 1 where it has neighbours on both sides.
 */
enum { ALTERNATION_SHARE = 0, ALTERNATION_KNOWN, ALTERNATION_COUNT };
/* share: [n_local][CL_DIM][ALTERNATION_COUNT], dimensionless.  Collective. */
PetscErrorCode NodeMapAlternation(const Grid *g, NodeMap *map, const NodalField *f, double *share);
/* The share of a particle, from the means over its nodes of theirs along each axis; K: its (293). */
double AlternationOf(const double mean[CL_DIM][ALTERNATION_COUNT], const double h[CL_DIM],
                     const double K[CL_SYMMETRIC]);
