/* Private to point/: the reaction of one particle with its slopes; docs/equations.md (11)-(13). */
#pragma once

#include "clathra/point_reaction.h"
#include "scalars.h"

/* Hydrate that goes, (12). */
INLINE void Dissociate(const Material *mat, double from, Jet growth, ScalarState *s)
{
  double       slope;
  const Jet    a    = JetScale(-mat->kinetics.A_geo, JetDiv(growth, s->rho_h));
  const double gain = ReactionDissociated(from, a.v, &slope);

  s->gain = JetChain(gain, slope, a);
}

/* m_h* + growth A_s - S rho_h V_p as a function of S for formation (13); decreasing in S. */
INLINE double FormationBalance(FormationArea A, double S, double m0, double growth, double pore, double *dS)
{
  *dS = growth * A.Sh - pore;
  return m0 + growth * A.v - pore * S;
}

/* W of (418) for the hydrate of the step's start, m0 of the `pore` kg that would fill the pores. */
INLINE Jet Wet(const Material *mat, double m0, Jet pore, Jet pc, Jet over, const ScalarState *s)
{
  const Jet    phi = JetDiv(s->Vp, s->V), S = JetDiv(JetConstant(m0), pore);
  const Wetted W = ReactionWet(mat, phi.v, S.v, pc.v, over.v);

  return JetAdd(JetChain3(W.v, W.v / phi.v, phi, W.Sh, S, W.pc, pc), JetChain(0.0, W.over, over));
}

/* (13) by Newton inside a bracket; the tangent follows from the implicit function theorem. */
INLINE void Form(const Material *mat, double m0, Jet per_area, Jet pc, Jet over, ScalarState *s)
{
  const Kinetics *k      = &mat->kinetics;
  const Jet       growth = JetMul(s->V, per_area);
  const Jet       pore = JetMul(s->rho_h, s->Vp), wet = Wet(mat, m0, pore, pc, over, s);
  double          lo = fmin(m0 / pore.v, 1.0), hi = 1.0, S = lo, dS = -1.0;

  for (int it = 0; it < 100; it++) {
    const double f = FormationBalance(KineticsFormationArea(k, s->sw.v, wet.v, S), S, m0, growth.v, pore.v, &dS);

    if (f > 0.0)
      lo = S;
    else
      hi = S;
    double next = S - f / dS;
    if (!(next > lo && next < hi))
      next = f == 0.0 ? S : 0.5 * (lo + hi);
    if (fabs(next - S) <= 1e-16 + 4e-16 * S) {
      S = next;
      break;
    }
    S = next;
  }
  const FormationArea A = KineticsFormationArea(k, s->sw.v, wet.v, S);
  FormationBalance(A, S, m0, growth.v, pore.v, &dS);

  /* dS = -(df/dq)/(df/dS) dq with f = m0 + growth A(sw, W, S) - pore S */
  const Jet fq = JetSub(JetMul(growth, JetChain2(A.v, A.sw, s->sw, A.wet, wet)), JetScale(S, pore));
  const Jet Sj = JetChain(S, -1.0 / dS, fq);

  /* growth A = pore S - m0 = gain; where little grows the left is exact, where much does the right */
  const double grown = pore.v * S - m0, steep = growth.v * A.Sh / pore.v;
  s->gain   = JetMul(Sj, pore);
  s->gain.v = (growth.v * A.v - steep * grown) / (1.0 - steep);
}

/* m_h and its gain, from pressures, shares and pores of s.  The reaction sees p and T of the nodal fields, not the
   particle's own: those differ by what nodes cannot see (and so never correct), which a fast reaction would turn into
   hydrate. */
INLINE void HydrateMass(const Material *mat, const PointHistory *h, ScalarState *s)
{
  const Kinetics *k    = &mat->kinetics;
  const double    m0   = fmax(h->m_star[0], 0.0);
  const Jet       T_r  = JetShift(s->T, h->shift[2]);
  const Jet       held = JetScale(h->withheld, JetShift(s->pg, -h->pg_n)); /* thin gas (416) */
  const Jet       pw_r = JetAdd(JetShift(s->pw, h->shift[0]), held), pg_r = JetAdd(JetShift(s->pg, h->shift[1]), held);
  double          dK, dpe;

  s->limited = mat->reacts && h->m_star[0] < 0.0;
  if (!mat->reacts) {
    s->gain = JetConstant(0.0);
    s->m_h  = JetConstant(h->m_star[0]);
    return;
  }
  const double Kd      = KineticsRateConstant(k, T_r.v, &dK),
               pe      = EquilibriumPressure(&k->equilibrium, T_r.v, &dpe) + h->chord; /* chord (424) */
  const Driving d      = ReactionDriving(mat->gas.trace, s->sg.v, pw_r.v, pg_r.v, pe);
  const Growth  g      = ReactionGrowth(k, h->dt, h->held, &d, (OfTemperature){Kd, dK}, (OfTemperature){pe, dpe});
  const Jet     p_r    = JetChain3(d.p.v, d.p.sg, s->sg, d.p.pw, pw_r, d.p.pg, pg_r);
  const Jet     growth = JetChain2(g.v, g.p, p_r, g.T, T_r);

  if (d.forms)
    Form(mat, m0, growth, JetSub(pg_r, pw_r), JetChain2(p_r.v - pe, 1.0, p_r, -dpe, T_r), s);
  else
    Dissociate(mat, m0, growth, s);
  s->gain = JetShift(s->gain, m0 - h->m_star[0]);
  s->m_h  = JetShift(s->gain, h->m_star[0]);
}
