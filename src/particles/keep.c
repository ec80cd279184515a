/* What a step makes of the history of particles, for either kind of integrator: a variable that follows from the
   motion and from the state at the end of the step is written here and nowhere else. */
#include "clathra/particles.h"
#include <string.h>

/* Positions and domains. */
static void Move(const Particles *P, PetscInt p, PetscInt n, const ParticleMotion *m)
{
  for (int d = 0; d < CL_DIM; d++) {
    double *restrict x = P->f[P_X + d] + p, *restrict u = P->f[P_U + d] + p, *restrict l = P->f[P_L + d] + p;
    const double *restrict step = m->u[d], *restrict stretch = m->stretch[d];

    for (PetscInt q = 0; q < n; q++) {
      x[q] += step[q];
      u[q] += step[q];
    }
    for (PetscInt q = 0; stretch && q < n; q++)
      l[q] *= stretch[q];
  }
}

/* F <- (1 + H) F and ln J. */
static void Deform(const Particles *P, PetscInt p, PetscInt n, const ParticleMotion *m)
{
  double *restrict log_J      = P->f[P_LOGJ] + p;
  const double *restrict more = m->log_J;

  for (int j = 0; j < CL_DIM; j++) {
    INDEPENDENT
    for (PetscInt q = 0; q < n; q++) {
      double x[CL_DIM];

      for (int i = 0; i < CL_DIM; i++)
        x[i] = P->f[VectorAt(P_F, i, j)][p + q];
      for (int i = 0; i < CL_DIM; i++) {
        double sum = m->H[i][0][q] * x[0];

        for (int k = 1; k < CL_DIM; k++)
          sum += m->H[i][k][q] * x[k];
        P->f[VectorAt(P_F, i, j)][p + q] = x[i] + sum;
      }
    }
  }
  for (PetscInt q = 0; q < n; q++)
    log_J[q] += more[q];
}

/* F^-T of particle q of a motion. */
INLINE void InverseTransposed(const ParticleMotion *m, PetscInt q, double A[CL_DIM][CL_DIM])
{
  double F[CL_DIM][CL_DIM];

  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++)
      F[i][j] = (i == j ? 1.0 : 0.0) + m->H[i][j][q];
  }
  const double per = 1.0 / CofactorOf(F, A);

  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++)
      A[i][j] *= per;
  }
}

void MixedCarry(const double A[CL_DIM][CL_DIM], double B[CL_MIXED])
{
  double from[CL_MIXED];

  memcpy(from, B, sizeof(from));
  for (int k = 0; k < CL_PAIRS; k++) {
    const double *a = A[cl_pair[k][0]], *b = A[cl_pair[k][1]];

    B[k] = 0.0;
    for (int o = 0; o < CL_PAIRS; o++) {
      const int i = cl_pair[o][0], j = cl_pair[o][1];

      B[k] += from[o] * (a[i] * b[j] + a[j] * b[i]);
    }
  }
  for (int k = CL_PAIRS; k < CL_MIXED; k++) { /* the derivative by all three axes (446) */
    B[k] = 0.0;
    for (int i = 0; i < CL_DIM; i++) {
      const int j = (i + 1) % CL_DIM, l = (i + 2) % CL_DIM;

      B[k] += from[k] * A[0][i] * (A[1][j] * A[CL_DIM - 1][l] + A[1][l] * A[CL_DIM - 1][j]);
    }
  }
}

/* Gradients on the configuration at the begin of the step, brought to that at its end: F^-T g; and the mixed
   derivatives of T, xy (yz, xz) of F^-T B F^-1 (395), (446). */
static void CarryGradients(const Particles *P, PetscInt p, PetscInt n, const ParticleMotion *m)
{
  int grad[3 + CL_DIM] = {P_GW, P_GG, P_GT}; /* ... and a row of that of the velocity for each axis */

  for (int d = 0; d < CL_DIM; d++)
    grad[3 + d] = VectorAt(P_GV, d, 0);
  for (int k = 0; k < 3 + CL_DIM; k++) {
    const PetscInt held = P->f[grad[k]] ? n : 0;

    INDEPENDENT
    for (PetscInt q = 0; q < held; q++) {
      double A[CL_DIM][CL_DIM], g[CL_DIM];

      InverseTransposed(m, q, A);
      for (int d = 0; d < CL_DIM; d++)
        g[d] = P->f[grad[k] + d][p + q];
      for (int d = 0; d < CL_DIM; d++)
        P->f[grad[k] + d][p + q] = VectorDot(A[d], g);
    }
  }
  for (PetscInt q = 0; P->f[P_BT] && q < n; q++) {
    double A[CL_DIM][CL_DIM], B[CL_MIXED];

    InverseTransposed(m, q, A);
    for (int k = 0; k < CL_MIXED; k++)
      B[k] = P->f[P_BT + k][p + q];
    MixedCarry(A, B);
    for (int k = 0; k < CL_MIXED; k++)
      P->f[P_BT + k][p + q] = B[k];
  }
}

void ParticlesKeep(const Particles *P, PetscInt first, PetscInt n, const ParticleMotion *m)
{
  if (m) {
    Move(P, first, n, m);
    Deform(P, first, n, m);
    CarryGradients(P, first, n, m);
  }
}
