/* probes.csv: affine least-squares values at points of the body or of space, and means (means.c). */
#include "io_private.h"
#include "clathra/eigen.h"
#include <string.h>

/* Moments of the weights about the probe: sum of w, w d_i, w d_i d_j. */
enum { M_1 = 0, M_X, M_XX = M_X + CL_DIM, M_COUNT = M_XX + CL_DIM * CL_DIM };

/* Variance along a direction, in units of the reach squared, below which the neighbours say nothing about it. */
#define DEGENERATE 1e-3
#define WIDENINGS 40

typedef struct {
  double x[CL_DIM], reach[CL_DIM]; /* m */
  bool   fixed;
  double mean[CL_DIM], g[CL_DIM]; /* of d; C^-1 mean */
  double total;                   /* sum of weights */
} Fit;

/* One cell, or two particle spacings where they are wider: at an edge two rows of particles are within reach. */
static void Reach(const Scene *c, const Grid *g, const double x[CL_DIM], double widening, double reach[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++) {
    PetscInt ppc = 2;

    for (PetscInt k = 0; k < c->nregion; k++)
      ppc = c->region[k].material < 0 ? ppc : PetscMin(ppc, c->region[k].ppc[d]);
    reach[d] = widening * LinesWidthAt(&g->line[d], x[d]) * (ppc < 2 ? 2.0 : 1.0);
  }
}

/* Scaled distance of a particle from the probe and its weight, in the initial configuration unless fixed. */
static double Weight(const Fit *f, const Particles *P, PetscInt p, double d[CL_DIM])
{
  double w = 1.0;

  for (int i = 0; i < CL_DIM; i++) {
    const double x = f->fixed ? P->f[P_X + i][p] : ParticleInitialX(P, p, i);

    d[i] = (x - f->x[i]) / f->reach[i];
    w *= fmax(0.0, 1.0 - fabs(d[i]));
  }
  return w;
}

static void AddMoments(const Fit *f, const Particles *P, double M[M_COUNT])
{
  for (PetscInt p = 0; p < P->n; p++) {
    double       d[CL_DIM];
    const double w = Weight(f, P, p, d);

    if (w == 0.0)
      continue;
    M[M_1] += w;
    for (int i = 0; i < CL_DIM; i++) {
      M[M_X + i] += w * d[i];
      for (int j = 0; j < CL_DIM; j++)
        M[VectorAt(M_XX, i, j)] += w * d[i] * d[j];
    }
  }
}

/* Principal axes (rows) of a covariance, and the variances along them. */
static void PrincipalAxes(const double C[CL_DIM][CL_DIM], double axis[CL_DIM][CL_DIM], double lambda[CL_DIM])
{
#if CL_DIM == 2
  const double a = C[0][0], b = C[0][1], c = C[1][1], r = hypot(0.5 * (a - c), b), angle = 0.5 * atan2(2.0 * b, a - c);

  lambda[0]  = 0.5 * (a + c) + r;
  lambda[1]  = 0.5 * (a + c) - r;
  axis[0][0] = axis[1][1] = cos(angle);
  axis[0][1]              = sin(angle);
  axis[1][0]              = -axis[0][1];
#else
  EigenValues e;

  memcpy(e.Q, C, sizeof(e.Q));
  (void)Eigen(&e);
  for (int k = 0; k < 3; k++) {
    lambda[k] = e.y[k];
    for (int i = 0; i < 3; i++)
      axis[k][i] = e.Q[i][k];
  }
#endif
}

/* Solves the normal equations by the principal axes of the neighbours' covariance; axes without extent are dropped. */
static void Solve(Fit *f, const double M[M_COUNT])
{
  double C[CL_DIM][CL_DIM], axis[CL_DIM][CL_DIM], lambda[CL_DIM];

  f->total = M[M_1];
  for (int d = 0; d < CL_DIM; d++)
    f->g[d] = f->mean[d] = 0.0;
  if (f->total == 0.0)
    return;
  for (int d = 0; d < CL_DIM; d++)
    f->mean[d] = M[M_X + d] / M[M_1];
  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++)
      C[i][j] = M[VectorAt(M_XX, i, j)] / M[M_1] - f->mean[i] * f->mean[j];
  }
  PrincipalAxes(C, axis, lambda);
  for (int k = 0; k < CL_DIM; k++) {
    const double s = VectorDot(axis[k], f->mean);

    if (lambda[k] < DEGENERATE)
      continue;
    for (int i = 0; i < CL_DIM; i++)
      f->g[i] += axis[k][i] * s / lambda[k];
  }
}

static void AddValues(const Model *m, const Fit *f, double value[PROBE_COUNT])
{
  const Particles *P = &m->P;

  for (PetscInt p = 0; p < P->n; p++) {
    double       d[CL_DIM];
    const double w = Weight(f, P, p, d);

    if (w == 0.0)
      continue;
    double share = 1.0;

    for (int i = 0; i < CL_DIM; i++)
      share -= f->g[i] * (d[i] - f->mean[i]);
    share *= w / f->total;
    for (int q = 0; q < PROBE_COUNT; q++) {
      if (ProbeWanted(CaseOf(m->c), q))
        value[q] += share * ProbeQuantity(m, p, q);
    }
  }
}

/* Pressures, temperature and saturations, which a limit shares out in groups so that p stays the mean of p_w and p_g,
   and saturations add up to 1. */
enum { LIMITED = PROBE_SG + 1, GROUPS = 3 };
static const int group_end[GROUPS] = {3, 4, LIMITED}; /* p, p_w, p_g; T; S_h, S_w, S_g */

/* What a probe interpolates: its neighbours' largest values and those of their negatives, and so of their distances. */
typedef struct {
  double top[2 * LIMITED], far[2 * CL_DIM];
} Range;

static void AddRange(const Model *m, const Fit *f, Range *r, double mean[LIMITED])
{
  for (PetscInt p = 0; p < m->P.n; p++) {
    double       d[CL_DIM];
    const double w = Weight(f, &m->P, p, d);

    if (w == 0.0)
      continue;
    for (int q = 0; q < LIMITED; q++) {
      const double v = ProbeWanted(CaseOf(m->c), q) ? ProbeQuantity(m, p, q) : 0.0;

      mean[q] += w / f->total * v;
      r->top[2 * q]     = fmax(r->top[2 * q], v);
      r->top[2 * q + 1] = fmax(r->top[2 * q + 1], -v);
    }
    for (int i = 0; i < 2 * CL_DIM; i++)
      r->far[i] = fmax(r->far[i], i % 2 ? -d[i / 2] : d[i / 2]);
  }
}

/* Share of the affine part that keeps a value between its neighbours'. */
static double Share(double value, double mean, const double top[2])
{
  const double over = value - mean, room = over > 0.0 ? top[0] - mean : mean + top[1];

  return fabs(over) > room ? fmax(room, 0.0) / fabs(over) : 1.0;
}

/* Among its neighbours a probe stays in their range.  Beyond them, at the surface, it goes on linearly, saturations
   from 0 to 1. */
static void Limit(const Scene *c, const Range *r, const double mean[LIMITED], double value[PROBE_COUNT])
{
  bool among = true;

  for (int i = 0; i < 2 * CL_DIM; i++)
    among = among && r->far[i] >= 0.0;
  for (int k = 0, first = 0; k < GROUPS; first = group_end[k++]) {
    static const double saturation[2] = {1.0, 0.0};
    double              share = 1.0, end = 0.0;
    int                 tight = -1; /* the one that ends where its range does, to the last digit */

    for (int q = first; q < group_end[k] && (among || k == GROUPS - 1); q++) {
      const double *top = among ? &r->top[2 * q] : saturation;
      const double  own = ProbeWanted(CaseOf(c), q) ? Share(value[q], mean[q], top) : 1.0;

      if (own < share) {
        share = own;
        tight = q;
        end   = value[q] > mean[q] ? top[0] : -top[1];
      }
    }
    for (int q = first; q < group_end[k] && share < 1.0; q++)
      value[q] = q == tight ? end : mean[q] + share * (value[q] - mean[q]);
  }
}

static PetscErrorCode LimitAll(const Model *m, const Fit *fit, double *value)
{
  const Case    *c = CaseOf(m->c);
  const PetscInt n = c->nprobe;
  Range         *range;
  double(*mean)[LIMITED];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &range));
  PetscCall(PetscCalloc1(n, &mean));
  for (PetscInt k = 0; k < n; k++) {
    for (size_t i = 0; i < sizeof(*range) / sizeof(double); i++)
      ((double *)&range[k])[i] = -INFINITY;
    if (!ProbeIsMean(&c->probe[k]))
      AddRange(m, &fit[k], &range[k], mean[k]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, (PetscMPIInt)(n * sizeof(*range) / sizeof(double)), MPI_DOUBLE,
                             MPI_MAX, m->grid.comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, mean, (PetscMPIInt)(n * LIMITED), MPI_DOUBLE, MPI_SUM, m->grid.comm));
  for (PetscInt k = 0; k < n; k++) {
    if (!ProbeIsMean(&c->probe[k]) && fit[k].total > 0.0)
      Limit(m->c, &range[k], mean[k], value + k * PROBE_COUNT);
  }
  PetscCall(PetscFree(range));
  PetscCall(PetscFree(mean));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A material point without a neighbour (outside the body) gets a wider reach; a fixed one is then empty space. */
static PetscErrorCode FitAll(Output *out, const Model *m, Fit *fit)
{
  const Case *c = CaseOf(m->c);
  double     *M;
  bool        again = true;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(c->nprobe * M_COUNT, &M));
  for (int round = 0; again && round < WIDENINGS; round++) {
    again = false;
    PetscCall(PetscArrayzero(M, c->nprobe * M_COUNT));
    for (PetscInt k = 0; k < c->nprobe; k++) {
      fit[k] = (Fit){.fixed = c->probe[k].fixed};
      memcpy(fit[k].x, c->probe[k].x, sizeof(fit[k].x));
      Reach(&c->scene, &m->grid, fit[k].x, out->reach[k], fit[k].reach);
      if (ProbeIsMean(&c->probe[k]))
        continue;
      AddMoments(&fit[k], &m->P, M + k * M_COUNT);
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, M, (PetscMPIInt)(c->nprobe * M_COUNT), MPI_DOUBLE, MPI_SUM, m->grid.comm));
    for (PetscInt k = 0; k < c->nprobe; k++) {
      Solve(&fit[k], M + k * M_COUNT);
      if (fit[k].total > 0.0 || fit[k].fixed || ProbeIsMean(&c->probe[k]))
        continue;
      out->reach[k] *= 2.0;
      again = true;
    }
  }
  PetscCall(PetscFree(M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteRow(Output *out, const Case *c, double t, const Fit *fit, PetscInt n, const double *value)
{
  FILE *f;

  PetscFunctionBeginUser;
  PetscCall(RowBegin(out, &f));
  IoTime(c, f, t);
  for (PetscInt k = 0; k < n; k++) {
    for (int q = 0; q < PROBE_COUNT; q++) {
      if (!ProbeWanted(c, q))
        continue;
      if (fit[k].total > 0.0)
        fprintf(f, ",%.12e", value[k * PROBE_COUNT + q]);
      else
        fprintf(f, ",nan");
    }
  }
  fprintf(f, "\n");
  PetscCall(RowEnd(out, TABLE_PROBES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputProbes(Output *out, const Model *m, const StepperState *s)
{
  const Case    *c    = CaseOf(m->c);
  const PetscInt n    = c->nprobe;
  PetscErrorCode ierr = PETSC_SUCCESS;
  Fit           *fit;
  double        *value, *weight; /* weight: of means, behind the values of all */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &fit));
  PetscCall(PetscCalloc1(n * (PROBE_COUNT + 1), &value));
  weight = value + n * PROBE_COUNT;
  PetscCall(FitAll(out, m, fit));
  for (PetscInt k = 0; k < n; k++) {
    if (!ProbeIsMean(&c->probe[k]))
      AddValues(m, &fit[k], value + k * PROBE_COUNT);
  }
  PetscCall(MeansAdd(m, (double(*)[PROBE_COUNT])value, weight));
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, value, (PetscMPIInt)(n * (PROBE_COUNT + 1)), MPI_DOUBLE, MPI_SUM, m->grid.comm));
  PetscCall(LimitAll(m, fit, value));
  for (PetscInt k = 0; k < n; k++) {
    if (!ProbeIsMean(&c->probe[k]))
      continue;
    fit[k].total = weight[k];
    for (int q = 0; q < PROBE_COUNT; q++)
      value[k * PROBE_COUNT + q] /= weight[k] > 0.0 ? weight[k] : 1.0;
  }
  if (m->grid.rank == 0)
    ierr = WriteRow(out, c, s->t, fit, n, value);
  PetscCall(IoAgree(m->grid.comm, ierr));
  PetscCall(PetscFree(fit));
  PetscCall(PetscFree(value));
  PetscFunctionReturn(PETSC_SUCCESS);
}
