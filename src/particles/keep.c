/* What a step makes of the history of particles, for either kind of integrator: a variable that follows from the
   motion and from the state at the end of the step is written here and nowhere else. */
#include "clathra/particles.h"

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
  const double *restrict Hxx = m->H[0][0], *restrict Hxy = m->H[0][1], *restrict Hyx = m->H[1][0],
                         *restrict Hyy = m->H[1][1];

  for (int j = 0; j < CL_DIM; j++) {
    double *restrict x = P->f[P_F + j] + p, *restrict y = P->f[P_F + 2 + j] + p;

    for (PetscInt q = 0; q < n; q++) {
      const double a = Hxx[q] * x[q] + Hxy[q] * y[q], b = Hyx[q] * x[q] + Hyy[q] * y[q];

      x[q] += a;
      y[q] += b;
    }
  }
  for (PetscInt q = 0; q < n; q++)
    log_J[q] += more[q];
}

/* Gradients on the configuration at the begin of the step, brought to that at its end: F^-T g; and the mixed derivative
   of T, xy of F^-T B F^-1 (395). */
static void CarryGradients(const Particles *P, PetscInt p, PetscInt n, const ParticleMotion *m)
{
  static const int grad[3]   = {P_GW, P_GG, P_GT};
  const double *restrict Hxx = m->H[0][0], *restrict Hxy = m->H[0][1], *restrict Hyx = m->H[1][0],
                         *restrict Hyy = m->H[1][1];

  for (int k = 0; k < 3; k++) {
    double *restrict gx = P->f[grad[k]] + p, *restrict gy = P->f[grad[k] + 1] + p;

    for (PetscInt q = 0; P->f[grad[k]] && q < n; q++) {
      const double Fxx = 1.0 + Hxx[q], Fyy = 1.0 + Hyy[q], per = 1.0 / (Fxx * Fyy - Hxy[q] * Hyx[q]);
      const double x = gx[q], y = gy[q];

      gx[q] = (Fyy * x - Hyx[q] * y) * per;
      gy[q] = (Fxx * y - Hxy[q] * x) * per;
    }
  }
  for (PetscInt q = 0; P->f[P_BT] && q < n; q++) {
    const double Fxx = 1.0 + Hxx[q], Fyy = 1.0 + Hyy[q], turn = Hxy[q] * Hyx[q], det = Fxx * Fyy - turn;

    P->f[P_BT][p + q] *= (Fxx * Fyy + turn) / (det * det);
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
