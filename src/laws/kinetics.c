/* Kim-Bishnoi kinetics (1987): rate constant and formation surface, (P35), (P36). */
#include "clathra/laws_batch.h"
#include "laws_private.h"

/* (233): K_d = K_0 exp(-dE/(R T_K)), mol/(m^2 Pa s), and dK_d/dT; T in degC. */
INLINE double RateConstant(const Kinetics *law, double T, double *dKd_dT)
{
  const double TK = T + LAW_ZERO_CELSIUS, a = law->dE / LAW_GAS_CONSTANT;
  double       de;
  const double e = LawExp(-a / TK, &de);

  *dKd_dT = law->K0 * de * a / (TK * TK);
  return law->K0 * e;
}

double KineticsRateConstant(const Kinetics *law, double T, double *dKd_dT)
{
  return RateConstant(law, T, dKd_dT);
}

void KineticsRateConstantBatch(const Kinetics *law, int n, const double *restrict T, double *restrict Kd,
                               double *restrict dKd_dT)
{
  const Kinetics l = *law;

  for (int q = 0; q < n; q++) {
    Kd[q]     = l.K0;
    dKd_dT[q] = 0.0;
  }
  for (int q = 0; l.dE != 0.0 && q < n; q++)
    Kd[q] = RateConstant(&l, T[q], &dKd_dT[q]);
}

/* (234), (418): A_s = A_geo s_w (s_g + W) (1 - S_h)^3 with s_g = 1 - s_w: S_w S_g (1 - S_h) where W = 0. */
INLINE FormationArea Formation(const Kinetics *law, double sw, double wet, double Sh)
{
  const double v = 1.0 - Sh, open = law->A_geo * v * v, sg = 1.0 - sw;

  return (FormationArea){open * v * sw * (sg + wet), open * v * (sg + wet - sw), open * v * sw,
                         -3.0 * open * sw * (sg + wet)};
}

FormationArea KineticsFormationArea(const Kinetics *law, double sw, double wet, double Sh)
{
  return Formation(law, sw, wet, Sh);
}

void KineticsFormationAreaBatch(const Kinetics *law, int n, const double *restrict sw, const double *restrict wet,
                                const double *restrict Sh, double *restrict A)
{
  const Kinetics l = *law;

  for (int q = 0; q < n; q++)
    A[q] = Formation(&l, sw[q], wet[q], Sh[q]).v;
}
