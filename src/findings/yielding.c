/* How many particles yield or tear. */
#include "findings_private.h"

#define TEARING 0.01 /* share of the particles at the apex that is worth a word while the run goes on */

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

PetscErrorCode FindingsYieldText(const Model *m, char text[128])
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

PetscErrorCode FindingsFindYielding(Findings *f, FindingId id)
{
  char     tears[64] = "";
  Yielding y;

  PetscFunctionBeginUser;
  if (!f->s->model->P.f[P_YIELD])
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Count(f->s->model, &y));
  if (y.apex > 0.0)
    snprintf(tears, sizeof(tears), " (eps_d_p %.2g, up to %.2g)", y.behind / y.apex, y.torn);
  SAY("  plastic: %.0f of %.0f particles yield at the end, %.0f at the apex%s; eps_d_p up to %.3g, %.6g J dissipated",
      y.yield, y.all, y.apex, tears, y.eps, y.work);
  PetscFunctionReturn(PETSC_SUCCESS);
}
