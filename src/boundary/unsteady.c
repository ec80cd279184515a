/* Starts that do not stay as they are: pore pressure far from hydrostatic, hydrate that is not stable, gas where
   hydrate is (docs/equations.md, section 13). */
#include "clathra/boundary.h"

#define FAR 0.1         /* of the weight of the water from top to foot */
#define NOTICEABLE 0.01 /* of the largest pressure */
#define OUTSIDE 1.01    /* p_e over p */
#define WARMS 0.5       /* K: by how much hydrate that forms warms the sediment until p_e(T) = p */
#define SOME_GAS 1e-3   /* of the pores */

/* The largest of a value over all particles, and where it is. */
typedef struct {
  double value, x[CL_DIM], p, T;
  int    region;
} Most;

static void MostTake(Most *m, const Scene *c, const Particles *P, PetscInt i, double value, double p)
{
  const int region = (int)P->i[PI_REGION][i];

  if (value > m->value)
    *m = (Most){
        .value = value, .x = {P->f[P_X][i], P->f[P_X + 1][i]}, .p = p, .T = ParticleT(c, P, i), .region = region};
}

static PetscErrorCode MostOfAll(MPI_Comm comm, Most *m)
{
  PetscMPIInt rank;
  struct {
    double value;
    int    rank;
  } best;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  best.value = m->value;
  best.rank  = rank;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &best, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm));
  PetscCallMPI(MPI_Bcast(m, sizeof(*m), MPI_BYTE, best.rank, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- hydrostatic */
/* Mean density of the water, kg/m^3; the weight of its column from top to foot and the largest pressure, Pa. */
static PetscErrorCode Column(MPI_Comm comm, const Scene *c, const Particles *P, double *rho, double *weight,
                             double *top)
{
  double sum[2] = {0.0, 0.0}, most[3] = {-INFINITY, -INFINITY, 0.0}, dp, dT;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < P->n; p++) {
    const Region *r   = &c->region[P->i[PI_REGION][p]];
    const double  x[] = {P->f[P_X][p], P->f[P_X + 1][p]}, z = SceneHeight(c, x), T = ParticleT(c, P, p);
    const double  reach = fmax(P->f[P_L][p], P->f[P_L + 1][p]);

    sum[0] += P->f[P_V][p];
    sum[1] += P->f[P_V][p] * LiquidDensity(&c->material[r->material].water, P->f[P_PW][p], T, &dp, &dT);
    most[0] = fmax(most[0], z + reach);
    most[1] = fmax(most[1], reach - z);
    most[2] = fmax(most[2], fabs(P->f[P_PW][p]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_DOUBLE, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 3, MPI_DOUBLE, MPI_MAX, comm));
  *rho    = sum[1] / sum[0];
  *weight = *rho * SceneGravity(c) * (most[0] + most[1]);
  *top    = most[2];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (341): the pressure beyond that of water at rest is the same all over where water is at rest. */
static PetscErrorCode PressureWarning(MPI_Comm comm, const Scene *c, const Particles *P)
{
  Most   high = {.value = -INFINITY}, low = {.value = -INFINITY};
  double rho = 0.0, weight = 0.0, top = 0.0;

  PetscFunctionBeginUser;
  if (!c->fields.phase[PHASE_W] || SceneGravity(c) == 0.0 || c->gravity_ramp > 0.0)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Column(comm, c, P, &rho, &weight, &top));
  for (PetscInt p = 0; p < P->n; p++) {
    const double x[] = {P->f[P_X][p], P->f[P_X + 1][p]}, pw = P->f[P_PW][p],
                 beyond = pw + rho * SceneGravity(c) * SceneHeight(c, x);

    MostTake(&high, c, P, p, beyond, pw);
    MostTake(&low, c, P, p, -beyond, pw);
  }
  PetscCall(MostOfAll(comm, &high));
  PetscCall(MostOfAll(comm, &low));
  const double apart = high.value + low.value;

  if (apart < FAR * weight || apart < NOTICEABLE * top)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFPrintf(
      comm, stderr,
      "clathra: warning: the pore pressure starts far from hydrostatic: region %s at (%g m, %g m) has %.3g Pa "
      "more beyond water at rest than region %s at (%g m, %g m), and the water weighs %.3g Pa from top to "
      "foot: it will flow from the start (hydrostatic: yes with one datum, or -restart_as_initial of a run "
      "that came to rest, starts in balance)\n",
      c->region[high.region].name, high.x[0], high.x[1], apart, c->region[low.region].name, low.x[0], low.x[1],
      weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- hydrate */
/* Temperature (degC) of equilibrium at a pressure, by halving; p_e grows with T. */
static double EquilibriumTemperature(const Equilibrium *law, double p)
{
  double low = -50.0, high = 50.0, d;

  for (int k = 0; k < 60; k++) {
    const double T = 0.5 * (low + high);

    if (EquilibriumPressure(law, T, &d) < p)
      low = T;
    else
      high = T;
  }
  return 0.5 * (low + high);
}

static PetscErrorCode HydrateWarning(MPI_Comm comm, const Scene *c, const Particles *P)
{
  Most   worst   = {.value = 0.0};
  double mass[2] = {0.0, 0.0}, d; /* of hydrate that reacts, outside and in all */

  PetscFunctionBeginUser;
  for (PetscInt p = 0; c->fields.phase[PHASE_G] && p < P->n; p++) {
    const Material *m    = &c->material[c->region[P->i[PI_REGION][p]].material];
    const double    mean = ParticlePressure(P, p);

    if (!m->reacts || m->kinetics.K0 == 0.0 || P->f[P_SH][p] <= 0.0)
      continue;
    const double over = EquilibriumPressure(&m->kinetics.equilibrium, ParticleT(c, P, p), &d) / mean;

    mass[0] += over > OUTSIDE ? P->f[P_MH][p] : 0.0;
    mass[1] += P->f[P_MH][p];
    MostTake(&worst, c, P, p, over, mean);
  }
  PetscCall(MostOfAll(comm, &worst));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, mass, 2, MPI_DOUBLE, MPI_SUM, comm));
  if (worst.value <= OUTSIDE)
    PetscFunctionReturn(PETSC_SUCCESS);
  const Equilibrium *law = &c->material[c->region[worst.region].material].kinetics.equilibrium;

  PetscCall(PetscFPrintf(
      comm, stderr,
      "clathra: warning: hydrate starts outside its stability zone, %.3g %% of it; most in region %s at (%g m, %g m): "
      "at %.4g degC it needs %.4g Pa and has %.4g Pa, where it is stable up to %.4g degC: it dissociates from the "
      "start (more pressure, a lower temperature, or a first stage with kinetics_active: no)\n",
      100.0 * mass[0] / mass[1], c->region[worst.region].name, worst.x[0], worst.x[1], worst.T,
      EquilibriumPressure(law, worst.T, &d), worst.p, EquilibriumTemperature(law, worst.p)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gas and water that become hydrate: where T_e(p) - T > WARMS. */
static PetscErrorCode FormationWarning(MPI_Comm comm, const Scene *c, const Particles *P)
{
  Most   worst = {.value = -INFINITY};
  double d;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; c->fields.phase[PHASE_G] && p < P->n; p++) {
    const Material *m  = &c->material[c->region[P->i[PI_REGION][p]].material];
    const Kinetics *k  = &m->kinetics;
    const double    Sh = P->f[P_SH][p], Sw = P->f[P_SW][p], p_mean = ParticlePressure(P, p), T = ParticleT(c, P, p);

    if (!m->reacts || k->K0 == 0.0 || k->A_geo == 0.0 || !(Sw > 0.0) || !(1.0 - Sh - Sw > SOME_GAS) ||
        EquilibriumPressure(&k->equilibrium, T + WARMS, &d) >= p_mean)
      continue;
    MostTake(&worst, c, P, p, EquilibriumTemperature(&k->equilibrium, p_mean) - T, p_mean);
  }
  PetscCall(MostOfAll(comm, &worst));
  if (!(worst.value > WARMS))
    PetscFunctionReturn(PETSC_SUCCESS);
  const Equilibrium *law = &c->material[c->region[worst.region].material].kinetics.equilibrium;

  PetscCall(PetscFPrintf(
      comm, stderr,
      "clathra: warning: free gas starts where hydrate is stable, most in region %s at (%g m, %g m): at %.4g degC "
      "hydrate forms above %.4g Pa and there are %.4g Pa, up to %.4g degC: gas and water turn into hydrate from the "
      "start (Sg: 0, less pressure or a higher temperature starts in balance, or a first stage with kinetics_active: "
      "no)\n",
      c->region[worst.region].name, worst.x[0], worst.x[1], worst.T, EquilibriumPressure(law, worst.T, &d), worst.p,
      worst.T + worst.value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode UnsteadyWarnings(MPI_Comm comm, const Scene *c, const Particles *P)
{
  PetscFunctionBeginUser;
  PetscCall(PressureWarning(comm, c, P));
  PetscCall(HydrateWarning(comm, c, P));
  PetscCall(FormationWarning(comm, c, P));
  PetscFunctionReturn(PETSC_SUCCESS);
}
