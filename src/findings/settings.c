/* What a case or an option asks for that comes to nothing, or to something else than it looks. */
#include "findings_private.h"
#include "clathra/words.h"

#define LAYERED 2.0 /* ratio of permeabilities from which on layers count */

/* A time between two outputs that is longer than the run, or the stage, means none between its start and its end. */
static PetscErrorCode SayLate(const Findings *f, FindingId id, const Case *c, const char *stage, const char *key,
                              double every)
{
  const double length = c->t_end - c->scene.t_begin;

  PetscFunctionBeginUser;
  if (every > length * (1.0 + 1e-9))
    SAY("%s%s%s (%s) is longer than the %s (%s): it asks for nothing before its end", stage, stage[0] ? ": " : "", key,
        TimeWords(every, 4).s, stage[0] ? "stage" : "run", TimeWords(length, 4).s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FindingsFindLateOutput(Findings *f, FindingId id)
{
  const Case *c = f->c;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < PetscMax(c->nstage, 1); k++) {
    const Case *in    = CaseInStage(c, k);
    const char *stage = c->nstage ? c->stage[k].name : "";

    if (c->nstage && in->every == c->every && c->every <= c->t_end) /* the case's, for stages longer than this one */
      continue;
    PetscCall(SayLate(f, id, in, stage, "output_every", in->every));
  }
  PetscCall(SayLate(f, id, c, "", "output_probe_every", c->probe_every));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (350) is not in the paper's bare form. */
PetscErrorCode FindingsFindPaperLayers(Findings *f, FindingId id)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < PetscMax(f->c->nstage, 1); k++) {
    const Case  *c        = CaseInStage(f->c, k);
    const double contrast = IntegratorKinds(c->integrator) == BY_PAPER ? SceneContrast(&c->scene) : 1.0;

    if (contrast > LAYERED)
      SAY("permeability of the regions differs by a factor of %.3g: in the paper's form the least permeable material "
          "at a node holds all of its fluid, so that what flows along a layer is too little by what flows through "
          "about a cell of it",
          contrast);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The solver has read its own by now. */
PetscErrorCode FindingsFindUnusedOptions(Findings *f, FindingId id)
{
  char   **name, **value;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsLeftGet(NULL, &n, &name, &value));
  for (PetscInt k = 0; k < n; k++)
    SAY("option -%s was not used", name[k]);
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &name, &value));
  PetscFunctionReturn(PETSC_SUCCESS);
}
