/* The residual (15)-(23): particles, faces, stabilisation, Dirichlet rows. */
#include "gather.h"

PetscErrorCode ModelUnscale(Model *m, Vec X, double *x)
{
  const double *a;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(X, &a));
  for (PetscInt k = 0; k < m->map.n_owned * F_COUNT; k++)
    x[k] = a[k] * m->col_scale[k];
  PetscCall(VecRestoreArrayRead(X, &a));
  PetscCall(NodeMapBroadcast(&m->map, x, F_COUNT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelProjectGradients(Model *m, const double *x, double *proj)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(proj, 4 * m->map.n_local));
  for (PetscInt p = 0; p < m->P.n; p++) {
    double g[4] = {0.0};
    Reach  r;

    ReachExpand(m, p, &r);
    for (int a = 0; a < r.n; a++) {
      const double *xI = &x[r.node[a] * F_COUNT];

      for (int k = 0; k < 4; k++)
        g[k] += r.G[a][k % 2] * xI[F_PW + k / 2];
    }
    for (int a = 0; a < r.n; a++) {
      const double VS = m->P.f[P_V][p] * r.S[a];

      for (int k = 0; k < 4; k++)
        proj[4 * r.node[a] + k] += VS * g[k];
    }
  }
  PetscCall(NodeMapSum(&m->map, proj, 4));
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    for (int k = 0; k < 4; k++)
      proj[4 * I + k] /= m->V[I];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of one node from one particle. */
static void Scatter(const Model *m, const Reach *r, const double *x, const double out[OUT_COUNT], double *f)
{
  const double dt = m->stage.dt, *b = m->c->gravity;

  for (int a = 0; a < r->n; a++) {
    const PetscInt I  = r->node[a];
    const double  *xI = &x[I * F_COUNT], *xs = &m->stage.x_star[I * F_COUNT], S = r->S[a], *G = r->G[a];
    double        *fI = &f[I * F_COUNT];

    for (int i = 0; i < 2; i++) {
      double inertia = 0.0;

      for (int k = 0; k < 3; k++) {
        const double acc = (xI[F_VSX + 2 * k + i] - xs[F_VSX + 2 * k + i]) / dt - b[i];

        inertia += out[OUT_M + k] * acc;
        if (k == 0)
          continue;
        const int    ph = k - 1;
        const double J  = m->w[2 * I + ph] * (xI[F_VSX + 2 * k + i] - xI[F_VSX + i]);

        fI[F_VSX + 2 * k + i] += S * (out[OUT_MI + ph] * acc + out[OUT_D + ph] * J) -
                                 G[0] * out[OUT_PF + 4 * ph + 2 * i] - G[1] * out[OUT_PF + 4 * ph + 2 * i + 1];
      }
      fI[F_VSX + i] += S * inertia + G[0] * out[OUT_P + 2 * i] + G[1] * out[OUT_P + 2 * i + 1];
    }
    for (int ph = 0; ph < PHASE_COUNT; ph++) {
      fI[F_PW + ph] += S * out[OUT_DM + ph] - dt * (G[0] * out[OUT_FLUX + 2 * ph] + G[1] * out[OUT_FLUX + 2 * ph + 1]);
    }
    fI[F_T] +=
        S * (out[OUT_C] * (xI[F_T] - xs[F_T]) / dt + out[OUT_Q]) + G[0] * out[OUT_HEAT] + G[1] * out[OUT_HEAT + 1];
  }
}

static void ParticleLoop(Model *m, const double *x, double *f)
{
  for (PetscInt p = 0; p < m->P.n; p++) {
    Reach       r;
    PointState  state;
    PointOutput o;
    double      in[IN_COUNT];

    if (ParticleEvaluate(m, p, x, false, &r, in, &state, &o) != CL_OK)
      return;
    m->limited += state.limited;
    Scatter(m, &r, x, o.out, f);
  }
}

static void FaceLoop(const Model *m, const double *x, double *f)
{
  for (PetscInt k = 0; k < m->nface; k++) {
    const Face *face = &m->face[k];
    Reach       r;
    FaceOutput  o;

    FaceAt(m, face, x, &r, &o);
    for (int a = 0; a < r.n; a++) {
      for (int q = 0; q < F_COUNT; q++)
        f[r.node[a] * F_COUNT + q] += face->N[a] * o.out[q];
    }
  }
}

/* Scaled rows; a prescribed unknown's row is x - x_hat. */
static PetscErrorCode Finish(Model *m, const double *x, const double *f, Vec R)
{
  double *a;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayWrite(R, &a));
  for (PetscInt k = 0; k < m->map.n_owned * F_COUNT; k++) {
    const bool fixed = (m->mask[k / F_COUNT] >> (k % F_COUNT)) & 1u;

    a[k] = fixed ? (x[k] - m->fixed[k]) / m->col_scale[k] : f[k] / m->row_scale[k];
    if (m->status != CL_OK)
      a[k] = NAN; /* every rank and the line search must see the failure */
  }
  PetscCall(VecRestoreArrayWrite(R, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelResidual(SNES snes, Vec X, Vec R, void *model)
{
  Model *m = (Model *)model;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(m->event[1], 0, 0, 0, 0));
  m->status  = CL_OK;
  m->limited = 0;
  PetscCall(ModelUnscale(m, X, m->x));
  PetscCall(PetscArrayzero(m->f, m->map.n_local * F_COUNT));
  PetscCall(ModelProjectGradients(m, m->x, m->proj));
  ParticleLoop(m, m->x, m->f);
  FaceLoop(m, m->x, m->f);
  StabilisationResidual(m, m->x, m->f);
  PetscCall(NodeMapReduce(&m->map, m->f, F_COUNT));
  PetscCall(Finish(m, m->x, m->f, R));
  if (m->status != CL_OK && snes)
    PetscCall(SNESSetFunctionDomainError(snes));
  PetscCall(PetscLogEventEnd(m->event[1], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
