/* read: the case as a whole: names, the keys of every group, what is left over, derived values, errors. */
#include "case_private.h"
#include <ctype.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define NAMES_MAX CL_CONDITIONS

static bool NameValid(const char *name)
{
  if (!isalpha((unsigned char)*name) || strlen(name) >= 64)
    return false;
  for (; *name; name++)
    if (!isalnum((unsigned char)*name) && *name != '_' && *name != '-')
      return false;
  return true;
}

static bool NamesCheck(Reader *r, const GroupInfo *info, const char *shown, const List *list)
{
  if (list->n > NAMES_MAX) {
    ReaderError(r, shown, NULL, "lists %d names, at most %d are allowed", (int)list->n, NAMES_MAX);
    return false;
  }
  for (PetscInt i = 0; i < list->n; i++) {
    if (!NameValid(list->item[i]) || !strcasecmp(list->item[i], "all") || !strcasecmp(list->item[i], "none")) {
      ReaderError(r, shown, list->item[i],
                  "is not a name: a letter, then letters, digits, _ or -, fewer than 64 (and not 'all' or 'none')");
      return false;
    }
    for (PetscInt j = 0; j < i; j++) {
      if (strcasecmp(list->item[i], list->item[j]))
        continue;
      ReaderError(r, shown, list->item[i], "the %s is listed twice", info->noun);
      return false;
    }
  }
  return true;
}

/* Reads the list of names of a group and makes its instances. */
static PetscErrorCode NamesRead(Reader *r, Case *c, Group g)
{
  const GroupInfo *info = &case_group[g];
  const char      *text;
  char             shown[64];
  bool             found, from_file;
  List             list;

  PetscFunctionBeginUser;
  PetscCall(ReaderFind(r, info->list, &text, &found, &from_file));
  snprintf(shown, sizeof shown, "%s%s", found && !from_file ? "-" : "", info->list);
  if (!text) {
    r->bad[g] = info->required || found;
    if (info->required)
      ReaderError(r, shown, NULL, "is missing: the list of names of the case's %s, e.g. [%s1]", info->list, info->noun);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  ListCreate(text, &list);
  if (NamesCheck(r, info, shown, &list)) {
    char *instance;
    PetscCall(PetscCalloc(info->size * (size_t)PetscMax(list.n, 1), &instance));
    *(char **)((char *)c + info->pointer) = instance;
    *GroupCount(c, g)                     = list.n;
    for (PetscInt i = 0; i < list.n; i++)
      strcpy(GroupInstance(c, g, i), list.item[i]);
  } else
    r->bad[g] = true;
  ListDestroy(&list);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GroupRead(Reader *r, Case *c, Group g)
{
  PetscInt before = r->nerror, n = g == GROUP_CASE ? 1 : *GroupCount(c, g);

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    Bc *bc = g == GROUP_BC ? &c->scene.bc[i] : NULL;
    if (bc) {
      bc->number = i;
      bc->region = -1;
      bc->from   = -INFINITY;
      bc->to     = INFINITY;
    }
    for (const Key *k = case_group[g].key; k->name; k++) {
      if (!k->like)
        PetscCall(KeyRead(r, c, g, i, k));
      if (bc && !bc->type)
        break; /* which keys apply is not known */
      if (bc && k->offset == offsetof(Bc, type))
        PetscCall(PlateForm(r, bc));
    }
  }
  if (r->nerror > before)
    r->bad[g] = true;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- keys that nobody asked for */
static void Unknown(Reader *r, const Case *c, const char *shown, const char *name, const char *value, char last[128])
{
  char  nearest[256], instance[64], word[128];
  Group g;

  if (KeyUnlisted(c, name, &g, instance, sizeof instance)) {
    if (r->bad[g] && !*GroupCount(c, g))
      return; /* the list itself is wrong or missing, which was said */
    snprintf(word, sizeof word, "%s %s", case_group[g].noun, instance);
    if (strcmp(word, last))
      ReaderError(r, shown, NULL, "%s '%s' is not listed in %s", case_group[g].noun, instance, case_group[g].list);
    snprintf(last, 128, "%s", word); /* say it once */
  } else if (KeyNearest(c, name, nearest, sizeof nearest))
    ReaderError(r, shown, value, "unknown key; did you mean %s?", nearest);
  else
    ReaderError(r, shown, value, "unknown key (clathra -case_keys lists all)");
}

/* The instance of a boundary whose type is wrong: its keys were not asked for, that is no second error. */
static bool OfBadBoundary(const Scene *c, const char *name)
{
  for (PetscInt i = 0; i < c->nbc; i++) {
    char prefix[80];
    snprintf(prefix, sizeof prefix, "bc_%s_", c->bc[i].name);
    if (!c->bc[i].type && !strncasecmp(name, prefix, strlen(prefix)))
      return true;
  }
  return false;
}

/* A key of the file of an instance that a list of names on the command line leaves out. */
static PetscErrorCode LeftOut(Reader *r, const Case *c, const char *name, bool *out)
{
  const char *text;
  char        instance[64];
  Group       g;
  bool        found, from_file;

  PetscFunctionBeginUser;
  *out = KeyUnlisted(c, name, &g, instance, sizeof instance);
  if (*out) {
    PetscCall(ReaderFind(r, case_group[g].list, &text, &found, &from_file));
    *out = found && !from_file;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Leftovers(Reader *r, const Case *c)
{
  bool     out = false;
  PetscInt n;
  char   **names, **values, shown[256], last[128] = "";

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < r->nentry; i++) {
    Entry *e = &r->entry[i];
    if (!e->map && !e->used && !OfBadBoundary(&c->scene, e->name))
      PetscCall(LeftOut(r, c, e->name, &out));
    if (!e->map && !e->used && !OfBadBoundary(&c->scene, e->name) && !out)
      Unknown(r, c, e->name, e->name, e->value, last);
  }
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n; i++) {
    snprintf(shown, sizeof shown, "-%s", names[i]);
    if (OfBadBoundary(&c->scene, names[i]) || !KeyOwned(c, names[i]))
      continue;
    Unknown(r, c, shown, names[i], values[i], last);
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void PrintErrors(const Reader *r)
{
  PetscInt shown = PetscMin(r->nerror, CASE_ERRORS);

  if (r->rank || !r->nerror)
    return;
  for (PetscInt i = 0; i < shown; i++)
    fprintf(stderr, "%s\n", r->error[i]);
  if (r->nerror > shown)
    fprintf(stderr, "... and %d more\n", (int)(r->nerror - shown));
  fprintf(stderr, "The case has %d error%s; nothing was run or written.\n", (int)r->nerror, r->nerror == 1 ? "" : "s");
}

/* All keys, once the names of the instances and what they are like are known. */
static PetscErrorCode KeysRead(Reader *r, Case *c)
{
  PetscFunctionBeginUser;
  PetscCall(CaseStageEnds(r, c));
  PetscCall(GroupRead(r, c, GROUP_CASE));
  PetscCall(CaseSpacing(r, &c->scene));
  PetscCall(CaseFieldSet(r, c));
  for (Group g = GROUP_MATERIAL; g < GROUP_STAGE; g++)
    PetscCall(GroupRead(r, c, g));
  PetscCall(CaseDerive(r, c));
  CaseFieldSetFinish(r, c);
  CaseQuantities(r, c);
  PetscCall(CaseDerivePlaces(r, c));
  PetscCall(CaseStages(r, c));
  PetscCall(Leftovers(r, c));
  CaseCheck(r, c);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CaseRead(MPI_Comm comm, const char *path, Case *c, bool *ok)
{
  Reader   r = {.comm = comm};
  PetscInt errors;

  PetscFunctionBeginUser;
  FindingForget();
  memset(c, 0, sizeof *c);
  PetscCall(ReaderLoad(&r, path));
  strcpy(c->file, r.file);
  PetscCall(ProgramRead(&r));
  if (!r.nerror) {
    for (Group g = GROUP_MATERIAL; g < GROUP_COUNT; g++)
      PetscCall(NamesRead(&r, c, g));
    errors = r.nerror;
    PetscCall(CaseLike(&r, c));
    if (r.nerror == errors)
      PetscCall(KeysRead(&r, c));
  }
  *ok = r.nerror == 0;
  if (*ok)
    PetscCall(CaseIdle(&r, c));
  PrintErrors(&r);
  PetscCall(ReaderDestroy(&r));
  if (!*ok)
    PetscCall(CaseDestroy(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CaseDestroy(Case *c)
{
  PetscFunctionBeginUser;
  PetscCall(CaseStagesDestroy(c));
  for (int d = 0; d < CL_DIM; d++)
    PetscCall(LinesDestroy(&c->scene.line[d]));
  ScheduleDestroy(&c->scene.ambient_pressure);
  ScheduleDestroy(&c->scene.ambient_level);
  for (PetscInt i = 0; i < c->scene.nbc; i++) {
    ScheduleDestroy(&c->scene.bc[i].value);
    ScheduleDestroy(&c->scene.bc[i].shear);
    ScheduleDestroy(&c->scene.bc[i].displacement);
    ScheduleDestroy(&c->scene.bc[i].force);
    for (int ph = 0; ph < PHASE_COUNT; ph++)
      ScheduleDestroy(&c->scene.bc[i].phase[ph]);
    PetscCall(PetscFree(c->scene.bc[i].along.x));
  }
  for (PetscInt i = 0; i < c->scene.nmeter; i++)
    PetscCall(PetscFree(c->scene.meter[i].along.x));
  for (PetscInt i = 0; i < c->nprobe; i++)
    PetscCall(PetscFree(c->probe[i].surface.along.x));
  for (PetscInt i = 0; i < c->scene.nregion; i++) {
    PetscCall(PetscFree(c->scene.region[i].polygon.x));
    PetscCall(PetscFree(c->scene.region[i].below.x));
    PetscCall(PetscFree(c->scene.region[i].minus.i));
  }
  PetscCall(PetscFree(c->scene.material));
  PetscCall(PetscFree(c->scene.region));
  PetscCall(PetscFree(c->scene.bc));
  PetscCall(PetscFree(c->probe));
  PetscCall(PetscFree(c->scene.meter));
  PetscCall(PetscFree(c->times));
  memset(c, 0, sizeof *c);
  PetscFunctionReturn(PETSC_SUCCESS);
}
