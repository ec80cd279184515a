/* Between the first and the second pass: velocities of the nodes (36). */
#include "nodes.h"

/* Balances of a node (36): what has no direction, then one direction; fluids per unit of their volume. */
typedef struct {
  double M, per_M; /* skeleton: mass and its inverse, 0 without */
  double m[2], per_m[2];
  /* (16) of each fluid: inertia per velocity, drag, times k_r, and the inverse of what multiplies its velocity; k_r,
     share */
  double A[2], B[2], per_AB[2], kr[2], w[2];
  double flow;              /* V/(V k_p) (350) */
  double lhs;               /* of the mixture, N s/m */
  double v, f, vf[2], r[2]; /* skeleton: velocity, force on the mixture; fluids: velocity, force times k_r */
} Balance;

/* Share of a fluid in the volume of a node (18), (107). */
INLINE double Share(const Set s, const double *a, double per_V, int k)
{
  return Largest(a[A_Fluid(s, k) + FL_W] * per_V, CL_SHARE_FLOOR);
}

/* What makes (350) of sums weighted with k_p. */
INLINE double Flow(const Set s, const double *a)
{
  return s.layers ? a[A_V(s)] / a[A_K(s)] : 1.0;
}

/* Of a node with layers: the mean of A, weighted with k_p, and its inverse B (448). */
typedef struct {
  bool on;
  Beds drive, share;
} NodeBeds;

INLINE NodeBeds NodeBedsOf(const Set s, const double *a)
{
  NodeBeds n = {.on = s.layers};

  if (s.layers) {
    n.drive = BedsMean(&a[A_Beds(s)], a[A_K(s)]);
    n.share = BedsInverse(&n.drive);
  }
  return n;
}

/* v := B^-1 v, v := B v, with layers. */
INLINE void Driven(const NodeBeds *n, double v[CL_DIM])
{
  if (n->on)
    BedsDrive(&n->drive, v);
}

INLINE void Shared(const NodeBeds *n, double v[CL_DIM])
{
  if (n->on)
    BedsDrive(&n->share, v);
}

INLINE double Inverse(double mass)
{
  return mass > 0.0 ? 1.0 / mass : 0.0;
}

/* Drag that acts at the end of the step. */
INLINE double DragAtEnd(const Explicit *e, const Balance *b, int k)
{
  return e->o.drag_implicit ? b->B[k] : 0.0;
}

/* ... and at its start. */
INLINE double DragAtStart(const Explicit *e, const Balance *b, int k)
{
  return e->o.drag_implicit ? 0.0 : b->B[k] * (b->vf[k] - b->v);
}

/* Masses and drags, and the left side of the mixture's balance with the fluids' velocities eliminated. */
INLINE void ReadMasses(const Explicit *e, const Set s, const double *a, double dt, Balance *b)
{
  const double per_V = 1.0 / a[A_V(s)], scale = e->o.mass_scaling / dt;

  b->M     = s.solid ? a[A_M(s)] : 0.0;
  b->per_M = Inverse(b->M);
  b->lhs   = scale * b->M;
  b->flow  = Flow(s, a);
  for (int k = 0; k < s.fluids; k++) {
    const double *f = &a[A_Fluid(s, k)];

    b->m[k]      = f[FL_M];
    b->per_m[k]  = Inverse(f[FL_M]);
    b->kr[k]     = s.fluids == 2 ? PetscSqr(b->flow * f[FL_ROOT] * per_V) : 1.0;
    b->w[k]      = Share(s, a, per_V, k);
    b->A[k]      = scale * b->kr[k] * (s.layers ? PetscSqr(b->flow) * f[FL_Inertia(s)] : f[FL_MI]); /* inertia (310) */
    b->B[k]      = b->flow * f[FL_DRAG] * b->w[k];
    b->per_AB[k] = 1.0 / (b->A[k] + DragAtEnd(e, b, k));
    b->lhs += scale * b->m[k] * DragAtEnd(e, b, k) * b->per_AB[k];
  }
}

/* Velocities and forces along d. */
INLINE void ReadForces(const Explicit *e, const Set s, const double *a, int d, Balance *b)
{
  const double gravity = e->m->bc.gravity[d];
  double       mass    = b->M;

  b->v = s.solid ? a[A_Momentum(s, 0) + d] * b->per_M : 0.0;
  for (int k = 0; k < s.fluids; k++) {
    const double *f = &a[A_Fluid(s, k)];

    b->vf[k] = b->m[k] > 0.0 ? a[A_Momentum(s, 1 + k) + d] * b->per_m[k] : b->v;
    b->r[k]  = b->kr[k] * b->flow * (f[FL_G + d] + (s.layers ? 0.0 : f[FL_MI] * gravity));
    mass += b->m[k];
  }
  b->f = s.solid ? a[A_Force(s) + d] + mass * gravity : 0.0;
}

/* Local damping: a share of the force out of balance, against the motion, N. */
INLINE double Damping(const Balance *b, double share)
{
  return share * fabs(b->f) * (b->v > 0.0 ? 1.0 : b->v < 0.0 ? -1.0 : 0.0);
}

/* Right side of the balance of the mixture (36): lhs v_s = rhs. */
INLINE double MixtureForce(const Explicit *e, const Set s, const Balance *b, double dt, double damping)
{
  const double scale = e->o.mass_scaling / dt;
  double       rhs   = b->f + scale * b->M * b->v - Damping(b, damping);

  for (int k = 0; k < s.fluids; k++)
    rhs -= scale * b->m[k] * (b->r[k] - DragAtStart(e, b, k) - DragAtEnd(e, b, k) * b->vf[k]) * b->per_AB[k];
  return rhs;
}

double NodeFree(const Explicit *e, PetscInt I, int d, double dt, double *lhs)
{
  const Set     s = e->set;
  const double *a = Balances(e, s, I);
  Balance       b;

  ReadMasses(e, s, a, dt, &b);
  ReadForces(e, s, a, d, &b);
  *lhs = b.lhs;
  return MixtureForce(e, s, &b, dt, 0.0) / b.lhs - b.v;
}

/* Velocities at the end of the step (36), drag implicit or explicit; a held skeleton moves as it must. */
INLINE void Solve(const Explicit *e, const Set s, const Balance *b, double dt, bool held, double value, double v[3])
{
  v[0] = held ? value : s.solid ? MixtureForce(e, s, b, dt, e->o.damping) / b->lhs : 0.0;
  for (int k = 0; k < s.fluids; k++)
    v[1 + k] = (b->A[k] * b->vf[k] + b->r[k] - DragAtStart(e, b, k) + DragAtEnd(e, b, k) * v[0]) * b->per_AB[k];
}

/* The same with layers: fluids feel the skeleton's acceleration along every axis (308), so the balances b are one
   system (314).  v: [axis][3]. */
INLINE void SolveLayers(const Explicit *e, const Set s, const double *a, const NodeBeds *n, const Balance b[CL_DIM],
                        double dt, const bool held[CL_DIM], const double value[CL_DIM], double v[CL_DIM][3])
{
  const double scale = e->o.mass_scaling / dt;
  double       feels[PHASE_COUNT][CL_DIM][CL_DIM], L[CL_DIM][CL_DIM], rhs[CL_DIM], v_s[CL_DIM];

  for (int k = 0; k < s.fluids; k++) {
    const double mass = scale * b[0].kr[k] * b[0].flow * a[A_Fluid(s, k) + FL_MI];

    for (int i = 0; i < CL_DIM; i++) {
      for (int j = 0; j < CL_DIM; j++)
        feels[k][i][j] = mass * n->drive.A[cl_symmetric[i][j]] - (i == j ? b[0].A[k] : 0.0);
    }
  }
  for (int i = 0; i < CL_DIM; i++) {
    rhs[i] = MixtureForce(e, s, &b[i], dt, e->o.damping);
    for (int j = 0; j < CL_DIM; j++) {
      double sum = 0.0;

      for (int k = 0; k < s.fluids; k++)
        sum += scale * b[0].m[k] * b[0].per_AB[k] * feels[k][i][j];
      L[i][j] = (i == j ? b[i].lhs : 0.0) - sum;
      rhs[i] -= sum * b[j].v;
    }
  }
  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; held[i] && j < CL_DIM; j++)
      L[i][j] = i == j;
    rhs[i] = held[i] ? value[i] : rhs[i];
  }
  SolveSmall(CL_DIM, L[0], rhs, v_s);
  for (int i = 0; i < CL_DIM; i++) {
    v[i][0] = v_s[i];
    for (int k = 0; k < s.fluids; k++) {
      double along = 0.0;

      for (int j = 0; j < CL_DIM; j++)
        along += feels[k][i][j] * (v_s[j] - b[j].v);
      v[i][1 + k] =
          (b[i].A[k] * b[i].vf[k] + b[i].r[k] - DragAtStart(e, &b[i], k) + DragAtEnd(e, &b[i], k) * v[i][0] - along) *
          b[i].per_AB[k];
    }
  }
}

/* Mean velocity over the step in the works (92), from what it is before and at the end; what is held moves as it must,
   all the step. */
INLINE double Mean(const Explicit *e, PetscInt I, int unknown, double before, double end)
{
  double value;

  return Held(e, I, unknown, &value) ? value : 0.5 * (end + before);
}

/* (92): work of the drag in the balances n, b (of a node, or of one and those that follow it) with their answer v; a
   fluid that is held moves as it must. */
INLINE double DragWork(const Explicit *e, const Set s, PetscInt I, const NodeBeds *n, const Balance b[CL_DIM],
                       const double v[CL_DIM][3])
{
  double sum = 0.0, held;

  for (int k = 0; k < s.fluids; k++) {
    double drag[CL_DIM], flow[CL_DIM];

    for (int d = 0; d < CL_DIM; d++) {
      const int    at   = VectorAt(F_VW, k, d);
      const double end  = Held(e, I, at, &held) ? held : v[d][1 + k];
      const double slip = e->o.drag_implicit ? end - v[d][0] : b[d].vf[k] - b[d].v;

      drag[d] = b[d].B[k] / b[d].kr[k] * slip;
      flow[d] = b[d].w[k] * (Mean(e, I, at, b[d].vf[k], end) - Mean(e, I, F_VS + d, b[d].v, v[d][0]));
    }
    Shared(n, flow);
    sum += VectorDot(drag, flow);
  }
  return sum;
}

/* What a node's balance along d says, with its answer v. */
INLINE void KeepVelocities(Explicit *e, const Set s, PetscInt I, int d, const Balance *b, bool held, const double v[3],
                           double dt)
{
  if (!held)
    e->work[WORK_DAMPING] += e->node[I].own_v * dt * Damping(b, e->o.damping) * 0.5 * (v[0] + b->v);
  e->inc[INC * I + d] = v[0] - b->v;
  for (int k = 0; k < s.fluids; k++)
    e->inc[INC * I + VectorAt(0, 1 + k, d)] = s.layers ? b->flow * (v[1 + k] - v[0]) : v[1 + k] - b->vf[k];
  if (!held) /* of the mixture, which moves with the skeleton but for seepage */
    e->added += PetscSqr((e->o.mass_scaling - 1.0) * b->M * (v[0] - b->v) / dt);
}

INLINE void NodeVelocities(Explicit *e, const Set s, PetscInt I, double dt)
{
  const double *a = Balances(e, s, I);
  Balance       b[CL_DIM];
  double        v[CL_DIM][3], value[CL_DIM] = {0.0};
  bool          held[CL_DIM];

  const NodeBeds n = NodeBedsOf(s, a);
  ReadMasses(e, s, a, dt, &b[0]);
  for (int d = 1; d < CL_DIM; d++)
    b[d] = b[0];
  for (int d = 0; d < CL_DIM; d++) {
    ReadForces(e, s, a, d, &b[d]);
    held[d] = s.solid && Held(e, I, F_VS + d, &value[d]);
    if (!(s.layers && s.solid))
      Solve(e, s, &b[d], dt, held[d], value[d], v[d]);
  }
  if (s.layers && s.solid)
    SolveLayers(e, s, a, &n, b, dt, held, value, v);
  for (int d = 0; d < CL_DIM; d++)
    KeepVelocities(e, s, I, d, &b[d], held[d], v[d], dt);
  for (int k = 0; k < s.fluids; k++)
    Shared(&n, &e->inc[INC * I + VectorAt(0, 1 + k, 0)]);
  if (s.solid && s.fluids)
    e->work[WORK_DRAG] += e->node[I].own_v * dt * DragWork(e, s, I, &n, b, v);
}

/* (92): works at a node along d with the means of its velocities (skeleton, water, gas; v at the end) over the step,
   and the Darcy fluxes of these. */
INLINE void NodeWork(Explicit *e, const Set s, PetscInt I, int d, const Balance *w, const double v[3], double dt,
                     double flow[PHASE_COUNT][CL_DIM])
{
  const double *push  = e->m->plates ? e->push[I] : NULL;
  const double  scale = e->o.mass_scaling, mean = Mean(e, I, F_VS + d, w->v, v[0]), gravity = e->m->bc.gravity[d];
  double        gained = w->M * (v[0] - w->v), inertia = gained * mean, weight = w->M * mean, value = 0.0;

  for (int k = 0; k < s.fluids; k++) {
    const double own = Mean(e, I, VectorAt(F_VW, k, d), w->vf[k], v[1 + k]);

    flow[k][d] = w->w[k] * (own - mean);
    inertia += w->m[k] * (v[1 + k] - w->vf[k]) * own;
    gained += w->m[k] * (v[1 + k] - w->vf[k]);
    weight += w->m[k] * own;
  }
  e->work[WORK_INERTIA] += scale * inertia;
  e->work[WORK_GRAVITY] += dt * gravity * weight;
  if (push)
    e->work[WORK_PLATES] += dt * push[d] * v[0];
  if (Held(e, I, F_VS + d, &value))
    e->work[WORK_PLATES] += (scale * gained - dt * w->f) * value;
}

/* (92): of the fluids' pressures, with those Darcy fluxes J; what weighs A b of a fluid is that of the node. */
INLINE double PressureWork(const Explicit *e, const Set s, const double *a, const NodeBeds *n, double per_k,
                           const double J[PHASE_COUNT][CL_DIM])
{
  double sum = 0.0;

  for (int k = 0; k < s.fluids; k++) {
    const double *f = &a[A_Fluid(s, k)];
    double        weight[CL_DIM], g[CL_DIM], flow[CL_DIM];

    for (int d = 0; d < CL_DIM; d++) {
      weight[d] = s.layers ? f[FL_MI] * e->m->bc.gravity[d] : 0.0;
      flow[d]   = J[k][d];
    }
    Driven(n, weight);
    Shared(n, flow);
    for (int d = 0; d < CL_DIM; d++)
      g[d] = f[FL_G + d] - weight[d];
    sum += per_k * VectorDot(g, flow);
  }
  return sum;
}

/* Velocity of a fluid: the increments of (41), or with layers the skeleton's and what follows from the node's flow per
   permeability (311). */
INLINE double FluidVelocity(const Explicit *e, PetscInt I, const NodeBeds *n, const Balance *w, int k, int d,
                            double v_s)
{
  double flow[CL_DIM];

  if (!n->on)
    return w->vf[k] + Extended(e, I, VectorAt(0, 1 + k, d), d);
  for (int i = 0; i < CL_DIM; i++)
    flow[i] = Blended(e, I, e->node[I].own_v, INC, e->inc, VectorAt(0, 1 + k, i));
  Driven(n, flow);
  return v_s + flow[d] / w->flow;
}

/* Row that the particles read: own start velocity, the increment, then what is prescribed. */
INLINE void WriteVelocities(Explicit *e, const Set s, PetscInt I, double dt)
{
  const double *a = &e->A[I * LANES * Rows(A_Count(s))], per_V = 1.0 / a[A_V(s)];
  double       *b = &e->B[I * LANES * Rows(B_Count(s))], J[PHASE_COUNT][CL_DIM] = {{0.0}};
  Balance       w;

  const NodeBeds n = NodeBedsOf(s, a);
  ReadMasses(e, s, a, dt, &w);
  for (int d = 0; d < CL_DIM; d++) {
    double v[3] = {0.0}, value;

    ReadForces(e, s, a, d, &w);
    v[0] = s.solid ? w.v + Extended(e, I, d, d) : 0.0;
    if (s.solid && Held(e, I, F_VS + d, &value))
      v[0] = value;
    if (s.solid) {
      b[d]            = v[0];
      b[B_DVs(s) + d] = v[0] - w.v;
    }
    for (int k = 0; k < s.fluids; k++) {
      const double *f  = &a[A_Fluid(s, k)];
      double       *bf = &b[B_Fluid(s, k)];

      v[1 + k] = FluidVelocity(e, I, &n, &w, k, d, v[0]);
      if (Held(e, I, VectorAt(F_VW, k, d), &value))
        v[1 + k] = value;
      bf[B_J + d]    = w.flow * w.w[k] * (v[1 + k] - v[0]);
      bf[B_PROJ + d] = -w.flow * f[FL_G + d] * per_V;
      bf[B_DV + d]   = s.layers ? w.flow * (v[1 + k] - w.vf[k] - (v[0] - w.v)) : v[1 + k] - w.vf[k];
    }
    if (s.solid)
      NodeWork(e, s, I, d, &w, v, dt, J);
  }
  if (s.solid)
    e->work[WORK_PRESSURE] += dt * PressureWork(e, s, a, &n, w.flow, J);
  for (int k = 0; s.layers && k < s.fluids; k++) {
    for (int of = B_J; of < B_PER_FLUID; of += CL_DIM)
      Shared(&n, &b[B_Fluid(s, k) + of]);
  }
  for (int k = 0; k < s.fluids; k++)
    b[B_P(s, k)] = NodalPressure(s, a, k);
  if (s.heat)
    b[B_T(s)] = a[s.fluids] / a[A_C(s)];
}

/* Loops over the nodes of this rank that particles reach. */
INLINE void VelocitiesRun(Explicit *e, const Set s, Run r, double dt)
{
  for (PetscInt I = r.p; I < r.p + r.n; I++) {
    if (Volume(e, s, I) > 0.0)
      NodeVelocities(e, s, I, dt);
  }
}

INLINE void WriteRun(Explicit *e, const Set s, Run r, double dt)
{
  const int width = LANES * Rows(B_Count(s));

  for (PetscInt I = r.p; I < r.p + r.n; I++) {
    if (Volume(e, s, I) > 0.0)
      WriteVelocities(e, s, I, dt);
    else
      memset(&e->B[I * width], 0, (size_t)width * sizeof(double));
  }
}

MAKE_LOOPS(VelocitiesRun)
MAKE_LOOPS(WriteRun)

PetscErrorCode NodesPrepare(Explicit *e)
{
  PetscFunctionBeginUser;
  for (PetscInt h = 0; h < e->nheld; h++) {
    e->mask[h] = 0;
    PlaneConditions(e->m->c, &e->m->grid, &e->m->bc, e->map.ij[e->held[h]], false, &e->mask[h],
                    &e->fixed[h * e->m->c->fields.n]);
  }
  PetscCall(NodesFollow(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NodesVelocities(Explicit *e, double dt)
{
  PetscFunctionBeginUser;
  e->added = 0.0;
  ForNodes(e, VelocitiesRun_loops, dt);
  if (e->o.mass_scaling > 1.0) {
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &e->added, 1, MPI_DOUBLE, MPI_SUM, e->m->grid.comm));
    e->worst_scaling = Largest(e->worst_scaling, e->acting > 0.0 ? sqrt(e->added / e->acting) : 0.0);
  }
  PetscCall(NodeMapBroadcast(&e->map, e->inc, INC));
  ForNodes(e, WriteRun_loops, dt);
  PetscCall(NodeMapBroadcast(&e->map, e->B, LANES * Rows(B_Count(e->set))));
  PetscFunctionReturn(PETSC_SUCCESS);
}
