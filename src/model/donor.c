/* Gas has the mobility of the nodes it comes from, so that pores without gas give none: (332)-(334) of
   docs/equations.md. */
#include "gather.h"

#define ROUND_OFF 1e-12 /* of the terms of a gradient: less of it has no direction */

/* Direction of the gas that moves through a particle at t_n, by Darcy's law; false where there is none. */
static bool Direction(const Model *m, PetscInt p, const Reach *r, double e[CL_DIM])
{
  const FieldSet *fs  = &m->c->fields;
  double          rho = 0.0, terms = 0.0;

  for (int d = 0; d < CL_DIM; d++)
    e[d] = 0.0;
  for (int a = 0; a < r->n; a++) {
    const PetscInt I  = r->node[a];
    const double   pI = m->x_n[I * fs->n + PlaceP(fs, PHASE_G)];

    terms += VectorLength(r->G[a]) * fabs(pI);
    rho += r->S[a] * m->coef[I * NC_COUNT + NC_RHO + PHASE_G];
    for (int d = 0; d < CL_DIM; d++)
      e[d] -= r->G[a][d] * pI;
  }
  for (int d = 0; d < CL_DIM; d++)
    e[d] += rho * m->bc.gravity[d];
  Drive(m, p, e);
  const double size = VectorLength(e);
  if (size <= ROUND_OFF * terms)
    return false;
  for (int d = 0; d < CL_DIM; d++)
    e[d] /= size;
  return true;
}

#define NEAREST 1e-3 /* of a cell: mean distance of the nodes upstream below which there are none */

/* Weights that favour nodes upstream (332). */
static void DonorOf(const Model *m, PetscInt p, const Reach *r, Donor *donor)
{
  double e[CL_DIM], least = INFINITY, most = 0.0, distance = 0.0;

  *donor = (Donor){.base = 1.0};
  if (!Direction(m, p, r, e))
    return;
  for (int a = 0; a < r->n; a++) {
    const PetscInt I    = r->node[a];
    const double   root = sqrt(m->coef[I * NC_COUNT + NC_KR + PHASE_G]);

    least = fmin(least, root);
    most  = fmax(most, root);
    distance += r->S[a] * fmax(-Upstream(m, p, I, e), 0.0);
  }
  if (distance < NEAREST * NodeWidth(m, r->node[0]))
    return;
  donor->base = least / most;
  for (int d = 0; d < CL_DIM; d++)
    donor->up[d] = (1.0 - donor->base) * e[d] / distance;
}

PetscErrorCode DonorBuild(Model *m)
{
  PetscFunctionBeginUser;
  if (!m->added->donor)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArrayzero(m->added->source, 2 * m->map.n_local));
  for (PetscInt p = 0; p < m->P.n; p++) {
    Reach r;

    ReachExpand(m, p, &r);
    DonorOf(m, p, &r, &m->added->donor[p]);
    m->added->donor[p].kr = 0.0;
    for (int a = 0; a < r.n; a++) {
      const PetscInt I     = r.node[a];
      const double   share = r.S[a] * DonorShare(m, p, I);

      m->added->donor[p].kr += share * m->coef[I * NC_COUNT + NC_KR + PHASE_G];
      m->added->source[2 * I] += share * m->P.f[P_V][p];
      m->added->source[2 * I + 1] += share * ConductingVolume(m, p);
    }
  }
  PetscCall(NodeMapSum(&m->map, m->added->source, 2));
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    if (m->added->source[2 * I + 1] > 0.0) {
      m->added->source[2 * I] /= m->added->source[2 * I + 1];
      continue;
    }
    m->added->source[2 * I]     = m->flow[I]; /* nothing lies downstream of it */
    m->added->source[2 * I + 1] = m->Vk[I];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
