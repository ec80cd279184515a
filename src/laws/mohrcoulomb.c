/* Strength of hydrate-bearing sediment: Mohr-Coulomb's yield function, softening, the smooth flow potential of Menetrey
   and Willam (1995); (P48)-(P52), docs/equations.md, section 14. */
#include "clathra/laws.h"
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

/* (61), (62), (87) */
void StrengthEvaluate(const Plasticity *law, double Sh, double eps, Strength *s)
{
  double       dh, ds;
  const double eta     = SofteningRate(law);
  const double hydrate = LawExp(law->eta_h * (Sh - law->Sh_max), &dh), left = LawExp(-eta * eps, &ds);
  const double c_peak   = law->c_min + (law->c_max - law->c_min) * hydrate,
               psi_peak = law->psi_min + (law->psi_max - law->psi_min) * hydrate;

  s->c     = law->c_res + (c_peak - law->c_res) * left;
  s->phi   = LAW_DEG * (law->phi_res + (law->phi_peak - law->phi_res) * left);
  s->psi   = LAW_DEG * psi_peak * left;
  s->c_e   = -eta * ds * (c_peak - law->c_res);
  s->phi_e = -LAW_DEG * eta * ds * (law->phi_peak - law->phi_res);
  s->psi_e = -LAW_DEG * eta * ds * psi_peak;
  s->c_S   = law->eta_h * dh * (law->c_max - law->c_min) * left;
  s->psi_S = LAW_DEG * law->eta_h * dh * (law->psi_max - law->psi_min) * left;
  if (law->factor > 0.0 && law->factor != 1.0)
    Reduce(law->factor, s);
}

/* (63) */
double MohrCoulombYield(double phi, double c, const double y[3], double dy[3], double *dphi)
{
  const double si = sin(phi), co = cos(phi), half = 0.5 * (y[0] - y[2]), mean = 0.5 * (y[0] + y[2]);

  dy[0] = 0.5 * (1.0 + si) / co;
  dy[1] = 0.0;
  dy[2] = -0.5 * (1.0 - si) / co;
  *dphi = (half * si + mean) / (co * co);
  return (half + mean * si) / co - c;
}

/* Elliptic section R_mw (64) without its factor R_mc(pi/3, phi): f(t, e), t = cos(theta), and slopes. */
typedef struct {
  double f, t, tt, e, te;
} Section;

static Section SectionOf(double t, double e)
{
  const double a = 1.0 - e * e, b = 2.0 * e - 1.0, w = sqrt(fmax(4.0 * a * t * t + 5.0 * e * e - 4.0 * e, 1e-16));
  const double N = 4.0 * a * t * t + b * b, N_t = 8.0 * a * t, N_tt = 8.0 * a, N_e = -8.0 * e * t * t + 4.0 * b,
               N_te = -16.0 * e * t;
  const double w_t = 4.0 * a * t / w, w_tt = (4.0 * a - w_t * w_t) / w,
               w_e = (-8.0 * e * t * t + 10.0 * e - 4.0) / (2.0 * w), w_te = (-8.0 * e * t - w_e * w_t) / w;
  const double D = 2.0 * a * t + b * w, D_t = 2.0 * a + b * w_t, D_tt = b * w_tt,
               D_e = -4.0 * e * t + 2.0 * w + b * w_e, D_te = -4.0 * e + 2.0 * w_t + b * w_te;
  Section s;

  s.f  = N / D;
  s.t  = (N_t - s.f * D_t) / D;
  s.e  = (N_e - s.f * D_e) / D;
  s.tt = (N_tt - 2.0 * s.t * D_t - s.f * D_tt) / D;
  s.te = (N_te - s.t * D_e - s.e * D_t - s.f * D_te) / D;
  return s;
}

/* P (64) with m = apex tan(psi).  Stresses in any order: the potential
   is isotropic.  Where q = 0 the deviatoric slope is that of a triaxial state, and its product with rho zero. */
void MenetreyWillamGradient(double phi, double psi, double apex, const double y[3], FlowGradient *P)
{
  const int    top = y[0] >= y[1] ? (y[0] >= y[2] ? 0 : 2) : (y[1] >= y[2] ? 1 : 2);
  const double sm = (y[0] + y[1] + y[2]) / 3.0, s[3] = {y[0] - sm, y[1] - sm, y[2] - sm};
  const double q = sqrt(1.5 * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2])), t = q > 0.0 ? 1.5 * s[top] / q : 1.0;
  const double si = sin(phi), co = cos(phi), e = (3.0 - si) / (3.0 + si), e_phi = -6.0 * co / ((3.0 + si) * (3.0 + si));
  const double R = (3.0 - si) / (6.0 * co), R_phi = (3.0 * si - 1.0) / (6.0 * co * co);
  const Section k  = SectionOf(t, e);
  const double  tp = tan(psi), sec2 = 1.0 + tp * tp, m = apex * tp;
  const double  rho = R * k.f * q, S = sqrt(m * m + rho * rho), rho_phi = q * (R_phi * k.f + R * k.e * e_phi);
  double        u[3], r[3], r_phi[3], qy[3];

  const double share = S > 0.0 ? rho / S : 0.0, bend = S > 0.0 ? m * m / (S * S * S) : 0.0;
  for (int i = 0; i < 3; i++) {
    const double e1 = (i == top ? 1.0 : 0.0) - 1.0 / 3.0;

    qy[i]    = q > 0.0 ? 1.5 * s[i] / q : 0.0;
    u[i]     = 1.5 * e1 - t * qy[i]; /* q dt/dy */
    r[i]     = R * ((k.f - t * k.t) * qy[i] + 1.5 * k.t * e1);
    r_phi[i] = R_phi / R * r[i] + R * e_phi * ((k.e - t * k.te) * qy[i] + 1.5 * k.te * e1);
  }
  for (int i = 0; i < 3; i++) {
    P->dev[i] = share * r[i];
    P->y[i]   = P->dev[i] + tp / 3.0;
    P->phi[i] = bend * rho_phi * r[i] + share * r_phi[i];
    P->psi[i] = (S > 0.0 ? -rho * m * apex * sec2 / (S * S * S) * r[i] : 0.0) + sec2 / 3.0;
    for (int j = 0; j < 3; j++) {
      const double unit = (i == j ? 1.0 : 0.0) - 1.0 / 3.0;
      const double rr   = R * R * k.f * ((k.f - t * k.t) * (1.5 * unit - qy[i] * qy[j]) + k.tt * u[i] * u[j]);

      P->yy[i][j] = S > 0.0 ? bend * r[i] * r[j] + rr / S : 0.0;
    }
  }
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
