/* The state that a particle starts from; docs/equations.md, section 13. */
#include "clathra/particles.h"
#include "clathra/shape.h"
#include "clathra/point.h"

/* (81): grad is null where the temperature does not grow with depth. */
static double InitialTemperature(const Scene *c, const Region *r, const double x[], double grad[CL_DIM])
{
  const double depth = SceneDatum(c, r->geothermal_datum) - SceneHeight(c, x);

  for (int d = 0; d < CL_DIM; d++)
    grad[d] = 0.0;
  if (r->geothermal == 0.0 || depth <= 0.0)
    return r->temperature;
  for (int d = 0; d < CL_DIM; d++)
    grad[d] = r->geothermal * c->gravity[d] / SceneGravity(c);
  return r->temperature + r->geothermal * depth;
}

double ParticleInitialT(const Scene *c, const Particles *P, PetscInt p)
{
  double x[CL_DIM], grad[CL_DIM];

  ParticleInitialPlace(P, p, x);
  return InitialTemperature(c, &c->region[P->i[PI_REGION][p]], x, grad);
}

/* Integral of exp(-beta (T - T_ref)) over the height from the geothermal datum to z, m. */
static double ThermalHeight(const Scene *c, const Region *r, double z)
{
  const Liquid *water = &c->material[r->material].water;
  const double  above = z - SceneDatum(c, r->geothermal_datum), rate = water->beta * r->geothermal;
  const double  e = exp(-water->beta * (r->temperature - water->T_ref));

  return above >= 0.0 || rate == 0.0 ? e * above : -e * -expm1(rate * above) / rate;
}

double InitialWaterPressure(const Scene *c, const Region *r, double pressure, const double x[])
{
  const Liquid *water  = &c->material[r->material].water;
  const double  height = ThermalHeight(c, r, SceneHeight(c, x)) - ThermalHeight(c, r, r->datum);
  const double  weight = water->rho0 * SceneGravity(c) * height; /* of a column at the reference pressure */

  if (isinf(water->K))
    return pressure - weight;
  return pressure - water->K * log1p(weight / water->K * exp((pressure - water->p_ref) / water->K)); /* head (82) */
}

/* Whether a region starts with hydrate that reacts and with no gas. */
static bool HasHydrateAlone(const Scene *c, const Region *r)
{
  return r->material >= 0 && c->material[r->material].reacts && r->Sh > 0.0 && r->Sg == 0.0;
}

/* (103): p_g where there is no gas, from p_c (Pa) at which the law leaves none.  Water holds some methane; what hydrate
   started with, it has long shared with the water of all layers. */
static double InitialGasPressure(const Scene *c, double pc, const InitialScalars *s)
{
  double pg = fmax(s->pw + pc, CL_GAS_FLOWS * s->pw), dT;

  for (PetscInt k = 0; k < c->nregion; k++) {
    if (HasHydrateAlone(c, &c->region[k]))
      pg = fmin(pg, EquilibriumPressure(&c->material[c->region[k].material].kinetics.equilibrium, s->T, &dT));
  }
  return pg;
}

/* Pressures of the phases from their mean (10). */
static PetscErrorCode InitialPressures(const Scene *c, const Region *r, const Material *mat, const double x[],
                                       InitialScalars *s)
{
  const bool two = c->fields.has & HAS_GAS, none = two && r->Sg == 0.0 && mat->gas.trace > 0.0;
  double     pc = 0.0, d[2];

  PetscFunctionBeginUser;
  s->sg = r->Sg / (1.0 - r->Sh);
  if (none)
    PetscCheck(RetentionNoGas(&mat->retention, r->Sh, &pc), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "region %s: the retention law leaves gas at any pressure", r->name);
  else if (two)
    PetscCheck(RetentionInvert(&mat->retention, s->sg, r->Sh, &pc), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "region %s: the retention law never reaches the initial gas share %g", r->name, s->sg);
  s->pw = r->pressure - s->sg * pc;
  if (r->hydrostatic)
    s->pw = InitialWaterPressure(c, r, s->pw, x);
  s->pg = none ? InitialGasPressure(c, pc, s) : s->pw + pc;
  s->p  = PorePressureOf(s->sg, s->pw, s->pg).v;
  if (two) { /* to the last digit what the law makes of these pressures */
    s->sg = RetentionGasShare(&mat->retention, s->pg - s->pw, r->Sh, &d[0], &d[1]);
    s->p  = PorePressureOf(s->sg, s->pw, s->pg).v;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Masses of hydrate, water, gas and grains in a volume. */
static void Masses(const Scene *c, const Region *r, const InitialScalars *s, double V, double m[4])
{
  const Material *mat = &c->material[r->material];

  PointInitialMasses(&c->fields, mat, &(PointStart){V, mat->porosity, r->Sh, s->sg, s->pw, s->pg, s->T}, m);
}

PetscErrorCode InitialScalarsAt(const Scene *c, const Region *r, const double x[], InitialScalars *s)
{
  const Material *mat = &c->material[r->material];
  double          m[4], dp, dT;

  PetscFunctionBeginUser;
  *s   = (InitialScalars){0};
  s->T = InitialTemperature(c, r, x, s->grad_T);
  if (c->fields.fluid)
    PetscCall(InitialPressures(c, r, mat, x, s));
  for (int d = 0; r->hydrostatic && d < CL_DIM; d++)
    s->grad_p[d] = LiquidDensity(&mat->water, s->pw, s->T, &dp, &dT) * c->gravity[d];
  Masses(c, r, s, 1.0, m);
  s->density = m[0] + m[1] + m[2] + m[3];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Set(Particles *P, PetscInt p, int component, double value)
{
  if (P->f[component])
    P->f[component][p] = value;
}

double ParticleInitialVolume(const Scene *c, const double x[], const double l[])
{
  double V = c->axisymmetric ? 2.0 * M_PI * x[0] : 1.0;

  for (int d = 0; d < CL_DIM; d++)
    V *= 2.0 * l[d];
  return V;
}

PetscErrorCode ParticleInitialState(const Scene *c, PetscInt region, Particles *P, PetscInt p, const double x[],
                                    const double l[])
{
  const Region   *r   = &c->region[region];
  const Material *mat = &c->material[r->material];
  InitialScalars  s;
  const double    V = ParticleInitialVolume(c, x, l);
  double          m[4];

  PetscFunctionBeginUser;
  PetscCall(InitialScalarsAt(c, r, x, &s));
  Masses(c, r, &s, V, m);
  for (int k = 0; k < P_COUNT; k++)
    Set(P, p, k, 0.0);
  for (int d = 0; d < CL_DIM; d++) {
    P->f[P_X + d][p] = x[d];
    P->f[P_L + d][p] = l[d];
    Set(P, p, P_X0 + d, x[d]);
    Set(P, p, P_GW + d, s.grad_p[d]);
    Set(P, p, P_GG + d, s.grad_p[d]);
    Set(P, p, P_GT + d, s.grad_T[d]);
  }
  for (int d = 0; d < CL_DIM; d++)
    Set(P, p, VectorAt(P_F, d, d), 1.0);
  P->f[P_V][p]   = V;
  P->f[P_PHI][p] = mat->porosity;
  P->f[P_SH][p]  = r->Sh;
  Set(P, p, P_SW, r->Sw);
  Set(P, p, P_T, s.T);
  for (int k = 0; k < 2; k++) {
    Set(P, p, k ? P_PW0 : P_PW, s.pw);
    Set(P, p, k ? P_PG0 : P_PG, s.pg);
    for (int i = 0; i < 6; i++)
      Set(P, p, (k ? P_SIG0 : P_SIG) + i, r->stress[i]);
  }
  for (int k = 0; k < 4; k++)
    Set(P, p, P_MS + k, m[k]);
  if (SkeletonLawOf(mat)->start) {
    double own[OWN_COUNT] = {0.0};

    SkeletonLawOf(mat)->start(mat, own);
    for (int k = 0; k < OWN_COUNT; k++)
      Set(P, p, P_HISTORY + k, own[k]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Zero(Particles *P, int first, int n)
{
  for (int k = first; k < first + n; k++)
    for (PetscInt p = 0; P->f[k] && p < P->n; p++)
      P->f[k][p] = 0.0;
}

/* (340): what changes are counted from; the part of the stress that hydrate bears stays a stress of its own. */
void ParticlesBecomeInitial(Particles *P)
{
  Zero(P, P_U, CL_DIM);
  Zero(P, P_LOGJ, 1);
  for (PetscInt p = 0; p < P->n; p++) {
    for (int i = 0; P->f[P_SIG0] && i < 6; i++)
      P->f[P_SIG0 + i][p] = P->f[P_SIG + i][p] - (P->f[P_BOND] && i < CL_TENSOR ? P->f[P_BOND + i][p] : 0.0);
    for (int f = 0; f < PHASE_COUNT; f++)
      Set(P, p, P_PW0 + f, P->f[P_PW + f] ? P->f[P_PW + f][p] : 0.0);
  }
}
