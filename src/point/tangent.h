/* Private to point/: rows of a particle's tangent: of scalars by their jets, of vectors through the cofactor and the
   metric of the motion. */
#pragma once

#include "state.h"

/* Row of the tangent for a scalar output c * jet: J spreads over grad u. */
INLINE void AddJet(double D[IN_COUNT], double c, const Jet *a, const Kinematics *k)
{
  for (int i = 0; i < MOTION_COUNT; i++)
    D[IN_GRADU + i] += c * a->d[JET_J] * k->dJ[i];
  D[IN_P] += c * a->d[JET_PW];
  D[IN_P + 1] += c * a->d[JET_PG];
  D[IN_T] += c * a->d[JET_T];
}

INLINE void PutScalar(int r, Jet value, const Kinematics *k, bool tangent, PointOutput *o)
{
  o->out[r] = value.v;
  if (tangent)
    AddJet(o->D[r], 1.0, &value, k);
}

/* d(cof v)_i, row i of the cofactor against v, by number q of the motion. */
INLINE double CofactorSlope(const Kinematics *k, int i, int q, const double v[CL_DIM])
{
  double sum = k->dcof[i][0][q] * v[0];

  for (int j = 1; j < CL_DIM; j++)
    sum += k->dcof[i][j][q] * v[j];
  return sum;
}

/* (cof^T v)_i, and its slope likewise. */
INLINE double AlongCofactor(const Kinematics *k, int i, const double v[CL_DIM])
{
  double sum = k->cof[0][i] * v[0];

  for (int j = 1; j < CL_DIM; j++)
    sum += k->cof[j][i] * v[j];
  return sum;
}

INLINE double AlongCofactorSlope(const Kinematics *k, int i, int q, const double v[CL_DIM])
{
  double sum = k->dcof[0][i][q] * v[0];

  for (int j = 1; j < CL_DIM; j++)
    sum += k->dcof[j][i][q] * v[j];
  return sum;
}

/* K = cof^T cof / J (symmetric, from V F^-1 F^-T) and its derivatives. */
typedef struct {
  double K[CL_DIM][CL_DIM], d[CL_DIM][CL_DIM][MOTION_COUNT];
} Metric;

INLINE void MetricEvaluate(const Kinematics *k, bool tangent, Metric *g)
{
  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++) {
      double c = k->cof[0][i] * k->cof[0][j];

      for (int m = 1; m < CL_DIM; m++)
        c += k->cof[m][i] * k->cof[m][j];
      g->K[i][j] = c / k->J;
      for (int q = 0; tangent && q < MOTION_COUNT; q++) {
        double dc = k->dcof[0][i][q] * k->cof[0][j] + k->cof[0][i] * k->dcof[0][j][q];

        for (int m = 1; m < CL_DIM; m++)
          dc += k->dcof[m][i][q] * k->cof[m][j] + k->cof[m][i] * k->dcof[m][j][q];
        g->d[i][j][q] = (dc - g->K[i][j] * k->dJ[q]) / k->J;
      }
    }
  }
}

/* d(K v)_i by number q of the motion. */
INLINE double MetricSlope(const Metric *g, int i, int q, const double v[CL_DIM])
{
  double sum = g->d[i][0][q] * v[0];

  for (int j = 1; j < CL_DIM; j++)
    sum += g->d[i][j][q] * v[j];
  return sum;
}

/* v := A v, with beds (306). */
INLINE void Drive(const PointHistory *h, double v[CL_DIM])
{
  if (h->beds)
    BedsDrive(h->beds, v);
}
