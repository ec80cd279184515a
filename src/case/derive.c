/* derive: values that follow from the keys; all of them before stages copy the scene, and before anything is checked.
 */
#include "case_private.h"
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* bp2 for cases/bp2/case.yaml, else the file's name without .yaml. */
static void CaseName(const char *file, char *name, size_t size)
{
  char  full[PATH_MAX], *base, *dot;
  char *path = realpath(file, full) ? full : NULL;

  snprintf(name, size, "case");
  if (!path)
    return;
  base = strrchr(path, '/');
  if (!strcmp(base, "/case.yaml") && base > path) {
    *base = 0;
    base  = strrchr(path, '/');
  } else if ((dot = strrchr(base, '.')) && dot > base + 1)
    *dot = 0;
  if (base[1])
    snprintf(name, size, "%s", base + 1);
}

/* What salt and heat capacities make of the laws. */
static void DeriveFluids(Material *m)
{
  const Kinetics *k = &m->kinetics;

  m->water.rho0                 = m->fresh + BrineExcessDensity(m->salinity, m->water.T_ref);
  m->kinetics.equilibrium.shift = BrineEquilibriumShift(m->salinity);
  m->mu_w.salinity              = m->salinity;
  m->mu_g.M                     = m->gas.M;
  m->latent.dc                  = KineticsWater(k) * m->c_w + KineticsMethane(k) * m->c_g - m->c_h;
}

/* Pa, the largest retention_p_trap that is taken by itself where sediment starts without gas: 20 of it below p_w, water
   is to hold more methane than hydrate anywhere in its stability zone asks for (103). */
#define TRAPPED 5e4

/* Side of a square or cube as large as a mean cell, m. */
static double CellSize(const Scene *c)
{
  double size = 1.0;

  for (int d = 0; d < CL_DIM; d++)
    size *= (c->upper[d] - c->lower[d]) / c->cells[d];
  return CL_DIM == 2 ? sqrt(size) : cbrt(size);
}

PetscErrorCode CaseDerive(Reader *r, Case *c)
{
  const bool starts  = c->scene.without_gas == WITHOUT_GAS_AUTO && SceneStartsWithoutGas(&c->scene);
  const bool without = (c->scene.fields.has & HAS_GAS) && (starts || c->scene.without_gas == WITHOUT_GAS_YES);

  PetscFunctionBeginUser;
  c->scene.nlisted = c->scene.nbc;
  c->scene.listed  = c->scene.bc;
  if (!strcmp(c->output_dir, "results/<case name>")) {
    char name[256];
    CaseName(r->file, name, sizeof name);
    PetscCallMPI(MPI_Bcast(name, sizeof name, MPI_CHAR, 0, r->comm));
    snprintf(c->output_dir, sizeof c->output_dir, "results/%s", name);
  }
  RegionsFinish(&c->scene);
  for (PetscInt i = 0; i < c->scene.nmaterial; i++) {
    Material *m     = &c->scene.material[i];
    Liquid   *l[]   = {&m->solid, &m->hydrate};
    m->kinetics.M_g = m->gas.M;
    if (isinf(m->retention.p_trap)) /* not given (103) */
      m->retention.p_trap = starts ? fmin(m->retention.p0, TRAPPED) : m->retention.p0;
    if (isinf(m->gas.henry)) /* compression_heat takes all methane for gas */
      m->gas.henry = without && !c->scene.compression_heat ? GAS_SOLUBILITY : 0.0;
    m->gas.carried = c->scene.fields.has & HAS_GAS ? m->gas.M * m->gas.henry : 0.0;
    m->gas.trace   = m->gas.carried > 0.0 ? m->gas.carried : without ? GasTrace(&m->gas) : 0.0; /* H (102) */
    DeriveFluids(m);
    m->plasticity.factor = c->scene.strength_factor;
    m->plasticity.cell   = CellSize(&c->scene);
    m->plasticity.axis   = SceneVertical(&c->scene) < 0 ? 0 : SceneVertical(&c->scene);
    m->plasticity.up     = c->scene.gravity[m->plasticity.axis] > 0.0 ? -1 : 1;
    for (int j = 0; j < 2; j++) {
      l[j]->K     = INFINITY;
      l[j]->p_ref = m->water.p_ref;
      l[j]->T_ref = m->water.T_ref;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The index of each well that has a pressure, where CheckWell will find nothing wrong with its place. */
static PetscErrorCode DeriveWells(Scene *c)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->nbc; k++) {
    Bc  *b = &c->bc[k];
    Well w;

    if (b->type == BC_WELL && b->value.n && WellRuns(c, b) && WellPlace(c, b, &w) && WellFits(b, &w))
      PetscCall(WellIndex(c, b, &w, &b->index));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CaseDerivePlaces(Reader *r, Case *c)
{
  const bool *bad = r->bad;
  bool        box = !bad[GROUP_CASE];

  PetscFunctionBeginUser;
  for (int d = 0; d < CL_DIM; d++)
    box = box && c->scene.upper[d] > c->scene.lower[d];
  if (!bad[GROUP_REGION])
    r->bad[GROUP_REGION] = r->misshapen = !ShapesGood(r, c);
  if (box && !bad[GROUP_REGION]) {
    PetscCall(RegionsCut(r, c));
    r->bad[GROUP_REGION] = !RegionsFilled(r, c);
  }
  if (box && !bad[GROUP_REGION] && !bad[GROUP_MATERIAL] && !bad[GROUP_BC])
    PetscCall(DeriveWells(&c->scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
