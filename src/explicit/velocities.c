/* Between the first and the second pass: velocities of the nodes (36). */
#include "nodes.h"

/* One direction of one node: masses, start velocities, forces; fluids per unit of their volume. */
typedef struct {
  double M, v, f; /* skeleton; f of the mixture */
  /* fluids: mass, velocity; (16) of each: force, mass per unit of volume fraction, drag, all times k_r; k_r, share */
  double m[2], vf[2], r[2], Mi[2], B[2], kr[2], w[2];
} Balance;

/* Share of a fluid in the volume of a node (18), (107). */
static double Share(const Explicit *e, const double *a, int k)
{
  return Largest(a[A_Fluid(e->set, k) + FL_W] / a[A_V(e->set)], CL_SHARE_FLOOR);
}

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
    b->kr[k] = s.fluids == 2 ? PetscSqr(f[FL_ROOT] / V) : 1.0;
    b->w[k]  = Share(e, a, k);
    b->Mi[k] = b->kr[k] * f[FL_MI];
    b->r[k]  = b->kr[k] * (f[FL_GX + d] + f[FL_MI] * gravity);
    b->B[k]  = f[FL_DRAG] * b->w[k];
    mass += f[FL_M];
  }
  b->f = s.solid ? mix[MIX_FX + d] + (b->M + mass) * gravity : 0.0;
}

/* Local damping: a share of the force out of balance, against the motion, N. */
static double Damping(const Balance *b, double share)
{
  return share * fabs(b->f) * (b->v > 0.0 ? 1.0 : b->v < 0.0 ? -1.0 : 0.0);
}

/* Balance of the mixture (36) with the fluids' velocities eliminated: lhs v_s = rhs. */
static void Mixture(const Explicit *e, const Balance *b, double dt, double damping, double *left, double *right)
{
  const Set    s     = e->set;
  const double scale = e->o.mass_scaling / dt;
  double       lhs = scale * b->M, rhs = b->f + scale * b->M * b->v;

  rhs -= Damping(b, damping);
  for (int k = 0; k < s.fluids; k++) {
    const double A = scale * b->Mi[k], B = e->o.drag_implicit ? b->B[k] : 0.0;
    const double drag = e->o.drag_implicit ? 0.0 : b->B[k] * (b->vf[k] - b->v);

    lhs += scale * b->m[k] * B / (A + B);
    rhs -= scale * b->m[k] * (b->r[k] - drag - B * b->vf[k]) / (A + B);
  }
  *left  = lhs;
  *right = rhs;
}

double NodeFree(const Explicit *e, PetscInt I, int d, double dt, double *lhs)
{
  const int width = LANES * Rows(A_Count(e->set));
  Balance   b;
  double    rhs;

  ReadBalance(e, e->node[I].leads ? &e->G[I * width] : &e->A[I * width], d, &b);
  Mixture(e, &b, dt, 0.0, lhs, &rhs);
  return rhs / *lhs - b.v;
}

/* Velocities at the end of the step (36), drag implicit or explicit; a held skeleton moves as it must. */
static void Solve(const Explicit *e, const Balance *b, double dt, bool held, double value, double v[3])
{
  const Set    s     = e->set;
  const double scale = e->o.mass_scaling / dt;
  double       lhs, rhs;

  Mixture(e, b, dt, e->o.damping, &lhs, &rhs);
  v[0] = held ? value : s.solid ? rhs / lhs : 0.0;
  for (int k = 0; k < s.fluids; k++) {
    const double A = scale * b->Mi[k], B = e->o.drag_implicit ? b->B[k] : 0.0;
    const double drag = e->o.drag_implicit ? 0.0 : b->B[k] * (b->vf[k] - b->v);

    v[1 + k] = (A * b->vf[k] + b->r[k] - drag + B * v[0]) / (A + B);
  }
}

/* Mean velocity over the step in the works (92), from what it is before and at the end; what is held moves as it must,
   all the step. */
static double Mean(const Explicit *e, PetscInt I, int unknown, double before, double end)
{
  double value;

  return Held(e, I, unknown, &value) ? value : 0.5 * (end + before);
}

/* (92): work of the drag along d in a balance (of a node, or of one and those that follow it) with its answer v; a
   fluid that is held moves as it must. */
static double DragWork(const Explicit *e, PetscInt I, int d, const Balance *b, const double v[3])
{
  const Set    s    = e->set;
  const double mean = Mean(e, I, F_VSX + d, b->v, v[0]);
  double       sum  = 0.0, held;

  for (int k = 0; k < s.fluids; k++) {
    const int    at   = F_VWX + 2 * k + d;
    const double end  = Held(e, I, at, &held) ? held : v[1 + k];
    const double slip = e->o.drag_implicit ? end - v[0] : b->vf[k] - b->v;

    sum += b->B[k] / b->kr[k] * slip * b->w[k] * (Mean(e, I, at, b->vf[k], end) - mean);
  }
  return sum;
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
    if (e->set.solid && e->set.fluids)
      e->work[WORK_DRAG] += e->node[I].own_v * dt * DragWork(e, I, d, &b, v);
    if (!held)
      e->work[WORK_DAMPING] += e->node[I].own_v * dt * Damping(&b, e->o.damping) * 0.5 * (v[0] + b.v);
    e->inc[6 * I + d] = v[0] - b.v;
    for (int k = 0; k < e->set.fluids; k++)
      e->inc[6 * I + 2 * (1 + k) + d] = v[1 + k] - b.vf[k];
    if (!held) /* of the mixture, which moves with the skeleton but for seepage */
      e->added += PetscSqr((e->o.mass_scaling - 1.0) * b.M * (v[0] - b.v) / dt);
  }
}

/* (92): works at a node along d with the means of its velocities (skeleton, water, gas; v at the end) over the step. */
static void NodeWork(Explicit *e, PetscInt I, int d, const Balance *w, const double v[3], double dt)
{
  const Set     s = e->set;
  const double *a = &e->A[I * LANES * Rows(A_Count(s))], *push = e->nplate ? e->push[I] : NULL;
  const double  scale = e->o.mass_scaling, mean = Mean(e, I, F_VSX + d, w->v, v[0]), gravity = e->m->bc.gravity[d];
  double gained = w->M * (v[0] - w->v), inertia = gained * mean, weight = w->M * mean, pressure = 0.0, value = 0.0;

  for (int k = 0; k < s.fluids; k++) {
    const double own = Mean(e, I, F_VWX + 2 * k + d, w->vf[k], v[1 + k]), flow = w->w[k] * (own - mean);

    inertia += w->m[k] * (v[1 + k] - w->vf[k]) * own;
    gained += w->m[k] * (v[1 + k] - w->vf[k]);
    weight += w->m[k] * own;
    pressure += a[A_Fluid(s, k) + FL_GX + d] * flow;
  }
  e->work[WORK_INERTIA] += scale * inertia;
  e->work[WORK_GRAVITY] += dt * gravity * weight;
  e->work[WORK_PRESSURE] += dt * pressure;
  if (push)
    e->work[WORK_PLATES] += dt * push[d] * v[0];
  if (Held(e, I, F_VSX + d, &value))
    e->work[WORK_PLATES] += (scale * gained - dt * w->f) * value;
}

/* Row that the particles read: own start velocity, the increment, then what is prescribed. */
static void WriteVelocities(Explicit *e, PetscInt I, double dt)
{
  const Set     s = e->set;
  const double *a = &e->A[I * LANES * Rows(A_Count(s))], V = a[A_V(s)];
  double       *b = &e->B[I * LANES * Rows(B_Count(s))];

  for (int d = 0; d < CL_DIM; d++) {
    Balance w;
    double  v[3] = {0.0}, value;

    ReadBalance(e, a, d, &w);
    v[0] = s.solid ? w.v + Blended(e, I, e->node[I].own_v, 6, e->inc, d) : 0.0;
    if (s.solid && Held(e, I, F_VSX + d, &value))
      v[0] = value;
    if (s.solid) {
      b[d]            = v[0];
      b[B_DVs(s) + d] = v[0] - w.v;
    }
    for (int k = 0; k < s.fluids; k++) {
      const double *f  = &a[A_Fluid(s, k)];
      double       *bf = &b[B_Fluid(s, k)];

      v[1 + k] = w.vf[k] + Blended(e, I, e->node[I].own_v, 6, e->inc, 2 * (1 + k) + d);
      if (Held(e, I, F_VWX + 2 * k + d, &value))
        v[1 + k] = value;
      bf[B_J + d]    = w.w[k] * (v[1 + k] - v[0]);
      bf[B_PROJ + d] = -f[FL_GX + d] / V;
      bf[B_DV + d]   = v[1 + k] - w.vf[k];
      bf[B_VEL + d]  = v[1 + k];
    }
    if (s.solid)
      NodeWork(e, I, d, &w, v, dt);
  }
  for (int k = 0; k < s.fluids; k++)
    b[B_P(s, k)] = a[k] / V;
  if (s.heat)
    b[B_T(s)] = a[s.fluids] / a[A_C(s)];
}

PetscErrorCode NodesVelocities(Explicit *e, double t, double dt)
{
  const int width = LANES * Rows(B_Count(e->set));

  PetscFunctionBeginUser;
  for (PetscInt h = 0; h < e->nheld; h++) {
    e->mask[h] = 0;
    PlaneConditions(e->m->c, &e->m->grid, &e->m->bc, e->map.ij[e->held[h]], false, &e->mask[h],
                    &e->fixed[h * e->m->c->fields.n]);
  }
  e->added = 0.0;
  PetscCall(NodesFollow(e));
  if (e->nplate)
    PetscCall(PlatesForces(e, t, dt));
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
      WriteVelocities(e, I, dt);
    else
      PetscCall(PetscArrayzero(&e->B[I * width], width));
  }
  PetscCall(NodeMapBroadcast(&e->map, e->B, width));
  PetscFunctionReturn(PETSC_SUCCESS);
}
