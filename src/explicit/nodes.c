/* Nodes of the explicit integrators: numbering, prescribed unknowns, and who follows whom (41). */
#include "nodes.h"

#define TIE 0.25    /* of the volume of a neighbour: an emptier node follows it in part (41) */
#define MARGIN 1.01 /* among neighbours about as full the first stays, whatever the order of sums */
#define HOPS 3      /* from a nearly empty node to one that is not */
#define TORN 0.01   /* opening (427) beyond which ground is no continuum (454) */

enum { DIRECTIONS = 2 * CL_DIM };

/* ---------------------------------------------------------------- numbering */
static PetscErrorCode Allocate(Explicit *e)
{
  const Set      s = e->set;
  const PetscInt n = e->map.n_local + 1;
  const PetscInt A = LANES * Rows(A_Count(s)), B = LANES * Rows(B_Count(s)), R = LANES * Rows(PetscMax(R_Count(s), 1)),
                 C = C_Width(s);
  double *at;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(e->raw));
  PetscCall(PetscFree(e->alternates));
  PetscCall(PetscFree7(e->inc, e->gain, e->link, e->lean, e->torn, e->node, e->slot));
  e->rows = n;
  PetscCall(PetscFree3(e->spring, e->answer, e->push));
  PetscCall(PetscFree4(e->cell, e->mean, e->swell, e->part));
  if (SceneHasCellMeans(e->m->c))
    PetscCall(PetscCalloc4(n * CELL_MEAN, &e->cell, n, &e->mean, n, &e->swell, n, &e->part));
  if (SceneCarriesHeat(e->m->c) && !e->o.paper)
    PetscCall(PetscCalloc1(n * CL_DIM * ALTERNATION_COUNT, &e->alternates));
  if (e->m->plates)
    PetscCall(PetscCalloc3(n, &e->spring, n, &e->answer, n, &e->push));
  PetscCall(PetscCalloc1(n * (2 * A + B + R + C + (Corrects(e) ? LANES : 0)) + LANES, &e->raw));
  at       = (double *)(((uintptr_t)e->raw + sizeof(Lanes) - 1) / sizeof(Lanes) * sizeof(Lanes));
  e->A     = at;
  e->G     = e->A + n * A;
  e->B     = e->G + n * A;
  e->R     = e->B + n * B;
  e->C     = Scalars(s) ? e->R + n * R : e->B; /* a dry body goes from the first pass to the third */
  e->given = Corrects(e) ? at + n * (2 * A + B + R + C) : NULL;
  PetscCall(PetscCalloc7(INC * n, &e->inc, 3 * n, &e->gain, 2 * n, &e->link, n, &e->lean, n, &e->torn, n, &e->node,
                         GridPaddedSize(&e->m->grid), &e->slot));
  for (PetscInt q = 0; q < GridPaddedSize(&e->m->grid); q++)
    e->slot[q] = (int)(e->map.index[q] >= 0 ? e->map.index[q] : e->map.n_local);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes with prescribed unknowns. */
static PetscErrorCode FindHeld(Explicit *e)
{
  const PetscInt nf = e->m->c->fields.n;
  double         value[F_COUNT];
  PetscInt       n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscFree3(e->held, e->mask, e->fixed));
  for (PetscInt I = 0; I < e->map.n_local; I++) {
    unsigned mask = 0;

    PlaneConditions(e->m->c, &e->m->grid, &e->m->bc, e->map.ij[I], false, &mask, value);
    e->node[I].held = mask ? (int)n++ : -1;
  }
  PetscCall(PetscMalloc3(n, &e->held, n, &e->mask, n * nf, &e->fixed));
  e->nheld = n;
  for (PetscInt I = 0; I < e->map.n_local; I++) {
    if (e->node[I].held >= 0)
      e->held[e->node[I].held] = I;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Padded place of node a of the patch of particle p; -1 beyond the grid. */
static PetscInt PatchNode(const Explicit *e, PetscInt p, int a)
{
  const Grid *g = &e->m->grid;
  PetscInt    ij[CL_DIM];
  bool        in = true;

  for (int d = 0, rest = a; d < CL_DIM; d++, rest /= 3) {
    ij[d] = e->base[d][p] + rest % 3;
    in    = in && ij[d] >= 0 && ij[d] <= g->cells[d];
  }
  return in ? GridPadded(g, ij) : -1;
}

PetscErrorCode NodesRebuild(Explicit *e)
{
  const Grid    *g = &e->m->grid;
  unsigned char *flag;
  bool           changed;

  PetscFunctionBeginUser;
  if (e->shared != g->shared) {
    e->shared = g->shared;
    PetscCall(NodeMapDestroy(&e->map));
  }
  PetscCall(PetscCalloc1(GridPaddedSize(g), &flag));
  for (PetscInt p = 0; p < e->m->P.n; p++) {
    for (int a = 0; a < CL_NODES; a++) {
      const PetscInt at = PatchNode(e, p, a);

      if (at >= 0)
        flag[at] = 1;
    }
  }
  PetscCall(NodeMapUpdate(g, flag, &e->map, &changed));
  PetscCall(PetscFree(flag));
  if (changed || e->resize) {
    e->resize = false;
    PetscCall(Allocate(e));
    PetscCall(FindHeld(e));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- groups (41), (454) */
static int Neighbour(const Explicit *e, PetscInt I, int direction)
{
  const Grid *g    = &e->m->grid;
  const int   axis = direction / 2;
  PetscInt    ij[CL_DIM];

  for (int d = 0; d < CL_DIM; d++)
    ij[d] = e->map.ij[I][d];
  ij[axis] += direction % 2 ? 1 : -1;
  const PetscInt in = ij[axis] - g->gs[axis];
  return in < 0 || in >= g->gm[axis] ? (int)e->rows - 1 : e->slot[GridPadded(g, ij)];
}

/* 1 + direction of the neighbour that node I follows, 0 if it stands for itself; own: the share of its own balances
 * that it keeps. */
static int Follows(const Explicit *e, PetscInt I, double *own)
{
  double best  = 0.0;
  int    found = 0;

  for (int k = 0; k < DIRECTIONS; k++) {
    const double V = Volume(e, e->set, Neighbour(e, I, k));

    if (V > MARGIN * best) {
      best  = V;
      found = 1 + k;
    }
  }
  *own = fmin(Volume(e, e->set, I) / (TIE * best), 1.0);
  return *own < 1.0 ? found : 0;
}

/* Nodes about which ground is torn. */
static PetscErrorCode FindTorn(Explicit *e)
{
  const double *open = e->m->P.f[P_OPENING];

  PetscFunctionBeginUser;
  if (!open)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArrayzero(e->torn, e->rows));
  for (PetscInt p = 0; p < e->m->P.n; p++) {
    for (int a = 0; open[p] > TORN && a < CL_NODES; a++) {
      const PetscInt at = PatchNode(e, p, a);

      if (at >= 0)
        e->torn[e->slot[at]] = 1.0;
    }
  }
  PetscCall(NodeMapSum(&e->map, e->torn, 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is the velocity of I that of its own balances: in torn ground, and where it is held along the way to the node that it
   follows?  Its step has no bound with linear functions (150). */
static bool MovesAlone(const Explicit *e, PetscInt I)
{
  const int axis = ((int)e->link[2 * I] - 1) / 2;
  double    value;

  return e->set.solid && e->m->c->basis != BASIS_LINEAR &&
         (e->torn[I] + e->torn[e->node[I].root] > 0.0 || Held(e, I, F_VS + axis, &value));
}

/* The node beyond the one that I follows, if all three are in a row in ground that is not torn; nothing but their
   balances may move these two along an axis of which they say the velocity of I (454). */
static void FindBeyond(const Explicit *e, PetscInt I)
{
  const Grid *g         = &e->m->grid;
  NodeInfo   *n         = &e->node[I];
  const int   direction = (int)e->link[2 * I] - 1, axis = direction / 2, step = direction % 2 ? 1 : -1;
  const int   beyond = Neighbour(e, n->root, direction);

  if (!e->set.solid || Neighbour(e, I, direction) != n->root || beyond >= (int)e->map.n_local ||
      e->link[2 * beyond] > 0.0 || !(Volume(e, e->set, beyond) > 0.0) || e->torn[beyond] > 0.0)
    return;
  const PetscInt at = e->map.ij[n->root][axis];
  const double   x = GridNode(g, axis, at), here = GridNode(g, axis, at - step), there = GridNode(g, axis, at + step);

  n->beyond = beyond;
  for (int d = 0; d < CL_DIM; d++) {
    double value;

    if (!Held(e, n->root, F_VS + d, &value) && !Held(e, beyond, F_VS + d, &value))
      n->stretch[d] = (here - x) / (x - there);
  }
}

/* Row of a node's balances with what others give to it. */
static double *Leading(Explicit *e, PetscInt I)
{
  const int width = LANES * Rows(A_Count(e->set));
  double   *row   = &e->G[I * width];

  if (!e->node[I].leads)
    memcpy(row, &e->A[I * width], (size_t)width * sizeof(double));
  e->node[I].leads = true;
  return row;
}

/* Mass of the mixture in a row of balances, kg. */
static double Mass(const Explicit *e, const double *row)
{
  double sum = row[A_M(e->set)];

  for (int k = 0; k < e->set.fluids; k++)
    sum += row[A_Fluid(e->set, k) + FL_M];
  return sum;
}

void NodesExtend(Explicit *e, double dt)
{
  const int width = LANES * Rows(A_Count(e->set)), at = A_Force(e->set);

  for (PetscInt I = 0; I < e->map.n_local; I++) {
    const NodeInfo *n   = &e->node[I];
    const double   *own = &e->A[I * width], *root = &e->A[n->root * width], *beyond = &e->A[n->beyond * width];

    for (int d = 0; d < CL_DIM; d++)
      e->lean[I][d] = 0.0;
    for (int d = 0; n->beyond != (int)I && d < CL_DIM; d++) {
      const bool   plate = e->m->plates && e->spring[I][d] != 0.0; /* it goes with that */
      const double r = plate ? 0.0 : n->stretch[d], a_root = root[at + d] / Mass(e, root),
                   more = r * (a_root - beyond[at + d] / Mass(e, beyond)), gives = 1.0 - n->own_v,
                   excess = own[at + d] - Mass(e, own) * (a_root + more);

      e->lean[I][d] = dt / e->o.mass_scaling * more;
      Leading(e, n->root)[at + d] += gives * (r * excess - Mass(e, own) * more);
      Leading(e, n->beyond)[at + d] -= gives * r * excess;
    }
  }
}

PetscErrorCode NodesFollow(Explicit *e)
{
  const int width = LANES * Rows(A_Count(e->set));

  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < e->map.n_local; I++) {
    e->node[I].root = e->node[I].beyond = (int)I;
    for (int d = 0; d < CL_DIM; d++)
      e->node[I].stretch[d] = 0.0;
    e->node[I].own = e->node[I].own_v = 1.0;
    e->node[I].leads                  = false;
    e->link[2 * I] = e->link[2 * I + 1] = 0.0;
    if (!e->o.paper && I < e->map.n_owned && Volume(e, e->set, I) > 0.0)
      e->link[2 * I] = Follows(e, I, &e->link[2 * I + 1]);
  }
  if (e->o.paper)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(NodeMapBroadcast(&e->map, e->link, 2));
  PetscCall(FindTorn(e));
  for (PetscInt I = 0; I < e->map.n_local; I++) {
    int root = (int)I;

    for (int hop = 0; hop < HOPS && root < (int)e->map.n_local && e->link[2 * root] > 0.0; hop++)
      root = Neighbour(e, root, (int)e->link[2 * root] - 1);
    if (root == (int)I || root >= (int)e->map.n_local)
      continue;
    e->node[I].root = root;
    e->node[I].own  = e->link[2 * I + 1];
    if (MovesAlone(e, I))
      continue;
    e->node[I].own_v = e->node[I].own;
    AddRow(Leading(e, root), 1.0 - e->node[I].own, &e->A[I * width], width);
    FindBeyond(e, I);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
