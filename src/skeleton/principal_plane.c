/* Principal stresses where one is known to stand across the plane, and back with the tangent. */
#include "plastic.h"

void PrincipalOf(const double sig[6], Principal *p)
{
  const double d = 0.5 * (sig[XX] - sig[YY]), o = sig[XY], r = sqrt(d * d + o * o), m = 0.5 * (sig[XX] + sig[YY]);
  const double z = sig[ZZ], v[3] = {m + r, m - r, z};

  p->mean     = m;
  p->radius   = r;
  p->c2       = r > 0.0 ? d / r : 1.0;
  p->s2       = r > 0.0 ? o / r : 0.0;
  p->order[0] = z > v[0] ? 2 : 0;
  p->order[1] = z > v[0] ? 0 : z >= v[1] ? 2 : 1;
  p->order[2] = z >= v[1] ? 1 : 2;
  for (int i = 0; i < 3; i++)
    p->y[i] = v[p->order[i]];
}

/* In-plane upper, lower, out of plane. */
static void Unsort(const Principal *p, const double y[3], double v[3])
{
  for (int i = 0; i < 3; i++)
    v[p->order[i]] = y[i];
}

void FromPrincipal(const Principal *p, const double y[3], double sig[6])
{
  double v[3];

  Unsort(p, y, v);
  const double m = 0.5 * (v[0] + v[1]), r = 0.5 * (v[0] - v[1]);

  sig[XX] = m + r * p->c2;
  sig[YY] = m - r * p->c2;
  sig[ZZ] = v[2];
  sig[XY] = r * p->s2;
}

void StressSlopes(const Principal *p, const Returned *r, double C[CL_TENSOR][CL_TENSOR], double by_E[CL_TENSOR],
                  double by_S[CL_TENSOR])
{
  double v[3], D[3][3], e[3], h[3];

  Unsort(p, r->y, v);
  for (int i = 0; i < 3; i++) {
    e[p->order[i]] = r->dy[i][BY_E];
    h[p->order[i]] = r->dy[i][BY_SH];
    for (int j = 0; j < 3; j++)
      D[p->order[i]][p->order[j]] = r->dy[i][j];
  }
  const double size = fabs(p->mean) + p->radius;
  const double spin =
      p->radius > NEAR_EQUAL * size ? 0.5 * (v[0] - v[1]) / p->radius : 0.5 * (D[0][0] - D[0][1] - D[1][0] + D[1][1]);
  const double dir[3][4] = {{0.5 * (1.0 + p->c2), 0.5 * (1.0 - p->c2), 0.0, p->s2},
                            {0.5 * (1.0 - p->c2), 0.5 * (1.0 + p->c2), 0.0, -p->s2},
                            {0.0, 0.0, 1.0, 0.0}}; /* dv/d(xx yy zz xy) */
  const double out[3][4] = {{dir[0][0], dir[0][1], 0.0, 0.5 * p->s2},
                            {dir[1][0], dir[1][1], 0.0, -0.5 * p->s2},
                            {0.0, 0.0, 1.0, 0.0}};      /* d(xx yy zz xy)/dv */
  const double turn[4]   = {-p->s2, p->s2, 0.0, p->c2}; /* d(c2, s2) as the circle turns: (xx - yy)/2 and xy */

  for (int a = 0; a < 4; a++) {
    by_E[a] = by_S[a] = 0.0;
    for (int i = 0; i < 3; i++) {
      by_E[a] += out[i][a] * e[i];
      by_S[a] += out[i][a] * h[i];
    }
    for (int b = 0; b < 4; b++) {
      C[a][b] = spin * turn[a] * (b == 3 ? turn[b] : 0.5 * turn[b]);
      for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
          C[a][b] += out[i][a] * D[i][j] * dir[j][b];
      }
    }
  }
}
