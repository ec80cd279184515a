/* What probes and snapshots compute from a particle's state, a row each: pressure and saturation, invariants of stress
   and strain, distance to yield. */
#include "io_private.h"

#include "clathra/kinematics.h"
#include "clathra/point.h"
#include <string.h>

static double Pressure(const Model *m, PetscInt p)
{
  return ParticlePressure(&m->P, p);
}

static double GasSaturation(const Model *m, PetscInt p)
{
  return 1.0 - m->P.f[P_SH][p] - m->P.f[P_SW][p];
}

static void Stress(const Model *m, PetscInt p, double s[6])
{
  for (int k = 0; k < 6; k++)
    s[k] = m->P.f[P_SIG + k][p];
}

/* Mean effective stress, compression-positive. */
static double MeanStress(const Model *m, PetscInt p)
{
  double s[6];

  Stress(m, p, s);
  return -Trace6(s) / 3.0;
}

/* sqrt(3 J2) of the stress. */
static double Deviator(const Model *m, PetscInt p)
{
  double s[6];

  Stress(m, p, s);
  return Mises6(s);
}

/* Deviatoric logarithmic strain since the start, sqrt(2/3 dev e : dev e). */
static double Shear(const Model *m, PetscInt p)
{
  const Particles *P               = &m->P;
  double           u[MOTION_COUNT] = {0.0}, e[6] = {0.0};
  Kinematics       k;

  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++)
      u[VectorAt(0, i, j)] = P->f[VectorAt(P_F, i, j)][p] - (i == j ? 1.0 : 0.0);
  }

  if (m->c->axisymmetric)
    u[MOTION_HOOP] = P->f[P_X][p] / P->f[P_X0][p] - 1.0;
  if (!KinematicsValues(u, &k))
    return NAN;
  memcpy(e, k.e, sizeof(k.e));
  return 2.0 / 3.0 * Mises6(e);
}

/* Distance to yield; NaN for a particle that cannot. */
static double Margin(const Model *m, PetscInt p)
{
  const SkeletonStore store = ParticlesSkeleton(&m->P, 0, 0.0);
  SkeletonHistory     h;

  SkeletonTake(&store, p, &h);
  return SkeletonMargin(&m->c->material[m->c->region[m->P.i[PI_REGION][p]].material], m->P.f[P_SH][p], &h);
}

static double Yields(const Model *m, PetscInt p)
{
  return m->P.f[P_YIELD][p] != (double)RETURN_ELASTIC;
}

const DerivedQuantity io_derived[] = {
    [DERIVED_P]      = {"p", "Pa", HAS_WATER, Pressure, true},
    [DERIVED_SG]     = {"S_g", "-", HAS_GAS, GasSaturation, true},
    [DERIVED_MEAN]   = {"p_eff", "Pa", HAS_PLASTIC, MeanStress, true},
    [DERIVED_Q]      = {"q", "Pa", HAS_PLASTIC, Deviator, true},
    [DERIVED_SHEAR]  = {"eps_d", "-", HAS_PLASTIC, Shear, true},
    [DERIVED_MARGIN] = {"yield_distance", "Pa", HAS_PLASTIC, Margin, true},
    [DERIVED_YIELDS] = {"yields", "-", HAS_PLASTIC, Yields, false}, /* a snapshot has `yield` of the store */
    {NULL, NULL, 0, NULL, false}};
