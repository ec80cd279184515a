/* What a run says of a skeleton that yields: its strength at the start, how many particles yield or tear. */
#include "plastic.h"

#define TEARING 0.01 /* share of the particles at the apex that is worth a word while the run goes on */

PetscErrorCode PrintStrength(const Case *c, MPI_Comm comm)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->nregion; k++) {
    const Region     *r = &c->region[k];
    const Plasticity *p = r->material < 0 ? NULL : &c->material[r->material].plasticity;
    Strength          s;

    if (!p || p->type != PLASTICITY_MOHR_COULOMB || !c->fields.solid)
      continue;
    StrengthEvaluate(p, r->Sh, 0.0, &s);
    PetscCall(PetscPrintf(comm,
                          "  region %s starts with cohesion %.6g Pa, friction %.4g deg, dilation %.4g deg (S_h = %g)\n",
                          r->name, s.c, s.phi * 180.0 / M_PI, s.psi * 180.0 / M_PI, r->Sh));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Over all particles of the scene. */
typedef struct {
  double all, yield, apex, work, eps;
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
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &y->all, 4, MPI_DOUBLE, MPI_SUM, m->grid.comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &y->eps, 1, MPI_DOUBLE, MPI_MAX, m->grid.comm));
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
    PetscCall(PetscSNPrintf(tears, sizeof(tears), ", %.0f at the apex (tearing)", y.apex));
  if (y.yield > 0.0)
    PetscCall(PetscSNPrintf(text, 128, ", %.0f particles yield%s", y.yield, tears));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode YieldSummary(const Model *m, char text[256])
{
  Yielding y;

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (!m->P.f[P_YIELD])
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Count(m, &y));
  PetscCall(
      PetscSNPrintf(text, 256,
                    "  plastic: %.0f of %.0f particles yield at the end, %.0f at the apex; eps_d_p up to %.3g, %.6g "
                    "J dissipated\n",
                    y.yield, y.all, y.apex, y.eps, y.work));
  PetscFunctionReturn(PETSC_SUCCESS);
}
