/* Surface faces at the start of a step: what they need of their particles and nodes at t_n. */
#include "gather.h"

/* (197) of a face; drag: mean mu/k_a of its nodes at t_n, Pa s/m^2. */
static void AddWall(Model *m, const Reach *r, const Face *f, int phase, double drag)
{
  const double lost = f->ring[0] * f->x[0] * PetscSqr(f->n[0]) / VectorLength(f->n) * drag;

  for (int a = 0; a < r->n; a++) {
    const PetscInt I     = r->node[a];
    const double   share = f->N[a] > 0.0 ? PetscSqr(f->Nr[a]) / f->N[a] : 0.0;

    m->wall[PHASE_COUNT * I + phase] +=
        lost * share * FaceFlow(m, f->particle, I, VectorAt(F_VW, phase, 0)) * FaceShare(m, f->particle, I, phase);
  }
}

/* (195), (197): about an axis the flux through a face goes with 1/r. */
static void RadialFace(Model *m, const Reach *r, Face *f)
{
  double drag[PHASE_COUNT] = {0.0}, sum = 0.0;

  if (!m->c->axisymmetric || !(f->x[0] > 0.0) || f->share > 0.0)
    return;
  for (int a = 0; a < r->n; a++) {
    const double *c = &m->coef[r->node[a] * NC_COUNT];

    f->Nr[a] = f->N[a] / (c[NC_RING] * f->x[0]);
    sum += f->N[a];
    for (int k = 0; k < PHASE_COUNT; k++)
      drag[k] += f->N[a] * c[NC_DRAG + k];
  }
  for (int k = 0; m->wall && k < PHASE_COUNT; k++)
    AddWall(m, r, f, k, drag[k] / sum);
}

void ModelFaceProperties(const Model *m, Face *f, int n, const double S[])
{
  PointProperties q;
  const char     *why;

  if ((f->bc[BC_INFLOW] < 0 && f->bc[BC_WELL] < 0) || ModelParticleProperties(m, f->particle, &q, &why) != CL_OK)
    return;
  FaceInflow(f, n, S, q.kr);
  WellProperties(&q, f);
}

/* (365): by the flux at t_n. */
static void FaceDirections(const Model *m, const Reach *r, Face *f)
{
  for (int k = 0; k < PHASE_COUNT; k++) {
    double sum[CL_DIM] = {0.0}, J[CL_DIM];

    if (!m->c->fields.phase[k])
      continue;
    for (int a = 0; a < r->n; a++) {
      SharedFlux(m, r->node[a], k, &m->x_n[r->node[a] * m->c->fields.n], J);
      for (int d = 0; d < CL_DIM; d++)
        sum[d] += FaceWeight(f, a, VectorAt(F_VW, k, d)) * FaceShare(m, f->particle, r->node[a], k) * J[d];
    }
    Drive(m, f->particle, sum);
    FaceDirection(f, k, sum);
  }
}

PetscErrorCode FacesStart(Model *m)
{
  PetscFunctionBeginUser;
  if (m->wall)
    PetscCall(PetscArrayzero(m->wall, PHASE_COUNT * m->map.n_local));
  for (PetscInt k = 0; k < m->nface; k++) {
    Face *f = &m->face[k];
    Reach r;

    ReachExpand(m, f->particle, &r);
    RadialFace(m, &r, f);
    ModelFaceProperties(m, f, r.n, r.S);
    FaceDirections(m, &r, f);
    if (f->bc[BC_PLATE] >= 0)
      ModelPlateStiffness(m, f);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
