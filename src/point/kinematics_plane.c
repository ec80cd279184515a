/* Exact kinematics of one increment, in plane strain or about an axis, and its derivatives. */
#include "atanh_ratio.h"
#include "clathra/kinematics.h"
#include "clathra/point_strain.h"

/* ln V_L = 1/2 ln J_2 1 + 1/2 f (b - m 1), f = atanh(r/m)/r, with m, r the mean and radius of b = F F^T (7). */
INLINE void LogStrain(const Stretch *b, bool slopes, Kinematics *k)
{
  const double(*F)[2] = k->F;
  const double o = b->off, m = b->m, d = b->d, y = b->y, J2 = k->cof_hoop;
  double       dg, g = AtanhRatio(y, &dg);
  const double f = g / m, lnJ = 0.5 * log(J2);

  LogStrainOf(lnJ, 0.5 * f * d, 0.5 * f * o, k->e);
  k->e[ZZ] = log(k->lambda);
  if (!slopes)
    return;
  for (int c = 0; c < 4; c++) {
    const int    i = c / 2, j = c % 2;
    const double dJ2  = k->dJ[c] / k->lambda;
    const double dbxx = i == 0 ? 2.0 * F[0][j] : 0.0, dbyy = i == 1 ? 2.0 * F[1][j] : 0.0;
    const double dm = 0.5 * (dbxx + dbyy), dd = 0.5 * (dbxx - dbyy), dO = F[1 - i][j];
    const double dy = 2.0 * (d * dd + o * dO) / (m * m) - 2.0 * y * dm / m;
    const double df = dg * dy / m - f * dm / m, dlnJ = 0.5 * dJ2 / J2;

    k->de[XX][c] = dlnJ + 0.5 * (df * d + f * dd);
    k->de[YY][c] = dlnJ - 0.5 * (df * d + f * dd);
    k->de[XY][c] = 0.5 * (df * o + f * dO);
    k->de[ZZ][c] = 0.0;
  }
  for (int s = 0; s < CL_TENSOR; s++)
    k->de[s][MOTION_HOOP] = s == ZZ ? 1.0 / k->lambda : 0.0;
}

/* cof = lambda cof F_2 of (6), linear in F_2 and in lambda. */
INLINE void Cofactor(bool slopes, Kinematics *k)
{
  static const double sign[2][2] = {{1.0, -1.0}, {-1.0, 1.0}};

  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++) {
      const double plane = sign[i][j] * k->F[1 - i][1 - j];

      k->cof[i][j] = k->lambda * plane;
      for (int c = 0; slopes && c < 4; c++)
        k->dcof[i][j][c] = c == VectorAt(0, 1 - i, 1 - j) ? k->lambda * sign[i][j] : 0.0;
      if (slopes) {
        k->dcof[i][j][MOTION_HOOP] = plane;
        k->dJ[VectorAt(0, i, j)]   = k->cof[i][j];
      }
    }
  }
  if (slopes)
    k->dJ[MOTION_HOOP] = k->cof_hoop;
}

INLINE bool MotionOf(const double motion[MOTION_COUNT], bool slopes, Kinematics *k)
{
  // cppcheck-suppress ctuuninitvar ; the address only: k is filled here
  double(*F)[2] = k->F;

  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++)
      F[i][j] = motion[VectorAt(0, i, j)] + (i == j);
  }
  k->lambda   = 1.0 + motion[MOTION_HOOP];
  k->cof_hoop = F[0][0] * F[1][1] - F[0][1] * F[1][0];
  k->J        = k->cof_hoop * k->lambda;
  if (!(k->J > 0.0) || !(k->lambda > 0.0) || !isfinite(k->J))
    return false;
  Cofactor(slopes, k);

  const Stretch of = StretchOf(F[0][0], F[0][1], F[1][0], F[1][1]);
  const double  a = of.along, b = of.turn, n = a * a + b * b, root = sqrt(n);

  k->turn = (Rotation){a / root, b / root};
  if (slopes) {
    k->dtheta[0][0] = k->dtheta[0][3] = -b / n;
    k->dtheta[0][1]                   = -a / n;
    k->dtheta[0][2]                   = a / n;
  }
  StretchDiagonal(k->turn.c, k->turn.s, F[0][0], F[0][1], F[1][0], F[1][1], k->stretch);
  LogStrain(&of, slopes, k);
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
