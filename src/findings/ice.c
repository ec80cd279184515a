/* Ice, of which no equation knows. */
#include "findings_private.h"
#include "clathra/words.h"

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

/* Counts the particles below the melting point of their water (127), and says so the first time; the case may want the
   run to end there. */
PetscErrorCode FindingsFindIce(Findings *f, FindingId id)
{
  StepperState *z = &f->s->state;
  Cold          cold;

  PetscFunctionBeginUser;
  if (!f->s->model->c->fields.heat && !SceneReacts(f->s->model->c)) /* T is a number that densities are taken at */
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Look(f->s->model, &cold));
  if (cold.n == 0)
    PetscFunctionReturn(PETSC_SUCCESS);
  f->ends = StepperCase(f->s)->ice == ICE_STOP;
  if (z->ice_total++ == 0 || f->ends)
    SAY("%s t = %s: the water of %" PetscInt_FMT
        " particles is colder than the melting point of ice, by up to %.3g K; ice is not modelled%s",
        f->ends ? "stopped at" : "at", TimeAt(z->t).s, cold.n, cold.coldest,
        f->ends ? " (ice: stop); -ice warn goes on" : " (ice: stop would end the run here)");
  z->ice_most    = PetscMax(z->ice_most, cold.n);
  z->ice_coldest = fmax(z->ice_coldest, cold.coldest);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FindingsFindIceSoFar(Findings *f, FindingId id)
{
  const StepperState *z = &f->s->state;

  PetscFunctionBeginUser;
  if (z->ice_total)
    SAY("  water was colder than the melting point of ice at %" PetscInt_FMT " looks, in up to %" PetscInt_FMT
        " particles and by up to %.3g K: ice is not modelled",
        z->ice_total, z->ice_most, z->ice_coldest);
  PetscFunctionReturn(PETSC_SUCCESS);
}
