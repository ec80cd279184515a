#include "clathra/eigen.h"
#include <math.h>
#include <string.h>

#define SWEEPS 20       /* four are usual */
#define ROUND_OFF 1e-17 /* of the largest number of the matrix */

/* Jacobi's rotation about the axis that is neither p nor q, with which A_pq vanishes; the vectors Q turn with it. */
static void Turn(double A[3][3], double Q[3][3], int p, int q)
{
  const int    r     = 3 - p - q;
  const double theta = (A[q][q] - A[p][p]) / (2.0 * A[p][q]); /* cot of twice the angle */
  const double t = copysign(1.0, theta) / (fabs(theta) + sqrt(1.0 + theta * theta)), c = 1.0 / sqrt(1.0 + t * t),
               s = t * c, rp = A[r][p], rq = A[r][q];

  A[p][p] -= t * A[p][q];
  A[q][q] += t * A[p][q];
  A[p][q] = A[q][p] = 0.0;
  A[r][p] = A[p][r] = c * rp - s * rq;
  A[r][q] = A[q][r] = s * rp + c * rq;
  for (int i = 0; i < 3; i++) {
    const double ip = Q[i][p], iq = Q[i][q];

    Q[i][p] = c * ip - s * iq;
    Q[i][q] = s * ip + c * iq;
  }
}

static void Swap(double *a, double *b)
{
  const double old = *a;

  *a = *b;
  *b = old;
}

/* By rising values. */
static void Sort(EigenValues *e)
{
  static const int pair[3][2] = {{0, 1}, {1, 2}, {0, 1}};

  for (int k = 0; k < 3; k++) {
    const int i = pair[k][0], j = pair[k][1];

    if (e->y[i] <= e->y[j])
      continue;
    Swap(&e->y[i], &e->y[j]);
    for (int d = 0; d < 3; d++)
      Swap(&e->Q[d][i], &e->Q[d][j]);
  }
}

bool Eigen(EigenValues *e)
{
  double A[3][3], most = 0.0, sum = 0.0;
  bool   turned = true;

  for (int k = 0; k < 9; k++) {
    A[k / 3][k % 3]    = e->Q[k / 3][k % 3];
    e->Q[k / 3][k % 3] = k % 4 == 0 ? 1.0 : 0.0;
    most               = fmax(most, fabs(A[k / 3][k % 3]));
    sum += A[k / 3][k % 3];
  }
  if (!isfinite(sum))
    return false;
  for (int sweep = 0; sweep < SWEEPS && turned; sweep++) {
    turned = false;
    for (int p = 0; p < 2; p++) {
      for (int q = p + 1; q < 3; q++) {
        if (fabs(A[p][q]) <= ROUND_OFF * most)
          continue;
        Turn(A, e->Q, p, q);
        turned = true;
      }
    }
  }
  for (int i = 0; i < 3; i++)
    e->y[i] = A[i][i];
  Sort(e);
  return !turned;
}
