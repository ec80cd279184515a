/* plates: the two forms of a plate, and what its keys must agree in. */
#include "case_private.h"
#include "clathra/shape.h"

/* of a cell: so far a plate on a grid line may move; the spurious force it makes is the total stress times the motion
   over a cell */
#define SMALL 0.01

#define FAIL(b, key, ...) FAIL_AT(GROUP_BC, (b)->name, key, __VA_ARGS__)

PetscErrorCode PlateForm(Reader *r, Bc *b)
{
  const char *const key[] = {"side", "axis", "position"};
  bool              given[3], from_file;
  const char       *text;
  char              option[256];

  PetscFunctionBeginUser;
  if (b->type != BC_PLATE)
    PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 3; k++) {
    KeyOption(option, sizeof option, GROUP_BC, b->name, key[k]);
    PetscCall(ReaderFind(r, option, &text, &given[k], &from_file));
  }
  if (!given[0] && (given[1] || given[2]))
    b->type = BC_PLATE_LINE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Farthest that a velocity leads from the start, until t_end: at its kinks and where it turns; a wave at most by twice
 * its own swing. */
static double Farthest(const Schedule *velocity, double t_end)
{
  const Schedule plain = {.n = velocity->n, .t = velocity->t, .y = velocity->y, .steps = velocity->steps}, *v = &plain;
  double         far = 0.0;

  for (double t = 0.0, to; t < t_end; t = to) {
    to              = fmin(ScheduleNextKink(v, t), t_end);
    const double v0 = ScheduleValue(v, t), v1 = ScheduleValue(v, to), turn = t + (to - t) * v0 / (v0 - v1);

    if (!v->steps && v0 * v1 < 0.0)
      far = fmax(far, fabs(ScheduleIntegral(v, turn)));
    far = fmax(far, fabs(ScheduleIntegral(v, to)));
  }
  for (PetscInt k = 0; k < velocity->nwave; k++)
    far += fabs(velocity->wave[k].amplitude) * velocity->wave[k].period / M_PI;
  return far;
}

static void CheckLine(Reader *r, const Case *c, const Bc *b)
{
  const GridLines line = SceneLines(&c->scene, b->axis);
  const double    h    = LinesLeastAt(&line, b->position);
  const double    far  = Farthest(&b->value, c->nstage ? c->stage[c->nstage - 1].end : c->t_end);

  if (h > 0.0 && far > SMALL * h)
    FAIL(
        b, "velocity",
        "moves the plate %g m away from its grid line, which is right only for motions below %g m (%g of a cell): give "
        "the plate a side of the body (side: left, right, bottom, top) instead of axis and position",
        far, SMALL * h, SMALL);
}

/* Do two conditions share a part of the body's surface, sides or lines? */
static bool Meet(const Scene *c, const Bc *a, const Bc *b)
{
  return (a->along.n || b->along.n || a->side == b->side) && FacesShared(c, &BcFaces(a), &BcFaces(b));
}

static bool ActsIn(const Case *stage, const Bc *b)
{
  for (PetscInt k = 0; k < stage->scene.nbc; k++) {
    if (stage->scene.bc[k].number == b->number)
      return true;
  }
  return false;
}

/* A closed plate leaves no side open in any stage. */
static void CheckOpen(Reader *r, const Case *c, const Bc *b)
{
  for (PetscInt i = 0; i < PetscMax(c->nstage, 1) && !b->drained; i++) {
    const Case *stage = CaseInStage(c, i);

    for (PetscInt k = 0; k < stage->scene.nbc && ActsIn(stage, b); k++) {
      const Bc *o = &stage->scene.bc[k];

      if ((o->type != BC_PRESSURE && o->type != BC_INFLOW) || !Meet(&c->scene, b, o))
        continue;
      FAIL(b, "holds",
           "is all, a closed plate, but %s lets fluid through the same part of the side; a porous plate has holds: "
           "skeleton",
           o->name);
      return;
    }
  }
}

/* Where a plate is and what it holds counts from the start of the run, when the body was where it was seeded. */
static void CheckStages(Reader *r, const Case *c, const Bc *b)
{
  const bool counts = !b->force.n || b->rough;

  if (counts && b->of_stage)
    FAIL(b, "clock", "is stage, but %s counts from the start of the run",
         b->rough ? "what a rough plate holds" : "the position of a plate");
  if (counts && c->nstage && !ActsIn(CaseInStage(c, 0), b))
    FAIL(b,
         b->rough     ? "rough"
         : b->value.n ? "velocity"
                      : "displacement",
         "counts from the start of the run, but the plate does not act in the first stage; from a later one on it can "
         "have a force, and be smooth");
}

void CheckPlate(Reader *r, const Case *c, const Bc *b)
{
  if (b->type == BC_PLATE_LINE) {
    CheckLine(r, c, b);
    return;
  }
  if ((b->value.n > 0) + (b->displacement.n > 0) + (b->force.n > 0) != 1)
    FAIL(b, b->value.n && b->displacement.n ? "displacement" : "force",
         "leaves nothing for %s to say: give one of velocity, displacement and force",
         b->value.n ? "velocity" : "displacement");
  if (b->rough && b->separates)
    FAIL(b, "separates", "does not go with rough: where the body touches again its place on the plate is not known");
  for (PetscInt i = 0; b->separates && i < b->force.n; i++) {
    const double least = b->force.y[i] - ScheduleSwing(&b->force);

    if (least < 0.0) {
      FAIL(b, "force", "is %g N, a pull, but the plate separates", least);
      break;
    }
  }
  if (r->bad[GROUP_CASE] || r->bad[GROUP_REGION])
    return;
  if (!FacesShared(&c->scene, &BcFaces(b), &BcFaces(b)))
    FAIL(b, "side", "the body has no free surface there that the plate could act on");
  if (!r->bad[GROUP_STAGE]) {
    CheckOpen(r, c, b);
    CheckStages(r, c, b);
  }
}
