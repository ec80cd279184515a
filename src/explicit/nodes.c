/* Between the passes: what nodes make of their sums; docs/equations.md, section 12. */
#include "lanes.h"

#define TIE 0.25    /* of the volume of a neighbour: an emptier node follows it in part (41) */
#define MARGIN 1.01 /* among neighbours about as full the first stays, whatever the order of sums */
#define HOPS 3      /* from a nearly empty node to one that is not */

static const int step_to[4][CL_DIM] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};

/* ---------------------------------------------------------------- numbering */
static PetscErrorCode Allocate(Explicit *e)
{
  const Set      s = e->set;
  const PetscInt n = e->map.n_local + 1;
  const PetscInt A = LANES * Rows(A_Count(s)), B = LANES * Rows(B_Count(s)), R = LANES * Rows(PetscMax(R_Count(s), 1)),
                 C = LANES;
  double *at;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(e->raw));
  PetscCall(PetscFree5(e->inc, e->gain, e->link, e->node, e->slot));
  e->rows = n;
  PetscCall(PetscCalloc1(n * (2 * A + B + R + C) + LANES, &e->raw));
  at   = (double *)(((uintptr_t)e->raw + sizeof(Lanes) - 1) / sizeof(Lanes) * sizeof(Lanes));
  e->A = at;
  e->G = e->A + n * A;
  e->B = e->G + n * A;
  e->R = e->B + n * B;
  e->C = Scalars(s) ? e->R + n * R : e->B; /* a dry body goes from the first pass to the third */
  PetscCall(PetscCalloc5(6 * n, &e->inc, 3 * n, &e->gain, 2 * n, &e->link, n, &e->node,
                         e->m->grid.gm[0] * e->m->grid.gm[1], &e->slot));
  for (PetscInt q = 0; q < e->m->grid.gm[0] * e->m->grid.gm[1]; q++)
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

    PlaneConditions(e->m->c, &e->m->grid, &e->m->bc, e->map.ij[I], &mask, value);
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

PetscErrorCode NodesRebuild(Explicit *e)
{
  const Grid    *g = &e->m->grid;
  unsigned char *flag;
  bool           changed;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(g->gm[0] * g->gm[1], &flag));
  for (PetscInt p = 0; p < e->m->P.n; p++) {
    for (int b = 0; b < 3; b++) {
      for (int a = 0; a < 3; a++) {
        const PetscInt i = e->base[0][p] + a, j = e->base[1][p] + b;

        if (i >= 0 && i <= g->cells[0] && j >= 0 && j <= g->cells[1])
          flag[GridPadded(g, i, j)] = 1;
      }
    }
  }
  PetscCall(NodeMapUpdate(g, flag, &e->map, &changed));
  PetscCall(PetscFree(flag));
  if (changed) {
    PetscCall(Allocate(e));
    PetscCall(FindHeld(e));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- groups (41) */
static int Neighbour(const Explicit *e, PetscInt I, int direction)
{
  const Grid    *g = &e->m->grid;
  const PetscInt i = e->map.ij[I][0] + step_to[direction][0] - g->gs[0],
                 j = e->map.ij[I][1] + step_to[direction][1] - g->gs[1];

  return i < 0 || j < 0 || i >= g->gm[0] || j >= g->gm[1] ? (int)e->rows - 1 : e->slot[j * g->gm[0] + i];
}

static double Volume(const Explicit *e, PetscInt I)
{
  return e->A[I * LANES * Rows(A_Count(e->set)) + A_V(e->set)];
}

/* 1 + direction of the neighbour that node I follows, 0 if it stands for itself; own: the share of its own balances
 * that it keeps. */
static int Follows(const Explicit *e, PetscInt I, double *own)
{
  double best  = 0.0;
  int    found = 0;

  for (int k = 0; k < 4; k++) {
    const double V = Volume(e, Neighbour(e, I, k));

    if (V > MARGIN * best) {
      best  = V;
      found = 1 + k;
    }
  }
  *own = fmin(Volume(e, I) / (TIE * best), 1.0);
  return *own < 1.0 ? found : 0;
}

static void AddRow(double *to, double share, const double *from, int n)
{
  for (int k = 0; k < n; k++)
    to[k] += share * from[k];
}

/* Finds who follows whom, and adds to A of a leading node what its followers give up. */
static PetscErrorCode Group(Explicit *e)
{
  const int width = LANES * Rows(A_Count(e->set));

  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < e->map.n_local; I++) {
    e->node[I].root  = (int)I;
    e->node[I].own   = 1.0;
    e->node[I].leads = false;
    e->link[2 * I] = e->link[2 * I + 1] = 0.0;
    if (e->o.tied && I < e->map.n_owned && Volume(e, I) > 0.0)
      e->link[2 * I] = Follows(e, I, &e->link[2 * I + 1]);
  }
  if (!e->o.tied)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(NodeMapBroadcast(&e->map, e->link, 2));
  for (PetscInt I = 0; I < e->map.n_local; I++) {
    int root = (int)I;

    for (int hop = 0; hop < HOPS && root < (int)e->map.n_local && e->link[2 * root] > 0.0; hop++)
      root = Neighbour(e, root, (int)e->link[2 * root] - 1);
    if (root == (int)I || root >= (int)e->map.n_local)
      continue;
    e->node[I].root = root;
    e->node[I].own  = e->link[2 * I + 1];
    if (!e->node[root].leads)
      PetscCall(PetscArraycpy(&e->G[root * width], &e->A[root * width], width));
    e->node[root].leads = true;
    AddRow(&e->G[root * width], 1.0 - e->node[I].own, &e->A[I * width], width);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- velocities */
static bool Held(const Explicit *e, PetscInt I, int unknown, double *value)
{
  const int h = e->node[I].held, at = e->m->c->fields.at[unknown];

  if (h < 0 || !((e->mask[h] >> at) & 1u))
    return false;
  *value = e->fixed[h * e->m->c->fields.n + at];
  return true;
}

/* One direction of one node: masses, start velocities, forces; fluids per unit of their volume. */
typedef struct {
  double M, v, f;                        /* skeleton; f of the mixture */
  double m[2], vf[2], r[2], Mi[2], B[2]; /* fluids: mass, velocity, force, mass per unit of volume fraction, drag */
} Balance;

static double Velocity(double momentum, double mass, double otherwise)
{
  return mass > 0.0 ? momentum / mass : otherwise;
}

static void ReadBalance(const Explicit *e, const double *a, int d, Balance *b)
{
  const Set    s = e->set;
  const double V = a[A_V(s)], *mix = &a[A_Mix(s)], gravity = e->m->bc.gravity[d];
  double       mass = 0.0;

  b->M = s.solid ? mix[MIX_M] : 0.0;
  b->v = s.solid ? Velocity(mix[MIX_VX + d], b->M, 0.0) : 0.0;
  for (int k = 0; k < s.fluids; k++) {
    const double *f = &a[A_Fluid(s, k)];

    b->m[k]  = f[FL_M];
    b->vf[k] = Velocity(f[FL_VX + d], f[FL_M], b->v);
    b->Mi[k] = f[FL_MI];
    b->r[k]  = f[FL_GX + d] + f[FL_MI] * gravity;
    b->B[k]  = f[FL_DRAG] * f[FL_W] / V;
    mass += f[FL_M];
  }
  b->f = s.solid ? mix[MIX_FX + d] + (b->M + mass) * gravity : 0.0;
}

/* Velocities at the end of the step (36), drag implicit or explicit; a held skeleton moves as it must. */
static void Solve(const Explicit *e, const Balance *b, double dt, bool held, double value, double v[3])
{
  const Set    s     = e->set;
  const double scale = e->o.mass_scaling / dt;
  double       lhs = scale * b->M, rhs = b->f + scale * b->M * b->v;

  rhs -= e->o.damping * fabs(b->f) * (b->v > 0.0 ? 1.0 : b->v < 0.0 ? -1.0 : 0.0);
  for (int k = 0; k < s.fluids; k++) {
    const double A = scale * b->Mi[k], B = e->o.drag_implicit ? b->B[k] : 0.0;
    const double drag = e->o.drag_implicit ? 0.0 : b->B[k] * (b->vf[k] - b->v);

    lhs += scale * b->m[k] * B / (A + B);
    rhs -= scale * b->m[k] * (b->r[k] - drag - B * b->vf[k]) / (A + B);
  }
  v[0] = held ? value : s.solid ? rhs / lhs : 0.0;
  for (int k = 0; k < s.fluids; k++) {
    const double A = scale * b->Mi[k], B = e->o.drag_implicit ? b->B[k] : 0.0;
    const double drag = e->o.drag_implicit ? 0.0 : b->B[k] * (b->vf[k] - b->v);

    v[1 + k] = (A * b->vf[k] + b->r[k] - drag + B * v[0]) / (A + B);
  }
}

static void NodeVelocities(Explicit *e, PetscInt I, double dt)
{
  const int     width = LANES * Rows(A_Count(e->set));
  const double *a     = e->node[I].leads ? &e->G[I * width] : &e->A[I * width];

  for (int d = 0; d < CL_DIM; d++) {
    Balance b;
    double  v[3], value = 0.0;

    ReadBalance(e, a, d, &b);
    const bool held = e->set.solid && Held(e, I, F_VSX + d, &value);
    Solve(e, &b, dt, held, value, v);
    e->inc[6 * I + d] = v[0] - b.v;
    for (int k = 0; k < e->set.fluids; k++)
      e->inc[6 * I + 2 * (1 + k) + d] = v[1 + k] - b.vf[k];
    if (!held) /* of the mixture, which moves with the skeleton but for seepage */
      e->added += PetscSqr((e->o.mass_scaling - 1.0) * b.M * (v[0] - b.v) / dt);
  }
}

/* (41): increment k of a node, of which it keeps its own share and takes the rest from the node it follows. */
static double Blended(const Explicit *e, PetscInt I, int width, const double *inc, int k)
{
  const NodeInfo *n = &e->node[I];

  return n->own * inc[width * I + k] + (1.0 - n->own) * inc[width * n->root + k];
}

/* Row that the particles read: own start velocity, the increment, then what is prescribed. */
static void WriteVelocities(Explicit *e, PetscInt I)
{
  const Set     s = e->set;
  const double *a = &e->A[I * LANES * Rows(A_Count(s))], V = a[A_V(s)];
  double       *b = &e->B[I * LANES * Rows(B_Count(s))];

  for (int d = 0; d < CL_DIM; d++) {
    Balance w;
    double  v[3] = {0.0}, value;

    ReadBalance(e, a, d, &w);
    v[0] = s.solid ? w.v + Blended(e, I, 6, e->inc, d) : 0.0;
    if (s.solid && Held(e, I, F_VSX + d, &value))
      v[0] = value;
    if (s.solid) {
      b[d]            = v[0];
      b[B_DVs(s) + d] = v[0] - w.v;
    }
    for (int k = 0; k < s.fluids; k++) {
      const double *f  = &a[A_Fluid(s, k)];
      double       *bf = &b[B_Fluid(s, k)];

      v[1 + k] = w.vf[k] + Blended(e, I, 6, e->inc, 2 * (1 + k) + d);
      if (Held(e, I, F_VWX + 2 * k + d, &value))
        v[1 + k] = value;
      bf[B_J + d]    = f[FL_W] / V * (v[1 + k] - v[0]);
      bf[B_PROJ + d] = -f[FL_GX + d] / V;
      bf[B_DV + d]   = v[1 + k] - w.vf[k];
      bf[B_VEL + d]  = v[1 + k];
    }
  }
  for (int k = 0; k < s.fluids; k++)
    b[B_P(s, k)] = a[k] / V;
  if (s.heat)
    b[B_T(s)] = a[s.fluids] / a[A_C(s)];
}

PetscErrorCode NodesVelocities(Explicit *e, double dt)
{
  const int width = LANES * Rows(B_Count(e->set));

  PetscFunctionBeginUser;
  for (PetscInt h = 0; h < e->nheld; h++) {
    e->mask[h] = 0;
    PlaneConditions(e->m->c, &e->m->grid, &e->m->bc, e->map.ij[e->held[h]], &e->mask[h],
                    &e->fixed[h * e->m->c->fields.n]);
  }
  e->added = 0.0;
  PetscCall(Group(e));
  for (PetscInt I = 0; I < e->map.n_owned; I++) {
    if (Volume(e, I) > 0.0)
      NodeVelocities(e, I, dt);
  }
  if (e->o.mass_scaling > 1.0) {
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &e->added, 1, MPI_DOUBLE, MPI_SUM, e->m->grid.comm));
    e->worst_scaling = Largest(e->worst_scaling, e->acting > 0.0 ? sqrt(e->added / e->acting) : 0.0);
  }
  PetscCall(NodeMapBroadcast(&e->map, e->inc, 6));
  for (PetscInt I = 0; I < e->map.n_owned; I++) {
    if (Volume(e, I) > 0.0)
      WriteVelocities(e, I);
    else
      PetscCall(PetscArrayzero(&e->B[I * width], width));
  }
  PetscCall(NodeMapBroadcast(&e->map, e->B, width));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- scalars */
/* x of the n x n system A x = b by elimination with the diagonal as pivots: storage and capacity outweigh what couples
 * them. */
static void SolveSmall(int n, double *A, double *b, double *x)
{
  for (int k = 0; k < n; k++) {
    for (int i = k + 1; i < n; i++) {
      const double c = A[i * n + k] / A[k * n + k];

      for (int j = k; j < n; j++)
        A[i * n + j] -= c * A[k * n + j];
      b[i] -= c * b[k];
    }
  }
  for (int k = n - 1; k >= 0; k--) {
    x[k] = b[k];
    for (int j = k + 1; j < n; j++)
      x[k] -= A[k * n + j] * x[j];
    x[k] /= A[k * n + k];
  }
}

/* Increments of p_w, p_g, T of a node, with what its followers gave it; a held temperature takes the heat it needs. */
static void NodeScalars(Explicit *e, PetscInt I, StageRates *rates)
{
  const Set     s = e->set;
  const int     n = Scalars(s);
  const double *r = &e->R[I * LANES * Rows(R_Count(s))], *a = &e->A[I * LANES * Rows(A_Count(s))];
  double        A[9], b[3], T;

  for (int k = 0; k < n; k++)
    b[k] = r[k];
  for (int k = 0; k < n * n; k++)
    A[k] = r[R_Matrix(s) + k];
  const bool held = s.heat && Held(e, I, F_T, &T);
  if (held) {
    for (int j = 0; j < n; j++)
      A[(n - 1) * n + j] = j == n - 1;
    b[n - 1] = T - a[s.fluids] / a[A_C(s)];
  }
  SolveSmall(n, A, b, &e->gain[3 * I]);
  if (!held || e->node[I].root != (int)I)
    return;
  double heat = -r[n - 1];
  for (int j = 0; j < n; j++)
    heat += r[R_Matrix(s) + (n - 1) * n + j] * e->gain[3 * I + j];
  rates->heat_in += heat;
}

/* Adds what a node gives up of its rows to those of the node it follows.  A temperature prescribed there is its own:
   what it does to the masses is known, and its row of heat says what it needs. */
static void Join(Explicit *e, PetscInt I)
{
  const Set     s     = e->set;
  const double  share = 1.0 - e->node[I].own;
  const int     n = Scalars(s), width = LANES * Rows(R_Count(s));
  const double *from = &e->R[I * width], *a = &e->A[I * LANES * Rows(A_Count(s))];
  double       *to = &e->R[e->node[I].root * width], T;

  if (!s.heat || !Held(e, I, F_T, &T)) {
    AddRow(to, share, from, width);
    return;
  }
  const double dT = T - a[s.fluids] / a[A_C(s)];
  for (int k = 0; k < s.fluids; k++) {
    to[k] += share * (from[k] - from[R_Matrix(s) + k * n + s.fluids] * dT);
    for (int j = 0; j < s.fluids; j++)
      to[R_Matrix(s) + k * n + j] += share * from[R_Matrix(s) + k * n + j];
  }
}

/* Row that the particles read: increments, end values, velocity of the skeleton. */
static void WriteScalars(Explicit *e, PetscInt I, StageRates *rates)
{
  const Set     s = e->set;
  const int     n = Scalars(s);
  const double *a = &e->A[I * LANES * Rows(A_Count(s))], V = a[A_V(s)], *r = &e->R[I * LANES * Rows(R_Count(s))];
  double       *c = &e->C[I * LANES], T;

  for (int k = 0; k < n; k++)
    c[k] = Blended(e, I, 3, e->gain, k);
  if (s.heat && e->node[I].root != (int)I && Held(e, I, F_T, &T)) {
    c[s.fluids] = T - a[s.fluids] / a[A_C(s)];
    rates->heat_in -= r[s.fluids];
    for (int j = 0; j < n; j++)
      rates->heat_in += r[R_Matrix(s) + s.fluids * n + j] * c[j];
  }
  for (int k = 0; k < n; k++)
    c[C_End(s) + k] = a[k] / (k < s.fluids ? V : a[A_C(s)]) + c[k];
  if (s.heat)
    rates->heat_rate += a[A_C(s)] * c[s.fluids];
  for (int d = 0; s.solid && d < CL_DIM; d++)
    c[C_Vs(s) + d] = e->B[I * LANES * Rows(B_Count(s)) + d];
}

PetscErrorCode NodesScalars(Explicit *e, StageRates *rates)
{
  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < e->map.n_local; I++) {
    if (e->node[I].root != (int)I)
      Join(e, I);
  }
  for (PetscInt I = 0; I < e->map.n_owned; I++) {
    if (Volume(e, I) > 0.0)
      NodeScalars(e, I, rates);
  }
  PetscCall(NodeMapBroadcast(&e->map, e->gain, 3));
  for (PetscInt I = 0; I < e->map.n_owned; I++) {
    if (Volume(e, I) > 0.0)
      WriteScalars(e, I, rates);
    else
      PetscCall(PetscArrayzero(&e->C[I * LANES], LANES));
  }
  PetscCall(NodeMapBroadcast(&e->map, e->C, LANES));
  PetscFunctionReturn(PETSC_SUCCESS);
}
