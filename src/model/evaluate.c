/* One particle, one face: gather from the nodes and evaluate. */
#include "gather.h"

#define GRADIENTS (GIVE_COUNT - GIVE_GRAD)

/* Sums of what a particle's nodes hold. */
typedef struct {
  double S[GIVE_GRAD], G[CL_DIM][GRADIENTS];
} Sums;

static void Sum(const Model *m, const Reach *r, Sums *s)
{
  Lanes S[GIVE_GRAD / LANES] = {{0.0}}, G[CL_DIM][GRADIENTS / LANES] = {{{0.0}}};

  for (int a = 0; a < r->n; a++) {
    const Lanes *node = (const Lanes *)&m->give[GIVE_COUNT * r->node[a]], *grad = node + GIVE_GRAD / LANES;

    for (int k = 0; k < GIVE_GRAD / LANES; k++)
      S[k] += r->S[a] * node[k];
    for (int d = 0; d < CL_DIM; d++) {
      for (int k = 0; k < GRADIENTS / LANES; k++)
        G[d][k] += r->G[a][d] * grad[k];
    }
  }
  memcpy(s->S, S, sizeof(S));
  memcpy(s->G, G, sizeof(G));
}

/* Displacement and its gradient where the motion has weights of its own. */
static void GatherMotion(const Model *m, PetscInt p, const Reach *r, double in[IN_COUNT])
{
  double u[CL_NODES][CL_DIM];

  for (int d = 0; d < CL_DIM; d++) {
    in[IN_U + d] = 0.0;
    for (int a = 0; a < r->n; a++) {
      u[a][d] = m->give[GIVE_COUNT * r->node[a] + GIVE_U + d];
      in[IN_U + d] += MotionWeight(m, p, r, a) * u[a][d];
    }
  }
  MotionGradient(m, r, u, &in[IN_GRADU]);
}

/* (333): gas that comes from where it is. */
static void GatherDonated(const Model *m, PetscInt p, const Reach *r, const double *x, double J[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    J[d] = 0.0;
  for (int a = 0; a < r->n; a++) {
    const double w = r->S[a] * FlowWeight(m, p, r->node[a], PHASE_G);
    double       at[CL_DIM];

    SharedFlux(m, r->node[a], PHASE_G, &x[r->node[a] * m->c->fields.n], at);
    for (int d = 0; d < CL_DIM; d++)
      J[d] += w * at[d];
  }
}

/* Inputs (1), (5), (19) of particle p as far as nodes give them: of p_w, p_g, T what they add to its own at t_n. */
static void GatherInputs(const Model *m, PetscInt p, const Reach *r, const double *x, const Sums *s,
                         double in[IN_COUNT])
{
  const FieldSet *fs = &m->c->fields;

  for (int q = 0; q < IN_COUNT; q++)
    in[q] = 0.0;
  in[IN_T] = s->S[GIVE_SCALAR + F_T - F_PW];
  for (int d = 0; d < CL_DIM; d++) {
    in[IN_GT + d] = s->G[d][F_T - F_PW];
    in[IN_U + d]  = s->S[GIVE_U + d];
    for (int i = 0; i < CL_DIM; i++)
      in[VectorAt(IN_GRADU, i, d)] = s->G[d][GIVE_MOTION - GIVE_GRAD + i];
  }
  if (fs->solid && (m->c->axisymmetric || r->M != r->G))
    GatherMotion(m, p, r, in);
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    in[IN_P + f] = s->S[GIVE_SCALAR + f];
    for (int d = 0; d < CL_DIM; d++) {
      in[VectorAt(IN_GP, f, d)] = s->G[d][f];
      in[VectorAt(IN_J, f, d)]  = m->conduct[p] * s->S[VectorAt(GIVE_J, f, d)];
    }
    if (Donated(m, f))
      GatherDonated(m, p, r, x, &in[VectorAt(IN_J, f, 0)]);
  }
}

#define MOST_SHARE 2.0 /* of what its nodes change by: where they hold less than half of a particle's gas, or none */

/* (416): 1 - a. */
static double Withheld(const Model *m, PetscInt p, const Sums *s)
{
  const double own = OwnValue(m, p, F_PG), nodal = s->S[GIVE_START + F_PG - F_PW];

  if (!(own > 0.0))
    return 0.0;
  return 1.0 - (own < MOST_SHARE * nodal ? own / nodal : MOST_SHARE);
}

/* (416): inputs, or with them the slopes of all outputs. */
static void WithholdInputs(double less, double in[IN_COUNT])
{
  const double withheld = less * in[IN_P + PHASE_G];

  for (int f = 0; f < PHASE_COUNT; f++)
    in[IN_P + f] -= withheld;
}

static void WithholdSlopes(double less, PointOutput *o)
{
  for (int k = 0; k < OUT_COUNT; k++)
    o->D[k][IN_P + PHASE_G] -= less * (o->D[k][IN_P + PHASE_W] + o->D[k][IN_P + PHASE_G]);
}

/* The particle's own. */
static void AddOwn(const Model *m, PetscInt p, double in[IN_COUNT])
{
  in[IN_T] += ParticleT(m->c, &m->P, p);
  for (int f = 0; f < PHASE_COUNT; f++)
    in[IN_P + f] += m->c->fields.phase[f] ? m->P.f[P_PW + f][p] : 0.0;
}

/* (Pi g)_p of a fluid. */
static void GatherProjected(const Model *m, PetscInt p, const Reach *r, const Sums *s, int f, double proj[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++) {
    proj[d] = Donated(m, f) ? 0.0 : s->S[VectorAt(GIVE_PROJ, f, d)];
    for (int a = 0; Donated(m, f) && a < r->n; a++)
      proj[d] += ProjectedShare(m, p, r->node[a], f, r->S[a]) * m->proj[VectorAt(0, PHASE_COUNT * r->node[a] + f, d)];
  }
}

/* Displacement and Darcy fluxes at a face of the particle. */
static void GatherFace(const Model *m, PetscInt p, const Reach *r, const double *x, const Face *face,
                       double in[IN_COUNT])
{
  const FieldSet *fs = &m->c->fields;

  for (int a = 0; a < r->n; a++) {
    const PetscInt I    = r->node[a];
    const double  *node = &m->give[GIVE_COUNT * I];

    for (int d = 0; d < CL_DIM; d++)
      in[IN_U + d] = (a ? in[IN_U + d] : 0.0) + face->N[a] * node[GIVE_U + d];
    for (int f = 0; f < PHASE_COUNT; f++) {
      double J[CL_DIM];

      if (!fs->phase[f])
        continue;
      SharedFlux(m, I, f, &x[I * fs->n], J);
      for (int d = 0; d < CL_DIM; d++) {
        const int at = VectorAt(IN_J, f, d);

        in[at] = (a ? in[at] : 0.0) + FaceWeight(face, a, VectorAt(F_VW, f, d)) * FaceShare(m, p, I, f) * J[d];
      }
    }
  }
}

/* What nodes add to a pressure until the stage starts, Pa. */
static double StarredChange(const Model *m, const Reach *r, int f)
{
  const FieldSet *fs  = &m->c->fields;
  double          sum = 0.0;

  for (int a = 0; a < r->n; a++) {
    const PetscInt k = r->node[a] * fs->n + PlaceP(fs, f);

    sum += r->S[a] * (m->stage.x_star[k] - m->x_n[k]);
  }
  return sum;
}

/* (1), (416) of the pressure that the stage starts from, Pa. */
static double StarredPressure(const Model *m, PetscInt p, const Reach *r, int f, double less)
{
  const double withheld = less != 0.0 ? less * StarredChange(m, r, PHASE_G) : 0.0;

  return m->P.f[P_PW + f][p] + StarredChange(m, r, f) - withheld;
}

static void GatherHistory(const Model *m, PetscInt p, const Reach *r, const Sums *s, double less, PointHistory *h)
{
  const FieldSet *fs = &m->c->fields;

  h->V        = m->P.f[P_V][p];
  h->m_s      = m->P.f[P_MS][p];
  h->T_n      = ParticleT(m->c, &m->P, p);
  h->Sh_n     = m->P.f[P_SH][p];
  h->dt       = m->stage.dt;
  h->held     = m->added->held ? m->added->held[p] : 0.0;
  h->chord    = ParticleChord(m, p);
  h->mobility = m->added->donor ? m->added->donor[p].kr : 0.0;
  h->withheld = less / (1.0 - less);
  h->pg_n     = less != 0.0 ? OwnValue(m, p, F_PG) : 0.0;
  for (int f = 0; f < PHASE_COUNT; f++)
    h->spread[f] = m->added->spread ? m->added->spread[PHASE_COUNT * p + f] : 0.0;
  for (int k = 0; k < CL_SYMMETRIC; k++)
    h->upwind[k] = m->added->upwind ? m->added->upwind[CL_SYMMETRIC * p + k] : 0.0;
  h->compression = m->c->compression_heat;
  for (int k = 0; h->compression && k < PHASE_COUNT; k++)
    h->p_star[k] = fs->phase[k] ? StarredPressure(m, p, r, k, less) : 0.0;
  for (int d = 0; h->compression && d < CL_DIM; d++)
    h->gravity[d] = m->bc.gravity[d];
  h->beds = m->beds ? &m->beds[p].A : NULL;
  for (int f = 0; m->beds && f < PHASE_COUNT; f++)
    BedsWeight(m, p, f, h->weight[f]);
  h->ambient = m->bc.ambient.on ? &m->bc.ambient : NULL;
  if (h->ambient)
    ParticleCentroid(&m->grid, &m->P, p, &m->stencil[p], h->x);
  for (int k = 0; k < 3; k++) {
    h->m_star[k] = m->stage.m_star[TRIAL_MASSES * p + k];
    h->shift[k]  = fs->at[F_PW + k] >= 0 ? s->S[GIVE_START + k] - OwnValue(m, p, F_PW + k) : 0.0;
  }
  if (fs->solid) {
    const SkeletonStore store = ParticlesSkeleton(&m->P, 0, m->stage.ahead);

    SkeletonTake(&store, p, &h->skeleton);
    if (m->stage.k_star)
      h->skeleton.from = m->stage.k_star[p];
  }
  for (int f = 0; f < PHASE_COUNT; f++)
    GatherProjected(m, p, r, s, f, h->proj[f]);
}

ClStatus ParticleEvaluate(Model *m, PetscInt p, const double *x, bool tangent, ParticleResult *at)
{
  Reach       *r  = &at->r;
  double      *in = at->in;
  PointHistory h;
  Sums         sums;
  const char  *why = NULL;

  at->p = p;
  ReachMotion(m, p, r);
  Sum(m, r, &sums);
  const double less = m->relative_gas ? Withheld(m, p, &sums) : 0.0;
  GatherInputs(m, p, r, x, &sums, in);
  if (less != 0.0)
    WithholdInputs(less, in);
  AddOwn(m, p, in);
  GatherHistory(m, p, r, &sums, less, &h);
  const ClStatus status =
      PointEvaluate(&(PointInput){&m->c->fields, ParticleMaterial(m, p), &h, in}, tangent, &at->state, &at->o, &why);
  if (status != CL_OK)
    ModelNoteFailure(m, status, why, p);
  else if (m->P.f[P_HEAT] && m->c->fields.heat)
    at->o.out[OUT_Q] -= m->stage.drain * m->P.f[P_HEAT][p]; /* what hybrid left of (69) */
  if (tangent && less != 0.0)
    WithholdSlopes(less, &at->o);
  return status;
}

void ParticleChange(const Model *m, PetscInt p, const double *x, Reach *r, double in[IN_COUNT],
                    double proj[CL_FLUID_VECTORS])
{
  Sums sums;

  ReachMotion(m, p, r);
  Sum(m, r, &sums);
  GatherInputs(m, p, r, x, &sums, in);
  for (int f = 0; f < PHASE_COUNT; f++)
    GatherProjected(m, p, r, &sums, f, &proj[VectorAt(0, f, 0)]);
}

void FaceChange(const Model *m, const Face *face, const double *x, Reach *r, double in[IN_COUNT])
{
  Sums sums;

  ReachMotion(m, face->particle, r);
  Sum(m, r, &sums);
  GatherInputs(m, face->particle, r, x, &sums, in);
  GatherFace(m, face->particle, r, x, face, in);
}

ClStatus ModelParticleProperties(const Model *m, PetscInt p, PointProperties *q, const char **why)
{
  const FieldSet     *fs = &m->c->fields;
  const PointContents x  = {.V   = m->P.f[P_V][p],
                            .m_s = m->P.f[P_MS][p],
                            .m_h = m->P.f[P_MH][p],
                            .pw  = fs->phase[PHASE_W] ? m->P.f[P_PW][p] : 0.0,
                            .pg  = fs->phase[PHASE_G] ? m->P.f[P_PG][p] : 0.0,
                            .T   = ParticleT(m->c, &m->P, p)};

  return PointPropertiesEvaluate(fs, ParticleMaterial(m, p), &x, q, why);
}

/* Initial pressures with the weight of the water between particle and face (276). */
void ModelInitialAtFace(const Model *m, const Face *face, double p0[PHASE_COUNT])
{
  const PetscInt p      = face->particle;
  const Region  *r      = &m->c->region[m->P.i[PI_REGION][p]];
  double         weight = 0.0, rho = 0.0, dp, dT;

  if (r->hydrostatic && m->c->fields.phase[PHASE_W])
    rho = LiquidDensity(&ParticleMaterial(m, p)->water, m->P.f[P_PW0][p], ParticleInitialT(m->c, &m->P, p), &dp, &dT);
  for (int d = 0; d < CL_DIM; d++)
    weight += rho * m->c->gravity[d] * face->r[d];
  for (int f = 0; f < PHASE_COUNT; f++)
    p0[f] = m->c->fields.phase[f] ? m->P.f[P_PW0 + f][p] + weight : 0.0;
}

/* Pressures at a face drive a fluid like those in its particle (308); the slopes of what flows in those of (448). */
static void FaceBeds(const Beds *A, const FieldSet *fs, FaceOutput *o)
{
  for (int f = 0; f < PHASE_COUNT; f++) {
    const int at = F_VW + CL_DIM * f;

    if (!fs->phase[f])
      continue;
    BedsDrive(A, &o->out[at]);
    for (int q = 0; q < IN_COUNT; q++) {
      double slope[CL_DIM];

      for (int d = 0; d < CL_DIM; d++)
        slope[d] = o->D[at + d][q];
      BedsDrive(A, slope);
      for (int d = 0; d < CL_DIM; d++)
        o->D[at + d][q] = slope[d];
    }
    for (int q = 0; q < F_COUNT; q++)
      BedsDrive(A, &o->D[q][VectorAt(IN_J, f, 0)]);
  }
}

void FaceAt(const Model *m, const Face *face, const double *x, Reach *r, FaceOutput *o)
{
  const PetscInt p = face->particle;
  double         in[IN_COUNT], p0[PHASE_COUNT], velocity[CL_DIM] = {0.0}, kappa = 0.0, sum = 0.0;

  FaceChange(m, face, x, r, in);
  AddOwn(m, p, in);
  for (int q = F_PW; q <= F_T; q++)
    in[q == F_T ? IN_T : IN_P + q - F_PW] += Shift(m, p, r, q);
  for (int f = 0; f < PHASE_COUNT; f++)
    Drive(m, p, &in[VectorAt(IN_J, f, 0)]);
  ModelInitialAtFace(m, face, p0);
  for (int a = 0; a < r->n; a++) {
    kappa += face->N[a] * m->coef[r->node[a] * NC_COUNT + NC_KAPPA];
    sum += face->N[a];
    for (int d = 0; m->c->fields.solid && d < CL_DIM; d++)
      velocity[d] += face->N[a] * x[r->node[a] * m->c->fields.n + PlaceVs(&m->c->fields) + d];
  }
  FaceEvaluate(&(FaceInput){m->c, face, &m->bc, ParticleMaterial(m, p), p0, in, velocity, m->P.f[P_SH][p], kappa / sum,
                            m->stage.dt},
               o);
  if (m->beds)
    FaceBeds(&m->beds[p].A, &m->c->fields, o);
  if (face->bc[BC_PLATE] >= 0)
    PlateEvaluate(&m->c->bc[face->bc[BC_PLATE]], face, m->bc.value[face->bc[BC_PLATE]], in, o);
}
