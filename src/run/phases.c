/* What a run says of phases: where hydrate is stable at the start, and ice, of which no equation knows. */
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

/* Particles whose water is colder than its melting point, by how much at most, and one of them; all ranks. */
typedef struct {
  double   coldest; /* K */
  PetscInt n;
} Cold;

static PetscErrorCode Look(const Model *m, Cold *cold)
{
  const Scene     *c = m->c;
  const Particles *P = &m->P;

  PetscFunctionBeginUser;
  *cold = (Cold){0.0, 0};
  for (PetscInt p = 0; c->fields.phase[PHASE_W] && p < P->n; p++) {
    const Region *r     = &c->region[P->i[PI_REGION][p]];
    const double  T     = ParticleT(c, P, p);
    const double  below = BrineMelting(c->material[r->material].salinity, P->f[P_PW][p]) - T;

    cold->n += below > 0.0;
    cold->coldest = fmax(cold->coldest, below);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &cold->coldest, 1, MPI_DOUBLE, MPI_MAX, m->grid.comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &cold->n, 1, MPIU_INT, MPI_SUM, m->grid.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode IceLook(Stepper *s, bool *ends)
{
  StepperState *z     = &s->state;
  const bool    first = z->ice_total == 0;
  Cold          cold;

  PetscFunctionBeginUser;
  *ends = false;
  if (!s->model->c->fields.heat && !SceneReacts(s->model->c)) /* T is a number that densities are taken at */
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Look(s->model, &cold));
  *ends = cold.n > 0 && StepperCase(s)->ice == ICE_STOP;
  if (cold.n == 0)
    PetscFunctionReturn(PETSC_SUCCESS);
  z->ice_total++;
  z->ice_most    = PetscMax(z->ice_most, cold.n);
  z->ice_coldest = fmax(z->ice_coldest, cold.coldest);
  if (first || *ends)
    PetscCall(
        PetscFPrintf(s->model->grid.comm, stderr,
                     "clathra: %s at t = %s: the water of %" PetscInt_FMT
                     " particles is colder than the melting point of ice, by up to %.3g K; ice is not modelled%s\n",
                     *ends ? "stopped" : "warning", TimeAt(z->t).s, cold.n, cold.coldest,
                     *ends ? " (ice: stop); -ice warn goes on" : " (ice: stop would end the run here)"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void IceSummary(const Stepper *s, char text[256])
{
  const StepperState *z = &s->state;

  text[0] = '\0';
  if (z->ice_total)
    snprintf(text, 256,
             "  water was colder than the melting point of ice at %" PetscInt_FMT " looks, in up to %" PetscInt_FMT
             " particles and by up to %.3g K: ice is not modelled\n",
             z->ice_total, z->ice_most, z->ice_coldest);
}
