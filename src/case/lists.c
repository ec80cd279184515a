/* lists: values that are lists of any length: names, and points [[x, y], ...]. */
#include "case_private.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

PetscErrorCode KeyNames(Reader *r, const Case *c, const char *shown, const char *text, const Key *k, Names *names)
{
  List list;

  PetscFunctionBeginUser;
  ListCreate(text, &list);
  if (list.n)
    PetscCall(PetscCalloc1(list.n, &names->i));
  while (names->n < list.n && KeyName(r, c, shown, list.item[names->n], k, &names->i[names->n]))
    names->n++;
  ListDestroy(&list);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Inner lists as ReaderParse writes them: [[a, b], [c, d]] to a; b, c; d.  false: it is no list of lists. */
static bool FlattenLists(char *text)
{
  int depth = 0;

  for (char *p = text; *p; p++) {
    depth += *p == '[';
    depth -= *p == ']';
    if (depth < 0 || depth > 2)
      return false;
    if (*p == ',' && depth == 2)
      *p = ';';
    if (strchr("[]", *p))
      *p = ' ';
  }
  return depth == 0;
}

static char *Trim(char *text)
{
  char *end = text + strlen(text);

  while (end > text && isspace((unsigned char)end[-1]))
    *--end = 0;
  return text + strspn(text, " \t\r\n");
}

static bool PointRead(Reader *r, const char *shown, char *text, const Key *k, double x[])
{
  char *second = strchr(text, ';');

  if (!second || strchr(second + 1, ';')) {
    ReaderError(r, shown, text, "is not a point [x, y]; a list of points is [[x, y], [x, y], ...]");
    return false;
  }
  *second++ = 0;
  return RealRead(r, shown, Trim(text), k->unit, k->range, &x[0]) &&
         RealRead(r, shown, Trim(second), k->unit, k->range, &x[1]);
}

PetscErrorCode KeyPoints(Reader *r, const char *shown, const char *text, const Key *k, Points *points)
{
  List  list;
  char *flat = strdup(text);
  bool  good;

  PetscFunctionBeginUser;
  good = FlattenLists(flat);
  if (!good)
    ReaderError(r, shown, text, "its brackets do not match; a list of points is [[x, y], [x, y], ...]");
  ListCreate(flat, &list);
  points->n = list.n;
  PetscCall(PetscCalloc1(2 * list.n, &points->x));
  for (PetscInt i = 0; i < list.n && good; i++)
    good = PointRead(r, shown, list.item[i], k, points->x + 2 * i);
  ListDestroy(&list);
  free(flat);
  PetscFunctionReturn(PETSC_SUCCESS);
}
