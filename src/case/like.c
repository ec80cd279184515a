/* like: a material or a region may be like another one: a key that it does not give is the other's, whose own may be
   that of a third. */
#include "case_private.h"
#include <stdio.h>

static PetscInt LikeOf(const Reader *r, Group g, PetscInt i)
{
  return r->like[g] ? r->like[g][i] : -1;
}

PetscErrorCode KeyFind(Reader *r, const Case *c, Group g, PetscInt i, const Key *k, Found *f)
{
  char     option[256];
  PetscInt j = i;

  PetscFunctionBeginUser;
  do {
    KeyOption(option, sizeof option, g, GroupInstance(c, g, j), k->name);
    PetscCall(ReaderFind(r, option, &f->text, &f->found, &f->from_file));
    f->own = j == i;
    j      = k->own ? -1 : LikeOf(r, g, j);
  } while (!f->found && j >= 0);
  if (!f->found)
    KeyOption(option, sizeof option, g, GroupInstance(c, g, i), k->name);
  snprintf(f->shown, sizeof f->shown, "%s%s", f->found && !f->from_file ? "-" : "", option);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends at an instance that is like none; false: it comes back to i, by the way that `round` says. */
static bool Ends(const Reader *r, const Case *c, Group g, PetscInt i, char *round, size_t size)
{
  PetscInt j = i;

  snprintf(round, size, "%s", GroupInstance(c, g, i));
  for (PetscInt n = 0; n < *GroupCount(c, g); n++) {
    j = LikeOf(r, g, j);
    if (j < 0)
      return true;
    snprintf(round + strlen(round), size - strlen(round), " like %s", GroupInstance(c, g, j));
    if (j == i)
      return false;
  }
  return true; /* into a circle that is said of its own */
}

static PetscErrorCode GroupLike(Reader *r, const Case *c, Group g, const Key *k)
{
  const PetscInt n = *GroupCount(c, g);
  char           round[512];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(PetscMax(n, 1), &r->like[g]));
  for (PetscInt i = 0; i < n; i++)
    r->like[g][i] = -1;
  for (PetscInt i = 0; i < n; i++) {
    Found f;

    PetscCall(KeyFind(r, c, g, i, k, &f));
    if (f.found && !f.text)
      ReaderError(r, f.shown, NULL, "has no value");
    else if (f.found)
      (void)KeyName(r, c, f.shown, f.text, k, &r->like[g][i]);
  }
  for (PetscInt i = 0; i < n; i++) {
    if (Ends(r, c, g, i, round, sizeof round))
      continue;
    FAIL_AT(g, GroupInstance(c, g, i), k->name, "goes round in a circle: %s", round);
    r->like[g][i] = -1; /* the circle is open now */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CaseLike(Reader *r, const Case *c)
{
  PetscFunctionBeginUser;
  for (Group g = GROUP_MATERIAL; g < GROUP_COUNT; g++) {
    for (const Key *k = case_group[g].key; k->name; k++) {
      if (k->like)
        PetscCall(GroupLike(r, c, g, k));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LikeDestroy(Reader *r)
{
  PetscFunctionBeginUser;
  for (Group g = GROUP_MATERIAL; g < GROUP_COUNT; g++)
    PetscCall(PetscFree(r->like[g]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
