/* Lines of the summary that not every run has. */
#include "run_private.h"
#include "clathra/words.h"

/* What an integrator without matrices has to say at the end. */
void LocalSummary(const Stepper *s, char text[512])
{
  const double scaling     = StepperCase(s)->mass_scaling;
  char         scaled[128] = "";

  text[0] = '\0';
  if (!s->explicit)
    return;
  if (scaling > 1.0)
    snprintf(scaled, sizeof(scaled), "; mass scaling %g added inertia of up to %.2g of the forces", scaling,
             ExplicitMassScalingError(s->explicit));
  snprintf(text, 512, "  stable step %.4g s at the end (%s rules); %.0f B a particle%s\n", s->limit.dt,
           cl_limit_word[s->limit.rules], ExplicitBytesPerParticle(s->explicit), scaled);
}

/* What Newton's method left in the balances of mass: it goes back to the particles (28), so the ledger does not show
 * it. */
void LeftSummary(const Stepper *s, char text[128])
{
  const StepperState *z        = &s->state;
  double              share[2] = {0.0};

  text[0] = '\0';
  for (int ph = 0; ph < PHASE_COUNT; ph++)
    share[ph] = z->moved[ph] > 0.0 ? z->left[ph] / z->moved[ph] : 0.0;
  if (z->moved[PHASE_W] + z->moved[PHASE_G] > 0.0)
    snprintf(text, 128, "  left in the balances by Newton's method: water %.2e, gas %.2e of what moved\n",
             share[PHASE_W], share[PHASE_G]);
}

void GoneSummary(const StepperState *z, char text[512])
{
  const double *r = z->removed;

  text[0] = '\0';
  if (r[REMOVED_N] > 0.0)
    snprintf(
        text, 512,
        "  %.0f particles left the grid and were taken out, with %.4g kg of solid, %.4g kg of hydrate, %.4g kg of "
        "water and %.4g kg of methane (both with what hydrate holds), a momentum of (%.3g, %.3g) N s and a kinetic "
        "energy of %.3g J\n",
        r[REMOVED_N], r[REMOVED_SOLID], r[REMOVED_HYDRATE], r[REMOVED_WATER], r[REMOVED_METHANE], r[REMOVED_MOMENTUM],
        r[REMOVED_MOMENTUM + 1], r[REMOVED_ENERGY + ENERGY_KINETIC]);
}

/* The largest estimated error of any particle, and errors that were put up with. */
void LooseSummary(const Stepper *s, char text[512])
{
  const StepperState *z = &s->state;

  text[0] = '\0';
  if (z->peak > 0.0) {
    snprintf(text, 512, "  largest error of a step at any particle: %.3g of the tolerance, of %s near %s at t = %s\n",
             z->peak, stepper_error_word[(int)z->peak_of], PlaceWords(z->peak_at).s, TimeWords(z->peak_t, 4).s);
  }
  const size_t told = strlen(text);
  if (z->loose_total)
    snprintf(text + told, 512 - told,
             "  %" PetscInt_FMT " step%s accepted above the tolerance, with an estimated error of up "
             "to %.3g of it (at stepper_dt_min, or noise of the particles)\n",
             z->loose_total, z->loose_total == 1 ? " was" : "s were", z->err_worst);
}

/* Hydrate there is, kg, and what has become of it. */
void HydrateSummary(const StepperState *z, double now, char text[160])
{
  const double gone = z->hydrate0 - now;
  const int    told = snprintf(text, 160, "  hydrate %.7g kg", now);

  if (z->hydrate0 == 0.0 && now == 0.0)
    text[0] = '\0';
  else
    snprintf(text + told, 160 - (size_t)told,
             ", %.4g kg %s than at the start; hydrate positivity limiter acted %" PetscInt_FMT " times\n", fabs(gone),
             gone < 0.0 ? "more" : "less", z->limited_total);
}

/* Steps without (353), for (354) did not converge. */
void UnevenSummary(const StepperState *z, char text[256])
{
  text[0] = '\0';
  if (z->uneven_total)
    snprintf(text, 256,
             "  %" PetscInt_FMT " steps evened no pressures out within cells: their projection was not found in "
             "-exchange_ksp_max_it iterations\n",
             z->uneven_total);
}

/* Domains that act shorter than they are (BasisHalfLength). */
PetscErrorCode LongSummary(const Model *m, char text[256])
{
  bool     changes = m->c->basis == BASIS_CPGIMP; /* length, or cells */
  PetscInt n       = 0;

  for (int d = 0; d < CL_DIM; d++)
    changes = changes || m->grid.line[d].x;

  PetscFunctionBeginUser;
  text[0] = '\0';
  for (PetscInt p = 0; changes && m->c->basis != BASIS_LINEAR && p < m->P.n; p++) {
    bool cut = false;

    for (int d = 0; d < CL_DIM; d++)
      cut = cut || BasisReach(m->c->basis, &m->grid.line[d], m->P.f[P_X + d][p], INFINITY) * (1.0 + BASIS_SNAP) <
                       m->P.f[P_L + d][p];
    n += cut;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPIU_INT, MPI_SUM, m->grid.comm));
  if (n)
    snprintf(text, 256,
             "  %" PetscInt_FMT " particles are longer than a cell and leave gaps: take more of them in a cell\n", n);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The borders of the start are the first. */
PetscErrorCode RanksSummary(const Model *m, char text[128])
{
  double mean, most;

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (m->grid.size == 1)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ParticlesFullest(&m->grid, &m->P, &mean, &most));
  snprintf(text, 128,
           "  %d ranks: the fullest has %.3g times the mean of %.4g particles; borders moved %" PetscInt_FMT " times\n",
           m->grid.size, most, mean, m->grid.shared - 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}
