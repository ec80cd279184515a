/* terms: the inside of the boundary conditions.  A row of CL_FACE_CONDITIONS or CL_NODE_CONDITIONS names one function
   here; adding a condition is that function and that row. */
#pragma once

#include "clathra/boundary.h"

/* What the terms of a face see; slopes are those in the inputs IN_GRADU of its particle. */
struct FaceState {
  const Scene    *c;
  const Face     *f;
  const BcValues *v;
  const Material *mat;
  const double   *p0, *in;                             /* as of FaceEvaluate */
  double          Sh, kappa, dt;                       /* -, W/(m K), s */
  double          T;                                   /* at the face, degC */
  double          a[CL_DIM], da[CL_DIM][MOTION_COUNT]; /* area vector, m^2 */
  double          s[CL_DIM], ds[CL_DIM][MOTION_COUNT]; /* that of the true surface (70) */
  double          area, darea[MOTION_COUNT];           /* |s|: over which fluxes per area act */
};

/* Sum over the axes of v_i d a_i, by input k. */
static inline double AlongSlope(const double v[CL_DIM], const double da[CL_DIM][MOTION_COUNT], int k)
{
  double sum = v[0] * da[0][k];

  for (int i = 1; i < CL_DIM; i++)
    sum += v[i] * da[i][k];
  return sum;
}

/* Each adds what condition Case.bc[k] does at the face. */
void FaceTraction(const FaceState *x, PetscInt k, FaceOutput *o);
void FacePressures(const FaceState *x, PetscInt k, FaceOutput *o);
void FaceHeatFlux(const FaceState *x, PetscInt k, FaceOutput *o);
void FaceConvection(const FaceState *x, PetscInt k, FaceOutput *o);
void FaceTemperature(const FaceState *x, PetscInt k, FaceOutput *o);
void FaceInflows(const FaceState *x, PetscInt k, FaceOutput *o);
void FaceWell(const FaceState *x, PetscInt k, FaceOutput *o);
void FaceHeatSource(const FaceState *x, PetscInt k, FaceOutput *o);

/* (152): the drag of the fluid around the body; velocity of the skeleton at the face, m/s. */
void FaceDrag(const FaceState *x, const double velocity[CL_DIM], FaceOutput *o);
