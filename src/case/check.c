/* check: what no single key can show: values that must agree with each other. */
#include "case_private.h"
#include "clathra/shape.h"
#include <stdio.h>
#include <string.h>

static void CheckCase(Reader *r, const Case *c)
{
  for (int d = 0; d < CL_DIM; d++)
    if (c->scene.upper[d] <= c->scene.lower[d])
      FAIL_AT(GROUP_CASE, "", "grid_upper", "must lie above grid_lower on all axes (%g m <= %g m)", c->scene.upper[d],
              c->scene.lower[d]);
  if (c->scene.axisymmetric && c->scene.lower[0] < 0.0)
    FAIL_AT(GROUP_CASE, "", "grid_lower", "must not be left of the axis, x = 0, when geometry is axisymmetric (%g m)",
            c->scene.lower[0]);
  if (c->scene.basis == BASIS_TOTAL && c->scene.mean_strain > 0.0)
    FAIL_AT(GROUP_CASE, "", "basis", "total is not known with a mean_strain");
  if (c->scene.compression_heat && !(c->scene.fields.heat && c->scene.fields.fluid))
    FAIL_AT(GROUP_CASE, "", "compression_heat", "yes needs heat and a fluid among the fields of the scene (%s)",
            c->fields_wanted);
  if (c->scene.ambient_density > 0.0 && SceneGravity(&c->scene) == 0.0)
    FAIL_AT(GROUP_CASE, "", "ambient_density", "makes no pressure without gravity (%g kg/m^3)",
            c->scene.ambient_density);
  if (c->scene.ambient_drag > 0.0 && c->scene.ambient_density == 0.0)
    FAIL_AT(GROUP_CASE, "", "ambient_drag", "(%g) is that of a fluid with a density: give ambient_density",
            c->scene.ambient_drag);
  double cells = 1.0;
  for (int d = 0; d < CL_DIM; d++)
    cells *= (double)c->scene.cells[d];
  if (cells > 1e8)
    FAIL_AT(GROUP_CASE, "", "grid_cells", "has more than 1e8 cells in all");
  if (c->ntimes && c->times[c->ntimes - 1] > c->t_end && !(c->nstage && r->bad[GROUP_STAGE]))
    FAIL_AT(GROUP_CASE, "", "output_times", "has %g s after time_end, %g s", c->times[c->ntimes - 1], c->t_end);
}

static void CheckMaterial(Reader *r, const Scene *c, const Material *m)
{
  const Kinetics *k       = &m->kinetics;
  double          balance = k->M_g + k->N_h * k->M_w;

  if (m->retention.Swr + m->retention.Sgr >= 1)
    FAIL_AT(GROUP_MATERIAL, m->name, "retention_Swr", "plus retention_Sgr must be below 1, is %g",
            m->retention.Swr + m->retention.Sgr);
  else if (m->relperm.Swr + m->relperm.Sgr >= 1)
    FAIL_AT(GROUP_MATERIAL, m->name, "relperm_Swr", "plus relperm_Sgr must be below 1, is %g",
            m->relperm.Swr + m->relperm.Sgr);
  if (fabs(k->M_h - balance) > 1e-6 * k->M_h)
    FAIL_AT(GROUP_MATERIAL, m->name, "hydrate_molar_mass",
            "is %.9g kg/mol but gas + hydrate_number * water make %.9g kg/mol", k->M_h, balance);
  if (c->compression_heat && m->gas.carried > 0.0)
    FAIL_AT(GROUP_MATERIAL, m->name, "gas_solubility",
            "(%g mol/(m^3 Pa)) is not known with compression_heat: yes, which takes all methane for gas", m->gas.henry);
}

/* K_d at RATE_AT has been measured between 1e-11 and 1e-9 (Kim et al. 1987, Clarke and Bishnoi 2001).  Above SWIFT all
   is at equilibrium at once, below SLOW nothing happens in any time of a run. */
#define RATE_AT 10.0 /* degC */
#define SWIFT 1e-6   /* mol/(m^2 Pa s) */
#define SLOW 1e-16   /* mol/(m^2 Pa s) */

static void CheckRate(const Reader *r, const Material *m)
{
  double       slope;
  const double K = KineticsRateConstant(&m->kinetics, RATE_AT, &slope);

  if (!m->reacts || m->kinetics.K0 == 0.0 || (K >= SLOW && K <= SWIFT))
    return;
  WARN_AT(FINDING_RATE_NOT_MEASURED, GROUP_MATERIAL, m->name, "kinetics_K0",
          "mat_%s_kinetics_K0 = %.6g mol/(m^2 Pa s) and mat_%s_kinetics_dE = %.6g J/mol make K_d = %.2g mol/(m^2 Pa s) "
          "at %.3g degC, where 1e-11 to 1e-9 have been measured: hydrate %s",
          m->name, m->kinetics.K0, m->name, m->kinetics.dE, K, RATE_AT,
          K > SWIFT ? "is in equilibrium at once, in steps that may be far shorter" : "never reacts");
}

static void CheckSaturations(Reader *r, const Scene *c, const Region *g)
{
  const Material *m = &c->material[g->material];
  double          pc, sum = g->Sh + g->Sw + g->Sg;

  if (!c->fields.fluid)
    return;
  if (fabs(sum - 1) > 1e-9) {
    FAIL_AT(GROUP_REGION, g->name, "Sw", "Sh + Sw + Sg must be 1, is %.12g", sum);
    return;
  }
  if (r->bad[GROUP_MATERIAL] || !c->fields.phase[PHASE_G])
    return;
  if (g->Sg == 0.0 && c->without_gas != WITHOUT_GAS_NO
          ? RetentionNoGas(&m->retention, g->Sh, &pc)
          : RetentionInvert(&m->retention, g->Sg / (1 - g->Sh), g->Sh, &pc))
    return;
  FAIL_AT(
      GROUP_REGION, g->name, "Sg",
      "the retention law %s of material %s never holds a gas share Sg/(1-Sh) of %g (water share %g, Swr %g, Sgr %g)",
      m->retention.type, m->name, g->Sg / (1 - g->Sh), g->Sw / (1 - g->Sh), m->retention.Swr, m->retention.Sgr);
}

/* (120) is for a gas that no pressure condenses. */
static void CheckGas(Reader *r, const Scene *c, const Region *g)
{
  const Gas *law = &c->material[g->material].gas;

  if (c->fields.phase[PHASE_G] && !r->bad[GROUP_MATERIAL] && !strcmp(law->type, "peng_robinson") &&
      g->temperature + CL_ZERO_CELSIUS <= law->Tc)
    FAIL_AT(GROUP_REGION, g->name, "temperature",
            "%g degC is not above gas_critical_temperature, %g K (%g degC): peng_robinson does not know liquid gas",
            g->temperature, law->Tc, law->Tc - CL_ZERO_CELSIUS);
}

/* Beds (306) keep their shape about an axis if they are level. */
static void CheckBeds(Reader *r, const Scene *c, const Material *m)
{
  const Permeability *law = &m->permeability;

  if (law->ratio != 1.0 && c->fields.fluid && c->axisymmetric && law->dip != 0.0)
    FAIL_AT(GROUP_MATERIAL, m->name, "permeability_dip",
            "must be 0 deg when geometry is axisymmetric (%g deg): beds about an axis are level", law->dip);
}

static void CheckRegion(Reader *r, const Case *c, PetscInt i)
{
  const Region  *g      = &c->scene.region[i];
  const PetscInt before = r->nerror;

  if (RegionEmpty(g))
    return;
  PetscInt many = 1;
  for (int d = 0; d < CL_DIM; d++)
    many *= g->ppc[d];
  if (many < 2)
    FAIL_AT(GROUP_REGION, g->name, "particles_per_cell",
            "must make at least 2 particles a cell: one does not see a cell's hourglass modes");
  CheckSaturations(r, &c->scene, g);
  CheckGas(r, &c->scene, g);
  if (CL_DIM == 2 && !r->bad[GROUP_MATERIAL] && c->scene.material[g->material].plasticity.type != PLASTICITY_NONE &&
      (g->stress[4] != 0.0 || g->stress[5] != 0.0))
    FAIL_AT(GROUP_REGION, g->name, "stress", "has shear out of the plane (yz %g Pa, xz %g Pa), which %s", g->stress[4],
            g->stress[5], "plasticity_law does not know");
  const Case *first = r->bad[GROUP_STAGE] ? c : CaseInStage(c, 0);
  if (r->nerror == before && !r->bad[GROUP_REGION] && !r->bad[GROUP_CASE] && !r->bad[GROUP_MATERIAL])
    CheckInitial(r, &first->scene, &first->scene.region[i]);
}

static void CheckPlane(Reader *r, const Scene *c, const Bc *b)
{
  const GridLines lines = SceneLines(c, b->axis);
  const double    line  = LinesPlace(&lines, b->position);

  if (!(lines.h > 0))
    return;
  if (line < -1e-6 || line > c->cells[b->axis] + 1e-6)
    FAIL_AT(GROUP_BC, b->name, "position", "%g m lies outside the grid, %g..%g m", b->position, c->lower[b->axis],
            c->upper[b->axis]);
  else if (fabs(line - round(line)) > 1e-6)
    FAIL_AT(GROUP_BC, b->name, "position", "%g m is not on a grid line; the nearest is at %.9g m", b->position,
            LinesAt(&lines, (PetscInt)round(line)));
}

/* (425) needs depth, and leaves absolute temperatures positive. */
static void CheckDepth(Reader *r, const Scene *c, const Bc *b)
{
  double low, high;

  if (b->with_depth == 0.0)
    return;
  BcTemperatureSpan(c, b, &low, &high);
  if (SceneGravity(c) == 0.0)
    FAIL_AT(GROUP_BC, b->name, "with_depth", "is given but gravity, which says where depth is, is zero");
  else if (low <= -CL_ZERO_CELSIUS)
    FAIL_AT(GROUP_BC, b->name, "with_depth", "makes the temperature %g degC at the top or foot of the body", low);
}

/* In each stage, whose gravity may differ; the first that fails tells. */
static void CheckDepths(Reader *r, const Case *c)
{
  const PetscInt errors = r->nerror;

  for (PetscInt k = 0; k < PetscMax(c->nstage, 1) && r->nerror == errors; k++) {
    const Scene *scene = &CaseInStage(c, k)->scene;

    for (PetscInt i = 0; i < scene->nbc; i++)
      CheckDepth(r, scene, &scene->bc[i]);
  }
}

static void CheckMeter(Reader *r, const Scene *c, const Meter *m)
{
  if (m->well < 0)
    CheckFaces(r, c, GROUP_METER, m->name, m);
  else if (c->bc[m->well].type != BC_WELL)
    FAIL_AT(GROUP_METER, m->name, "well", "names %s, which is not a well but a %s", c->bc[m->well].name,
            cl_condition[c->bc[m->well].type].word);
  else if (m->side != SIDE_COUNT || m->along.n)
    FAIL_AT(GROUP_METER, m->name, "well", "and %s are two things to count: give one", m->along.n ? "along" : "side");
}

/* What the plane alone knows. */
static void CheckSpace(Reader *r, const Case *c)
{
  if (c->scene.axisymmetric)
    FAIL_AT(GROUP_CASE, "", "geometry",
            "axisymmetric is a geometry of the plane, as clathra has it; this is clathra3d");
  for (PetscInt i = 0; i < c->scene.nbc && !r->bad[GROUP_BC]; i++) {
    const Bc *b = &c->scene.bc[i];

    if (b->type == BC_TRACTION && !ScheduleIsZero(&b->shear))
      FAIL_AT(GROUP_BC, b->name, "shear", "has one direction in the plane alone; clathra3d does not know it");
    if (isfinite(b->from) || isfinite(b->to))
      FAIL_AT(GROUP_BC, b->name, isfinite(b->from) ? "from" : "to",
              "goes along the one direction of a side in the plane; in space name a region whose side it is");
  }
}

void CaseCheck(Reader *r, const Case *c)
{
  const bool *bad = r->bad;

  CheckFields(r, c);
  if (!bad[GROUP_CASE] && !bad[GROUP_STAGE])
    CheckTimes(r, c);
  if (!bad[GROUP_CASE])
    CheckCase(r, c);
  for (PetscInt i = 0; i < c->scene.nmaterial && !bad[GROUP_MATERIAL]; i++) {
    CheckMaterial(r, &c->scene, &c->scene.material[i]);
    CheckRate(r, &c->scene.material[i]);
    CheckBeds(r, &c->scene, &c->scene.material[i]);
    CheckPlasticity(r, c, &c->scene.material[i]);
  }
  if (!bad[GROUP_CASE] && !bad[GROUP_MATERIAL])
    CheckReduction(r, c);
  for (int d = 0; d < CL_DIM; d++)
    r->bad[GROUP_CASE] |= c->scene.upper[d] <= c->scene.lower[d];
  if (CL_DIM == 3)
    CheckSpace(r, c);
  for (PetscInt i = 0, all = !bad[GROUP_REGION] || r->misshapen; i < c->scene.nregion && all; i++)
    CheckRegion(r, c, i);
  for (PetscInt i = 0; i < c->scene.nbc && !bad[GROUP_BC]; i++) {
    const Bc *b     = &c->scene.bc[i];
    const int where = cl_condition[b->type].where;

    if (c->scene.basis == BASIS_TOTAL && (BC_CURRENT >> b->type & 1u))
      FAIL_AT(GROUP_BC, b->name, "type", "%s is not known with basis: total", cl_condition[b->type].word);
    if (b->type == BC_WELL) {
      CheckWell(r, c, b);
    } else if (b->type == BC_HEAT_SOURCE) {
      if (!bad[GROUP_CASE] && !bad[GROUP_REGION])
        CheckSource(r, &c->scene, b);
    } else if (where == ON_FACES) {
      if (!bad[GROUP_CASE] && !bad[GROUP_REGION])
        CheckFaces(r, &c->scene, GROUP_BC, b->name, &BcFaces(b));
      CheckFlow(r, &c->scene, b);
      if (b->type == BC_PLATE)
        CheckPlate(r, c, b);
    } else if (where == IN_REGION) {
      if (!bad[GROUP_CASE] && !bad[GROUP_REGION])
        CheckHeld(r, &c->scene, b);
    } else if (!bad[GROUP_CASE]) {
      CheckPlane(r, &c->scene, b);
      if (b->type == BC_PLATE_LINE)
        CheckPlate(r, c, b);
    }
  }
  if (!bad[GROUP_CASE] && !bad[GROUP_REGION] && !bad[GROUP_BC] && !bad[GROUP_STAGE])
    CheckDepths(r, c);
  for (PetscInt i = 0; i < c->nprobe && !bad[GROUP_PROBE] && !bad[GROUP_CASE] && !bad[GROUP_REGION]; i++)
    CheckProbe(r, &c->scene, &c->probe[i]);
  for (PetscInt i = 0; i < c->scene.nmeter && !bad[GROUP_METER] && !bad[GROUP_CASE] && !bad[GROUP_REGION]; i++)
    CheckMeter(r, &c->scene, &c->scene.meter[i]);
  if (c->scene.nmeter > CL_METERS)
    FAIL_AT(GROUP_CASE, "", "meters", "lists %d names, at most %d are allowed", (int)c->scene.nmeter, CL_METERS);
}
