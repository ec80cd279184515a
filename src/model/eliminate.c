/* Fluid velocities eliminated from the tangent of a particle or a face, as if its forces were those of its nodes:
   (171)-(174) of docs/equations.md.  What is left couples nodes only as far as a particle reaches. */
#include "gather.h"

/* (171): what a particle's flux of a fluid along each axis gains for a force on each of its nodes as on itself: w/R,
   and with k_r of the nodes. */
typedef struct {
  double plain[CL_DIM], with_kr[CL_DIM];
} Mobility;

static void MobilityOf(const Model *m, PetscInt p, const Reach *r, int f, Mobility *of)
{
  const double inertia = m->c->fields.inertia ? 1.0 / m->stage.dt : 0.0;

  *of = (Mobility){{0.0}, {0.0}};
  for (int a = 0; a < r->n; a++) {
    const PetscInt   I    = r->node[a];
    const FluidNode *node = m->fluid ? &m->fluid[PHASE_COUNT * I + f] : NULL;
    const double    *c = &m->coef[I * NC_COUNT], w = m->w[PHASE_COUNT * I + f], V = m->V[I];
    const double kr = node ? PetscSqr(node->root) : 1.0, share = r->S[a] * FlowWeight(m, p, I, f) * V / m->P.f[P_V][p];

    for (int i = 0; i < CL_DIM; i++) {
      const double drag   = node ? node->D[i] : c[NC_DRAG + f] * V + WallDrag(m, I, f, i);
      const double resist = drag * w + inertia * kr * c[NC_RHO + f] * V;

      of->plain[i] += resist > 0.0 ? share * w / resist : 0.0;
      of->with_kr[i] += resist > 0.0 ? share * w / resist * kr : 0.0;
    }
  }
}

/* v := A^-1 v of a particle with beds. */
static void Undriven(const Model *m, PetscInt p, double v[CL_DIM])
{
  if (!m->beds)
    return;
  const Beds inverse = BedsInverse(&m->beds[p].A);
  BedsDrive(&inverse, v);
}

/* (171): d J/d(inputs) of a particle's Darcy flux, with beds of A^-1 J, as if all particles of its nodes had its
   gradients. */
static void FluxResponse(const Model *m, const double *x, const ParticleResult *at, int f, double dJ[CL_DIM][IN_COUNT])
{
  const FieldSet    *fs = &m->c->fields;
  const PetscInt     p  = at->p;
  const Reach       *r  = &at->r;
  const PointOutput *o  = &at->o;
  const double      *dM = o->D[OUT_MI + f], *dD = o->D[OUT_D + f], *dR = o->D[OUT_ROOT + f];
  double             acc[CL_DIM] = {0.0}, G[CL_DIM], kr = 0.0;
  Mobility           mobile;

  MobilityOf(m, p, r, f, &mobile);
  for (int a = 0; a < r->n; a++) {
    double own[CL_DIM];

    Acceleration(m, r->node[a], x, PlaceV(fs, f), 1.0, own);
    kr += r->S[a] * (m->fluid ? PetscSqr(m->fluid[PHASE_COUNT * r->node[a] + f].root) : 1.0);
    for (int i = 0; i < CL_DIM; i++)
      acc[i] += r->S[a] * own[i];
  }
  memcpy(G, &o->out[VectorAt(OUT_G, f, 0)], sizeof(G));
  Undriven(m, p, G);
  for (int q = 0; q < IN_COUNT; q++) {
    double dG[CL_DIM];

    for (int i = 0; i < CL_DIM; i++)
      dG[i] = o->D[VectorAt(OUT_G, f, i)][q];
    Undriven(m, p, dG);
    for (int i = 0; i < CL_DIM; i++) {
      const double rise = 2.0 * sqrt(kr) * (G[i] + acc[i] * o->out[OUT_MI + f]);

      dJ[i][q] = -mobile.with_kr[i] * (dG[i] + acc[i] * dM[q]) -
                 mobile.plain[i] * (rise * dR[q] + at->in[VectorAt(IN_J, f, i)] * dD[q]);
    }
  }
  for (int i = 0; fs->solid && fs->inertia && i < CL_DIM; i++)
    dJ[i][IN_U + i] -= mobile.with_kr[i] * o->out[OUT_MI + f] / PetscSqr(m->stage.dt);
}

/* Row `k` of the tangent: the flux follows the other inputs. */
static void Follow(double *D, int f, const double dJ[CL_DIM][IN_COUNT])
{
  for (int i = 0; i < CL_DIM; i++) {
    const double J = D[VectorAt(IN_J, f, i)];

    for (int q = 0; q < IN_COUNT && J != 0.0; q++)
      D[q] += J * dJ[i][q];
  }
}

/* Share of the bracket's slope that the flux takes over. */
static double BracketShare(const PointOutput *o, int f, const double dJ[CL_DIM][IN_COUNT])
{
  double flux = 0.0, bracket = 0.0;

  for (int i = 0; i < CL_DIM; i++) {
    const int row = VectorAt(OUT_FLUX, f, i);

    for (int j = 0; j < CL_DIM; j++)
      flux -= o->D[row][VectorAt(IN_J, f, j)] * dJ[j][VectorAt(IN_GP, f, i)];
    bracket += o->wide[f][f][i][i];
  }
  return bracket > flux ? flux / bracket : 1.0;
}

/* (172): with Pi g = g the bracket of (19) has no slope with respect to g. */
static void DropBracket(const FieldSet *fs, PointOutput *o, int f, double share)
{
  for (int i = 0; i < PHASE_COUNT * CL_DIM + fs->heat; i++) {
    const bool    heat = i == PHASE_COUNT * CL_DIM;
    const double *wide = heat ? o->wide_q[f] : o->wide[i / CL_DIM][f][i % CL_DIM];
    double       *D    = o->D[heat ? OUT_Q : OUT_FLUX + i];

    for (int j = 0; j < CL_DIM; j++)
      D[VectorAt(IN_GP, f, j)] += share * wide[j];
  }
}

/* (174): what the mass rows lose to a skeleton that gives way to the pressures. */
static void FixedStress(const FieldSet *fs, PointOutput *o)
{
  double M = 0.0;

  for (int i = 0; i < CL_DIM; i++)
    M += o->D[VectorAt(OUT_P, i, i)][VectorAt(IN_GRADU, i, i)] / CL_DIM;
  for (int f = 0; f < PHASE_COUNT && M > 0.0; f++) {
    double *D = o->D[OUT_DM + f], dV = 0.0;

    if (!fs->phase[f])
      continue;
    for (int i = 0; i < CL_DIM; i++)
      dV += D[VectorAt(IN_GRADU, i, i)] / CL_DIM;
    for (int q = IN_P; q <= IN_T; q++) {
      double P = 0.0;

      for (int i = 0; i < CL_DIM; i++)
        P += o->D[VectorAt(OUT_P, i, i)][q] / CL_DIM;
      D[q] -= dV * P / M;
    }
  }
}

void EliminateParticle(const Model *m, const double *x, bool fixed_stress, ParticleResult *at)
{
  const FieldSet *fs = &m->c->fields;
  PointOutput    *o  = &at->o;

  for (int f = 0; f < PHASE_COUNT; f++) {
    double dJ[CL_DIM][IN_COUNT];

    if (!fs->phase[f])
      continue;
    FluxResponse(m, x, at, f, dJ);
    DropBracket(fs, o, f, BracketShare(o, f, dJ));
    for (int row = OUT_FLUX; row < OUT_FLUX + PHASE_COUNT * CL_DIM; row++) /* gas goes with the water, too (352) */
      Follow(o->D[row], f, dJ);
    if (fs->heat)
      Follow(o->D[OUT_Q], f, dJ);
    for (int q = 0; fs->solid && fs->inertia && q < IN_U; q++) { /* (173); its share of v_s is lumped */
      double flow[CL_DIM];

      for (int i = 0; i < CL_DIM; i++)
        flow[i] = dJ[i][q];
      Drive(m, at->p, flow);
      for (int i = 0; i < CL_DIM; i++)
        o->D[OUT_A + i][q] += o->out[OUT_MI + f] / m->stage.dt * flow[i];
    }
  }
  if (fixed_stress && fs->solid)
    FixedStress(fs, o);
}

void EliminateFace(const Model *m, const Face *face, const Reach *r, FaceOutput *o)
{
  const FieldSet *fs      = &m->c->fields;
  const double    inertia = fs->inertia ? 1.0 / m->stage.dt : 0.0;

  for (int f = 0; f < PHASE_COUNT; f++) {
    double *D = o->D[F_PW + f], J[CL_DIM], given = 0.0, own = 0.0;

    if (!fs->phase[f])
      continue;
    for (int a = 0; a < r->n; a++) {
      const double *c = &m->coef[r->node[a] * NC_COUNT], w = m->w[PHASE_COUNT * r->node[a] + f];
      const double kr = c[NC_KR + f], resist = (c[NC_DRAG + f] + WallDrag(m, r->node[a], f, 0) / m->V[r->node[a]]) * w +
                                               inertia * kr * c[NC_RHO + f];
      const double mobile = resist > 0.0 ? w * kr / resist : 0.0;

      own += face->N[a] * mobile;
      given += face->N[a] * face->N[a] * mobile / m->V[r->node[a]];
    }
    memcpy(J, &D[VectorAt(IN_J, f, 0)], sizeof(J));
    for (int q = 0; q < IN_COUNT; q++) {
      double force[CL_DIM];

      for (int i = 0; i < CL_DIM; i++)
        force[i] = o->D[VectorAt(F_VW, f, i)][q];
      Undriven(m, face->particle, force);
      D[q] -= given * VectorDot(J, force);
    }
    for (int i = 0; i < CL_DIM; i++)
      D[VectorAt(IN_GP, f, i)] -= own * J[i];
  }
}
