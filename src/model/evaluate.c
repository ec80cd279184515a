/* One particle, one face: gather from the nodes and evaluate. */
#include "gather.h"

ClStatus ParticleEvaluate(Model *m, PetscInt p, const double *x, bool tangent, Reach *r, double in[IN_COUNT],
                          PointState *s, PointOutput *o)
{
  PointHistory h;
  const char  *why = NULL;

  ReachExpand(m, p, r);
  GatherInputs(m, p, r, x, NULL, in);
  GatherHistory(m, p, r, &h);
  const ClStatus status = PointEvaluate(ParticleMaterial(m, p), &h, in, tangent, s, o, &why);
  if (status != CL_OK)
    NoteFailure(m, status, why, p);
  return status;
}

void FaceAt(const Model *m, const Face *face, const double *x, Reach *r, FaceOutput *o)
{
  const PetscInt p               = face->particle;
  const double   p0[PHASE_COUNT] = {m->P.f[P_PW0][p], m->P.f[P_PG0][p]};
  double         in[IN_COUNT];

  ReachExpand(m, p, r);
  GatherInputs(m, p, r, x, face->N, in);
  FaceEvaluate(m->c, face, &m->bc, ParticleMaterial(m, p), p0, in, m->coef[r->node[0] * NC_COUNT + NC_KAPPA],
               m->stage.dt, o);
}
