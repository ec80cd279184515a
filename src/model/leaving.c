/* Particles that cross the edge of the grid, where the case has them taken out of the run (373). */
#include "gather.h"

static bool Outside(const Model *m, PetscInt p)
{
  double x[CL_DIM];

  ParticleGridPlace(&m->P, p, x);
  PetscInt cell[CL_DIM];

  return !GridCell(&m->grid, x, cell);
}

/* Adds the particle, as it is, to what left. */
static PetscErrorCode Book(Model *m, PetscInt p, double t)
{
  Leaving       *l        = &m->leaving;
  double *const *f        = m->P.f;
  const double   phase[3] = {f[P_MS][p] + f[P_MH][p], f[P_MW] ? f[P_MW][p] : 0.0, f[P_MG] ? f[P_MG][p] : 0.0};
  ModelTotals    held     = {0};
  double        *sum      = l->sum;

  PetscFunctionBeginUser;
  ModelAddTotals(m, p, &held);
  ModelAddEnergies(m, p, &sum[REMOVED_ENERGY]);
  sum[REMOVED_N] += 1.0;
  sum[REMOVED_SOLID] += held.solid;
  sum[REMOVED_HYDRATE] += held.hydrate;
  sum[REMOVED_WATER] += held.water;
  sum[REMOVED_METHANE] += held.methane;
  sum[REMOVED_ENTHALPY] += held.enthalpy;
  for (int k = 0; k < 3; k++) {
    for (int d = 0; f[P_VS + CL_DIM * k] && d < CL_DIM; d++)
      sum[REMOVED_MOMENTUM + d] += phase[k] * f[P_VS + CL_DIM * k + d][p];
  }
  if (l->n == l->cap) {
    l->cap = 2 * l->cap + 16;
    PetscCall(PetscRealloc(sizeof(*l->one) * (size_t)l->cap, &l->one));
  }
  l->one[l->n++] = (LeavingParticle){.id     = (double)m->P.i[PI_ID][p],
                                     .region = (double)m->P.i[PI_REGION][p],
                                     .t      = t,
                                     .mass   = phase[0] + phase[1] + phase[2]};
  ParticlePlace(&m->P, p, l->one[l->n - 1].x);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ModelForgetLeaving(Model *m)
{
  m->leaving.n = 0;
  memset(m->leaving.sum, 0, sizeof(m->leaving.sum));
}

/* Those that stay keep their order. */
PetscErrorCode ModelTakeOut(Model *m, double t)
{
  PetscInt *order, stay = 0, left = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; m->leaving.removes && p < m->P.n; p++)
    left += Outside(m, p);
  if (left == 0)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(m->P.n, &order));
  for (PetscInt p = 0; p < m->P.n; p++) {
    if (!Outside(m, p)) {
      order[stay++] = p;
      continue;
    }
    PetscCall(Book(m, p, t));
    order[m->P.n - left--] = p;
  }
  PetscCall(ParticlesPermute(&m->P, order));
  PetscCall(ParticlesResize(&m->P, stay));
  PetscCall(PetscFree(order));
  PetscFunctionReturn(PETSC_SUCCESS);
}
