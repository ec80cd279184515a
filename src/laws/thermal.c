/* Heat: latent heat of dissociation and properties of the mixture. */
#include "clathra/laws_batch.h"
#include "laws_private.h"

/* (235), (P30): L = C0 - C1 T_K, J per kg of hydrate, and dL/dT; T in degC.  Or (130), Kirchhoff's law from T_ref on.
 */
INLINE double Latent(const LatentHeat *law, double T, double *dL_dT)
{
  const double at = law->kirchhoff ? law->T_ref : T;

  *dL_dT = law->kirchhoff ? law->dc : -law->C1;
  return law->C0 - law->C1 * (at + LAW_ZERO_CELSIUS) + (law->kirchhoff ? law->dc * (T - at) : 0.0);
}

LAW_OF_ONE(LatentHeatEvaluate, LatentHeatBatch, LatentHeat, Latent)

/* (236): X = (1 - phi) X_s + phi [S_h X_h + (1 - S_h)(s_w X_w + s_g X_g)], s_g = 1 - s_w; X in the order solid,
   hydrate, water, gas.  (P29). */
INLINE double Average(double phi, double Sh, double sw, const double X[4], double *d_dphi, double *d_dSh, double *d_dsw)
{
  const double fluid = sw * X[2] + (1.0 - sw) * X[3], pore = Sh * X[1] + (1.0 - Sh) * fluid;

  *d_dphi = pore - X[0];
  *d_dSh  = phi * (X[1] - fluid);
  *d_dsw  = phi * (1.0 - Sh) * (X[2] - X[3]);
  return (1.0 - phi) * X[0] + phi * pore;
}

double MixtureAverage(double phi, double Sh, double sw, const double X[4], double *d_dphi, double *d_dSh, double *d_dsw)
{
  return Average(phi, Sh, sw, X, d_dphi, d_dSh, d_dsw);
}

void MixtureAverageBatch(int n, const double *restrict phi, const double *restrict Sh, const double *restrict sw,
                         const double X[4], double *restrict mean)
{
  const double x[4] = {X[0], X[1], X[2], X[3]};
  double       d[3];

  for (int q = 0; q < n; q++)
    mean[q] = Average(phi[q], Sh[q], sw[q], x, &d[0], &d[1], &d[2]);
}

/* Conductivity that carries heat with the flow (293). */
bool HeatUpwind(double kappa, const double a[CL_DIM], const double h[CL_DIM], double K[CL_SYMMETRIC])
{
  double half = 0.5 * h[0] * fabs(a[0]);

  for (int d = 1; d < CL_DIM; d++)
    half += 0.5 * h[d] * fabs(a[d]);
  const double c = half > kappa ? (half - kappa) / VectorDot(a, a) : 0.0;

  for (int i = 0; i < CL_DIM; i++) {
    for (int j = i; j < CL_DIM; j++)
      K[cl_symmetric[i][j]] = c * a[i] * a[j];
  }
  return c > 0.0;
}
