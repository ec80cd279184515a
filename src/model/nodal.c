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
  const FieldSet *fs    = &m->c->fields;
  const bool      donor = m->added->donor;
  int             at[PHASE_COUNT]; /* of a fluid that is not there: the other's, for nobody */

  PetscFunctionBeginUser;
  for (int f = 0; f < PHASE_COUNT; f++)
    at[f] = PlaceP(fs, fs->phase[f] ? f : 1 - f);
  if (!fs->fluid)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArrayzero(proj, CL_FLUID_VECTORS * m->map.n_local));
  for (PetscInt p = 0; p < m->P.n; p++) {
    const double Vk                  = ConductingVolume(m, p);
    double       g[CL_FLUID_VECTORS] = {0.0};
    Reach        r;

    ReachExpand(m, p, &r);
    for (int a = 0; a < r.n; a++) {
      const double *xI = &x[r.node[a] * fs->n], pI[PHASE_COUNT] = {xI[at[PHASE_W]], xI[at[PHASE_G]]};

      for (int k = 0; k < CL_FLUID_VECTORS; k++)
        g[k] += r.G[a][k % CL_DIM] * pI[k / CL_DIM];
    }
    for (int f = 0; m->beds && f < PHASE_COUNT; f++) {
      double w[CL_DIM] = {0.0};

      if (!slope)
        BedsWeight(m, p, f, w);
      for (int d = 0; d < CL_DIM; d++)
        g[VectorAt(0, f, d)] -= w[d];
      BedsDrive(&m->beds[p].A, &g[VectorAt(0, f, 0)]);
    }
    for (int a = 0; a < r.n; a++) {
      const double VS    = Vk * r.S[a];
      const double of[2] = {VS, donor ? VS * DonorShare(m, p, r.node[a]) : VS};

      for (int k = 0; k < CL_FLUID_VECTORS; k++)
        proj[CL_FLUID_VECTORS * r.node[a] + k] += of[k / CL_DIM] * g[k];
    }
  }
  PetscCall(NodeMapSum(&m->map, proj, CL_FLUID_VECTORS));
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    for (int k = 0; k < CL_FLUID_VECTORS; k++)
      proj[CL_FLUID_VECTORS * I + k] /= Donated(m, k / CL_DIM) ? m->added->source[2 * I + 1] : m->Vk[I];
    for (int f = 0; f < PHASE_COUNT; f++)
      ShareOut(m, I, &proj[VectorAt(CL_FLUID_VECTORS * I, f, 0)]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ModelGive(Model *m, const double *x, bool slope)
{
  const FieldSet *fs = &m->c->fields;

  for (PetscInt I = 0; I < m->map.n_local; I++) {
    const double *now = &x[I * fs->n];
    double       *to  = &m->give[GIVE_COUNT * I];

    for (int q = F_PW; q <= F_T; q++) {
      const int k = fs->at[q];

      if (k < 0)
        continue;
      const double start         = slope ? 0.0 : m->x_n[I * fs->n + k];
      to[GIVE_SCALAR + q - F_PW] = now[k] - start;
      to[GIVE_START + q - F_PW]  = start;
      to[GIVE_GRAD + q - F_PW]   = now[k];
    }
    for (int d = 0; fs->solid && d < CL_DIM; d++)
      to[GIVE_U + d] = to[GIVE_MOTION + d] =
          (slope ? 0.0 : m->stage.u_star[I * CL_DIM + d]) + m->stage.dt * now[PlaceVs(fs) + d];
    for (int f = 0; f < PHASE_COUNT; f++) {
      double *J = &to[VectorAt(GIVE_J, f, 0)];

      if (!fs->phase[f])
        continue;
      SharedFlux(m, I, f, now, J);
      for (int d = 0; d < CL_DIM; d++) {
        J[d] *= m->flow[I];
        to[VectorAt(GIVE_PROJ, f, d)] = m->proj[VectorAt(0, PHASE_COUNT * I + f, d)];
      }
    }
  }
}
