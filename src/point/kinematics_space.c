/* Exact kinematics of one increment in space, and its derivatives. */
#include "atanh_ratio.h"
#include "clathra/eigen.h"
#include "clathra/kinematics.h"
#include <string.h>

/* b - 1 = Q diag(y) Q^T with b = F F^T, and the stretches v = sqrt(1 + y). */
typedef struct {
  double Q[3][3], y[3], v[3];
} Stretches;

/* H = F - 1; b - 1 = H + H^T + H H^T loses nothing of a small strain. */
static bool StretchesOf(const double H[3][3], Stretches *s)
{
  EigenValues e;

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      e.Q[i][j] = H[i][j] + H[j][i] + VectorDot(H[i], H[j]);
  }
  if (!Eigen(&e))
    return false;
  memcpy(s->Q, e.Q, sizeof(s->Q));
  for (int i = 0; i < 3; i++) {
    s->y[i] = e.y[i];
    s->v[i] = sqrt(1.0 + e.y[i]);
  }
  return true;
}

/* L of (429). */
static double LogQuotient(const Stretches *s, int a, int b)
{
  const double sum = 2.0 + s->y[a] + s->y[b], z = (s->y[a] - s->y[b]) / sum;
  double       slope;

  return 2.0 / sum * AtanhRatio(z * z, &slope);
}

/* r = Q^T m Q. */
static void ToAxes(const double Q[3][3], const double m[3][3], double r[3][3])
{
  double half[3][3];

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      half[i][j] = m[i][0] * Q[0][j] + m[i][1] * Q[1][j] + m[i][2] * Q[2][j];
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      r[i][j] = Q[0][i] * half[0][j] + Q[1][i] * half[1][j] + Q[2][i] * half[2][j];
  }
}

/* r = Q m Q^T. */
static void FromAxes(const double Q[3][3], const double m[3][3], double r[3][3])
{
  double back[3][3];

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      back[i][j] = Q[j][i];
  }
  ToAxes(back, m, r);
}

/* (428): ln V, R = V^-1 F, and diag U = diag R^T F. */
static void Values(const Stretches *s, Kinematics *k)
{
  double lnV[3][3] = {{0.0}}, inverse[3][3] = {{0.0}}, m[3][3];

  for (int a = 0; a < 3; a++) {
    lnV[a][a]     = 0.5 * log1p(s->y[a]);
    inverse[a][a] = 1.0 / s->v[a];
  }
  FromAxes(s->Q, lnV, m);
  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++)
      k->e[voigt[i][j]] = m[i][j];
  }
  FromAxes(s->Q, inverse, m);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      k->turn.R[i][j] = m[i][0] * k->F[0][j] + m[i][1] * k->F[1][j] + m[i][2] * k->F[2][j];
  }
  for (int d = 0; d < 3; d++)
    k->stretch[d] = k->turn.R[0][d] * k->F[0][d] + k->turn.R[1][d] * k->F[1][d] + k->turn.R[2][d] * k->F[2][d];
}

/* (429), (430) by F_ij. */
static void Slopes(const Stretches *s, const double quotient[3][3], int i, int j, Kinematics *k)
{
  const int at       = VectorAt(0, i, j);
  double    db[3][3] = {{0.0}}, dW[3][3] = {{0.0}}, m[3][3];

  for (int n = 0; n < 3; n++) {
    db[i][n] += k->F[n][j];
    db[n][i] += k->F[n][j];
    dW[i][n] = k->turn.R[n][j];
  }
  ToAxes(s->Q, db, m);
  for (int a = 0; a < 3; a++) {
    for (int b = 0; b < 3; b++)
      m[a][b] *= 0.5 * quotient[a][b];
  }
  FromAxes(s->Q, m, db);
  for (int a = 0; a < 3; a++) {
    for (int b = a; b < 3; b++)
      k->de[voigt[a][b]][at] = db[a][b];
  }
  ToAxes(s->Q, dW, m);
  for (int a = 0; a < 3; a++) {
    for (int b = 0; b < 3; b++)
      dW[a][b] = (m[a][b] - m[b][a]) / (s->v[a] + s->v[b]);
  }
  FromAxes(s->Q, dW, m);
  for (int spin = 0; spin < CL_SPINS; spin++)
    k->dtheta[spin][at] = m[(spin + 1) % 3][spin];
}

/* cof F and its slopes: each a product of two numbers of F less another one. */
static void Cofactor(bool slopes, Kinematics *k)
{
  for (int i = 0; i < 3; i++) {
    const int a = (i + 1) % 3, b = (i + 2) % 3;

    for (int j = 0; j < 3; j++) {
      const int c = (j + 1) % 3, d = (j + 2) % 3;
      double   *slope = k->dcof[i][j];

      k->cof[i][j] = k->F[a][c] * k->F[b][d] - k->F[a][d] * k->F[b][c];
      if (!slopes)
        continue;
      memset(slope, 0, sizeof(k->dcof[i][j]));
      slope[VectorAt(0, a, c)] = k->F[b][d];
      slope[VectorAt(0, b, d)] = k->F[a][c];
      slope[VectorAt(0, a, d)] = -k->F[b][c];
      slope[VectorAt(0, b, c)] = -k->F[a][d];
      k->dJ[VectorAt(0, i, j)] = k->cof[i][j];
    }
  }
}

static bool MotionOf(const double motion[MOTION_COUNT], bool slopes, Kinematics *k)
{
  double    H[3][3], quotient[3][3];
  Stretches s;

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      H[i][j]    = motion[VectorAt(0, i, j)];
      k->F[i][j] = H[i][j] + (i == j);
    }
  }
  Cofactor(slopes, k);
  k->lambda = 1.0;
  k->J = k->cof_hoop = VectorDot(k->F[0], k->cof[0]);
  if (!(k->J > 0.0) || !isfinite(k->J))
    return false;
  if (!StretchesOf(H, &s))
    return false;
  Values(&s, k);
  if (!slopes)
    return true;
  for (int a = 0; a < 3; a++) {
    for (int b = 0; b < 3; b++)
      quotient[a][b] = LogQuotient(&s, a, b);
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      Slopes(&s, quotient, i, j, k);
  }
  for (int c = 0; c < CL_TENSOR; c++)
    k->de[c][MOTION_HOOP] = 0.0;
  k->dJ[MOTION_HOOP] = 0.0;
  return true;
}

bool KinematicsEvaluate(const double motion[MOTION_COUNT], Kinematics *k)
{
  return MotionOf(motion, true, k);
}

bool KinematicsValues(const double motion[MOTION_COUNT], Kinematics *k)
{
  return MotionOf(motion, false, k);
}
