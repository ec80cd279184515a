/* Nodal values from the solver, and projected from particles. */
#include "gather.h"

PetscErrorCode ModelUnscale(Model *m, Vec X, double *x)
{
  const PetscInt n = m->c->fields.n;
  const double  *a;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(X, &a));
  for (PetscInt k = 0; k < m->map.n_owned * n; k++)
    x[k] = a[k] * m->col_scale[k];
  PetscCall(VecRestoreArrayRead(X, &a));
  PetscCall(NodeMapBroadcast(&m->map, x, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelProjectGradients(Model *m, const double *x, bool slope, double *proj)
{
  const FieldSet *fs = &m->c->fields;

  PetscFunctionBeginUser;
  if (!fs->fluid || !m->c->stabilisation.flux_interpolation)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArrayzero(proj, 4 * m->map.n_local));
  for (PetscInt p = 0; p < m->P.n; p++) {
    const double Vk   = ConductingVolume(m, p);
    double       g[4] = {0.0};
    Reach        r;

    ReachExpand(m, p, &r);
    for (int f = 0; f < PHASE_COUNT; f++) {
      for (int a = 0; fs->phase[f] && a < r.n; a++) {
        const double pI = x[r.node[a] * fs->n + PlaceP(fs, f)];

        for (int d = 0; d < CL_DIM; d++)
          g[VectorAt(0, f, d)] += r.G[a][d] * pI;
      }
    }
    for (int f = 0; m->beds && f < PHASE_COUNT; f++) {
      double w[CL_DIM] = {0.0};

      if (!slope)
        BedsWeight(m, p, f, w);
      BedsDriveMoving(&m->beds[p].A, w, &g[VectorAt(0, f, 0)]);
    }
    for (int a = 0; a < r.n; a++) {
      const double VS    = Vk * r.S[a];
      const double of[2] = {VS, m->added->donor ? VS * DonorShare(m, p, r.node[a]) : VS};

      for (int k = 0; k < 4; k++)
        proj[4 * r.node[a] + k] += of[k / CL_DIM] * g[k];
    }
  }
  PetscCall(NodeMapSum(&m->map, proj, 4));
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    for (int k = 0; k < 4; k++)
      proj[4 * I + k] /= Donated(m, k / CL_DIM) ? m->added->source[2 * I + 1] : m->Vk[I];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
