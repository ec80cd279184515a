/* What gave nothing in a whole stage: conditions and meters that the case lists, and that a user counts on. */
#include "findings_private.h"
#include "clathra/words.h"

#define STILL_WORDS 2048

/* Is it asked for nothing at any time?  Of what is given as a rate. */
static bool AsksNothing(const Bc *b)
{
  const unsigned rates =
      1u << BC_TRACTION | 1u << BC_HEAT_FLUX | 1u << BC_INFLOW | 1u << BC_HEAT_SOURCE | 1u << BC_WELL;
  bool zero = (rates >> b->type & 1u) && (b->type == BC_INFLOW || ScheduleIsZero(&b->value));

  if (b->type == BC_WELL && b->value.n)
    return false;
  zero = zero && ScheduleIsZero(&b->shear);
  for (int phase = 0; phase < PHASE_COUNT; phase++)
    zero = zero && ScheduleIsZero(&b->phase[phase]) && ScheduleIsZero(&b->rate[phase]);
  return zero;
}

/* Does the condition prescribe anything at an active node of this rank? */
static bool Holds(const Model *m, const Bc *b)
{
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    double x[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      x[d] = GridNode(&m->grid, d, m->map.ij[I][d]);
    if (NodePrescribed(m->c, &m->grid, b, x))
      return true;
  }
  return false;
}

/* Adds to `acts` what no face shows: nodes that are held, plates that bear something. */
static PetscErrorCode AddNodes(const Model *m, double acts[])
{
  PetscInt holds[CL_CONDITIONS] = {0};
  bool     open                 = false;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->nbc; k++) {
    const Bc  *b     = &m->c->bc[k];
    const bool nodes = cl_condition[b->type].node, plate = b->type == BC_PLATE;

    if (acts[b->number] != 0.0 || !(nodes || plate))
      continue;
    open     = true;
    holds[k] = plate ? m->plate[b->number][PLATE_FORCE] != 0.0 : Holds(m, b);
  }
  if (!open)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, holds, (PetscMPIInt)m->c->nbc, MPIU_INT, MPI_MAX, m->grid.comm));
  for (PetscInt k = 0; k < m->c->nbc; k++)
    acts[m->c->bc[k].number] += (double)holds[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ", a b" behind what is there. */
static void Add(const char *kind, const char *name, char words[STILL_WORDS])
{
  const size_t n = strlen(words);

  snprintf(words + n, STILL_WORDS - n, "%s%s %s", n ? ", " : "", kind, name);
}

/* At the end of a stage, or of a run without stages: conditions and meters of which nothing came in all of it. */
PetscErrorCode FindingsFindStill(Findings *f, FindingId id)
{
  Stepper     *s                  = f->s;
  const Model *m                  = s->model;
  const Scene *c                  = m->c;
  double      *acts               = s->state.acts;
  char         words[STILL_WORDS] = "", stage[80];

  PetscFunctionBeginUser;
  PetscCall(AddNodes(m, acts));
  if (!StepperStageDone(s))
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < c->nbc; k++) {
    if (acts[c->bc[k].number] == 0.0 && !AsksNothing(&c->bc[k]))
      Add(cl_condition[c->bc[k].type].word, c->bc[k].name, words);
  }
  for (PetscInt k = 0; k < c->nmeter; k++) {
    if (acts[ACTS_METER + k] == 0.0)
      Add("meter", c->meter[k].name, words);
  }
  StepperStageWords(s, stage);
  if (words[0])
    SAY("%sfrom %s to %s nothing at all came of: %s", stage, TimeWords(c->t_begin, 6).s, TimeAt(s->state.t).s, words);
  PetscFunctionReturn(PETSC_SUCCESS);
}
