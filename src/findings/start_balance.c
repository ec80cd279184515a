/* What a user should know of a start that is out of balance with gravity (docs/equations.md, section 13), or whose pore
   pressure is left to tractions (section 6), or where capillary pressure jumps or gas is trapped (section 13); and of
   heat that is let in beside hydrate (section 7). */
#include "findings_private.h"
#include "clathra/point_heat.h"
#include "clathra/shape.h"
#include "clathra/words.h"

#define LEAST_JUMP 10e3 /* Pa, of (342) */
#define JUMP 0.5        /* of the smaller p_0 */
#define NEGLIGIBLE 1e-6 /* of the weight: what may be left to the skeleton without a word */

/* Does the skeleton of a region have a weight to carry, and no stress that does?  Its weight from top to foot, Pa, and
   how far it would sink under that, held at its sides, m. */
static PetscErrorCode Unstressed(const Scene *c, const Region *r, bool *unstressed, double *weight, double *sinks)
{
  const Elasticity *el    = &c->material[r->material].elasticity;
  double            water = 0.0, dp, dT, dE, up[CL_DIM], down[CL_DIM], middle[CL_DIM];
  InitialScalars    s;

  PetscFunctionBeginUser;
  SceneUp(c, 1.0, up);
  SceneUp(c, -1.0, down);
  RegionMiddle(r, middle);
  const double g = SceneGravity(c), height = RegionHighest(r, up) + RegionHighest(r, down);

  *unstressed = RegionUnstressed(r);
  if (!*unstressed)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(InitialScalarsAt(c, r, middle, &s));
  if (c->fields.fluid && r->hydrostatic)
    water = LiquidDensity(&c->material[r->material].water, s.pw, s.T, &dp, &dT);
  *unstressed = fabs(s.density - water) > NEGLIGIBLE * s.density;
  *weight     = (s.density - water) * g * height;
  *sinks      = 0.5 * *weight * height / (ElasticityConstrainedFactor(el) * ElasticityYoung(el, r->Sh, &dE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest tension of a geostatic start, Pa, and the stress it is measured by; globally. */
static PetscErrorCode LargestTension(MPI_Comm comm, const Scene *c, const Particles *P, double *tension, double *scale)
{
  const int v       = SceneVertical(c);
  double    most[2] = {0.0, 0.0};

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < P->n; p++) {
    if (!RegionGeostatic(&c->region[P->i[PI_REGION][p]]))
      continue;
    most[0] = fmax(most[0], P->f[P_SIG + v][p]);
    most[1] = fmax(most[1], fabs(P->f[P_SIG + v][p]) + (P->f[P_PW] ? fabs(P->f[P_PW][p]) : 0.0));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPI_DOUBLE, MPI_MAX, comm));
  *tension = most[0];
  *scale   = most[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is there a traction as large as this one, at any time? */
static bool Pushed(const Scene *c, double least)
{
  for (PetscInt k = 0; k < c->nbc; k++) {
    const Schedule *q = &c->bc[k].value;

    for (PetscInt i = 0; c->bc[k].type == BC_TRACTION && i < q->n; i++) {
      if (q->y[i] + ScheduleSwing(q) >= least)
        return true;
    }
  }
  return false;
}

PetscErrorCode FindingsFindTornPores(Findings *f, FindingId id)
{
  const Scene *c = f->s->model->c;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; c->fields.solid && c->fields.fluid && k < c->nregion; k++) {
    const Region  *r      = &c->region[k];
    const Ambient  around = AmbientOf(c, c->t_begin, c->gravity);
    double         E, beyond, gradient[CL_DIM], dE, middle[CL_DIM];
    InitialScalars s;

    if (RegionEmpty(r))
      continue;
    E = ElasticityYoung(&c->material[r->material].elasticity, r->Sh, &dE);
    RegionMiddle(r, middle);
    PetscCall(InitialScalarsAt(c, r, middle, &s));
    beyond = s.p - AmbientPressure(&around, middle, gradient);
    if (beyond < E || !Pushed(c, E))
      continue;
    SAY("the pores of region %s bear %s, %.3g times its stiffness, against tractions on its faces: what the two differ "
        "by, as faces move, may tear it apart",
        r->name, PressureWords(beyond, 3).s, beyond / E);
    break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a local particle of region a have one of region b beside it? */
static bool Touches(const Scene *c, const Particles *P, PetscInt a, PetscInt b)
{
  for (PetscInt p = 0; p < P->n; p++) {
    for (int side = 0; P->i[PI_REGION][p] == a && side < 2 * CL_DIM; side++) {
      double y[CL_DIM];

      for (int d = 0; d < CL_DIM; d++)
        y[d] = P->f[P_X + d][p];
      y[side / 2] += (side % 2 ? 1.5 : -1.5) * P->f[P_L + side / 2][p];
      if (RegionHolds(c, b, y))
        return true;
    }
  }
  return false;
}

/* p_c = p_g - p_w that two regions start with, Pa, as the materials and shares of both say it of the place between
   them. */
static PetscErrorCode StartCapillary(const Scene *c, const Region *const r[2], double pc[2])
{
  InitialScalars s;
  double         between[CL_DIM];

  PetscFunctionBeginUser;
  for (int d = 0; d < CL_DIM; d++)
    between[d] = 0.25 * (r[0]->lower[d] + r[0]->upper[d] + r[1]->lower[d] + r[1]->upper[d]);
  for (int k = 0; k < 2; k++) {
    PetscCall(InitialScalarsAt(c, r[k], between, &s));
    pc[k] = s.pg - s.pw;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gas share S_g with which region r starts at the capillary pressure pc (Pa) of another, with its own p_0 (346). */
static double ShareAt(const Scene *c, const Region *r, double pc)
{
  double d[2];

  return (1.0 - r->Sh) * RetentionGasShare(&c->material[r->material].retention, pc, r->Sh, &d[0], &d[1]);
}

#define BALANCED 320 /* characters */

/* How two regions that are not in balance could start so. */
static void Balanced(const Scene *c, const Region *r[2], const double pc[2], char text[BALANCED])
{
  const int finer = c->material[r[1]->material].retention.p0 > c->material[r[0]->material].retention.p0;

  if (r[0]->Sg == 0.0 && r[1]->Sg == 0.0)
    snprintf(text, BALANCED,
             "the same retention_p_trap in both: p_g starts 20 of it below p_w, or at the equilibrium of hydrate; a "
             "small one for the finer, 1 kPa, says least");
  else if (r[0]->Sg == 0.0 || r[1]->Sg == 0.0)
    snprintf(text, BALANCED, "Sg: 0 in both or neither");
  else
    snprintf(text, BALANCED,
             "Sg: %.6g in %s, which is what its p0 holds at the p_g - p_w of %s; the same p0 and gas share Sg/(1 - Sh) "
             "in both, though the finer may not have so much",
             ShareAt(c, r[finer], pc[!finer]), r[finer]->name, r[!finer]->name);
}

/* (342) between two regions; *found: it was said. */
static PetscErrorCode FindJump(const Findings *f, FindingId id, PetscInt a, PetscInt b, bool *found)
{
  const Scene  *c     = f->s->model->c;
  const Region *r[2]  = {&c->region[a], &c->region[b]};
  const double  p0    = fmin(c->material[r[0]->material].retention.p0, c->material[r[1]->material].retention.p0);
  double        pc[2] = {0.0, 0.0};
  int           touch;
  char          balanced[BALANCED];

  PetscFunctionBeginUser;
  PetscCall(StartCapillary(c, r, pc));
  if (fabs(pc[0] - pc[1]) <= fmax(LEAST_JUMP, JUMP * p0))
    PetscFunctionReturn(PETSC_SUCCESS);
  touch = Touches(c, &f->s->model->P, a, b);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &touch, 1, MPI_INT, MPI_LOR, f->comm));
  if (!touch)
    PetscFunctionReturn(PETSC_SUCCESS);
  Balanced(c, r, pc, balanced);
  *found = true;
  SAY_TRY(balanced,
          "regions %s and %s touch and start with p_g - p_w of %.4g kPa%s and %.4g kPa%s: water and gas flow between "
          "them at once, the faster the larger their permeability",
          r[0]->name, r[1]->name, 1e-3 * pc[0], r[0]->Sg == 0.0 ? " (no gas)" : "", 1e-3 * pc[1],
          r[1]->Sg == 0.0 ? " (no gas)" : "");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first jump. */
PetscErrorCode FindingsFindCapillaryJump(Findings *f, FindingId id)
{
  const Scene *c     = f->s->model->c;
  bool         found = false;

  PetscFunctionBeginUser;
  for (PetscInt a = 0; (c->fields.has & HAS_GAS) && !found && a < c->nregion; a++) {
    for (PetscInt b = a + 1; !found && b < c->nregion; b++) {
      if (!RegionEmpty(&c->region[a]) && !RegionEmpty(&c->region[b]))
        PetscCall(FindJump(f, id, a, b, &found));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gas that starts below its residual share has p_g below p_w: (223) takes it for trapped and compressed. */
PetscErrorCode FindingsFindTrappedGas(Findings *f, FindingId id)
{
  const Scene   *c = f->s->model->c;
  InitialScalars s;
  double         middle[CL_DIM];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; (c->fields.has & HAS_GAS) && k < c->nregion; k++) {
    const Region   *r     = &c->region[k];
    const Material *m     = &c->material[r->material];
    const double    share = r->Sg / (1.0 - r->Sh);

    if (RegionEmpty(r) || !(share > 0.0) || share >= m->retention.Sgr)
      continue;
    RegionMiddle(r, middle);
    PetscCall(InitialScalarsAt(c, r, middle, &s));
    if (s.pg >= s.pw)
      continue;
    SAY("gas starts below its residual share: region_%s_Sg = %.4g and region_%s_Sh = %.4g are Sg/(1 - Sh) = %.4g of "
        "the open pores, mat_%s_retention_Sgr is %.4g: it counts as trapped and compressed, with p_g %s below p_w",
        r->name, r->Sg, r->name, r->Sh, share, m->name, m->retention.Sgr, PressureWords(s.pw - s.pg, 3).s);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first region that starts without a stress under its weight. */
PetscErrorCode FindingsFindUnstressed(Findings *f, FindingId id)
{
  const Scene *c = f->s->model->c;

  PetscFunctionBeginUser;
  if (!c->fields.solid || SceneGravity(c) == 0.0 || c->gravity_ramp > 0.0)
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < c->nregion; k++) {
    bool   unstressed;
    double weight = 0.0, sinks = 0.0;

    if (RegionEmpty(&c->region[k]))
      continue;
    PetscCall(Unstressed(c, &c->region[k], &unstressed, &weight, &sinks));
    if (!unstressed)
      continue;
    SAY("gravity acts on an unstressed body: region %s starts without the stress that carries its weight, %s from top "
        "to foot, and will move, by some %.3g m held at its sides",
        c->region[k].name, PressureWords(weight, 3).s, sinks);
    break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FindingsFindStartTension(Findings *f, FindingId id)
{
  const Model *m       = f->s->model;
  double       tension = 0.0, scale = 0.0;

  PetscFunctionBeginUser;
  if (m->c->fields.solid && SceneGravity(m->c) != 0.0 && SceneVertical(m->c) >= 0)
    PetscCall(LargestTension(f->comm, m->c, &m->P, &tension, &scale));
  if (tension > NEGLIGIBLE * scale)
    SAY("the geostatic stress is a tension of up to %s: the load on the body's top is less than the pore pressure "
        "there, or the top cuts a cell of the grid",
        PressureWords(tension, 4).s);
  PetscFunctionReturn(PETSC_SUCCESS);
}
