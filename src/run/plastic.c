/* What a run says of a skeleton that yields: its strength at the start, how many particles yield or tear. */
#include "plastic.h"
#include "clathra/words.h"

#define TEARING 0.01 /* share of the particles at the apex that is worth a word while the run goes on */

PetscErrorCode PrintStrength(const Scene *c, MPI_Comm comm)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->nregion; k++) {
    const Region     *r           = &c->region[k];
    const Plasticity *p           = r->material < 0 ? NULL : &c->material[r->material].plasticity;
    char              reduced[48] = "", grows[96] = "";
    Strength          s;

    if (!p || p->type != PLASTICITY_MOHR_COULOMB || !c->fields.solid)
      continue;
    if (c->strength_factor != 1.0)
      snprintf(reduced, sizeof(reduced), ", strength_factor %g", c->strength_factor);
    const double     ends[2] = {StrengthDepth(p, r->lower), StrengthDepth(p, r->upper)};
    const Plasticity top     = StrengthAtDepth(p, fmin(ends[0], ends[1])),
                     foot    = StrengthAtDepth(p, fmax(ends[0], ends[1]));

    StrengthEvaluate(&foot, r->Sh, 0.0, &s);
    if (p->gradient > 0.0)
      snprintf(grows, sizeof(grows), " at its top and %s at its foot", PressureWords(s.c, 6).s);
    StrengthEvaluate(&top, r->Sh, 0.0, &s);
    PetscCall(PetscPrintf(
        comm, "  region %s starts with cohesion %s%s, friction %.4g deg, dilation %.4g deg (S_h = %g%s)\n", r->name,
        PressureWords(s.c, 6).s, grows, s.phi * 180.0 / M_PI, s.psi * 180.0 / M_PI, r->Sh, reduced));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Over all particles of the scene. */
typedef struct {
  double all, yield, apex, work, behind; /* behind: sum of eps_d_p of those at the apex */
  double eps, torn;                      /* largest eps_d_p, and of those at the apex */
} Yielding;

static PetscErrorCode Count(const Model *m, Yielding *y)
{
  const Particles *P = &m->P;

  PetscFunctionBeginUser;
  *y = (Yielding){.all = (double)P->n};
  for (PetscInt p = 0; p < P->n; p++) {
    const double at = P->f[P_YIELD][p];

    y->yield += at != (double)RETURN_ELASTIC;
    y->apex += at == (double)RETURN_APEX;
    y->work += P->f[P_WP][p];
    y->eps = fmax(y->eps, P->f[P_EPS][p]);
    if (at == (double)RETURN_APEX) {
      y->behind += P->f[P_EPS][p];
      y->torn = fmax(y->torn, P->f[P_EPS][p]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &y->all, 5, MPI_DOUBLE, MPI_SUM, m->grid.comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &y->eps, 2, MPI_DOUBLE, MPI_MAX, m->grid.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode YieldText(const Model *m, char text[128])
{
  char     tears[64] = "";
  Yielding y;

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (!m->P.f[P_YIELD])
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Count(m, &y));
  if (y.apex > TEARING * y.all)
    snprintf(tears, sizeof(tears), ", %.0f at the apex (tearing; eps_d_p %.2g, up to %.2g)", y.apex, y.behind / y.apex,
             y.torn);
  if (y.yield > 0.0)
    snprintf(text, 128, ", %.0f particles yield%s", y.yield, tears);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode YieldSummary(const Model *m, char text[256])
{
  char     tears[64] = "";
  Yielding y;

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (!m->P.f[P_YIELD])
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Count(m, &y));
  if (y.apex > 0.0)
    snprintf(tears, sizeof(tears), " (eps_d_p %.2g, up to %.2g)", y.behind / y.apex, y.torn);
  snprintf(text, 256,
           "  plastic: %.0f of %.0f particles yield at the end, %.0f at the apex%s; eps_d_p up to %.3g, %.6g "
           "J dissipated\n",
           y.yield, y.all, y.apex, tears, y.eps, y.work);
  PetscFunctionReturn(PETSC_SUCCESS);
}
