/* Starts that do not stay as they are: pore pressure far from hydrostatic, gas that rises, hydrate that is not stable,
   gas where hydrate is (docs/equations.md, section 13). */
#include "findings_private.h"
#include "clathra/point_flow.h"
#include "clathra/shape.h"
#include "clathra/words.h"

#define FAR 0.1         /* of the weight of the water from top to foot */
#define NOTICEABLE 0.01 /* of the largest pressure */
#define MOVES 0.01      /* of the height of the body, in the whole run: less and gas does not count as moving */
#define DAY 86400.0     /* s */
#define OUTSIDE 1.01    /* p_e over p */
#define WARMS 0.5       /* K: by how much hydrate that forms warms the sediment until p_e(T) = p */
#define SOME_GAS 1e-3   /* of the pores */

/* The largest of a value over all particles, and where it is. */
typedef struct {
  double value, x[CL_DIM], p, T;
  int    region;
} Most;

static void MostTake(Most *most, const Scene *c, const Particles *P, PetscInt i, double value, double p)
{
  const int region = (int)P->i[PI_REGION][i];

  if (value > most->value) {
    *most = (Most){.value = value, .p = p, .T = ParticleT(c, P, i), .region = region};
    ParticlePlace(P, i, most->x);
  }
}

/* ---------------------------------------------------------------- hydrostatic */
/* What water at rest would be in this body. */
typedef struct {
  double rho, height, weight; /* mean density, kg/m^3; of the body, m; of the water from top to foot, Pa */
  double top;                 /* largest pressure of the water, Pa */
} Column;

/* All zero where gravity does not move the water. */
static PetscErrorCode ColumnOf(const Findings *f, Column *w)
{
  const Scene     *c      = f->s->model->c;
  const Particles *P      = &f->s->model->P;
  double           sum[2] = {0.0, 0.0}, most[3] = {-INFINITY, -INFINITY, 0.0}, dp, dT;

  PetscFunctionBeginUser;
  *w = (Column){.weight = 0.0};
  if (!c->fields.phase[PHASE_W] || SceneGravity(c) == 0.0 || c->gravity_ramp > 0.0)
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt p = 0; p < P->n; p++) {
    const Region *r = &c->region[P->i[PI_REGION][p]];
    const double  T = ParticleT(c, P, p);
    double        x[CL_DIM], reach = 0.0;

    ParticlePlace(P, p, x);
    for (int d = 0; d < CL_DIM; d++)
      reach = fmax(reach, P->f[P_L + d][p]);
    const double z = SceneHeight(c, x);

    sum[0] += P->f[P_V][p];
    sum[1] += P->f[P_V][p] * LiquidDensity(&c->material[r->material].water, P->f[P_PW][p], T, &dp, &dT);
    most[0] = fmax(most[0], z + reach);
    most[1] = fmax(most[1], reach - z);
    most[2] = fmax(most[2], fabs(P->f[P_PW][p]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_DOUBLE, MPI_SUM, f->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 3, MPI_DOUBLE, MPI_MAX, f->comm));
  w->rho    = sum[1] / sum[0];
  w->height = most[0] + most[1];
  w->weight = w->rho * SceneGravity(c) * w->height;
  w->top    = most[2];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Are pressures that are so far apart (Pa) worth a word? */
static bool FarApart(const Column *w, double apart)
{
  return apart >= FAR * w->weight && apart >= NOTICEABLE * w->top;
}

/* (341): the pressure beyond that of water at rest is the same all over where water is at rest. */
PetscErrorCode FindingsFindFarPressure(Findings *f, FindingId id)
{
  const Scene     *c    = f->s->model->c;
  const Particles *P    = &f->s->model->P;
  Most             high = {.value = -INFINITY}, low = {.value = -INFINITY};
  Column           w;

  PetscFunctionBeginUser;
  PetscCall(ColumnOf(f, &w));
  if (w.weight == 0.0)
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt p = 0; p < P->n; p++) {
    const double pw = P->f[P_PW][p];
    double       x[CL_DIM];

    ParticlePlace(P, p, x);
    const double beyond = pw + w.rho * SceneGravity(c) * SceneHeight(c, x);

    MostTake(&high, c, P, p, beyond, pw);
    MostTake(&low, c, P, p, -beyond, pw);
  }
  PetscCall(GridShareLargest(f->comm, &high, sizeof(Most)));
  PetscCall(GridShareLargest(f->comm, &low, sizeof(Most)));
  const double apart = high.value + low.value;

  if (!FarApart(&w, apart))
    PetscFunctionReturn(PETSC_SUCCESS);
  SAY("the pore pressure starts far from hydrostatic: region %s at %s has %s more beyond water at rest than region %s "
      "at %s, and the water weighs %s from top to foot: it will flow from the start",
      c->region[high.region].name, PlaceWords(high.x).s, PressureWords(apart, 3).s, c->region[low.region].name,
      PlaceWords(low.x).s, PressureWords(w.weight, 3).s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- gas under gravity */
/* (316): how fast gas moves for every Pa/m that drives it, m^2/(Pa s), and its density, kg/m^3; 0 where it has no
   relative permeability of its own, or the state is no start. */
static double GasMoves(const Scene *c, const Particles *P, PetscInt p, double *rho)
{
  const Material     *m  = &c->material[c->region[P->i[PI_REGION][p]].material];
  const double        pw = P->f[P_PW][p], pg = P->f[P_PG] ? P->f[P_PG][p] : pw;
  const PointContents x = {P->f[P_V][p], P->f[P_MS][p], P->f[P_MH][p], pw, pg, ParticleT(c, P, p)};
  const char         *why;
  PointProperties     q;

  if (PointPropertiesEvaluate(&c->fields, m, &x, &q, &why) != CL_OK || !(q.kr[PHASE_G] > CL_MOBILITY_FLOOR))
    return 0.0;
  *rho = q.rho[PHASE_G];
  return q.kr[PHASE_G] / (q.resist[PHASE_G] * q.phi * (1.0 - q.Sh) * q.s[PHASE_G]);
}

/* Gas of one region that moves by more than MOVES in `span` (s). */
typedef struct {
  Most   high, low; /* e_g of (315), Pa, and its negative */
  double fastest;   /* (316), m^2/(Pa s) */
} Buoyancy;

/* Mean density of that gas, kg/m^3; 0: there is none. */
static PetscErrorCode MovingGas(MPI_Comm comm, const Scene *c, const Particles *P, PetscInt region, double least,
                                double *mean)
{
  double sum[2] = {0.0, 0.0}, rho = 0.0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < P->n; p++) {
    if (P->i[PI_REGION][p] != region || !(GasMoves(c, P, p, &rho) > least))
      continue;
    sum[0] += P->f[P_V][p];
    sum[1] += P->f[P_V][p] * rho;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_DOUBLE, MPI_SUM, comm));
  *mean = sum[0] > 0.0 ? sum[1] / sum[0] : 0.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BuoyancyOf(MPI_Comm comm, const Scene *c, const Particles *P, PetscInt region, double least,
                                 double mean, Buoyancy *b)
{
  PetscFunctionBeginUser;
  *b = (Buoyancy){.high = {.value = -INFINITY}, .low = {.value = -INFINITY}};
  for (PetscInt p = 0; p < P->n; p++) {
    double       rho, x[CL_DIM];
    const double pg = P->f[P_PG] ? P->f[P_PG][p] : P->f[P_PW][p];

    ParticlePlace(P, p, x);
    const double moves = P->i[PI_REGION][p] == region ? GasMoves(c, P, p, &rho) : 0.0;
    const double e     = pg + mean * SceneGravity(c) * SceneHeight(c, x);

    if (!(moves > least))
      continue;
    b->fastest = fmax(b->fastest, moves);
    MostTake(&b->high, c, P, p, e, pg);
    MostTake(&b->low, c, P, p, -e, pg);
  }
  PetscCall(GridShareLargest(comm, &b->high, sizeof(Most)));
  PetscCall(GridShareLargest(comm, &b->low, sizeof(Most)));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &b->fastest, 1, MPI_DOUBLE, MPI_MAX, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static double Apart(const double a[CL_DIM], const double b[CL_DIM])
{
  double between[CL_DIM];

  for (int d = 0; d < CL_DIM; d++)
    between[d] = a[d] - b[d];
  return VectorLength(between);
}

/* (315) of the first region where it holds in the time of the run. */
PetscErrorCode FindingsFindRisingGas(Findings *f, FindingId id)
{
  const Scene     *c = f->s->model->c;
  const Particles *P = &f->s->model->P;
  Column           w;

  PetscFunctionBeginUser;
  PetscCall(ColumnOf(f, &w));
  if (w.weight == 0.0)
    PetscFunctionReturn(PETSC_SUCCESS);
  const double least = MOVES * w.height / ((f->c->t_end - f->c->scene.t_begin) * w.rho * SceneGravity(c));

  for (PetscInt k = 0; c->fields.phase[PHASE_G] && k < c->nregion; k++) {
    double   mean = 0.0;
    Buoyancy b;

    if (RegionEmpty(&c->region[k]))
      continue;
    PetscCall(MovingGas(f->comm, c, P, k, least, &mean));
    if (!(mean > 0.0))
      continue;
    PetscCall(BuoyancyOf(f->comm, c, P, k, least, mean, &b));
    const double apart = b.high.value + b.low.value, away = Apart(b.high.x, b.low.x);

    if (!FarApart(&w, apart))
      continue;
    SAY("gas starts out of balance with gravity: in region %s it has %s more at %s than gas at rest would, seen from "
        "%s, and moves there from the start, by up to some %.2g m a day",
        c->region[k].name, PressureWords(apart, 3).s, PlaceWords(b.high.x).s, PlaceWords(b.low.x).s,
        b.fastest * apart / away * DAY);
    break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- hydrate */
PetscErrorCode FindingsFindUnstableHydrate(Findings *f, FindingId id)
{
  const Scene     *c       = f->s->model->c;
  const Particles *P       = &f->s->model->P;
  Most             worst   = {.value = 0.0};
  double           mass[2] = {0.0, 0.0}, d; /* of hydrate that reacts, outside and in all */

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
  PetscCall(GridShareLargest(f->comm, &worst, sizeof(Most)));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, mass, 2, MPI_DOUBLE, MPI_SUM, f->comm));
  if (worst.value <= OUTSIDE)
    PetscFunctionReturn(PETSC_SUCCESS);
  const Equilibrium *law = &c->material[c->region[worst.region].material].kinetics.equilibrium;

  SAY("hydrate starts outside its stability zone, %.3g %% of it; most in region %s at %s: at %.4g degC it needs %s and "
      "has %s, where it is stable up to %.4g degC: it dissociates from the start",
      100.0 * mass[0] / mass[1], c->region[worst.region].name, PlaceWords(worst.x).s, worst.T,
      PressureWords(EquilibriumPressure(law, worst.T, &d), 4).s, PressureWords(worst.p, 4).s,
      EquilibriumTemperature(law, worst.p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static bool Forms(const Material *m)
{
  return m->reacts && m->kinetics.K0 > 0.0 && m->kinetics.A_geo > 0.0;
}

/* The first material whose hydrate forms, or NULL. */
static const Material *AnyForms(const Scene *c)
{
  for (PetscInt k = 0; k < c->nregion; k++) {
    const Material *m = RegionEmpty(&c->region[k]) ? NULL : &c->material[c->region[k].material];

    if (m && Forms(m))
      return m;
  }
  return NULL;
}

/* Most of what T_e(p) - T > WARMS of gas that hydrate of its own material can form of, or only that beside it. */
static PetscErrorCode FindForming(MPI_Comm comm, const Scene *c, const Particles *P, bool own, Most *worst)
{
  const Material *any = AnyForms(c);
  double          d;

  PetscFunctionBeginUser;
  *worst = (Most){.value = -INFINITY};
  for (PetscInt p = 0; any && c->fields.phase[PHASE_G] && p < P->n; p++) {
    const Material    *m   = &c->material[c->region[P->i[PI_REGION][p]].material];
    const Equilibrium *law = Forms(m) ? &m->kinetics.equilibrium : &any->kinetics.equilibrium;
    const double       Sh = P->f[P_SH][p], Sw = P->f[P_SW][p], p_mean = ParticlePressure(P, p), T = ParticleT(c, P, p);

    if (Forms(m) != own || !(Sw > 0.0) || !(1.0 - Sh - Sw > SOME_GAS) ||
        EquilibriumPressure(law, T + WARMS, &d) >= p_mean)
      continue;
    MostTake(worst, c, P, p, EquilibriumTemperature(law, p_mean) - T, p_mean);
  }
  PetscCall(GridShareLargest(comm, worst, sizeof(Most)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gas and water that become hydrate, of their own material or of one beside theirs. */
PetscErrorCode FindingsFindForming(Findings *f, FindingId id)
{
  const bool   own = id == FINDING_FORMING;
  const Scene *c   = f->s->model->c;
  Most         worst;
  double       d;

  PetscFunctionBeginUser;
  PetscCall(FindForming(f->comm, c, &f->s->model->P, own, &worst));
  if (!(worst.value > WARMS))
    PetscFunctionReturn(PETSC_SUCCESS);
  const Material    *m   = &c->material[c->region[worst.region].material];
  const Equilibrium *law = Forms(m) ? &m->kinetics.equilibrium : &AnyForms(c)->kinetics.equilibrium;

  SAY("free gas starts where hydrate is stable, most in region %s at %s: at %.4g degC hydrate forms above %s and there "
      "are %s, up to %.4g degC: %s",
      c->region[worst.region].name, PlaceWords(worst.x).s, worst.T,
      PressureWords(EquilibriumPressure(law, worst.T, &d), 4).s, PressureWords(worst.p, 4).s, worst.T + worst.value,
      own ? "gas and water turn into hydrate from the start"
          : "nothing forms in it, for its material has no reaction, but where it comes to sediment that has one it "
            "does, from the start if they touch");
  PetscFunctionReturn(PETSC_SUCCESS);
}
