/* Young's modulus of hydrate-bearing sediment, (P46). */
#include "clathra/laws.h"
#include "laws_private.h"

/* S^b for S >= 0.  For b < 1 the slope at 0 is infinite: below S_0 = 1e-3, with t = S/S_0, the parabola
   S_0^b t [(2 - b) + (b - 1) t] meets S^b in value and slope.  S < 0 (round-off) continues that, or 0. */
static double Stiffening(double S, double b, double *dS)
{
  if (b < 1.0 && S < LAW_TOE) {
    const double t = S / LAW_TOE, v = pow(LAW_TOE, b);

    *dS = v / LAW_TOE * ((2.0 - b) + 2.0 * (b - 1.0) * t);
    return v * t * ((2.0 - b) + (b - 1.0) * t);
  }
  *dS = 0.0;
  if (S <= 0.0)
    return 0.0;
  const double v = pow(S, b);

  *dS = b * v / S;
  return v;
}

/* (237): E = E_0 + a_h E_h S_h^b_h, Pa, and dE/dS_h. */
double ElasticityYoung(const Elasticity *law, double Sh, double *dE_dSh)
{
  const double a = law->ah * law->Eh;
  double       d = 1.0;
  const double f = law->bh == 1.0 ? Sh : Stiffening(Sh, law->bh, &d);

  *dE_dSh = a * d;
  return law->E0 + a * f;
}
