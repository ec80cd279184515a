/* Strength of hydrate-bearing sediment: Mohr-Coulomb's yield function, softening, the smooth flow potential of Menetrey
   and Willam (1995); (P48)-(P52), docs/equations.md, section 14. */
#include "clathra/laws_strength.h"
#include "laws_private.h"

/* (87): atan(tan(angle)/F) with what its slopes are multiplied by. */
static double ReduceAngle(double factor, double *angle)
{
  const double t = tan(*angle), r = t / factor;

  *angle = atan(r);
  return (1.0 + t * t) / (factor * (1.0 + r * r));
}

static void Reduce(double factor, Strength *s)
{
  const double phi = ReduceAngle(factor, &s->phi), psi = ReduceAngle(factor, &s->psi);

  s->c /= factor;
  s->c_e /= factor;
  s->c_S /= factor;
  s->phi_e *= phi;
  s->psi_e *= psi;
  s->psi_S *= psi;
}

/* Strength by hydrate (61) and plastic strain (62), over the strength factor (87). */
void StrengthEvaluate(const Plasticity *law, double Sh, double eps, Strength *s)
{
  double       dh, ds;
  const double eta     = SofteningRate(law);
  const double hydrate = LawExp(law->eta_h * (Sh - law->Sh_max), &dh), left = LawExp(-eta * eps, &ds);
  PeakStrength peak;

  PeakStrengthOf(law, hydrate, dh, &peak);
  SoftenedStrengthOf(law, &peak, eta, left, ds, s);
  if (law->factor > 0.0 && law->factor != 1.0)
    Reduce(law->factor, s);
}

double MohrCoulombYield(double phi, double c, const double y[3], double dy[3], double *dphi)
{
  return YieldOf(sin(phi), cos(phi), c, y, dy, dphi);
}

void MenetreyWillamGradient(double phi, double psi, double apex, const double y[3], FlowGradient *P)
{
  FlowGradientOf(sin(phi), cos(phi), tan(psi), apex, y, P);
}

double SofteningRatio(const Plasticity *law, double E, double nu, double Sh, double eps, double sm)
{
  const double G2 = E / (1.0 + nu), lame = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  double       worst = 0.0;
  Strength     k;

  StrengthEvaluate(law, Sh, eps, &k);
  if (sm * sin(k.phi) >= k.c * cos(k.phi))
    return 0.0;
  for (int i = 0; i <= 12; i++) { /* deviators of length 1 from extension to compression, scaled onto F = 0 */
    const double th   = LAW_PI / 3.0 * i / 12.0;
    const double s[3] = {cos(th), cos(th - 2.0 * LAW_PI / 3.0), cos(th + 2.0 * LAW_PI / 3.0)};
    double       y[3], dF[3], dphi, sum = 0.0, n2 = 0.0;
    FlowGradient P;

    const double at_mean = MohrCoulombYield(k.phi, k.c, (const double[3]){sm, sm, sm}, dF, &dphi);
    const double size    = -at_mean / (dF[0] * s[0] + dF[2] * s[2]);
    for (int j = 0; j < 3; j++)
      y[j] = sm + size * s[j];
    MohrCoulombYield(k.phi, k.c, y, dF, &dphi);
    MenetreyWillamGradient(k.phi, k.psi, FlowRoundness(law), y, &P);
    if (law->flow == FLOW_MOHR_COULOMB) {
      const double tp[3] = {1.0 + sin(k.psi), 0.0, sin(k.psi) - 1.0};

      for (int j = 0; j < 3; j++) {
        P.y[j]   = tp[j];
        P.dev[j] = tp[j] - 2.0 / 3.0 * sin(k.psi);
      }
    }
    const double trP = P.y[0] + P.y[1] + P.y[2];
    for (int j = 0; j < 3; j++) {
      sum += dF[j] * (G2 * P.y[j] + lame * trP);
      n2 += P.dev[j] * P.dev[j];
    }
    worst = fmax(worst, (dphi * k.phi_e - k.c_e) * sqrt(2.0 / 3.0 * n2) / sum);
  }
  return worst;
}
