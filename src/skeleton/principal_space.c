/* Principal stresses of any stress, and back with the tangent. */
#include "clathra/eigen.h"
#include "plastic.h"

void PrincipalOf(const double sig[6], Principal *p)
{
  EigenValues e;

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      e.Q[i][j] = sig[voigt[i][j]];
  }
  const bool found = Eigen(&e);

  for (int i = 0; i < 3; i++) {
    p->y[i] = found ? e.y[2 - i] : NAN;
    for (int j = 0; j < 3; j++)
      p->Q[j][i] = e.Q[j][2 - i];
  }
}

/* n_i n_j, symmetric. */
static void Dyad(const Principal *p, int i, int j, double n[6])
{
  for (int a = 0; a < 3; a++) {
    for (int b = a; b < 3; b++)
      n[voigt[a][b]] = 0.5 * (p->Q[a][i] * p->Q[b][j] + p->Q[b][i] * p->Q[a][j]);
  }
}

void FromPrincipal(const Principal *p, const double y[3], double sig[6])
{
  for (int k = 0; k < 6; k++)
    sig[k] = 0.0;
  for (int i = 0; i < 3; i++) {
    double n[6];

    Dyad(p, i, i, n);
    for (int k = 0; k < 6; k++)
      sig[k] += y[i] * n[k];
  }
}

/* w of (431). */
static double Spin(const Principal *p, const Returned *r, int i, int j)
{
  const double size = fabs(p->y[0]) + fabs(p->y[2]), apart = p->y[i] - p->y[j];

  return apart > NEAR_EQUAL * size ? (r->y[i] - r->y[j]) / apart
                                   : 0.5 * (r->dy[i][i] - r->dy[i][j] - r->dy[j][i] + r->dy[j][j]);
}

/* Slopes of the stress by those of its principal values (431). */
void StressSlopes(const Principal *p, const Returned *r, double C[CL_TENSOR][CL_TENSOR], double by_E[CL_TENSOR],
                  double by_S[CL_TENSOR])
{
  double n[3][3][6], spin[3][3] = {{0.0}};

  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++) {
      Dyad(p, i, j, n[i][j]);
      spin[i][j] = i == j ? 0.0 : 2.0 * Spin(p, r, i, j);
    }
  }
  for (int a = 0; a < CL_TENSOR; a++) {
    by_E[a] = by_S[a] = 0.0;
    for (int i = 0; i < 3; i++) {
      by_E[a] += n[i][i][a] * r->dy[i][BY_E];
      by_S[a] += n[i][i][a] * r->dy[i][BY_SH];
    }
    for (int b = 0; b < CL_TENSOR; b++) {
      double sum = 0.0;

      for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
          sum += n[i][i][a] * r->dy[i][j] * n[j][j][b];
          if (j > i)
            sum += spin[i][j] * n[i][j][a] * n[i][j][b];
        }
      }
      C[a][b] = (b <= ZZ ? 1.0 : 2.0) * sum; /* a shear stands twice in the stress */
    }
  }
}
