/* The part of the Jacobian that runs through the projected gradients (27): particle by particle, never assembled. */
#include "gather.h"

/* y += C diag(1/V) B x on scaled, owned vectors. */
static PetscErrorCode WideApply(Model *m, Vec X, Vec Y)
{
  const double dt = m->stage.dt;
  double      *y, *x, *f, *proj;
  PetscInt     n = m->map.n_local;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n * F_COUNT, &x, n * F_COUNT, &f, n * 4, &proj));
  PetscCall(ModelUnscale(m, X, x));
  PetscCall(ModelProjectGradients(m, x, proj));
  PetscCall(PetscArrayzero(f, n * F_COUNT));
  for (PetscInt p = 0; p < m->P.n; p++) {
    const double *W    = &m->wide[12 * p];
    double        g[4] = {0.0}, flux[4], q = 0.0;
    Reach         r;

    ReachExpand(m, p, &r);
    for (int a = 0; a < r.n; a++) {
      for (int k = 0; k < 4; k++)
        g[k] += r.S[a] * proj[4 * r.node[a] + k];
    }
    for (int ph = 0; ph < PHASE_COUNT; ph++) {
      for (int i = 0; i < 2; i++)
        flux[2 * ph + i] = W[4 * ph + 2 * i] * g[2 * ph] + W[4 * ph + 2 * i + 1] * g[2 * ph + 1];
      q += W[8 + 2 * ph] * g[2 * ph] + W[8 + 2 * ph + 1] * g[2 * ph + 1];
    }
    for (int a = 0; a < r.n; a++) {
      double *fI = &f[r.node[a] * F_COUNT];

      for (int ph = 0; ph < PHASE_COUNT; ph++)
        fI[F_PW + ph] -= dt * (r.G[a][0] * flux[2 * ph] + r.G[a][1] * flux[2 * ph + 1]);
      fI[F_T] += r.S[a] * q;
    }
  }
  PetscCall(NodeMapReduce(&m->map, f, F_COUNT));
  PetscCall(VecGetArray(Y, &y));
  for (PetscInt k = 0; k < m->map.n_owned * F_COUNT; k++) {
    if (!((m->mask[k / F_COUNT] >> (k % F_COUNT)) & 1u))
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
  PetscCall(MatMult(m->J2, X, Y));
  if (m->c->flux_interpolation) {
    PetscCall(PetscLogEventBegin(m->event[3], 0, 0, 0, 0));
    PetscCall(WideApply(m, X, Y));
    PetscCall(PetscLogEventEnd(m->event[3], 0, 0, 0, 0));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WideCreate(Model *m, Mat *A)
{
  const PetscInt n = m->map.n_owned * F_COUNT, N = m->map.n_global * F_COUNT;

  PetscFunctionBeginUser;
  PetscCall(MatCreateShell(m->grid.comm, n, n, N, N, m, A));
  PetscCall(MatShellSetOperation(*A, MATOP_MULT, (void (*)(void))WideMult));
  PetscFunctionReturn(PETSC_SUCCESS);
}
