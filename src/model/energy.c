/* Mechanical energy: what the particles hold (89), and the powers of an implicit stage (91). */
#include "gather.h"

void ModelAddEnergies(const Model *m, PetscInt p, double energy[ENERGY_COUNT])
{
  const Particles *P = &m->P;
  SkeletonHistory  h;
  double           dE;

  energy[ENERGY_KINETIC] += ModelKineticEnergy(P, p);
  if (!m->c->fields.solid)
    return;
  const Material     *mat   = ParticleMaterial(m, p);
  const SkeletonStore store = ParticlesSkeleton(P, 0, 0.0);

  SkeletonTake(&store, p, &h);
  energy[ENERGY_ELASTIC] +=
      P->f[P_V][p] * SkeletonEnergy(&mat->elasticity, ElasticityYoung(&mat->elasticity, P->f[P_SH][p], &dE), &h);
  if (P->f[P_WP]) {
    energy[ENERGY_PLASTIC] += P->f[P_WP][p];
    energy[ENERGY_HEAT] += mat->plasticity.heat * P->f[P_WP][p];
  }
}

PetscErrorCode ModelEnergies(const Model *m, double energy[ENERGY_COUNT])
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(energy, ENERGY_COUNT));
  for (PetscInt p = 0; p < m->P.n; p++)
    ModelAddEnergies(m, p, energy);
  energy[ENERGY_RELEASED] = m->released;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, energy, ENERGY_COUNT, MPI_DOUBLE, MPI_SUM, m->grid.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Velocities of skeleton, water and gas at a particle, and V div v_s. */
typedef struct {
  double v[1 + PHASE_COUNT][CL_DIM], expansion;
} Motion;

static void MotionAt(const Model *m, PetscInt p, const Reach *r, const double *x, const PointState *s, Motion *o)
{
  const FieldSet *fs      = &m->c->fields;
  const bool      there[] = {fs->solid, fs->phase[PHASE_W], fs->phase[PHASE_G]};
  double          u[CL_NODES][CL_DIM], g[MOTION_COUNT], cof[CL_DIM][CL_DIM];
  const double    det = CofactorOf(s->F, cof), lambda = s->V / (m->P.f[P_V][p] * det);

  *o = (Motion){0};
  for (int a = 0; a < r->n; a++) {
    const double *xI = &x[r->node[a] * fs->n];

    for (int k = 0; k < 3; k++) {
      for (int i = 0; there[k] && i < CL_DIM; i++)
        o->v[k][i] += r->S[a] * xI[fs->at[VectorAt(F_VS, k, 0)] + i];
    }
    for (int i = 0; i < CL_DIM; i++)
      u[a][i] = xI[PlaceVs(fs) + i];
  }
  MotionGradient(m, r, u, g);
  o->expansion = s->V * g[MOTION_HOOP] / lambda;
  for (int i = 0; i < CL_DIM; i++)
    o->expansion += s->V * VectorDot(cof[i], &g[VectorAt(0, i, 0)]) / det;
}

/* Of the mass of a phase in the inertia of the rows: M a . v over the nodes. */
static double InertiaPower(const Model *m, const Reach *r, const double *x, const double out[OUT_COUNT])
{
  const FieldSet *fs      = &m->c->fields;
  const bool      there[] = {fs->solid, fs->phase[PHASE_W], fs->phase[PHASE_G]};
  double          sum     = 0.0;

  for (int k = 0; k < 3; k++) {
    for (int a = 0; there[k] && a < r->n; a++) {
      const PetscInt q = r->node[a] * fs->n + fs->at[VectorAt(F_VS, k, 0)];

      for (int i = 0; i < CL_DIM; i++)
        sum += out[OUT_M + k] * r->S[a] * (x[q + i] - m->stage.x_star[q + i]) / m->stage.dt * x[q + i];
    }
  }
  return sum;
}

/* Of a fluid at a node: J, and B J, with which its drag takes power. */
static void Fluxes(const Model *m, PetscInt I, int f, const double *x, double J[CL_DIM], double BJ[CL_DIM])
{
  DarcyFlux(m, I, f, &x[I * m->c->fields.n], J);
  memcpy(BJ, J, CL_DIM * sizeof(double));
  ShareOut(m, I, BJ);
}

void ParticlePower(const Model *m, const double *x, const ParticleResult *of, double power[WORK_RATES])
{
  const FieldSet *fs = &m->c->fields;
  const PetscInt  p  = of->p;
  const Reach    *r  = &of->r;
  const double   *in = of->in, *out = of->o.out;
  Motion          k;

  MotionAt(m, p, r, x, &of->state, &k);
  if (fs->inertia)
    power[WORK_INERTIA] += InertiaPower(m, r, x, out);
  for (int i = 0; i < CL_DIM; i++)
    power[WORK_GRAVITY] +=
        m->bc.gravity[i] * (out[OUT_M] * k.v[0][i] + (fs->phase[PHASE_W] ? out[OUT_M + 1] * k.v[1][i] : 0.0) +
                            (fs->phase[PHASE_G] ? out[OUT_M + 2] * k.v[2][i] : 0.0));
  power[WORK_PRESSURE] += fs->fluid ? of->state.p * k.expansion : 0.0;
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    for (int i = 0; i < CL_DIM; i++)
      power[WORK_PRESSURE] -= out[VectorAt(OUT_G, f, i)] * in[VectorAt(IN_J, f, i)];
    for (int a = 0; !m->fluid && a < r->n; a++) {
      double J[CL_DIM], BJ[CL_DIM];

      Fluxes(m, r->node[a], f, x, J, BJ);
      power[WORK_DRAG] += r->S[a] * FlowWeight(m, p, r->node[a], f) * out[OUT_D + f] * VectorDot(J, BJ);
    }
  }
  if (!m->bc.ambient.on)
    return;
  double at[CL_DIM], gradient[CL_DIM];
  ParticleCentroid(&m->grid, &m->P, p, &m->stencil[p], at);
  for (int d = 0; d < CL_DIM; d++)
    at[d] += in[IN_U + d];
  double sum = AmbientPressure(&m->bc.ambient, at, gradient) * k.expansion;
  for (int d = 0; d < CL_DIM; d++)
    sum += out[OUT_A + d] * k.v[0][d];
  power[WORK_LOADS] -= sum;
}

void FacePower(const Model *m, const Face *f, const Reach *r, const double *x, const FaceOutput *o,
               double power[WORK_RATES])
{
  const FieldSet *fs    = &m->c->fields;
  double          force = 0.0, plate = 0.0;

  for (int a = 0; a < r->n; a++) {
    const double *xI = &x[r->node[a] * fs->n];

    for (int d = 0; d < CL_DIM; d++) {
      const double v    = f->N[a] * xI[PlaceVs(fs) + d];
      const bool   over = f->bc[BC_PLATE] >= 0 && d == SideAxis(f->side);

      force -= o->out[F_VS + d] * v;
      if (f->bc[BC_PLATE] >= 0)
        plate += (over ? -SideSign(f->side) * o->plate[PLATE_FORCE] : o->plate[PLATE_SHEAR]) * v;
    }
    for (int ph = 0; ph < PHASE_COUNT; ph++) {
      double J[CL_DIM];

      if (!fs->phase[ph])
        continue;
      SharedFlux(m, r->node[a], ph, xI, J);
      for (int d = 0; d < CL_DIM; d++)
        power[WORK_PRESSURE] -= FaceWeight(f, a, VectorAt(F_VW, ph, d)) * FaceShare(m, f->particle, r->node[a], ph) *
                                o->out[VectorAt(F_VW, ph, d)] * J[d];
    }
  }
  power[WORK_PLATES] += plate;
  power[WORK_LOADS] += force - plate;
}

/* Of a lone fluid at the wall of a well (197): its other drag is that of the particles. */
static double WallPower(const Model *m, const double *x)
{
  double sum = 0.0;

  for (PetscInt k = 0; m->wall && k < m->map.n_local * PHASE_COUNT; k++) {
    double J[CL_DIM], BJ[CL_DIM];

    if (m->wall[k] == 0.0 || !m->c->fields.phase[k % PHASE_COUNT])
      continue;
    Fluxes(m, k / PHASE_COUNT, k % PHASE_COUNT, x, J, BJ);
    sum += m->wall[k] * J[0] * BJ[0];
  }
  return sum;
}

/* Drag of two fluids (16): D |J|^2/k_r; of one what the particles do not have. */
double DragPower(const Model *m, const double *x)
{
  double sum = m->fluid ? 0.0 : WallPower(m, x);

  for (PetscInt I = 0; m->fluid && I < m->map.n_owned; I++) {
    for (int f = 0; f < PHASE_COUNT; f++) {
      const FluidNode *at = &m->fluid[PHASE_COUNT * I + f];
      double           J[CL_DIM], BJ[CL_DIM];

      Fluxes(m, I, f, x, J, BJ);
      for (int d = 0; d < CL_DIM; d++)
        sum += at->D[d] * J[d] * BJ[d] / PetscSqr(at->root);
    }
  }
  return sum;
}

/* Prescribed motion of nodes: what is left in their rows (15) is the force that holds them. */
double HeldPower(const Model *m)
{
  const FieldSet *fs  = &m->c->fields;
  double          sum = 0.0;

  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int k = PlaceVs(fs); k < PlaceVs(fs) + CL_DIM; k++) {
      if ((m->mask[I] >> k) & 1u)
        sum += m->f[I * fs->n + k] * m->fixed[I * fs->n + k];
    }
  }
  return sum;
}
