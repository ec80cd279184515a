/* What a run says of phases: where hydrate is stable at the start, and whether water holds methane. */
#include "run_private.h"
#include "clathra/shape.h"
#include "clathra/words.h"

PetscErrorCode PrintEquilibrium(const Scene *c, MPI_Comm comm)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->nregion; k++) {
    const Region   *r        = &c->region[k];
    const Material *m        = RegionEmpty(r) ? NULL : &c->material[r->material];
    char            salt[64] = "";
    double          d;

    if (!m || !m->reacts || !c->fields.phase[PHASE_G])
      continue;
    const Equilibrium *law = &m->kinetics.equilibrium;
    if (m->salinity > 0.0)
      snprintf(salt, sizeof(salt), ", salinity %g (%.3g K colder)", m->salinity, law->shift);
    PetscCall(PetscPrintf(comm, "  region %s: equilibrium of hydrate by %s%s: p_e = %s at %g degC\n", r->name,
                          law->type, salt, PressureWords(EquilibriumPressure(law, r->temperature, &d), 6).s,
                          r->temperature));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PrintSolubility(const Scene *c, MPI_Comm comm)
{
  double least = INFINITY, most = 0.0;

  PetscFunctionBeginUser;
  if (!(c->fields.has & HAS_GAS))
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < c->nmaterial; k++) {
    least = fmin(least, c->material[k].gas.henry);
    most  = fmax(most, c->material[k].gas.henry);
  }
  if (most == 0.0)
    PetscCall(
        PetscPrintf(comm, "  water holds no methane (gas_solubility; by itself it does where a region has Sg: 0)\n"));
  else if (least == most)
    PetscCall(PetscPrintf(comm, "  water holds methane, %g mol/(m^3 Pa)\n", most));
  else
    PetscCall(PetscPrintf(comm, "  water holds methane, %g to %g mol/(m^3 Pa)\n", least, most));
  PetscFunctionReturn(PETSC_SUCCESS);
}
