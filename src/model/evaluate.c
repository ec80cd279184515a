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
  const ClStatus status = PointEvaluate(&m->c->fields, ParticleMaterial(m, p), &h, in, tangent, s, o, &why);
  if (status != CL_OK)
    ModelNoteFailure(m, status, why, p);
  else if (m->P.f[P_HEAT] && m->c->fields.heat)
    o->out[OUT_Q] -= m->stage.drain * m->P.f[P_HEAT][p]; /* (69) */
  return status;
}

ClStatus ModelParticleProperties(const Model *m, PetscInt p, PointProperties *q, const char **why)
{
  const FieldSet *fs = &m->c->fields;
  const double    pw = fs->phase[PHASE_W] ? m->P.f[P_PW][p] : 0.0;
  const double    pg = fs->phase[PHASE_G] ? m->P.f[HeldPressure(fs, P_PW, PHASE_G)][p] : 0.0;

  return PointPropertiesEvaluate(fs, ParticleMaterial(m, p), m->P.f[P_V][p], m->P.f[P_MS][p], m->P.f[P_MH][p], pw, pg,
                                 ParticleT(m->c, &m->P, p), ParticleSw(m, p), q, why);
}

/* (276) */
void ModelInitialAtFace(const Model *m, const Face *face, double p0[PHASE_COUNT])
{
  const PetscInt p      = face->particle;
  const Region  *r      = &m->c->region[m->P.i[PI_REGION][p]];
  double         weight = 0.0, rho = 0.0, dp, dT;

  if (r->hydrostatic && m->c->fields.phase[PHASE_W])
    rho = LiquidDensity(&ParticleMaterial(m, p)->water, m->P.f[HeldPressure(&m->c->fields, P_PW0, PHASE_W)][p],
                        ParticleInitialT(m->c, &m->P, p), &dp, &dT);
  for (int d = 0; d < CL_DIM; d++)
    weight += rho * m->c->gravity[d] * face->r[d];
  for (int f = 0; f < PHASE_COUNT; f++)
    p0[f] = m->c->fields.phase[f] ? m->P.f[HeldPressure(&m->c->fields, P_PW0, f)][p] + weight : 0.0;
}

/* Pressures at a face drive a fluid like those in its particle (308). */
static void FaceBeds(const Beds *A, const FieldSet *fs, FaceOutput *o)
{
  for (int f = 0; f < PHASE_COUNT; f++) {
    const int at = F_VWX + CL_DIM * f;

    if (!fs->phase[f])
      continue;
    BedsDrive(A, &o->out[at]);
    for (int q = 0; q < IN_COUNT; q++) {
      double slope[CL_DIM] = {o->D[at][q], o->D[at + 1][q]};

      BedsDrive(A, slope);
      o->D[at][q]     = slope[0];
      o->D[at + 1][q] = slope[1];
    }
  }
}

void FaceAt(const Model *m, const Face *face, const double *x, Reach *r, FaceOutput *o)
{
  const PetscInt p = face->particle;
  double         in[IN_COUNT], p0[PHASE_COUNT], velocity[CL_DIM] = {0.0}, kappa = 0.0, sum = 0.0;

  ReachExpand(m, p, r);
  GatherInputs(m, p, r, x, face, in);
  for (int q = F_PW; q <= F_T; q++)
    in[q == F_T ? IN_T : IN_P + q - F_PW] += Shift(m, p, r, q);
  ModelInitialAtFace(m, face, p0);
  for (int a = 0; a < r->n; a++) {
    kappa += face->N[a] * m->coef[r->node[a] * NC_COUNT + NC_KAPPA];
    sum += face->N[a];
    for (int d = 0; m->c->fields.solid && d < CL_DIM; d++)
      velocity[d] += face->N[a] * x[r->node[a] * m->c->fields.n + PlaceVs(&m->c->fields) + d];
  }
  FaceEvaluate(m->c, face, &m->bc, ParticleMaterial(m, p), p0, m->P.f[P_SH][p], in, velocity, kappa / sum, m->stage.dt,
               o);
  if (m->beds)
    FaceBeds(&m->beds[p].A, &m->c->fields, o);
  if (face->bc[BC_PLATE] >= 0)
    PlateEvaluate(&m->c->bc[face->bc[BC_PLATE]], face, m->bc.value[face->bc[BC_PLATE]], in, o);
}
