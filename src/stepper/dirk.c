/* Diagonally implicit Runge-Kutta methods: backward Euler and Alexander's SDIRK of two stages; docs/equations.md,
   section 8. */
#include "clathra/stepper.h"

#define GAMMA (1.0 - 0.70710678118654752440)
/* of k_1, k_2 where b^ integrates quadratics through c = 0, GAMMA, 1 */
#define HAT_1 (1.0 / (6.0 * GAMMA * (1.0 - GAMMA)))
#define HAT_2 (0.5 - HAT_1 * GAMMA)

static const Tableau euler = {
    .stages = 1, .a = {{1.0}}, .embedded = {0.5, 0.5}, .embedded_fresh = {0.0, 1.0}, .error_order = 2};
static const Tableau sdirk2 = {.stages         = 2,
                               .a              = {{GAMMA}, {1.0 - GAMMA, GAMMA}},
                               .embedded       = {1.0 - HAT_1 - HAT_2, HAT_1, HAT_2},
                               .embedded_fresh = {0.0, 1.0, 0.0},
                               .error_order    = 3};

const StepperScheme StepperScheme_Euler  = {.kind = INTEGRATOR_EULER, .tableau = &euler};
const StepperScheme StepperScheme_Sdirk2 = {.kind = INTEGRATOR_SDIRK2, .tableau = &sdirk2};

/* p_w, p_g, T, S_h of a particle at t_n, and their rates in the last step; zero where there is no such field. */
static void History(const Model *m, PetscInt p, double y[TRIAL_SCALARS], double rate[TRIAL_SCALARS])
{
  static const int held[TRIAL_SCALARS] = {P_PW, P_PG, P_T, P_SH};

  for (int k = 0; k < TRIAL_SCALARS; k++) {
    y[k]    = m->P.f[held[k]] ? m->P.f[held[k]][p] : 0.0;
    rate[k] = m->P.f[P_RATE] ? m->P.f[P_RATE + k][p] : 0.0;
  }
  if (m->P.f[P_PG])
    y[1] = GasToBe(y[0], y[1]);
}

/* Rates k of the stages of a variable from its value at t_n and, in k, those at the ends of the stages. */
static void RatesOfStages(const Tableau *b, double dt, double y_n, double k[DIRK_STAGES])
{
  for (int i = 0; i < b->stages; i++) {
    k[i] -= y_n;
    for (int j = 0; j < i; j++)
      k[i] -= b->a[i][j] * dt * k[j];
    k[i] /= b->a[i][i] * dt;
  }
}

/* Error of a step of length dt (26) from the rates of the step before and of the stages. */
static double ErrorOfStep(const Tableau *b, bool fresh, double dt, double k_n, const double k[DIRK_STAGES])
{
  const double *hat = fresh ? b->embedded_fresh : b->embedded;
  double        sum = hat[0] * k_n;

  for (int i = 0; i < b->stages; i++)
    sum += (hat[1 + i] - b->a[b->stages - 1][i]) * k[i];
  return dt * sum;
}

/* (24) in values: stage i starts from y_n + sum_j d_j (y_j - y_n). */
static void SharesOfStages(const Tableau *b, int i, double d[DIRK_STAGES])
{
  for (int j = i - 1; j >= 0; j--) {
    double weight = b->a[i][j]; /* of dt k_j, less what later stages started with of it */

    for (int l = j + 1; l < i; l++)
      weight -= d[l] * b->a[l][j];
    d[j] = weight / b->a[j][j];
  }
}

/* Starred values of stage i (24). */
static void StartOfStage(Stepper *s, int i, double dt)
{
  const Model    *m   = s->model;
  const FieldSet *fs  = &m->c->fields;
  const Tableau  *b   = s->scheme->tableau;
  StepperWork    *w   = &s->work;
  const double   *x_n = ModelStart(m);
  double          d[DIRK_STAGES];

  SharesOfStages(b, i, d);
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    for (PetscInt k = I * fs->n; k < (I + 1) * fs->n; k++) {
      w->x_star[k] = x_n[k];
      for (int j = 0; j < i; j++)
        w->x_star[k] += d[j] * (w->x_stage[j][k] - x_n[k]);
    }
    for (int q = 0; q < CL_DIM; q++) {
      w->u_star[I * CL_DIM + q] = 0.0;
      for (int j = 0; fs->solid && j < i; j++)
        w->u_star[I * CL_DIM + q] += b->a[i][j] * dt * w->x_stage[j][I * fs->n + PlaceVs(fs) + q];
    }
  }
  for (PetscInt p = 0; p < m->P.n; p++) {
    for (int k = 0; k < TRIAL_MASSES; k++) {
      const double m_n  = m->P.f[P_MH + k] ? m->P.f[P_MH + k][p] : 0.0;
      double      *star = &w->m_star[TRIAL_MASSES * p + k];

      *star = m_n;
      for (int j = 0; j < i; j++)
        *star += d[j] * (w->trial[j].m[TRIAL_MASSES * p + k] - m_n);
    }
    if (!w->k_star)
      continue;
    const SkeletonStage y_n = ModelSkeletonStart(m, p);

    w->k_star[p] = y_n;
    for (int j = 0; j < i; j++)
      SkeletonStar(&y_n, &w->trial[j].end[p], d[j], &w->k_star[p]);
  }
}

/* Rates of plastic strain and stress at the end of the step, and their errors. */
static void PlasticErrors(Stepper *s, double dt)
{
  const Particles *P    = &s->model->P;
  const Tableau   *b    = s->scheme->tableau;
  StepperWork     *w    = &s->work;
  Trial           *last = &w->trial[b->stages - 1];

  for (PetscInt k = 0; w->e_plastic && k < TRIAL_PLASTIC * P->n; k++) {
    const PetscInt p = k / TRIAL_PLASTIC;
    const int      q = (int)(k % TRIAL_PLASTIC); /* eps_d_p, stress xx yy zz xy */
    double         rate[DIRK_STAGES];

    for (int i = 0; i < b->stages; i++)
      rate[i] = w->trial[i].s[k];
    RatesOfStages(b, dt, P->f[q ? P_SIG + q - 1 : P_EPS][p], rate);
    w->e_plastic[k] = ErrorOfStep(b, s->state.fresh, dt, P->f[P_KP + q][p], rate);
    last->k[k]      = rate[b->stages - 1];
  }
}

double StepperErrorNorm(Stepper *s, const double *e, const double *eu, Attempt *a)
{
  const Model *m                       = s->model;
  const double scale[STEPPER_ERRORS]   = {s->state.scale_p, s->state.scale_p,  s->state.scale_T, STEPPER_SCALE_SH,
                                          s->state.scale_u, STEPPER_SCALE_EPS, s->state.scale_p};
  const double half                    = 0.5 * CaseOf(m->c)->error_exponent;
  double       sum[STEPPER_ERRORS + 1] = {0.0}, worst = 0.0, top = 0.0;

  a->peak = (Peak){.err = 0.0};
  for (PetscInt p = 0; p < m->P.n; p++) {
    double square[STEPPER_ERRORS] = {0.0};

    for (int k = 0; k < TRIAL_SCALARS; k++)
      square[k] = PetscSqr(e[TRIAL_SCALARS * p + k]);
    square[TRIAL_SCALARS] = VectorDot(&eu[CL_DIM * p], &eu[CL_DIM * p]);
    for (int k = 0; s->work.e_plastic && k < TRIAL_PLASTIC; k++)
      square[k ? 6 : 5] += PetscSqr(s->work.e_plastic[TRIAL_PLASTIC * p + k]);
    for (int k = 0; k < STEPPER_ERRORS; k++) {
      const double one = ClSize(square[k] / PetscSqr(s->tol * scale[k]));

      sum[k] += pow(one, half);
      if (one > top) {
        top     = one;
        a->peak = (Peak){.err = sqrt(one), .of = k};
        ParticlePlace(&m->P, p, a->peak.at);
      }
    }
  }
  sum[STEPPER_ERRORS] = (double)m->P.n;
  if (GridShareLargest(m->grid.comm, &a->peak, sizeof(a->peak)) ||
      MPI_Allreduce(MPI_IN_PLACE, sum, STEPPER_ERRORS + 1, MPI_DOUBLE, MPI_SUM, m->grid.comm))
    return NAN;
  a->rules = 0;
  for (int k = 0; k < STEPPER_ERRORS; k++) {
    const double err = ClSize(pow(sum[k] / sum[STEPPER_ERRORS], 0.5 / half));

    if (err > worst) {
      worst    = err;
      a->rules = k;
    }
  }
  return worst;
}

/* Rates of p_w, p_g, T, S_h at the end of the step; norm of the errors of all that has one. */
static PetscErrorCode Errors(Stepper *s, double dt, Attempt *a)
{
  const Model   *m = s->model;
  const Tableau *b = s->scheme->tableau;
  StepperWork   *w = &s->work;
  double        *e, *eu;

  PetscFunctionBeginUser;
  PlasticErrors(s, dt);
  PetscCall(PetscMalloc2(TRIAL_SCALARS * m->P.n, &e, CL_DIM * m->P.n, &eu));
  for (PetscInt p = 0; p < m->P.n; p++) {
    double y_n[TRIAL_SCALARS], k_n[TRIAL_SCALARS], rate[DIRK_STAGES];

    History(m, p, y_n, k_n);
    for (int k = 0; k < TRIAL_SCALARS; k++) {
      const PetscInt q = TRIAL_SCALARS * p + k;

      for (int i = 0; i < b->stages; i++)
        rate[i] = w->trial[i].y[q];
      RatesOfStages(b, dt, y_n[k], rate);
      w->rates[q] = rate[b->stages - 1];
      e[q]        = ErrorOfStep(b, s->state.fresh, dt, k_n[k], rate);
    }
    for (PetscInt q = CL_DIM * p; q < CL_DIM * (p + 1); q++) {
      for (int i = 0; i < b->stages; i++)
        rate[i] = w->trial[i].v[q];
      eu[q] = ErrorOfStep(b, s->state.fresh, dt, w->v_n[q], rate);
    }
  }
  a->err = StepperErrorNorm(s, e, eu, a);
  PetscCall(PetscFree2(e, eu));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A stage that ends at t, of length dt, from the starred values in the work space; weight (s) is its share of the
   step's integrals. */
static PetscErrorCode StageSolve(Stepper *s, double t, double dt, Trial *trial, double weight, Attempt *a)
{
  Model       *m     = s->model;
  StepperWork *w     = &s->work;
  const Stage  stage = {.t      = t,
                        .dt     = dt,
                        .ahead  = t - s->state.t,
                        .drain  = w->drain,
                        .x_star = w->x_star,
                        .u_star = w->u_star,
                        .m_star = w->m_star,
                        .k_star = w->k_star};
  StageRates   rates;
  PetscInt     newton = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelBeginStage(m, &stage));
  PetscCall(ModelPlatesCheck(m, &a->status));
  if (a->status == CL_OK)
    PetscCall(ModelSolve(m, w->x, &newton, &a->status));
  a->newton += newton;
  if (a->status == CL_OK)
    PetscCall(ModelEndStage(m, w->x, trial, &rates, &a->status));
  if (a->status != CL_OK)
    PetscFunctionReturn(PETSC_SUCCESS);
  a->limited += m->limited;
  StepperCount(m->c, &rates, weight, a);
  PetscFunctionReturn(PETSC_SUCCESS);
}

bool StepperBlind(const Stepper *s)
{
  const Tableau *b = s->scheme->tableau;

  return s->state.fresh && !memcmp(&b->embedded_fresh[1], b->a[b->stages - 1], (size_t)b->stages * sizeof(double));
}

PetscErrorCode StepperDirkStep(Stepper *s, double dt, Attempt *a)
{
  const Tableau *b    = s->scheme->tableau;
  const double  *last = b->a[b->stages - 1];
  StepperWork   *w    = &s->work;

  PetscFunctionBeginUser;
  for (int i = 0; i < b->stages; i++) {
    double end = 0.0;

    for (int j = 0; j <= i; j++)
      end += b->a[i][j];
    StartOfStage(s, i, dt);
    PetscCall(StageSolve(s, s->state.t + end * dt, b->a[i][i] * dt, &w->trial[i], last[i] * dt, a));
    if (a->status != CL_OK)
      PetscFunctionReturn(PETSC_SUCCESS);
    if (i < b->stages - 1)
      PetscCall(PetscArraycpy(w->x_stage[i], w->x, s->model->map.n_local * s->model->c->fields.n));
  }
  PetscCall(Errors(s, dt, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}
