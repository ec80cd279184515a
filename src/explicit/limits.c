/* The largest stable step (38), (39), (150). */
#include "lanes.h"
#include "storage.h"

const char *const cl_limit_word[LIMIT_COUNT] = {"none",
                                                "waves in the mixture",
                                                "waves in thin domains",
                                                "waves in the water",
                                                "waves in the gas",
                                                "diffusion of pressure",
                                                "conduction of heat",
                                                "explicit drag"};

/* What one particle contributes: squares of the highest frequencies (1/s^2), rates of decay of relative motion (1/s).
 */
typedef struct {
  double wave, sliver, fluid[PHASE_COUNT], drag[PHASE_COUNT], both[PHASE_COUNT],
      heat;      /* both: drag felt by fluid and skeleton */
  double across; /* time of a wave across a cell, the longest way, s */
  int    fluids;
} Spectrum;

/* Change of pressure per change of the volume of each fluid, C^-1 (1/Pa)^-1.  Gas that dissolves makes C lopsided. */
static void Stiffness(const Set s, const PointProperties *q, double C[2][2])
{
  if (s.fluids == 1) {
    C[0][0] = 1.0 / q->storage[PHASE_W];
    return;
  }
  const double det = q->storage[PHASE_W] * q->storage[PHASE_G] - q->cross[PHASE_W] * q->cross[PHASE_G];

  C[0][0] = q->storage[PHASE_G] / det;
  C[1][1] = q->storage[PHASE_W] / det;
  C[0][1] = -q->cross[PHASE_W] / det;
  C[1][0] = -q->cross[PHASE_G] / det;
}

/* (150) in the form of (38), where ground may tear: k^2 of the thinnest sliver of a particle's domain; linear functions
   have none. */
static double Sliver(const Explicit *e, PetscInt p)
{
  const BasisType type = e->m->c->basis;
  double          k2   = 0.0;

  for (int d = 0; e->m->P.f[P_OPENING] && d < CL_DIM && type != BASIS_LINEAR; d++) {
    const GridLines *line = &e->m->grid.line[d];
    const double     x    = e->m->P.f[P_X + d][p];

    k2 = Largest(k2, 2.0 / (BasisReach(type, line, x, e->m->P.f[P_L + d][p]) * LinesLeastAt(line, x)));
  }
  return k2;
}

static double Widest(const Grid *g, const double x[CL_DIM])
{
  double h = 0.0;

  for (int d = 0; d < CL_DIM; d++)
    h = Largest(h, LinesWidthAt(&g->line[d], x[d]));
  return h;
}

/* Conductivity with all of (293), W/(m K). */
static double Conductivity(const Model *m, PetscInt p, const PointProperties *q)
{
  double a[CL_DIM], half = 0.0;

  ModelHeatFlow(m, p, q, a);
  for (int d = 0; d < CL_DIM; d++)
    half += 0.5 * LinesWidthAt(&m->grid.line[d], m->P.f[P_X + d][p]) * fabs(a[d]);
  return fmax(q->kappa, half);
}

/* conductance: of the conditions at its faces, W/K. */
static ClStatus SpectrumOf(const Explicit *e, PetscInt p, double conductance, Spectrum *w)
{
  const Model    *m   = e->m;
  const Set       s   = e->set;
  const Material *mat = &m->c->material[m->c->region[m->P.i[PI_REGION][p]].material];
  double *const  *f   = (double *const *)m->P.f;
  const char     *why;
  PointProperties q;
  double          x[CL_DIM], C[2][2] = {{0.0}}, bulk = 0.0, skeleton, rho;

  ParticlePlace(&m->P, p, x);
  const double   k2     = GridHighest2At(&m->grid, x);
  const ClStatus status = ModelParticleProperties(m, p, &q, &why);
  if (status != CL_OK)
    return status;
  *w  = (Spectrum){.fluids = s.fluids, .across = INFINITY};
  rho = (f[P_MS][p] + f[P_MH][p]) / f[P_V][p];
  if (s.fluids)
    Stiffness(s, &q, C);
  skeleton     = q.M;
  double total = rho;
  for (int i = 0; i < s.fluids; i++) {
    const double share = q.phi * (1.0 - q.Sh) * q.s[i];

    const double drag = q.resist[i] / q.kr[i];

    total += share * q.rho[i];
    w->fluid[i] = k2 * share * C[i][i] / (q.rho[i] * e->o.mass_scaling);
    w->drag[i]  = Openness(s, mat, q.phi, q.Sh) * drag * share / (q.rho[i] * e->o.mass_scaling);
    w->both[i]  = drag * share * (1.0 / q.rho[i] + share / rho) / e->o.mass_scaling;
    for (int j = 0; j < s.fluids; j++) {
      const double other = q.phi * (1.0 - q.Sh) * q.s[j];

      bulk += q.s[i] * C[i][j] * q.s[j];
      skeleton += (q.s[i] - share) * C[i][j] * (q.s[j] - other);
    }
  }
  if (s.solid) {
    const double square = Largest(skeleton / rho, (q.M + bulk) / total) / e->o.mass_scaling;

    w->wave   = k2 * square;
    w->across = Widest(&m->grid, x) / sqrt(square);
    w->sliver = Sliver(e, p) * square;
  }
  if (s.heat)
    w->heat = (k2 * Conductivity(m, p, &q) * f[P_V][p] + conductance) / q.capacity;
  return CL_OK;
}

/* Left side of (38); a step is stable while it is below 4. */
static double Growth(const Spectrum *w, const ExplicitOptions *o, double dt)
{
  double fluids = 0.0, drag = 0.0;

  for (int i = 0; i < w->fluids; i++) {
    fluids += FluidGrowth(dt, w->fluid[i], o->drag_implicit ? w->drag[i] : 0.0);
    drag += o->drag_implicit ? 0.0 : 2.0 * dt * w->both[i];
  }
  return dt * dt * w->wave + drag + (o->paper ? 1.0 : 1.0 + ConsistentShare(fluids)) * fluids;
}

/* Largest step with Growth <= 4, by bisection of its logarithm. */
static double Together(const Spectrum *w, const ExplicitOptions *o)
{
  double lo = 1e-30, hi = 1e30;

  if (Growth(w, o, hi) <= 4.0)
    return INFINITY;
  if (!(Growth(w, o, lo) <= 4.0)) /* waves of any speed */
    return 0.0;
  while (hi > lo * (1.0 + 1e-9)) {
    const double mid = sqrt(lo * hi);

    if (Growth(w, o, mid) > 4.0)
      hi = mid;
    else
      lo = mid;
  }
  return lo;
}

static void Lower(double *bound, double by)
{
  *bound = by < *bound ? by : *bound; /* also where by is infinite; NaN never lowers */
}

/* Each kind alone, for the reader; a fluid whose drag damps the wave within a step diffuses. */
static void Each(const Spectrum *w, bool implicit, double each[LIMIT_COUNT])
{
  Lower(&each[LIMIT_WAVE], 2.0 / sqrt(w->wave));
  Lower(&each[LIMIT_THIN], 2.0 / sqrt(w->sliver));
  Lower(&each[LIMIT_HEAT], 2.0 / w->heat);
  for (int i = 0; i < w->fluids; i++) {
    const double lambda = w->drag[i], square = w->fluid[i];

    if (!implicit) {
      Lower(&each[LIMIT_WATER + i], sqrt(2.0 / square));
      Lower(&each[LIMIT_DRAG], 2.0 / w->both[i]);
      continue;
    }
    const double dt = (lambda + sqrt(lambda * lambda + 2.0 * square)) / square; /* dt^2 Omega^2 = 2 (1 + lambda dt) */
    Lower(&each[lambda * dt > 1.0 ? (int)LIMIT_DIFFUSION : LIMIT_WATER + i], dt);
  }
}

PetscErrorCode ExplicitStableStep(Explicit *e, StableStep *limit)
{
  double bound[LIMIT_COUNT + 2], *conductance;

  PetscFunctionBeginUser;
  for (int k = 0; k < LIMIT_COUNT + 2; k++)
    bound[k] = INFINITY;
  PetscCall(PetscCalloc1(e->m->P.n, &conductance));
  if (e->set.heat)
    PetscCall(FacesConductance(e, conductance));
  for (PetscInt p = 0; p < e->m->P.n; p++) {
    Spectrum w;

    if (SpectrumOf(e, p, conductance[p], &w) != CL_OK)
      continue; /* the step itself will say why */
    Each(&w, e->o.drag_implicit, bound);
    Lower(&bound[LIMIT_COUNT], Together(&w, &e->o));
    Lower(&bound[LIMIT_COUNT], 2.0 / sqrt(w.sliver));
    Lower(&bound[LIMIT_COUNT], 2.0 / w.heat);
    Lower(&bound[LIMIT_COUNT + 1], w.across);
  }
  PetscCall(PetscFree(conductance));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bound, LIMIT_COUNT + 2, MPI_DOUBLE, MPI_MIN, e->m->grid.comm));
  limit->dt     = bound[LIMIT_COUNT];
  limit->across = bound[LIMIT_COUNT + 1];
  e->across     = limit->across;
  e->stable     = limit->dt;
  limit->rules  = LIMIT_NONE;
  for (int k = LIMIT_NONE; k < LIMIT_COUNT; k++) {
    limit->each[k] = bound[k];
    if (bound[k] < limit->each[limit->rules])
      limit->rules = (LimitKind)k;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
