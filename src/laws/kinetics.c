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

/* (234): A_s = A_geo S_w S_g (1 - S_h) = A_geo s_w s_g (1 - S_h)^3, 1/m, with s_g = 1 - s_w; and its derivatives. */
INLINE double FormationArea(const Kinetics *law, double sw, double Sh, double *dA_dsw, double *dA_dSh)
{
  const double v = 1.0 - Sh, film = law->A_geo * sw * (1.0 - sw);

  *dA_dsw = law->A_geo * (1.0 - 2.0 * sw) * v * v * v;
  *dA_dSh = -3.0 * film * v * v;
  return film * v * v * v;
}

double KineticsFormationArea(const Kinetics *law, double sw, double Sh, double *dA_dsw, double *dA_dSh)
{
  return FormationArea(law, sw, Sh, dA_dsw, dA_dSh);
}

void KineticsFormationAreaBatch(const Kinetics *law, int n, const double *restrict sw, const double *restrict Sh,
                                double *restrict A)
{
  const Kinetics l = *law;
  double         dw, dSh;

  for (int q = 0; q < n; q++)
    A[q] = FormationArea(&l, sw[q], Sh[q], &dw, &dSh);
}
