/* What a particle adds to its nodes. */
#include "gather.h"

/* What a particle adds at each of its nodes: [0] is weighted with S, [1] and [2] with the components of G. */
typedef struct {
  double S[TAKE_GRAD], G[CL_DIM][TAKE_COUNT - TAKE_GRAD];
} Shares;

static void SharesOf(const Model *m, PetscInt p, const double out[OUT_COUNT], Shares *s)
{
  const FieldSet *fs = &m->c->fields;
  const double    c = m->conduct[p], dt = m->stage.dt;

  *s = (Shares){.S = {[TAKE_M] = out[OUT_M]}};
  for (int i = 0; fs->solid && i < CL_DIM; i++) {
    s->S[TAKE_A + i] = m->bc.ambient.on ? out[OUT_A + i] : 0.0;
    for (int d = 0; d < CL_DIM; d++)
      s->G[d][i] = out[VectorAt(OUT_P, i, d)];
  }
  for (int f = 0; f < PHASE_COUNT; f++) {
    double *of = &s->S[TAKE_FLUID + FLUID_COUNT * f];

    if (!fs->phase[f])
      continue;
    s->S[TAKE_M + 1 + f] = out[OUT_M + 1 + f];
    s->S[TAKE_DM + f]    = out[OUT_DM + f];
    s->S[TAKE_ROOT + f]  = m->fluid ? (Donated(m, f) ? 1.0 : c) * m->P.f[P_V][p] * out[OUT_ROOT + f] : 0.0;
    of[FLUID_MI]         = c * out[OUT_MI + f];
    of[FLUID_MI2]        = c * of[FLUID_MI];
    of[FLUID_D]          = c * out[OUT_D + f];
    for (int d = 0; d < CL_DIM; d++) {
      of[FLUID_G + d]                    = c * out[VectorAt(OUT_G, f, d)];
      s->G[d][TAKE_MASS - TAKE_GRAD + f] = -dt * out[VectorAt(OUT_FLUX, f, d)];
    }
  }
  if (!fs->heat)
    return;
  s->S[TAKE_C]     = out[OUT_C];
  s->S[TAKE_C + 1] = out[OUT_Q];
  for (int d = 0; d < CL_DIM; d++)
    s->G[d][TAKE_HEAT - TAKE_GRAD] = out[OUT_HEAT + d];
}

/* Where motion has weights of its own: about an axis, over cells. */
static void ScatterMotion(Model *m, const Reach *r, const double out[OUT_COUNT], Shares *s)
{
  double mean = out[OUT_P];

  for (int d = 1; d < CL_DIM; d++)
    mean += out[VectorAt(OUT_P, d, d)];
  if (SceneStrainsAcross(m->c))
    mean += out[OUT_HOOP];

  for (int i = 0; i < CL_DIM; i++) {
    for (int a = 0; a < r->n; a++) {
      double *row = &m->take[TAKE_COUNT * r->node[a] + TAKE_GRAD + i], sum = r->M[a][0] * s->G[0][i];

      for (int d = 1; d < CL_DIM; d++)
        sum += r->M[a][d] * s->G[d][i];
      *row += sum;
      if (m->c->axisymmetric && i == 0)
        *row += r->K[a] * out[OUT_HOOP];
      if (m->cell)
        *row += r->B[a][i] * mean;
    }
    for (int d = 0; d < CL_DIM; d++)
      s->G[d][i] = 0.0;
  }
}

/* Gas of a particle has weights that differ from node to node (333). */
static void ScatterDonated(Model *m, PetscInt p, const Reach *r, int f, Shares *s)
{
  double *of = &s->S[TAKE_FLUID + FLUID_COUNT * f];

  for (int a = 0; a < r->n; a++) {
    const PetscInt I     = r->node[a];
    const double   share = DonorShare(m, p, I);
    double        *node  = &m->take[TAKE_COUNT * I];

    for (int k = 0; k < FLUID_COUNT; k++)
      node[TAKE_FLUID + FLUID_COUNT * f + k] += r->S[a] * share * (k == FLUID_MI2 ? share : 1.0) * of[k];
  }
  for (int k = 0; k < FLUID_COUNT; k++)
    of[k] = 0.0;
}

/* What the skeleton's acceleration and gravity have in (308). */
static void ScatterBeds(Model *m, PetscInt p, const Reach *r, const double *x, int f, const double out[OUT_COUNT])
{
  for (int a = 0; a < r->n; a++) {
    const PetscInt I      = r->node[a];
    const double   weight = r->S[a] * FlowWeight(m, p, I, f) / NodeShare(m, I, f) * out[OUT_MI + f];
    double         across[CL_DIM];

    BedsHold(m, p, I, x, f, across);
    for (int d = 0; d < CL_DIM; d++)
      m->take[TAKE_COUNT * I + TAKE_FLUID + FLUID_COUNT * f + FLUID_G + d] += weight * across[d];
  }
}

/* Adds the sum over the axes of g times the k-th Lanes of G; a vector that is returned has no place everywhere. */
static inline void LanesAlong(const double g[CL_DIM], const double G[CL_DIM][TAKE_COUNT - TAKE_GRAD], int k, Lanes *to)
{
  Lanes sum = g[0] * ((const Lanes *)G[0])[k];

  for (int d = 1; d < CL_DIM; d++)
    sum += g[d] * ((const Lanes *)G[d])[k];
  *to += sum;
}

void ParticleScatter(Model *m, PetscInt p, const Reach *r, const double *x, const double out[OUT_COUNT])
{
  const FieldSet *fs = &m->c->fields;
  Shares          s;

  SharesOf(m, p, out, &s);
  if (fs->solid && (m->c->axisymmetric || r->M != r->G))
    ScatterMotion(m, r, out, &s);
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (fs->phase[f] && m->beds)
      ScatterBeds(m, p, r, x, f, out);
    if (fs->phase[f] && Donated(m, f))
      ScatterDonated(m, p, r, f, &s);
  }
  const Lanes *S = (const Lanes *)s.S;
  for (int a = 0; a < r->n; a++) {
    Lanes *node = (Lanes *)&m->take[TAKE_COUNT * r->node[a]];

    for (int k = 0; k < TAKE_GRAD / LANES; k++)
      node[k] += r->S[a] * S[k];
    for (int k = 0; k < (TAKE_COUNT - TAKE_GRAD) / LANES; k++)
      LanesAlong(r->G[a], s.G, k, &node[TAKE_GRAD / LANES + k]);
  }
}
