/* Third pass: increments of pressure and temperature back to the particles; strain, stress, hydrate, masses, motion;
   docs/equations.md, section 12. */
#include "masses.h"
#include "stress.h"

/* Bare form, the paper's (P72): increments of pressure from the particle's own balances, with the new temperature. */
INLINE void OwnPressures(const Explicit *e, const Set s, Run r, Gathered *g)
{
  for (int q = 0; q < r.n; q++) {
    const PetscInt p  = r.p + q;
    double *const *L  = (double *const *)&e->t[T_LOCAL];
    const double   dT = s.heat ? g->value[q][s.fluids] : 0.0, w = e->t[T_MISS][p] - L[2][p] * dT;

    if (s.fluids == 1) {
      g->value[q][0] = w / L[0][p];
      continue;
    }
    const double gas = e->t[T_MISS + 1][p] - L[5][p] * dT, det = L[0][p] * L[4][p] - L[1][p] * L[3][p];
    g->value[q][0] = (w * L[4][p] - gas * L[1][p]) / det;
    g->value[q][1] = (gas * L[0][p] - w * L[3][p]) / det;
  }
}

/* Pressures of particles: p_g changes in proportion (151). */
INLINE void Pressures(const Explicit *e, Run r, Gathered *g)
{
  const double *restrict p = e->m->P.f[P_PG] + r.p;

  for (int q = 0; q < r.n; q++) {
    const double y[2] = {g->value[q][0], g->value[q][1]};

    PressuresOf(p[q], y, g->value[q]);
  }
}

#define FARTHEST 1e15 /* Pa, degC: beyond it a field has left its range */

static double Least(const Material *mat, int field)
{
  return field == 0 || (field == 1 && mat->gas.trace > 0.0) ? -FARTHEST : field == 1 ? 0.0 : -CL_ZERO_CELSIUS;
}

/* The first particle of a block with a field outside its range. */
static PetscInt OutOfRange(const Explicit *e, const Set s, Run r)
{
  for (int q = 0; q < r.n; q++) {
    for (int k = 0; k < Scalars(s); k++) {
      const int    field = k < s.fluids ? k : 2;
      const double y     = e->m->P.f[P_PW + field][r.p + q];

      if (!(y > Least(r.mat, field) && y < FARTHEST))
        return r.p + q;
    }
  }
  return r.p;
}

/* p_w, p_g, T, their gradients, rates of pressure; false if one leaves its range. */
INLINE bool Fields(Explicit *e, const Set s, Run r, const Weights *w, const Gathered *g, double dt)
{
  const double per_dt = 1.0 / dt;
  const bool   rates  = SceneReactsWithHeat(e->m->c); /* which alone asks for them */
  Wrong        out    = 0;

  for (int k = 0; k < Scalars(s); k++) {
    const int field    = k < s.fluids ? k : 2;
    double *restrict y = e->m->P.f[P_PW + field] + r.p;
    const double least = Least(r.mat, field);

    for (int q = 0; q < r.n; q++) {
      y[q] += g->value[q][k];
      out |= WRONG_UNLESS((y[q] > least) & (y[q] < FARTHEST));
    }
    for (int q = 0; rates && k < s.fluids && q < r.n; q++)
      e->m->P.f[P_RATE + k][r.p + q] = per_dt * g->value[q][k];
    for (int d = 0; d < CL_DIM; d++) {
      for (int q = 0; q < r.n; q++)
        e->m->P.f[VectorAt(P_GW, field, d)][r.p + q] = g->grad[d][q][C_End(s) + k];
    }
  }
  for (int q = 0; s.heat && q < r.n; q++) {
    for (int c = 0; c < CL_MIXED; c++)
      e->m->P.f[P_BT + c][r.p + q] = Mixed(e, e->C + C_End(s) + s.fluids, C_Width(s), w, q, c);
  }
  return !out;
}

#define FASTEST 0.08 /* (451): deformation in a step beyond which no motion of a continuum goes */

/* (451); a particle that flies alone keeps its own, and where that shrinks it would come to a point. */
INLINE void KeepVelocityGradient(Explicit *e, Run r, const Strain *n, double dt)
{
  double share[BLOCK];

  for (int q = 0; q < r.n; q++) {
    double square = 0.0;

    for (int k = 0; k < CL_DIM * CL_DIM; k++)
      square += n->H[k / CL_DIM][k % CL_DIM][q] * n->H[k / CL_DIM][k % CL_DIM][q];
    share[q] = e->o.paper ? 0.0 : (square > FASTEST * FASTEST ? FASTEST / sqrt(square) : 1.0) / dt;
  }
  for (int k = 0; k < CL_DIM * CL_DIM; k++) {
    double *restrict to = e->m->P.f[P_GV + k] + r.p;

    for (int q = 0; q < r.n; q++)
      to[q] = share[q] * n->H[k / CL_DIM][k % CL_DIM][q];
  }
}

INLINE void UpdateRun(Explicit *e, const Set s, Run r, double dt)
{
  _Alignas(64) Gathered g;
  Weights               w;
  Strain                n;
  double *const        *f = e->m->P.f;
  double                kept[BLOCK];
  const double         *T;

  for (int q = 0; q < BLOCK; q++)
    kept[q] = 1.0;
  WeightsOf(e, r, &w);
  Gather(e, e->C, Rows(C_Count(s)), Rows(C_Count(s)), r, &w, &g);
  MeanMotion(e, s, r, &w, C_Vs(s), &g);
  if (s.fluids && e->o.paper)
    OwnPressures(e, s, r, &g);
  if (Relative(e, s))
    Pressures(e, r, &g);
  if (!Fields(e, s, r, &w, &g, dt))
    ModelNoteFailure(e->m, CL_NONFINITE, "a pressure or temperature left its range", OutOfRange(e, s, r));
  MassesOf(e, s, r, &g, kept, &e->m->limited);
  if (s.heat && e->m->c->compression_heat)
    CountCompression(e, s, r, &g);
  if (s.fluids == 2 && r.mat->gas.trace > 0.0)
    GasOfMethane(e, s, r, &g);
  T = s.heat ? f[P_T] + r.p : e->t[T_T] + r.p;
  if (!s.solid) {
    ParticlesKeep(&e->m->P, r.p, r.n, NULL);
    return;
  }
  if (!StrainOf(s, r.n, &g, dt, &n))
    ModelNoteFailure(e->m, CL_DOMAIN, "the strain of one step exceeds 10 % or is not finite", Strained(r, &n));
  KeepVelocityGradient(e, r, &n, dt);
  ExpansionWork(e, s, r, &g, &n, dt);
  StressOf(e, s, r, &g, &n, T, kept);
  if (!Scalars(s)) {
    for (int d = 0; d < CL_DIM; d++)
      AddChange(r.n, f[P_VS + d] + r.p, &g.value[0][C_DVs(s) + d], GATHERED);
  }
  if (!Move(e, s, r, &g, &n, dt))
    NoteStray(e, s, r, &g, dt);
}

MAKE_LOOPS(UpdateRun)

void Update(Explicit *e, double dt)
{
  ForRuns(e, UpdateRun_loops, dt);
}
