/* What the implicit schemes know of the skeleton: where a second stage starts, and the error of plastic strain and
   stress; docs/equations.md, section 8. */
#include "clathra/stepper.h"

void StepperStarSkeleton(Stepper *s, double c)
{
  const Model *m = s->model;
  StepperWork *w = &s->work;

  for (PetscInt p = 0; w->k_star && p < m->P.n; p++) {
    const SkeletonStage y_n = ModelSkeletonStart(m, p);

    SkeletonStar(&y_n, &w->trial[0].end[p], c, &w->k_star[p]);
  }
}

void StepperPlasticErrors(Stepper *s, double dt, double gamma, const double weight[3])
{
  const Particles *P    = &s->model->P;
  StepperWork     *w    = &s->work;
  const int        last = s->scheme->stages - 1;

  for (PetscInt p = 0; w->e_plastic && p < P->n; p++) {
    for (int q = 0; q < TRIAL_PLASTIC; q++) { /* eps_d_p, stress xx yy zz xy */
      const double y_n = P->f[q ? P_SIG + q - 1 : P_EPS][p], k_n = P->f[P_KP + q][p];
      const double k_1 = (w->trial[0].s[TRIAL_PLASTIC * p + q] - y_n) / (gamma * dt);
      const double k_2 =
          last ? (w->trial[1].s[TRIAL_PLASTIC * p + q] - y_n - (1.0 - gamma) * dt * k_1) / (gamma * dt) : 0.0;

      w->e_plastic[TRIAL_PLASTIC * p + q]     = dt * (weight[0] * k_n + weight[1] * k_1 + weight[2] * k_2);
      w->trial[last].k[TRIAL_PLASTIC * p + q] = last ? k_2 : k_1;
    }
  }
}
