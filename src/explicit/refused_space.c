/* In space there are no integrators without a matrix.  SceneNeedsImplicit keeps every scene from them, by name; what
   would get here all the same is an error of the program. */
#include "clathra/explicit.h"

#define REFUSE SETERRQ(PETSC_COMM_SELF, PETSC_ERR_PLIB, "an integrator without a matrix was asked for in space")

const char *const cl_limit_word[LIMIT_COUNT] = {"none"};

PetscErrorCode ExplicitCreate(PETSC_UNUSED Model *m, PETSC_UNUSED const ExplicitOptions *o, PETSC_UNUSED Explicit **e)
{
  REFUSE;
}

PetscErrorCode ExplicitDestroy(PETSC_UNUSED Explicit **e)
{
  REFUSE;
}

PetscErrorCode ExplicitBegin(PETSC_UNUSED Explicit *e, PETSC_UNUSED ClStatus *status)
{
  REFUSE;
}

PetscErrorCode ExplicitStableStep(PETSC_UNUSED const Explicit *e, PETSC_UNUSED StableStep *limit)
{
  REFUSE;
}

PetscErrorCode ExplicitStep(PETSC_UNUSED Explicit *e, PETSC_UNUSED double t, PETSC_UNUSED double dt,
                            PETSC_UNUSED StageRates *sum, PETSC_UNUSED ClStatus *status)
{
  REFUSE;
}

PetscErrorCode ExplicitEnd(PETSC_UNUSED Explicit *e)
{
  REFUSE;
}

double ExplicitMassScalingError(PETSC_UNUSED const Explicit *e)
{
  return NAN;
}

double ExplicitBytesPerParticle(PETSC_UNUSED const Explicit *e)
{
  return NAN;
}
