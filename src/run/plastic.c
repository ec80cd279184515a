/* What a run says at its start of a skeleton that yields: the strength of its regions. */
#include "run_private.h"
#include "clathra/words.h"

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
