/* Equilibrium between nodes (424): T and p are linear there, p_e(T) is not. */
#include "clathra/point_reaction.h"
#include "gather.h"

/* Nodal values of p_w, p_g, T, in the order of F_PW, ..., at t_n. */
#define SEEN 3

static double ChordOf(const Model *m, PetscInt p)
{
  const FieldSet    *fs         = &m->c->fields;
  const Material    *mat        = ParticleMaterial(m, p);
  const int          at[SEEN]   = {PlaceP(fs, PHASE_W), PlaceP(fs, PHASE_G), PlaceT(fs)};
  const Equilibrium *law        = &mat->kinetics.equilibrium;
  double             mean[SEEN] = {0.0};
  NodesSeen          seen       = {.variance = 0.0};
  Reach              r;

  ReachExpand(m, p, &r);
  for (int a = 0; a < r.n; a++) {
    for (int k = 0; k < SEEN; k++)
      mean[k] += r.S[a] * m->x_n[r.node[a] * fs->n + at[k]];
  }
  for (int a = 0; a < r.n; a++) {
    const double *x = &m->x_n[r.node[a] * fs->n], warmer = x[at[2]] - mean[2];

    for (int f = 0; f < PHASE_COUNT; f++)
      seen.covariance[f] += r.S[a] * warmer * (x[at[f]] - mean[f]);
    seen.variance += r.S[a] * warmer * warmer;
  }
  seen.p         = ReactionPressure(mat->gas.trace, 1.0 - ParticleSw(m, p), mean[0], mean[1]);
  seen.pe        = EquilibriumPressure(law, mean[2], &seen.dpe_dT);
  seen.curvature = EquilibriumCurvature(law, mean[2]);
  return ReactionChord(&seen);
}

void ChordsBuild(Model *m)
{
  for (PetscInt p = 0; m->added->chord && p < m->P.n; p++)
    m->added->chord[p] = ParticleMaterial(m, p)->reacts ? ChordOf(m, p) : 0.0;
}
