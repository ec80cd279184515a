/* stages: the case as it holds in each stage of a run.  All of it is made when the case is read; a run only looks. */
#include "case_private.h"
#include "clathra/shape.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define FAIL(stage, key, ...) FAIL_AT(GROUP_STAGE, (stage)->name, key, __VA_ARGS__)

/* Is there such a key in the file or on the command line? */
static PetscErrorCode Given(Reader *r, Group g, const char *instance, const char *key, bool *given)
{
  char        option[256];
  const char *text;
  bool        from_file;

  PetscFunctionBeginUser;
  KeyOption(option, sizeof option, g, instance, key);
  PetscCall(ReaderFind(r, option, &text, given, &from_file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds an error at the stage's key, or at the case's where the stage took its value. */
static void Fail(Reader *r, const char *stage, const char *key, const char *what)
{
  char option[256];
  bool given = false;

  if (!stage) {
    ReaderError(r, key, NULL, "%s", what);
    return;
  }
  KeyOption(option, sizeof option, GROUP_STAGE, stage, key);
  if (Given(r, GROUP_CASE, "", key, &given) || !given || Given(r, GROUP_STAGE, stage, key, &given) || given)
    ReaderError(r, option, NULL, "%s", what);
  else
    ReaderError(r, key, NULL, "in stage %s: %s", stage, what);
}

#define FAIL_STAGE(stage, key, ...)                                                                                    \
  do {                                                                                                                 \
    char what_[CASE_WHY];                                                                                              \
    snprintf(what_, sizeof what_, __VA_ARGS__);                                                                        \
    Fail(r, stage, key, what_);                                                                                        \
  } while (0)

/* What the case asks for and its integrator does not know. */
static void CheckIntegrator(Reader *r, const Case *c, const char *stage)
{
  const Bc   *b       = SceneBcUnknown(&c->scene, IntegratorKinds(c->integrator));
  const char *unknown = SceneUnknown(&c->scene, IntegratorKinds(c->integrator)), *word = case_integrator[c->integrator];

  if (b)
    FAIL_AT(GROUP_BC, b->name, "type", "%s%s%s%s does not know the condition %s; use sdirk2 or euler",
            stage ? "in stage " : "", stage ? stage : "", stage ? ": " : "", word, cl_condition[b->type].word);
  else if (unknown)
    FAIL_STAGE(stage, "stepper_type", "%s does not know %s; use sdirk2 or euler", word, unknown);
}

static void CheckSteps(Reader *r, const Case *c, const char *stage)
{
  const bool local = !(IntegratorKinds(c->integrator) & BY_IMPLICIT);

  if (!r->bad[GROUP_MATERIAL] && !r->bad[GROUP_REGION] && !r->bad[GROUP_BC])
    CheckIntegrator(r, c, stage);
  if (local && c->dt > c->dt_max)
    FAIL_STAGE(stage, "stepper_dt", "must not be above stepper_dt_max (%g s > %g s)", c->dt, c->dt_max);
  if (!local && (c->dt_min > c->dt || c->dt > c->dt_max))
    FAIL_STAGE(stage, "stepper_dt", "must lie between stepper_dt_min and stepper_dt_max (%g s <= %g s <= %g s fails)",
               c->dt_min, c->dt, c->dt_max);
  if (c->scene.axisymmetric && c->scene.gravity[0] != 0.0)
    FAIL_STAGE(stage, "gravity", "must point along the axis, y, when geometry is axisymmetric (%g m/s^2 along x)",
               c->scene.gravity[0]);
}

PetscErrorCode CaseStageEnds(Reader *r, Case *c)
{
  double before = 0.0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->nstage; i++) {
    CaseStage     *s      = &c->stage[i];
    const PetscInt errors = r->nerror;

    PetscCall(KeyRead(r, c, GROUP_STAGE, i, case_group[GROUP_STAGE].key)); /* the first key: end */
    r->bad[GROUP_STAGE] = r->bad[GROUP_STAGE] || r->nerror > errors;
    if (r->bad[GROUP_STAGE])
      continue;
    if (s->end <= before) {
      FAIL(s, "end", "is %g s but %s at %g s: %s", s->end, i ? "the stage before ends" : "the run begins", before,
           s->end == before ? "the stage is empty" : "stages must be listed in the order of their ends");
      r->bad[GROUP_STAGE] = true;
    }
    before = s->end;
  }
  if (c->nstage)
    c->t_end = before > 0.0 ? before : 1.0; /* 1: so that the rest of a bad case is read */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- keys */
/* "1e-3 @time_end" of the case's key means that share of the stage's length. */
static void OfLength(const char *name, const Case *c, void *place)
{
  for (const Key *k = case_group[GROUP_CASE].key; k->name; k++) {
    if (!strcmp(k->name, name) && k->def && strstr(k->def, "@time_end"))
      *(double *)place = strtod(k->def, NULL) * (c->t_end - c->scene.t_begin);
  }
}

static PetscErrorCode StageKeys(Reader *r, Case *c, PetscInt i)
{
  CaseStage *s = &c->stage[i];

  PetscFunctionBeginUser;
  for (const Key *k = case_group[GROUP_STAGE].key + 1; k->name; k++) {
    bool given = true;

    if (k->kept)
      PetscCall(Given(r, GROUP_CASE, "", k->name, &given));
    if (!given)
      OfLength(k->name, &s->c, (char *)s + k->offset);
    PetscCall(KeyRead(r, c, GROUP_STAGE, i, k));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- boundaries */
/* Index of a name among those of a group, -1 and an error if it is not there. */
static PetscInt Find(Reader *r, const Case *c, const CaseStage *s, const char *key, Group g, const char *name)
{
  const Key names = {.kind = KEY_NAMES, .names = g};
  char      option[256];
  PetscInt  i;

  KeyOption(option, sizeof option, GROUP_STAGE, s->name, key);
  return KeyName(r, c, option, name, &names, &i) ? i : -1;
}

static void MarkNames(Reader *r, const Case *c, const CaseStage *s, const char *key, const char *names, bool *marked)
{
  List list;

  ListCreate(names, &list);
  for (PetscInt i = 0; i < list.n; i++) {
    const PetscInt k = Find(r, c, s, key, GROUP_BC, list.item[i]);

    if (k < 0)
      continue;
    if (marked[k])
      FAIL(s, key, "the boundary %s is listed twice", c->scene.bc[k].name);
    marked[k] = true;
  }
  ListDestroy(&list);
}

/* The stage's own list of conditions, in the case's order. */
static PetscErrorCode StageBoundaries(Reader *r, const Case *c, CaseStage *s)
{
  const bool all = !strcasecmp(s->boundaries, "all"), none = !strcasecmp(s->boundaries, "none");
  bool       marked[256] = {false};
  PetscInt   n           = 0;

  PetscFunctionBeginUser;
  if (!all && s->off[0])
    FAIL(s, "boundaries_off", "is given beside boundaries; choose one");
  MarkNames(r, c, s, all ? "boundaries_off" : "boundaries", all ? s->off : none ? "" : s->boundaries, marked);
  PetscCall(PetscMalloc1(PetscMax(c->scene.nbc, 1), &s->c.scene.bc));
  for (PetscInt k = 0; k < c->scene.nbc; k++) {
    if (marked[k] == all)
      continue;
    s->c.scene.bc[n]      = c->scene.bc[k];
    s->c.scene.bc[n].zero = c->scene.bc[k].of_stage ? s->c.scene.t_begin : 0.0;
    n++;
  }
  s->c.scene.nbc = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- materials */
/* The first key that ties masses to pressures and volumes, or hydrate to water and gas, and differs: it cannot, while
   all of them stay; NULL if there is none. */
static const char *Differs(const Case *c, const Material *a, const Material *b)
{
  for (const Key *k = case_group[GROUP_MATERIAL].key; k->name; k++) {
    if ((k->binds & c->scene.fields.has) && (KeyActs(k, c, a) || KeyActs(k, c, b)) &&
        KeyHash(FNV_START, k, (const char *)a) != KeyHash(FNV_START, k, (const char *)b))
      return k->name;
  }
  return NULL;
}

static PetscErrorCode StageMaterials(Reader *r, const Case *c, CaseStage *s)
{
  List list;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(PetscMax(c->scene.nregion, 1), &s->c.scene.region));
  PetscCall(PetscArraycpy(s->c.scene.region, c->scene.region, c->scene.nregion));
  PetscCall(PetscMalloc1(PetscMax(c->scene.nmaterial, 1), &s->c.scene.material));
  PetscCall(PetscArraycpy(s->c.scene.material, c->scene.material, c->scene.nmaterial));
  ListCreate(s->materials, &list);
  if (list.n % 2)
    FAIL(s, "materials", "has %d names, needs pairs: region, material, ...", (int)list.n);
  for (PetscInt i = 0; i + 1 < list.n; i += 2) {
    const PetscInt g = Find(r, c, s, "materials", GROUP_REGION, list.item[i]);
    const PetscInt m = Find(r, c, s, "materials", GROUP_MATERIAL, list.item[i + 1]);

    if (g < 0 || m < 0)
      continue;
    if (RegionEmpty(&c->scene.region[g])) {
      FAIL(s, "materials", "region %s has no particles (material: none)", c->scene.region[g].name);
      continue;
    }
    const Material *old = &c->scene.material[c->scene.region[g].material];
    const char     *why = Differs(c, old, &c->scene.material[m]);

    if (why)
      FAIL(s, "materials",
           "region %s cannot change from %s to %s, whose %s differs: its masses could not stay as they are",
           c->scene.region[g].name, old->name, c->scene.material[m].name, why);
    s->c.scene.region[g].material = m;
  }
  ListDestroy(&list);
  for (PetscInt m = 0; m < c->scene.nmaterial; m++)
    s->c.scene.material[m].plasticity.factor = s->c.scene.strength_factor;
  for (PetscInt m = 0; m < c->scene.nmaterial && !s->reaction; m++)
    s->c.scene.material[m].kinetics.K0 = 0.0; /* hydrate stays, and goes on to count as water and gas in the balances */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- all of it */
PetscErrorCode CaseStages(Reader *r, Case *c)
{
  const PetscInt before = r->nerror;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->nstage; i++) {
    CaseStage *s = &c->stage[i];

    s->c               = *c;
    s->c.scene.t_begin = i ? c->stage[i - 1].end : 0.0;
    s->c.t_end         = s->end;
    PetscCall(StageKeys(r, c, i));
    s->c.scene.fields.inertia = s->c.scene.inertia;
    PetscCall(StageMaterials(r, c, s));
    PetscCall(StageBoundaries(r, c, s));
    for (int d = 0; d < CL_DIM; d++)
      s->c.scene.gravity_before[d] = i ? c->stage[i - 1].c.scene.gravity[d] : 0.0;
  }
  r->bad[GROUP_STAGE] = r->bad[GROUP_STAGE] || r->nerror > before;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void CheckRamp(Reader *r, const CaseStage *s)
{
  bool changes = false;

  for (int d = 0; d < CL_DIM; d++)
    changes = changes || s->c.scene.gravity_before[d] != s->c.scene.gravity[d];
  if (changes && s->c.scene.gravity_ramp > s->c.t_end - s->c.scene.t_begin)
    Fail(r, s->name, "gravity_ramp",
         "must not be longer than the stage, in which gravity changes, where another one follows");
}

void CheckTimes(Reader *r, const Case *c)
{
  const CaseStage *last = c->nstage ? &c->stage[c->nstage - 1] : NULL;

  if (!last)
    CheckSteps(r, c, NULL);
  else if (c->t_end != last->end)
    ReaderError(r, "time_end", NULL, "is %g s but the last stage, %s, ends at %g s; leave it out", c->t_end, last->name,
                last->end);
  for (const CaseStage *s = c->stage; last && s <= last; s++) {
    if (s < last)
      CheckRamp(r, s);
    CheckSteps(r, &s->c, s->name);
  }
}

PetscErrorCode CaseStagesDestroy(Case *c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->nstage; i++) {
    PetscCall(PetscFree(c->stage[i].c.scene.bc));
    PetscCall(PetscFree(c->stage[i].c.scene.region));
    PetscCall(PetscFree(c->stage[i].c.scene.material));
  }
  PetscCall(PetscFree(c->stage));
  PetscFunctionReturn(PETSC_SUCCESS);
}
