/* state: what the particles of a checkpoint are particles of: without these keys their masses, stresses and places
   would mean something else.  A scene that starts from them must say the same. */
#include "case_private.h"
#include "clathra/shape.h"
#include <string.h>

/* Of the case; of regions those of their shape besides, and the temperature of a scene without heat. */
static const char *const of_case[]   = {"grid_", "geometry", "fields", "pressures", NULL};
static const char *const of_region[] = {"particles_per_cell", "minus", NULL};
/* Of the material of each region: what ties masses to pressures and volumes, hydrate to water and gas, and the history
   of the skeleton to its law. */
static const char *const of_material[] = {"porosity",           "solid_density",       "solid_expansion",
                                          "hydrate_density",    "hydrate_expansion",   "hydrate_molar_mass",
                                          "hydrate_number",     "water_density",       "water_salinity",
                                          "water_bulk_modulus", "water_expansion",     "water_ref_",
                                          "water_molar_mass",   "gas_molar_mass",      "gas_eos",
                                          "gas_critical_",      "gas_acentric_factor", "retention_",
                                          "kinetics_active",    "plasticity_law",      NULL};

static bool Named(const char *name, const char *const *list)
{
  for (; *list; list++) {
    if (!strncmp(name, *list, strlen(*list)))
      return true;
  }
  return false;
}

/* The line "PREFIX KEY: VALUE". */
static void WriteLine(FILE *f, const Case *c, const char *prefix, const Key *k, const char *instance)
{
  if (!KeyActs(k, c, instance) || KeyEmpty(k, instance))
    return;
  fprintf(f, "%s%s: ", prefix, k->name);
  KeyWrite(f, c, k, instance);
  fputc('\n', f);
}

static void WriteMaterial(FILE *f, const Case *c, const Region *g)
{
  const Material *m = &c->material[g->material];
  char            prefix[128];

  snprintf(prefix, sizeof prefix, "material of region %s: ", g->name);
  for (const Key *k = case_group[GROUP_MATERIAL].key; k->name; k++) {
    if (Named(k->name, of_material))
      WriteLine(f, c, prefix, k, (const char *)m);
  }
  if (c->fields.has & HAS_GAS_PRESSURE)
    fprintf(f, "%swithout_gas: %s\n", prefix, m->gas.trace > 0.0 ? "yes" : "no"); /* (102) */
  if (c->fields.solid)
    fprintf(f, "%selasticity_stiffness_change: %s\n", prefix,
            ElasticityHasBonds(&m->elasticity) ? "bonds" : "without bonds");
  if (c->fields.has & HAS_NONLOCAL)
    fprintf(f, "%splasticity_nonlocal_length: %s\n", prefix, m->plasticity.nonlocal > 0.0 ? "some" : "none");
}

PetscErrorCode CaseWriteState(const Case *c, FILE *f)
{
  char prefix[80];

  PetscFunctionBeginUser;
  for (const Key *k = case_group[GROUP_CASE].key; k->name; k++) {
    if (Named(k->name, of_case))
      WriteLine(f, c, "", k, (const char *)c);
  }
  for (PetscInt i = 0; i < c->nregion; i++) {
    const Region *g = &c->region[i];

    snprintf(prefix, sizeof prefix, "region_%s_", g->name);
    for (const Key *k = case_group[GROUP_REGION].key; k->name; k++) {
      const bool place = k->shape && k->own && !k->like, cold = !strcmp(k->name, "temperature") && !c->fields.heat;

      if (place || (!RegionEmpty(g) && (cold || Named(k->name, of_region))))
        WriteLine(f, c, prefix, k, (const char *)g);
    }
    if (!RegionEmpty(g))
      WriteMaterial(f, c, g);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
