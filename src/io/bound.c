/* bound: why a checkpoint is none of this case, key by key. */
#include "io_private.h"

#include <stdlib.h>
#include <string.h>

#define NAMED 4  /* keys that are named */
#define SHOWN 70 /* characters of a value */

typedef struct {
  const char *key, *value;
  int         nkey, nvalue; /* characters */
} Line;

/* The line "key, tab, value" that begins at *at, and moves on; false: there is none. */
static bool NextLine(const char **at, Line *line)
{
  const char *end = *at + strcspn(*at, "\n"), *tab = memchr(*at, '\t', (size_t)(end - *at));

  if (!tab)
    return false;
  *line = (Line){*at, tab + 1, (int)(tab - *at), (int)(end - tab - 1)};
  *at   = *end ? end + 1 : end;
  return true;
}

static bool FindKey(const char *text, const Line *wanted, Line *found)
{
  while (NextLine(&text, found)) {
    if (found->nkey == wanted->nkey && !strncmp(found->key, wanted->key, (size_t)wanted->nkey))
      return true;
  }
  return false;
}

static void Add(char *why, size_t size, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void Add(char *why, size_t size, const char *format, ...)
{
  const size_t n = strlen(why);
  va_list      args;

  va_start(args, format);
  vsnprintf(why + n, size - n, format, args);
  va_end(args);
}

/* A value, or the begin of a long one. */
static void AddValue(char *why, size_t size, const Line *l)
{
  Add(why, size, "%.*s%s", PetscMin(l->nvalue, SHOWN), l->value, l->nvalue > SHOWN ? "..." : "");
}

/* Names what differs: keys of theirs, then those of ours that they do not have.  Returns how many there are. */
static int Compare(const char *theirs, const char *ours, char *why, size_t size)
{
  int         n = 0;
  Line        a, b;
  const char *at = theirs;

  while (NextLine(&at, &a)) {
    const bool both = FindKey(ours, &a, &b);

    if ((both && a.nvalue == b.nvalue && !strncmp(a.value, b.value, (size_t)a.nvalue)) || n++ >= NAMED)
      continue;
    Add(why, size, "%s%.*s is ", n > 1 ? "; " : "", a.nkey, a.key);
    AddValue(why, size, &a);
    Add(why, size, " in it but ");
    if (both)
      AddValue(why, size, &b);
    Add(why, size, both ? " here" : "not here");
  }
  for (at = ours; NextLine(&at, &b);) {
    if (FindKey(theirs, &b, &a) || n++ >= NAMED)
      continue;
    Add(why, size, "%s%.*s is ", n > 1 ? "; " : "", b.nkey, b.key);
    AddValue(why, size, &b);
    Add(why, size, " here but not in it");
  }
  if (n > NAMED)
    Add(why, size, "; and %d more", n - NAMED);
  return n;
}

PetscErrorCode BoundDiffers(hid_t file, const Case *c, char *why, size_t size)
{
  hsize_t n = 0;
  size_t  length;
  char   *theirs, *ours;
  int     found = 0;

  PetscFunctionBeginUser;
  snprintf(why, size, "it was written by another case: ");
  if (H5Rows(file, "case", &n) && n < PETSC_MAX_INT / 8) {
    PetscCall(PetscCalloc1((PetscInt)n + 1, &theirs));
    PetscCall(CaseText(c, CaseWriteBound, &ours, &length));
    if (H5Read(file, "case", H5T_NATIVE_CHAR, n, theirs))
      found = Compare(theirs, ours, why, size);
    free(ours);
    PetscCall(PetscFree(theirs));
  }
  if (found)
    Add(why, size, " (keys of the command line have to be given again)");
  else
    snprintf(why, size,
             "it was written by another case (grid, regions, materials, boundary conditions, meters or stages differ)");
  PetscFunctionReturn(PETSC_SUCCESS);
}
