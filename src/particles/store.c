/* The structure-of-arrays particle store. */
#include "clathra/particles.h"

#define CL_PARTICLE_ROW(id, fields, hdf5, ncomp, units, meaning)                                                       \
  {.name = hdf5, .unit = units, .doc = meaning, .first = id, .nc = ncomp, .has = fields},
const ParticleVariable cl_particle_variable[] = {CL_PARTICLE_TABLE(CL_PARTICLE_ROW){.name = NULL}};

PetscErrorCode ParticlesCreate(unsigned has, Particles *P)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(P, sizeof(*P)));
  P->has = has;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ParticlesDestroy(Particles *P)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < P_COUNT; k++)
    PetscCall(PetscFree(P->f[k]));
  for (int k = 0; k < PI_COUNT; k++)
    PetscCall(PetscFree(P->i[k]));
  P->n = P->cap = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ParticlesResize(Particles *P, PetscInt n)
{
  PetscFunctionBeginUser;
  if (n > P->cap || !P->f[0]) {
    const PetscInt cap = PetscMax(n + n / 8, 16);

    for (const ParticleVariable *v = cl_particle_variable; v->name; v++) {
      for (int k = v->first; k < v->first + v->nc && ParticlesHold(P, v); k++)
        PetscCall(PetscRealloc(sizeof(double) * (size_t)cap, &P->f[k]));
    }
    for (int k = 0; k < PI_COUNT; k++)
      PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)cap, &P->i[k]));
    P->cap = cap;
  }
  P->n = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ParticlesCopy(const Particles *from, Particles *to)
{
  PetscFunctionBeginUser;
  PetscCheck(to->has == from->has, PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP, "the stores hold different fields");
  PetscCall(ParticlesResize(to, from->n));
  for (int k = 0; k < P_COUNT; k++) {
    if (from->f[k])
      PetscCall(PetscArraycpy(to->f[k], from->f[k], from->n));
  }
  for (int k = 0; k < PI_COUNT; k++)
    PetscCall(PetscArraycpy(to->i[k], from->i[k], from->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ParticlesPermute(Particles *P, const PetscInt order[])
{
  double   *real;
  PetscInt *integer;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(P->n, &real, P->n, &integer));
  for (int k = 0; k < P_COUNT; k++) {
    if (!P->f[k])
      continue;
    for (PetscInt p = 0; p < P->n; p++)
      real[p] = P->f[k][order[p]];
    PetscCall(PetscArraycpy(P->f[k], real, P->n));
  }
  for (int k = 0; k < PI_COUNT; k++) {
    for (PetscInt p = 0; p < P->n; p++)
      integer[p] = P->i[k][order[p]];
    PetscCall(PetscArraycpy(P->i[k], integer, P->n));
  }
  PetscCall(PetscFree2(real, integer));
  PetscFunctionReturn(PETSC_SUCCESS);
}
