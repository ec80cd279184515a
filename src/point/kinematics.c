/* Exact plane kinematics of one increment and its derivatives. */
#include "clathra/kinematics.h"
#include <math.h>
#include <string.h>

/* g(y) = atanh(sqrt y)/sqrt y and g'(y), by series where the closed form cancels. */
static double AtanhRatio(double y, double *dg)
{
  if (y < 1e-2) {
    double g = 0.0, d = 0.0;

    for (int n = 8; n >= 0; n--) {
      g = g * y + 1.0 / (2.0 * n + 1.0);
      if (n > 0)
        d = d * y + n / (2.0 * n + 1.0);
    }
    *dg = d;
    return g;
  }
  const double x = sqrt(y), g = atanh(x) / x;

  *dg = 0.5 * (1.0 / (1.0 - y) - g) / y;
  return g;
}

/* ln V_L = 1/2 ln J 1 + 1/2 f (b - m 1), f = atanh(r/m)/r, with m, r the mean and radius of b = F F^T (7). */
static void LogStrain(Kinematics *k)
{
  const double(*F)[2] = k->F;
  const double bxx = F[0][0] * F[0][0] + F[0][1] * F[0][1], byy = F[1][0] * F[1][0] + F[1][1] * F[1][1];
  const double o = F[0][0] * F[1][0] + F[0][1] * F[1][1], m = 0.5 * (bxx + byy), d = 0.5 * (bxx - byy);
  const double y = (d * d + o * o) / (m * m);
  double       dg, g = AtanhRatio(y, &dg);
  const double f = g / m, lnJ = 0.5 * log(k->J);

  k->e[0] = lnJ + 0.5 * f * d;
  k->e[1] = lnJ - 0.5 * f * d;
  k->e[2] = 0.5 * f * o;
  for (int c = 0; c < 4; c++) {
    const int    i = c / 2, j = c % 2;
    const double dbxx = i == 0 ? 2.0 * F[0][j] : 0.0, dbyy = i == 1 ? 2.0 * F[1][j] : 0.0;
    const double dm = 0.5 * (dbxx + dbyy), dd = 0.5 * (dbxx - dbyy), dO = F[1 - i][j];
    const double dy = 2.0 * (d * dd + o * dO) / (m * m) - 2.0 * y * dm / m;
    const double df = dg * dy / m - f * dm / m, dlnJ = 0.5 * k->dJ[c] / k->J;

    k->de[0][c] = dlnJ + 0.5 * (df * d + f * dd);
    k->de[1][c] = dlnJ - 0.5 * (df * d + f * dd);
    k->de[2][c] = 0.5 * (df * o + f * dO);
  }
}

bool KinematicsEvaluate(const double gradu[2][2], Kinematics *k)
{
  static const double dcof[2][2][4] = {{{0, 0, 0, 1}, {0, 0, -1, 0}}, {{0, -1, 0, 0}, {1, 0, 0, 0}}};
  // cppcheck-suppress ctuuninitvar ; the address only: k is filled here
  double(*F)[2] = k->F;

  for (int i = 0; i < 2; i++) {
    for (int j = 0; j < 2; j++)
      F[i][j] = gradu[i][j] + (i == j);
  }
  k->cof[0][0] = F[1][1];
  k->cof[0][1] = -F[1][0];
  k->cof[1][0] = -F[0][1];
  k->cof[1][1] = F[0][0];
  memcpy(k->dcof, dcof, sizeof(dcof));
  k->J = F[0][0] * F[1][1] - F[0][1] * F[1][0];
  if (!(k->J > 0.0) || !isfinite(k->J))
    return false;
  for (int c = 0; c < 4; c++)
    k->dJ[c] = k->cof[c / 2][c % 2];

  const double a = F[0][0] + F[1][1], b = F[1][0] - F[0][1], n = a * a + b * b;
  const double co = a / sqrt(n), si = b / sqrt(n);

  k->theta     = atan2(b, a);
  k->dtheta[0] = k->dtheta[3] = -b / n;
  k->dtheta[1]                = -a / n;
  k->dtheta[2]                = a / n;
  k->stretch[0]               = co * F[0][0] + si * F[1][0]; /* U = R^T F */
  k->stretch[1]               = -si * F[0][1] + co * F[1][1];
  LogStrain(k);
  return true;
}
