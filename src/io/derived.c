/* What probes and snapshots compute from a particle's state: invariants of stress and strain, distance to yield. */
#include "io_private.h"

#include "clathra/kinematics.h"
#include "clathra/point.h"

double DerivedStress(const Particles *P, PetscInt p, bool deviator)
{
  double s[6];

  for (int k = 0; k < 6; k++)
    s[k] = P->f[P_SIG + k][p];
  return deviator ? Mises6(s) : -Trace6(s) / 3.0;
}

double DerivedShear(const Scene *c, const Particles *P, PetscInt p)
{
  double     u[MOTION_COUNT] = {P->f[P_F][p] - 1.0, P->f[P_F + 1][p], P->f[P_F + 2][p], P->f[P_F + 3][p] - 1.0};
  Kinematics k;

  if (c->axisymmetric)
    u[MOTION_HOOP] = P->f[P_X][p] / P->f[P_X0][p] - 1.0;
  if (!KinematicsEvaluate(u, &k))
    return NAN;
  const double mean = (k.e[0] + k.e[1] + k.e[3]) / 3.0, x = k.e[0] - mean, y = k.e[1] - mean, z = k.e[3] - mean;
  return sqrt(2.0 / 3.0 * (x * x + y * y + z * z + 2.0 * k.e[2] * k.e[2]));
}

double DerivedMargin(const Model *m, PetscInt p)
{
  const SkeletonStore store = ParticlesSkeleton(&m->P, 0, 0.0);
  SkeletonHistory     h;

  SkeletonTake(&store, p, &h);
  return SkeletonMargin(&m->c->material[m->c->region[m->P.i[PI_REGION][p]].material], m->P.f[P_SH][p], &h);
}
