/* Young's modulus of hydrate-bearing sediment, (P46). */
#include "clathra/laws_batch.h"
#include "laws_private.h"

/* S^b for S >= 0.  For b < 1 the slope at 0 is infinite: below S_0 = 1e-3, with t = S/S_0, the parabola
   S_0^b t [(2 - b) + (b - 1) t] meets S^b in value and slope.  S < 0 (round-off) continues that, or 0. */
INLINE double Stiffening(double S, double b, double *dS)
{
  const double x = LawWhereAbove0(S, 1.0);
  double       v = pow(x, b), d = b * v / x;

  if (b < 1.0) {
    const double t = S / LAW_TOE, w = pow(LAW_TOE, b);

    d   = S < LAW_TOE ? w / LAW_TOE * ((2.0 - b) + 2.0 * (b - 1.0) * t) : d;
    *dS = d;
    return S < LAW_TOE ? w * t * ((2.0 - b) + (b - 1.0) * t) : v;
  }
  *dS = S <= 0.0 ? 0.0 : d;
  return S <= 0.0 ? 0.0 : v;
}

/* (237): E = E_0 + a_h E_h S_h^b_h, Pa, and dE/dS_h. */
INLINE double Young(const Elasticity *law, double Sh, double *dE_dSh)
{
  const double a = law->ah * law->Eh;
  double       d = 1.0;
  const double f = law->bh == 1.0 || a == 0.0 ? Sh : Stiffening(Sh, law->bh, &d);

  *dE_dSh = a * d;
  return law->E0 + a * f;
}

LAW_OF_ONE(ElasticityYoung, ElasticityYoungBatch, Elasticity, Young)
