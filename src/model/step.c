/* Start of a step: stencils, active nodes and nodal start values on the configuration at t_n. */
#include "gather.h"

static bool InsideGrid(const Grid *g, const Stencil *s)
{
  for (int d = 0; d < CL_DIM; d++) {
    for (int k = 0; k < 3; k++) {
      const PetscInt i = s->axis[d].base + k;

      if ((i < 0 || i > g->cells[d]) && (s->axis[d].S[k] != 0.0 || s->axis[d].dS[k] != 0.0))
        return false;
    }
  }
  return true;
}

/* Stencils of all particles, and the flags of the nodes they reach. */
static PetscErrorCode BuildStencils(Model *m, unsigned char *flag)
{
  const Grid *g = &m->grid;

  PetscFunctionBeginUser;
  if (m->P.n > m->stencil_cap) {
    PetscCall(PetscFree(m->stencil));
    PetscCall(PetscFree(m->wide));
    m->stencil_cap = m->P.cap;
    PetscCall(PetscMalloc1(m->stencil_cap, &m->stencil));
    PetscCall(PetscCalloc1(12 * m->stencil_cap, &m->wide));
  }
  for (PetscInt p = 0; p < m->P.n; p++) {
    Stencil *s = &m->stencil[p];

    for (int d = 0; d < CL_DIM; d++)
      BasisAxis(m->c->basis, m->P.f[P_X + d][p], m->P.f[P_L + d][p], g->lower[d], g->h[d], g->cells[d], &s->axis[d]);
    if (!InsideGrid(g, s)) {
      NoteFailure(m, CL_LEFT_GRID, "a particle's domain leaves the background grid", p);
      continue;
    }
    for (int b = 0; b < 3; b++) {
      for (int a = 0; a < 3; a++) {
        const bool x = s->axis[0].S[a] != 0.0 || s->axis[0].dS[a] != 0.0,
                   y = s->axis[1].S[b] != 0.0 || s->axis[1].dS[b] != 0.0;

        if (x && y)
          flag[GridPadded(g, s->axis[0].base + a, s->axis[1].base + b)] = 1;
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums of one particle into its nodes: (2), masses, and the nodal means of its properties. */
enum { SUM_MS = 0, SUM_MW, SUM_MG, SUM_X, SUM_W = SUM_X + F_COUNT, SUM_COUNT = SUM_W + 2 };

static void Deposit(const Model *m, PetscInt p, const Reach *r, const PointProperties *q, double *sum)
{
  double *const *f = (double *const *)m->P.f;
  const double   V = f[P_V][p], mass[3] = {f[P_MS][p] + f[P_MH][p], f[P_MW][p], f[P_MG][p]};
  const double   fluid = q->phi * (1.0 - q->Sh);

  for (int a = 0; a < r->n; a++) {
    const PetscInt I = r->node[a];
    const double   S = r->S[a], VS = V * S;
    const double   dx = m->grid.lower[0] + (double)m->map.ij[I][0] * m->grid.h[0] - f[P_X][p];
    const double   dy = m->grid.lower[1] + (double)m->map.ij[I][1] * m->grid.h[1] - f[P_X + 1][p];
    double        *s = &sum[I * SUM_COUNT], *c = &m->coef[I * NC_COUNT];

    for (int k = 0; k < 3; k++) {
      s[SUM_MS + k] += S * mass[k];
      for (int d = 0; d < 2; d++)
        s[SUM_X + F_VSX + 2 * k + d] += S * mass[k] * f[P_VS + 2 * k + d][p];
    }
    s[SUM_X + F_PW] += VS * (f[P_PW][p] + f[P_GW][p] * dx + f[P_GW + 1][p] * dy);
    s[SUM_X + F_PG] += VS * (f[P_PG][p] + f[P_GG][p] * dx + f[P_GG + 1][p] * dy);
    s[SUM_X + F_T] += S * q->capacity * (f[P_T][p] + f[P_GT][p] * dx + f[P_GT + 1][p] * dy);
    m->V[I] += VS;
    c[NC_M] += VS * q->M;
    c[NC_KAPPA] += VS * q->kappa;
    c[NC_CAPACITY] += S * q->capacity;
    for (int k = 0; k < PHASE_COUNT; k++) {
      s[SUM_W + k] += VS * fluid * q->s[k];
      c[NC_LAMBDA + k] += VS * q->rho[k] / q->drag[k];
      c[NC_RHO + k] += VS * q->rho[k];
      c[NC_STORAGE + k] += VS * q->storage[k];
      c[NC_DRAG + k] += VS * q->drag[k];
    }
  }
}

static void Average(Model *m, const double *sum)
{
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    const double *s = &sum[I * SUM_COUNT], V = m->V[I];
    double       *c = &m->coef[I * NC_COUNT], *x = &m->x_n[I * F_COUNT];

    for (int k = 0; k < 3; k++) {
      const double mass = s[SUM_MS + k];

      for (int d = 0; d < 2; d++)
        x[F_VSX + 2 * k + d] = mass > 0.0 ? s[SUM_X + F_VSX + 2 * k + d] / mass : 0.0;
    }
    x[F_PW] = s[SUM_X + F_PW] / V;
    x[F_PG] = s[SUM_X + F_PG] / V;
    x[F_T]  = s[SUM_X + F_T] / c[NC_CAPACITY];
    for (int k = 0; k < PHASE_COUNT; k++)
      m->w[2 * I + k] = s[SUM_W + k] / V;
    for (int k = 0; k < NC_COUNT; k++)
      c[k] /= V;
  }
}

static PetscErrorCode Project(Model *m)
{
  double     *sum;
  const char *why;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->map.n_local * SUM_COUNT, &sum));
  PetscCall(PetscArrayzero(m->V, m->map.n_local));
  PetscCall(PetscArrayzero(m->coef, m->map.n_local * NC_COUNT));
  for (PetscInt p = 0; p < m->P.n; p++) {
    double *const  *f = (double *const *)m->P.f;
    PointProperties q;
    Reach           r;
    const ClStatus  status = PointPropertiesEvaluate(ParticleMaterial(m, p), f[P_V][p], f[P_MS][p], f[P_MH][p],
                                                     f[P_PW][p], f[P_PG][p], f[P_T][p], &q, &why);

    if (status != CL_OK) {
      NoteFailure(m, status, why, p);
      continue;
    }
    ReachExpand(m, p, &r);
    Deposit(m, p, &r, &q, sum);
  }
  PetscCall(NodeMapSum(&m->map, sum, SUM_COUNT));
  PetscCall(NodeMapSum(&m->map, m->V, 1));
  PetscCall(NodeMapSum(&m->map, m->coef, NC_COUNT));
  Average(m, sum);
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelBeginStep(Model *m, ClStatus *status)
{
  unsigned char *flag;
  bool           changed;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(m->event[0], 0, 0, 0, 0));
  m->status   = CL_OK;
  m->refactor = true;
  PetscCall(PetscCalloc1(m->grid.gm[0] * m->grid.gm[1], &flag));
  PetscCall(BuildStencils(m, flag));
  PetscCall(ModelReduceStatus(m, status));
  if (*status == CL_OK) {
    PetscCall(NodeMapUpdate(&m->grid, flag, &m->map, &changed));
    if (changed)
      PetscCall(ModelResizeNodal(m));
    PetscCall(Project(m));
    PetscCall(ModelReduceStatus(m, status));
  }
  if (*status == CL_OK) {
    PetscCall(FacesBuild(m->c, &m->grid, &m->P, m->stencil, &m->nface, &m->face));
    PetscCall(StabilisationBuild(m));
  }
  PetscCall(PetscFree(flag));
  PetscCall(PetscLogEventEnd(m->event[0], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mass that a change of 1 MPa stores or moves, but no more than there is, unless that is below the round-off of what
   moves. */
static double MassScale(const double c[NC_COUNT], int phase, double w, double dt, double h)
{
  const double moved =
      1e6 * (c[NC_RHO + phase] * (c[NC_STORAGE + phase] + w / c[NC_M]) + dt * c[NC_LAMBDA + phase] / (h * h));

  return fmax(fmin(moved, c[NC_RHO + phase] * w), 1e-3 * moved);
}

#define SLIVER 0.05 /* of a cell: emptier nodes are held by the ghost penalty, whose rows do not shrink with them */

/* Columns: 1 MPa, 1 K, and the velocities that belong to 1 MPa over a cell.  Rows: what such a change makes of each
   balance, so that scaled residuals and updates compare across fields. */
static void Scales(Model *m)
{
  const double h = fmin(m->grid.h[0], m->grid.h[1]), dt = m->stage.dt, P = 1e6;

  for (PetscInt I = 0; I < m->map.n_local; I++) {
    const double *c = &m->coef[I * NC_COUNT], V = m->V[I], V_row = fmax(V, SLIVER * m->grid.h[0] * m->grid.h[1]);
    double       *row = &m->row_scale[I * F_COUNT], *col = &m->col_scale[I * F_COUNT];

    for (int d = 0; d < 2; d++) {
      col[F_VSX + d] = P * h / (c[NC_M] * dt);
      row[F_VSX + d] = V_row * P / h;
      for (int k = 0; k < PHASE_COUNT; k++) {
        col[F_VWX + 2 * k + d] = P / h / (c[NC_RHO + k] / dt + c[NC_DRAG + k] * m->w[2 * I + k]);
        row[F_VWX + 2 * k + d] = V * P / h;
      }
    }
    for (int k = 0; k < PHASE_COUNT; k++) {
      col[F_PW + k] = P;
      row[F_PW + k] = V_row * MassScale(c, k, m->w[2 * I + k], dt, h);
    }
    col[F_T] = 1.0;
    row[F_T] = V_row * (c[NC_CAPACITY] / dt + c[NC_KAPPA] / (h * h));
  }
}

PetscErrorCode ModelBeginStage(Model *m, const Stage *s)
{
  PetscFunctionBeginUser;
  m->stage = *s;
  BcValuesEvaluate(m->c, s->t, &m->bc);
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    m->mask[I] = 0;
    PlaneConditions(m->c, &m->grid, &m->bc, m->map.ij[I], &m->mask[I], &m->fixed[I * F_COUNT]);
  }
  Scales(m);
  PetscFunctionReturn(PETSC_SUCCESS);
}
