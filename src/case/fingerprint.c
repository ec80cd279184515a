/* fingerprint: a number that two cases share when a checkpoint of one can be continued by the other, and what it is of
   in words.  Both run over the key table: a new key of the scene belongs to them by itself. */
#include "case_private.h"
#include <stddef.h>
#include <stdio.h>
#include <string.h>

_Static_assert(offsetof(Case, scene) == 0 && offsetof(Scene, stabilisation) + sizeof(Stabilisation) == sizeof(Scene),
               "the scene begins a case, and ends with the numerics of the model");

bool KeyMayChange(const Key *k, Group g)
{
  const size_t numerics = offsetof(Scene, stabilisation); /* and behind them how to run it */

  return g == GROUP_CASE ? k->offset >= numerics : g == GROUP_STAGE && k->offset >= offsetof(CaseStage, c) + numerics;
}

static uint64_t HashReals(uint64_t h, const double *v, size_t n)
{
  for (size_t i = 0; i < n; i++) {
    const double x = v[i] + 0.0; /* -0 is 0 */

    h = HashBytes(h, &x, sizeof x);
  }
  return h;
}

/* As C's own whole numbers, so that PETSc's may be wider where the case goes on. */
static uint64_t HashInts(uint64_t h, const PetscInt *v, size_t n)
{
  for (size_t i = 0; i < n; i++) {
    const int x = (int)v[i];

    h = HashBytes(h, &x, sizeof x);
  }
  return h;
}

static uint64_t HashText(uint64_t h, const char *text)
{
  return text ? HashBytes(h, text, strlen(text) + 1) : HashBytes(h, "", 1);
}

static uint64_t HashSchedule(uint64_t h, const Schedule *s)
{
  const int steps = s->steps;

  h = HashBytes(HashInts(h, &s->n, 1), &steps, sizeof steps);
  h = HashReals(HashReals(h, s->t, (size_t)s->n), s->y, (size_t)s->n);
  return HashReals(h, (const double *)s->wave, (size_t)s->nwave * sizeof(Wave) / sizeof(double));
}

static uint64_t HashPoints(uint64_t h, const Points *p)
{
  return HashReals(HashInts(h, &p->n, 1), p->x, (size_t)(2 * p->n));
}

static uint64_t HashNames(uint64_t h, const Names *l)
{
  return HashInts(HashInts(h, &l->n, 1), l->i, (size_t)l->n);
}

uint64_t KeyHash(uint64_t h, const Key *k, const char *instance)
{
  const char *place = instance + k->offset;
  const int   yes   = k->kind == KEY_BOOL && *(const bool *)place;

  switch (k->kind) {
  case KEY_REAL:
    return HashReals(h, (const double *)place, (size_t)k->count);
  case KEY_INT:
  case KEY_NAME:
    return HashInts(h, (const PetscInt *)place, (size_t)k->count);
  case KEY_CHOICE:
    return HashBytes(h, place, sizeof(int));
  case KEY_BOOL:
    return HashBytes(h, &yes, sizeof yes);
  case KEY_TEXT:
    return HashText(h, place);
  case KEY_LAW:
    return HashText(h, k->law->get((const Material *)instance));
  case KEY_SCHEDULE:
    return HashSchedule(h, (const Schedule *)place);
  case KEY_POINTS:
    return HashPoints(h, (const Points *)place);
  case KEY_NAMES:
    return HashNames(h, (const Names *)place);
  case KEY_REALS: /* output_times alone, which may change */
    return h;
  }
  return h;
}

/* Takes one key of an instance; k NULL: how many instances the group has. */
typedef void (*Take)(void *ctx, const Case *c, Group g, const Key *k, const char *instance);

/* All keys of a scene that a restart must find unchanged. */
static void EachBound(const Case *c, Take take, void *ctx)
{
  for (Group g = GROUP_CASE; g < GROUP_COUNT; g++) {
    const PetscInt n = g == GROUP_CASE ? 1 : *GroupCount(c, g);

    if (g == GROUP_PROBE || g == GROUP_STAGE)
      continue;
    take(ctx, c, g, NULL, NULL);
    for (PetscInt i = 0; i < n; i++) {
      for (const Key *k = case_group[g].key; k->name; k++) {
        if (!k->like && KeyActs(k, c, GroupInstance(c, g, i)) && !KeyMayChange(k, g))
          take(ctx, c, g, k, GroupInstance(c, g, i));
      }
    }
  }
}

/* ... and of a stage but those that its scene holds. */
static void EachOfStage(const CaseStage *s, Take take, void *ctx)
{
  for (const Key *k = case_group[GROUP_STAGE].key; k->name; k++) {
    if (!k->made && !KeyMayChange(k, GROUP_STAGE))
      take(ctx, &s->c, GROUP_STAGE, k, (const char *)s);
  }
}

/* ---------------------------------------------------------------- as a number */
static void HashOne(void *ctx, const Case *c, Group g, const Key *k, const char *instance)
{
  uint64_t      *h = ctx;
  const PetscInt n = g == GROUP_CASE ? 1 : *GroupCount(c, g);

  *h = k ? KeyHash(*h, k, instance) : HashInts(*h, &n, 1);
}

static uint64_t HashScene(uint64_t h, const Case *c)
{
  h = HashBytes(h, &c->scene.fields.has, sizeof c->scene.fields.has);
  EachBound(c, HashOne, &h);
  return h;
}

/* Of a case with stages: the scene as it holds in each, and when it begins; so it is the same whatever stage c is the
   case of. */
uint64_t CaseFingerprint(const Case *c)
{
  uint64_t h = FNV_START;

  if (!c->nstage)
    return HashScene(h, c);
  for (PetscInt i = 0; i < c->nstage; i++) {
    const CaseStage *s = &c->stage[i];

    h = HashScene(HashReals(h, &s->c.scene.t_begin, 1), &s->c);
    EachOfStage(s, HashOne, &h);
  }
  return h;
}

/* ---------------------------------------------------------------- in words */
typedef struct {
  FILE       *f;
  const char *stage; /* "in stage NAME: " */
} Bound;

static void WriteOne(void *ctx, const Case *c, Group g, const Key *k, const char *instance)
{
  const Bound *b = ctx;
  char         option[256];

  if (k && KeyApplies(k, g, instance)) { /* others share the member of one that does */
    KeyOption(option, sizeof option, g, instance, k->name);
    fprintf(b->f, "%s%s\t", b->stage, option);
    if (KeyEmpty(k, instance))
      fputs("empty", b->f);
    else
      KeyWrite(b->f, c, k, instance);
    fputc('\n', b->f);
  } else if (!k && g != GROUP_CASE) {
    fprintf(b->f, "%snumber of %s\t%" PetscInt_FMT "\n", b->stage, case_group[g].list, *GroupCount(c, g));
  }
}

static void WriteScene(const Case *c, Bound *b)
{
  char fields[128];

  FieldSetPrint(&c->scene.fields, fields, sizeof fields);
  fprintf(b->f, "%sfields\t%s\n", b->stage, fields);
  EachBound(c, WriteOne, b);
}

PetscErrorCode CaseWriteBound(const Case *c, FILE *f)
{
  Bound b = {f, ""};

  PetscFunctionBeginUser;
  if (!c->nstage)
    WriteScene(c, &b);
  for (PetscInt i = 0; i < c->nstage; i++) {
    const CaseStage *s = &c->stage[i];
    char             stage[160];

    snprintf(stage, sizeof stage, "in stage %s: ", s->name);
    b.stage = stage;
    fprintf(f, "%sbegin\t%.17g s\n", stage, s->c.scene.t_begin);
    WriteScene(&s->c, &b);
    EachOfStage(s, WriteOne, &b);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
