/* Lines of the summary that not every run has. */
#include "findings_private.h"
#include "clathra/words.h"

/* What an integrator without matrices has to say at the end. */
PetscErrorCode FindingsFindStableStep(Findings *f, FindingId id)
{
  const Stepper *s           = f->s;
  const double   scaling     = StepperCase(s)->mass_scaling;
  char           scaled[128] = "";

  PetscFunctionBeginUser;
  if (!s->explicit)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (scaling > 1.0)
    snprintf(scaled, sizeof(scaled), "; mass scaling %g added inertia of up to %.2g of the forces", scaling,
             ExplicitMassScalingError(s->explicit));
  SAY("  stable step %.4g s at the end (%s rules); %.0f B a particle%s", s->limit.dt, cl_limit_word[s->limit.rules],
      ExplicitBytesPerParticle(s->explicit), scaled);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Hydrate there is, and what has become of it. */
PetscErrorCode FindingsFindHydrate(Findings *f, FindingId id)
{
  const StepperState *z = &f->s->state;
  ModelTotals         t;

  PetscFunctionBeginUser;
  PetscCall(ModelComputeTotals(f->s->model, &t));
  if (z->hydrate0 != 0.0 || t.hydrate != 0.0)
    SAY("  hydrate %.7g kg, %.4g kg %s than at the start; hydrate positivity limiter acted %" PetscInt_FMT " times",
        t.hydrate, fabs(z->hydrate0 - t.hydrate), z->hydrate0 < t.hydrate ? "more" : "less", z->limited_total);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What Newton's method left in the balances of mass (277): it goes back to the particles (28), so the ledger does not
   show it. */
PetscErrorCode FindingsFindNewtonLeft(Findings *f, FindingId id)
{
  const StepperState *z        = &f->s->state;
  double              share[2] = {0.0};

  PetscFunctionBeginUser;
  for (int ph = 0; ph < PHASE_COUNT; ph++)
    share[ph] = z->moved[ph] > 0.0 ? z->left[ph] / z->moved[ph] : 0.0;
  if (z->moved[PHASE_W] + z->moved[PHASE_G] > 0.0)
    SAY("  left in the balances by Newton's method: water %.2e, gas %.2e of what moved", share[PHASE_W],
        share[PHASE_G]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Particles that left the grid (373). */
PetscErrorCode FindingsFindGone(Findings *f, FindingId id)
{
  const double *r = f->s->state.removed;

  PetscFunctionBeginUser;
  if (r[REMOVED_N] > 0.0)
    SAY("  %.0f particles left the grid and were taken out, with %.4g kg of solid, %.4g kg of hydrate, %.4g kg of "
        "water and %.4g kg of methane (both with what hydrate holds), a momentum of (%.3g, %.3g) N s and a kinetic "
        "energy of %.3g J",
        r[REMOVED_N], r[REMOVED_SOLID], r[REMOVED_HYDRATE], r[REMOVED_WATER], r[REMOVED_METHANE], r[REMOVED_MOMENTUM],
        r[REMOVED_MOMENTUM + 1], r[REMOVED_ENERGY + ENERGY_KINETIC]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps without exchange within cells (353), for (354) did not converge. */
PetscErrorCode FindingsFindUneven(Findings *f, FindingId id)
{
  PetscFunctionBeginUser;
  if (f->s->state.uneven_total)
    SAY("  %" PetscInt_FMT " steps evened no pressures out within cells: their projection was not found in "
        "-exchange_ksp_max_it iterations",
        f->s->state.uneven_total);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Domains that act shorter than they are (BasisHalfLength). */
PetscErrorCode FindingsFindLongParticles(Findings *f, FindingId id)
{
  const Model *m       = f->s->model;
  bool         changes = m->c->basis == BASIS_CPGIMP; /* length, or cells */
  PetscInt     n       = 0;

  for (int d = 0; d < CL_DIM; d++)
    changes = changes || m->grid.line[d].x;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; changes && m->c->basis != BASIS_LINEAR && p < m->P.n; p++) {
    bool cut = false;

    for (int d = 0; d < CL_DIM; d++)
      cut = cut || BasisReach(m->c->basis, &m->grid.line[d], m->P.f[P_X + d][p], INFINITY) * (1.0 + BASIS_SNAP) <
                       m->P.f[P_L + d][p];
    n += cut;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPIU_INT, MPI_SUM, f->comm));
  if (n)
    SAY("  %" PetscInt_FMT " particles are longer than a cell and leave gaps: take more of them in a cell", n);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How evenly ranks share the particles; the borders of the start are the first. */
PetscErrorCode FindingsFindRanks(Findings *f, FindingId id)
{
  const Model *m = f->s->model;
  double       mean, most;

  PetscFunctionBeginUser;
  if (m->grid.size == 1)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ParticlesFullest(&m->grid, &m->P, &mean, &most));
  SAY("  %d ranks: the fullest has %.3g times the mean of %.4g particles; borders moved %" PetscInt_FMT " times",
      m->grid.size, most, mean, m->grid.shared - 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}
