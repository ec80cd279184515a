/* state: what the particles of a checkpoint are particles of: without these keys their masses, stresses and places
   would mean something else.  A scene that starts from them must say the same. */
#include "case_private.h"
#include "clathra/shape.h"
#include <string.h>

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
  const Material *m = &c->scene.material[g->material];
  char            prefix[128];

  snprintf(prefix, sizeof prefix, "material of region %s: ", g->name);
  for (const Key *k = case_group[GROUP_MATERIAL].key; k->name; k++) {
    if (k->binds || k->history)
      WriteLine(f, c, prefix, k, (const char *)m);
  }
  if (c->scene.fields.has & HAS_GAS)
    fprintf(f, "%swithout_gas: %s\n", prefix, m->gas.trace > 0.0 ? "yes" : "no"); /* trace (102) */
  if (c->scene.fields.solid)
    fprintf(f, "%selasticity_stiffness_change: %s\n", prefix,
            ElasticityHasBonds(&m->elasticity) ? "bonds" : "without bonds");
  if (c->scene.fields.has & HAS_NONLOCAL)
    fprintf(f, "%splasticity_nonlocal_length: %s\n", prefix, m->plasticity.nonlocal > 0.0 ? "some" : "none");
}

PetscErrorCode CaseWriteState(const Case *c, FILE *f)
{
  char prefix[80];

  PetscFunctionBeginUser;
  for (const Key *k = case_group[GROUP_CASE].key; k->name; k++) {
    if (k->binds)
      WriteLine(f, c, "", k, (const char *)c);
  }
  for (PetscInt i = 0; i < c->scene.nregion; i++) {
    const Region *g = &c->scene.region[i];

    snprintf(prefix, sizeof prefix, "region_%s_", g->name);
    for (const Key *k = case_group[GROUP_REGION].key; k->name; k++) {
      const bool place = k->shape && k->own && !k->like,
                 cold  = !strcmp(k->name, "temperature") && !c->scene.fields.heat;

      if (place || (!RegionEmpty(g) && (cold || k->binds)))
        WriteLine(f, c, prefix, k, (const char *)g);
    }
    if (!RegionEmpty(g))
      WriteMaterial(f, c, g);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
