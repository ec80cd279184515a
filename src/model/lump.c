/* The reaction by nodes (265), (266): each node pays for the share of a particle's reaction that it drives itself. */
#include "clathra/point_reaction.h"
#include "clathra/point_state.h"
#include "gather.h"

/* Unknowns that drive the reaction, and rows that pay for it. */
static const int driven[] = {F_PW, F_PG, F_T};
#define DRIVEN 3

static void Coefficients(const Model *m, PetscInt p, const PointProperties *q, Lump *l)
{
  const Material *mat = ParticleMaterial(m, p);
  const Kinetics *k   = &mat->kinetics;
  double          own[F_COUNT], slope, dK, dw;
  Reach           r;

  ReachExpand(m, p, &r);
  own[F_T] = ParticleT(m->c, &m->P, p) + Shift(m, p, &r, F_T);
  for (int f = 0; f < PHASE_COUNT; f++)
    own[F_PW + f] = m->P.f[P_PW + f][p] + Shift(m, p, &r, F_PW + f);

  const double pe = EquilibriumPressure(&k->equilibrium, own[F_T], &slope) + ParticleChord(m, p),
               Kd = KineticsRateConstant(k, own[F_T], &dK);
  const Driving d = ReactionDriving(mat->gas.trace, q->s[PHASE_G], own[F_PW], own[F_PG], pe);
  const Growth  growth =
      ReactionGrowth(k, 1.0, m->added->held ? m->added->held[p] : 0.0, &d, Kd, dK, pe, slope); /* kg/(m^2 s) */
  const double wet  = ReactionWet(mat, q->phi, q->Sh, own[F_PG] - own[F_PW], fmax(d.p.v - pe, 0.0)).v,
               area = d.forms ? KineticsFormationArea(k, q->s[PHASE_W], wet, q->Sh).v
                              : KineticsMeltingArea(k, q->phi, q->Sh);

  l->rate        = d.wet ? 0.0 : m->P.f[P_V][p] * growth.p * area;
  l->decay       = !d.forms && q->Sh > 0.0 ? -growth.v * k->A_geo / mat->hydrate.rho0 : 0.0;
  l->drive[F_PW] = -d.p.pw;
  l->drive[F_PG] = -d.p.pg;
  l->drive[F_T]  = slope;
  l->gain[F_PW]  = KineticsWater(k);
  l->gain[F_PG]  = KineticsMethane(k);
  l->gain[F_T]   = -LatentHeatEvaluate(&mat->latent, own[F_T], &dw);
}

void LumpBuild(Model *m)
{
  for (PetscInt p = 0; m->added->lump && p < m->P.n; p++) {
    PointProperties q;
    const char     *why;

    m->added->lump[p] = (Lump){0};
    if (ParticleMaterial(m, p)->reacts && ModelParticleProperties(m, p, &q, &why) == CL_OK)
      Coefficients(m, p, &q, &m->added->lump[p]);
  }
}

/* - dt' k_p, kg/Pa (266). */
static double Share(const Model *m, const Lump *l)
{
  const double gone = 1.0 + m->stage.dt * l->decay;

  return -m->stage.dt * l->rate / (gone * gone);
}

/* Of a kg of hydrate, what row q of a node gains. */
static double Gain(const Model *m, const Lump *l, int q)
{
  return q == F_T ? l->gain[q] / m->stage.dt : l->gain[q];
}

void LumpResidual(const Model *m, PetscInt p, const Reach *r, const double *x, double *f)
{
  const FieldSet *fs   = &m->c->fields;
  const Lump     *l    = m->added->lump ? &m->added->lump[p] : NULL;
  double          mean = 0.0, drive[CL_NODES];

  if (!l || l->rate == 0.0)
    return;
  for (int a = 0; a < r->n; a++) {
    drive[a] = 0.0;
    for (int k = 0; k < DRIVEN; k++)
      drive[a] += fs->at[driven[k]] >= 0 ? l->drive[driven[k]] * x[r->node[a] * fs->n + fs->at[driven[k]]] : 0.0;
    mean += r->S[a] * drive[a];
  }
  for (int a = 0; a < r->n; a++) {
    const double hydrate = Share(m, l) * r->S[a] * (drive[a] - mean);

    for (int k = 0; k < DRIVEN; k++) {
      if (fs->at[driven[k]] >= 0)
        *RowOf(m, f, r->node[a], driven[k]) += hydrate * Gain(m, l, driven[k]);
    }
  }
}

void LumpBlock(const Model *m, const Assembly *to, PetscInt p, const Reach *r)
{
  const FieldSet *fs = &to->fs;
  const Lump     *l  = m->added->lump ? &m->added->lump[p] : NULL;

  if (!l || l->rate == 0.0)
    return;
  for (int a = 0; a < r->n; a++) {
    for (int k = 0; k < DRIVEN; k++) {
      const int    row = driven[k];
      const double w   = fs->at[row] < 0 ? 0.0 : Share(m, l) * r->S[a] * Gain(m, l, row);

      for (int b = 0; w != 0.0 && b < r->n; b++) {
        double *out = AssemblyBlock(m, to, r->node[a], r->node[b]) + fs->at[row] * fs->n;

        for (int q = 0; q < DRIVEN; q++) {
          if (fs->at[driven[q]] >= 0)
            out[fs->at[driven[q]]] += w * l->drive[driven[q]] * ((a == b) - r->S[b]);
        }
      }
    }
  }
}
