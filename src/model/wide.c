/* The part of the Jacobian that runs through the projected gradients (27): particle by particle, never assembled. */
#include "solver.h"

/* What one particle's rows see of the projected gradients. */
static void WideParticle(const Model *m, PetscInt p, const double *proj, double *f)
{
  const FieldSet *fs                     = &m->c->fields;
  const Wide     *W                      = &m->wide[p];
  const double    dt                     = m->stage.dt;
  double          g[PHASE_COUNT][CL_DIM] = {{0.0}};
  Reach           r;

  ReachExpand(m, p, &r);
  for (int ph = 0; ph < PHASE_COUNT; ph++) {
    for (int a = 0; fs->phase[ph] && a < r.n; a++) {
      const double share = ProjectedShare(m, p, r.node[a], ph, r.S[a]);

      for (int d = 0; d < CL_DIM; d++)
        g[ph][d] += share * proj[VectorAt(0, PHASE_COUNT * r.node[a] + ph, d)];
    }
  }
  for (int ph = 0; ph < PHASE_COUNT; ph++) {
    double flux[CL_DIM] = {0.0};

    if (!fs->phase[ph])
      continue;
    for (int of = 0; of < PHASE_COUNT; of++) {
      for (int d = 0; d < CL_DIM; d++)
        flux[d] += VectorDot(W->flux[ph][of][d], g[of]);
    }
    const double q = fs->heat ? VectorDot(W->q[ph], g[ph]) : 0.0;

    for (int a = 0; a < r.n; a++) {
      double *fI = &f[r.node[a] * fs->n];

      fI[PlaceP(fs, ph)] -= dt * VectorDot(r.G[a], flux);
      if (fs->heat)
        fI[PlaceT(fs)] += r.S[a] * q;
    }
  }
}

/* y += C diag(1/V) B x on scaled, owned vectors, and the dense part of plates with a prescribed force. */
static PetscErrorCode WideApply(Model *m, bool wide, Vec X, Vec Y)
{
  const PetscInt nf = m->c->fields.n, n = m->map.n_local;
  double        *y, *x, *f, *proj;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n * nf, &x, n * nf, &f, n * CL_FLUID_VECTORS, &proj));
  PetscCall(ModelUnscale(m, X, x));
  PetscCall(PetscArrayzero(f, n * nf));
  if (wide)
    PetscCall(ModelProjectGradients(m, x, true, proj));
  for (PetscInt p = 0; wide && p < m->P.n; p++)
    WideParticle(m, p, proj, f);
  if (PlatesCouple(m))
    PetscCall(PlatesMult(m, x, f));
  PetscCall(NodeMapReduce(&m->map, f, nf));
  PetscCall(VecGetArray(Y, &y));
  for (PetscInt k = 0; k < m->map.n_owned * nf; k++) {
    if (!((m->mask[k / nf] >> (k % nf)) & 1u))
      y[k] += f[k] / m->row_scale[k];
  }
  PetscCall(VecRestoreArray(Y, &y));
  PetscCall(PetscFree3(x, f, proj));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WideMult(Mat A, Vec X, Vec Y)
{
  Model *m;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &m));
  if (m->solver->product) {
    PetscCall(PetscLogEventBegin(m->event[EVENT_PRODUCT], 0, 0, 0, 0));
    PetscCall(ProductMult(m, false, X, Y));
    PetscCall(PetscLogEventEnd(m->event[EVENT_PRODUCT], 0, 0, 0, 0));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(MatMult(m->solver->J2, X, Y));
  const bool wide = m->c->fields.fluid;
  if (wide || PlatesCouple(m)) {
    PetscCall(PetscLogEventBegin(m->event[EVENT_WIDE], 0, 0, 0, 0));
    PetscCall(WideApply(m, wide, X, Y));
    PetscCall(PetscLogEventEnd(m->event[EVENT_WIDE], 0, 0, 0, 0));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WideCreate(Model *m, Mat *A)
{
  const PetscInt n = m->map.n_owned * m->c->fields.n, N = m->map.n_global * m->c->fields.n;

  PetscFunctionBeginUser;
  PetscCall(MatCreateShell(m->grid.comm, n, n, N, N, m, A));
  PetscCall(MatSetBlockSize(*A, m->c->fields.n));
  PetscCall(MatShellSetOperation(*A, MATOP_MULT, (void (*)(void))WideMult));
  PetscFunctionReturn(PETSC_SUCCESS);
}
