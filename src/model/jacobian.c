/* The assembled part J2 of the Jacobian: block of one particle, block of one face. */
#include "gather.h"

/* d out/d(nine unknowns of one node): column K of D B_in; NS replaces S for the Darcy fluxes. */
static void Columns(const double *D, double dt, double S, double NS, const double *G, const double *w,
                    double col[F_COUNT])
{
  const double g0 = dt * G[0], g1 = dt * G[1], cw = NS * w[PHASE_W], cg = NS * w[PHASE_G];

  for (int i = 0; i < 2; i++) {
    const double jw = D[IN_J + i] * cw, jg = D[IN_J + 2 + i] * cg;

    col[F_VSX + i] = D[2 * i] * g0 + D[2 * i + 1] * g1 - jw - jg;
    col[F_VWX + i] = jw;
    col[F_VGX + i] = jg;
  }
  for (int f = 0; f < PHASE_COUNT; f++)
    col[F_PW + f] = D[IN_P + f] * S + D[IN_GP + 2 * f] * G[0] + D[IN_GP + 2 * f + 1] * G[1];
  col[F_T] = D[IN_T] * S + D[IN_GT] * G[0] + D[IN_GT + 1] * G[1];
}

/* Nodal factors that multiply a particle's outputs: accelerations, Darcy fluxes, temperature rate. */
typedef struct {
  double acc[3][2], J[PHASE_COUNT][2], Tdot;
} NodeFactors;

static void Factors(const Model *m, PetscInt I, const double *x, NodeFactors *n)
{
  const double *xI = &x[I * F_COUNT], *xs = &m->stage.x_star[I * F_COUNT];

  for (int i = 0; i < 2; i++) {
    for (int k = 0; k < 3; k++)
      n->acc[k][i] = (xI[F_VSX + 2 * k + i] - xs[F_VSX + 2 * k + i]) / m->stage.dt - m->c->gravity[i];
    for (int f = 0; f < PHASE_COUNT; f++)
      n->J[f][i] = m->w[2 * I + f] * (xI[F_VWX + 2 * f + i] - xI[F_VSX + i]);
  }
  n->Tdot = (xI[F_T] - xs[F_T]) / m->stage.dt;
}

/* Nine rows of node a against the columns DB of node b (b's block starts at *out, row length ld). */
static void Rows(const NodeFactors *n, double dt, double S, const double *G, double DB[OUT_COUNT][F_COUNT], double *out,
                 int ld)
{
  for (int q = 0; q < F_COUNT; q++) {
    for (int i = 0; i < 2; i++) {
      out[(F_VSX + i) * ld + q] =
          G[0] * DB[OUT_P + 2 * i][q] + G[1] * DB[OUT_P + 2 * i + 1][q] +
          S * (n->acc[0][i] * DB[OUT_M][q] + n->acc[1][i] * DB[OUT_M + 1][q] + n->acc[2][i] * DB[OUT_M + 2][q]);
      for (int f = 0; f < PHASE_COUNT; f++) {
        out[(F_VWX + 2 * f + i) * ld + q] = S * (n->acc[1 + f][i] * DB[OUT_MI + f][q] + n->J[f][i] * DB[OUT_D + f][q]) -
                                            G[0] * DB[OUT_PF + 4 * f + 2 * i][q] -
                                            G[1] * DB[OUT_PF + 4 * f + 2 * i + 1][q];
      }
    }
    for (int f = 0; f < PHASE_COUNT; f++) {
      out[(F_PW + f) * ld + q] =
          S * DB[OUT_DM + f][q] - dt * (G[0] * DB[OUT_FLUX + 2 * f][q] + G[1] * DB[OUT_FLUX + 2 * f + 1][q]);
    }
    out[F_T * ld + q] =
        S * (n->Tdot * DB[OUT_C][q] + DB[OUT_Q][q]) + G[0] * DB[OUT_HEAT][q] + G[1] * DB[OUT_HEAT + 1][q];
  }
}

/* The lumped terms couple a node only with itself. */
static void Diagonal(const double out[OUT_COUNT], double dt, double S, const double *w, double *block, int ld)
{
  for (int i = 0; i < 2; i++) {
    for (int k = 0; k < 3; k++)
      block[(F_VSX + i) * ld + F_VSX + 2 * k + i] += S * out[OUT_M + k] / dt;
    for (int f = 0; f < PHASE_COUNT; f++) {
      const int    row  = F_VWX + 2 * f + i;
      const double drag = S * out[OUT_D + f] * w[f];

      block[row * ld + row] += S * out[OUT_MI + f] / dt + drag;
      block[row * ld + F_VSX + i] -= drag;
    }
  }
  block[F_T * ld + F_T] += S * out[OUT_C] / dt;
}

static void ParticleBlock(const Model *m, const Reach *r, const double *x, const PointOutput *o, double *block)
{
  const int    ld = r->n * F_COUNT;
  const double dt = m->stage.dt;
  NodeFactors  factor[CL_NODES];

  for (int a = 0; a < r->n; a++)
    Factors(m, r->node[a], x, &factor[a]);
  for (int b = 0; b < r->n; b++) {
    const double *w = &m->w[2 * r->node[b]];
    double        DB[OUT_COUNT][F_COUNT];

    for (int k = 0; k < OUT_COUNT; k++)
      Columns(o->D[k], dt, r->S[b], r->S[b], r->G[b], w, DB[k]);
    for (int a = 0; a < r->n; a++) {
      double *out = &block[(a * ld + b) * F_COUNT];

      Rows(&factor[a], dt, r->S[a], r->G[a], DB, out, ld);
      if (a == b)
        Diagonal(o->out, dt, r->S[a], w, out, ld);
    }
  }
}

PetscErrorCode JacobianAdd(Model *m, int n, const PetscInt *node, double *block)
{
  const int ld = n * F_COUNT;

  PetscFunctionBeginUser;
  for (int row = 0; row < ld; row++) {
    const PetscInt k     = node[row / F_COUNT] * F_COUNT + row % F_COUNT;
    const bool     fixed = (m->mask[node[row / F_COUNT]] >> (row % F_COUNT)) & 1u;
    const double   scale = fixed ? 0.0 : 1.0 / m->row_scale[k];
    double        *out   = &block[row * ld];

    for (int b = 0; b < n; b++) {
      const double *col = &m->col_scale[node[b] * F_COUNT];

      for (int q = 0; q < F_COUNT; q++)
        out[b * F_COUNT + q] *= scale * col[q];
    }
  }
  PetscCall(MatSetValuesBlockedLocal(m->J2, n, node, n, node, block, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void KeepWide(const PointOutput *o, double *wide)
{
  for (int f = 0; f < PHASE_COUNT; f++) {
    for (int k = 0; k < 4; k++)
      wide[4 * f + k] = o->wide[f][k / 2][k % 2];
    for (int j = 0; j < 2; j++)
      wide[8 + 2 * f + j] = o->wide_q[f][j];
  }
}

static PetscErrorCode ParticleLoop(Model *m, const double *x)
{
  double block[CL_NODES * CL_NODES * F_COUNT * F_COUNT];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->P.n; p++) {
    Reach       r;
    PointState  state;
    PointOutput o;
    double      in[IN_COUNT];

    if (ParticleEvaluate(m, p, x, true, &r, in, &state, &o) != CL_OK)
      continue; /* the residual said so */
    KeepWide(&o, &m->wide[12 * p]);
    ParticleBlock(m, &r, x, &o, block);
    PetscCall(JacobianAdd(m, r.n, r.node, block));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nine rows of a face's nodes: all are weighted with N. */
static void FaceBlock(const Model *m, const Face *face, const Reach *r, const FaceOutput *o, double *block)
{
  const int ld = r->n * F_COUNT;

  for (int b = 0; b < r->n; b++) {
    for (int q = 0; q < F_COUNT; q++) {
      double col[F_COUNT];

      Columns(o->D[q], m->stage.dt, r->S[b], face->N[b], r->G[b], &m->w[2 * r->node[b]], col);
      for (int a = 0; a < r->n; a++) {
        for (int c = 0; c < F_COUNT; c++)
          block[(a * F_COUNT + q) * ld + b * F_COUNT + c] = face->N[a] * col[c];
      }
    }
  }
}

static PetscErrorCode FaceLoop(Model *m, const double *x)
{
  double block[CL_NODES * CL_NODES * F_COUNT * F_COUNT];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->nface; k++) {
    Reach      r;
    FaceOutput o;

    FaceAt(m, &m->face[k], x, &r, &o);
    FaceBlock(m, &m->face[k], &r, &o, block);
    PetscCall(JacobianAdd(m, r.n, r.node, block));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of prescribed unknowns: 1 on the diagonal (the scales cancel). */
static PetscErrorCode DirichletDiagonal(Model *m)
{
  double unit[F_COUNT * F_COUNT];

  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int q = 0; q < F_COUNT * F_COUNT; q++)
      unit[q] = 0.0;
    for (int q = 0; q < F_COUNT; q++)
      unit[q * F_COUNT + q] = (m->mask[I] >> q) & 1u ? 1.0 : 0.0;
    PetscCall(MatSetValuesBlockedLocal(m->J2, 1, &I, 1, &I, unit, ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The factors of one step serve all its Newton iterations as long as GMRES stays quick with them. */
static PetscErrorCode ChoosePreconditioner(Model *m, SNES snes, Mat P)
{
  PetscInt its = 0;
  KSP      ksp = NULL;

  PetscFunctionBeginUser;
  if (snes) {
    PetscCall(SNESGetKSP(snes, &ksp));
    PetscCall(KSPGetIterationNumber(ksp, &its));
  }
  if (m->always_refactor || its > m->poor || fabs(m->stage.dt - m->factored_dt) > 1e-3 * m->factored_dt)
    m->refactor = true;
  if (snes)
    PetscCall(SNESSetLagPreconditioner(snes, m->refactor ? -2 : -1)); /* -2: once, now; -1: never again */
  if (m->refactor && P != m->J2)
    PetscCall(MatConvert(m->J2, MATAIJ, MAT_REUSE_MATRIX, &P));
  m->refactor    = false;
  m->factored_dt = m->stage.dt;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelJacobian(SNES snes, Vec X, Mat A, Mat P, void *model)
{
  Model *m = (Model *)model;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(m->event[2], 0, 0, 0, 0));
  PetscCall(ModelUnscale(m, X, m->x));
  PetscCall(ModelProjectGradients(m, m->x, m->proj));
  PetscCall(MatZeroEntries(m->J2));
  PetscCall(ParticleLoop(m, m->x));
  PetscCall(FaceLoop(m, m->x));
  PetscCall(StabilisationJacobian(m));
  PetscCall(DirichletDiagonal(m));
  PetscCall(MatAssemblyBegin(m->J2, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(m->J2, MAT_FINAL_ASSEMBLY));
  PetscCall(ChoosePreconditioner(m, snes, P));
  if (A != P) {
    PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  }
  PetscCall(PetscLogEventEnd(m->event[2], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
