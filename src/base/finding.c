/* Says findings, once each, and keeps them for the summary. */
#include "clathra/finding.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
  const char *before; /* the sentence */
  bool        aside;  /* on stderr, behind the place or the program's name */
} how[] = {[FINDING_AS_NOTE]    = {": note: ", true},
           [FINDING_AS_WARNING] = {": warning: ", true},
           [FINDING_AS_END]     = {"Given up at t = ", false},
           [FINDING_AS_CAUSE]   = {"A likely cause: ", false},
           [FINDING_AS_LINE]    = {"", false}};

static const struct {
  FindingKind kind;
  const char *what_to_try;
} row[] = {
#define ROW(id, when, kind, find, what_to_try) [FINDING_##id] = {FINDING_AS_##kind, what_to_try},
    CL_FINDINGS(ROW)};

/* Of this run: lines of the summary, and all else. */
static struct {
  char *lines, *others;
  int   times[FINDING_COUNT];
} said;

static PetscErrorCode Append(char **to, const char *text)
{
  const size_t n    = *to ? strlen(*to) : 0;
  char        *more = realloc(*to, n + strlen(text) + 1);

  PetscFunctionBeginUser;
  PetscCheck(more, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  strcpy(more + n, text);
  *to = more;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FindingSayOf(MPI_Comm comm, FindingId id, const char *place, const char *what_to_try, const char *format,
                            ...)
{
  const FindingKind kind   = row[id].kind;
  const char       *advice = what_to_try ? what_to_try : row[id].what_to_try;
  char             *text;
  size_t            size;
  va_list           args;
  FILE             *f = open_memstream(&text, &size);

  PetscFunctionBeginUser;
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  fprintf(f, "%s%s", !how[kind].aside ? "" : place ? place : "clathra", how[kind].before);
  va_start(args, format);
  vfprintf(f, format, args);
  va_end(args);
  fputc('\n', f);
  if (advice[0])
    fprintf(f, "  What to try, in this order: %s (docs/giving_up.md)\n", advice);
  PetscCheck(fclose(f) == 0, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  if (kind == FINDING_AS_LINE || !said.others || !strstr(said.others, text)) {
    said.times[id]++;
    PetscCall(Append(kind == FINDING_AS_LINE ? &said.lines : &said.others, text));
    PetscCall(PetscFPrintf(comm, how[kind].aside ? PETSC_STDERR : PETSC_STDOUT, "%s", text));
  }
  free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int FindingTimes(FindingId id)
{
  return said.times[id];
}

PetscErrorCode FindingSummary(char **text)
{
  PetscFunctionBeginUser;
  *text = NULL;
  PetscCall(Append(text, said.lines ? said.lines : ""));
  PetscCall(Append(text, said.others ? said.others : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void FindingForget(void)
{
  free(said.lines);
  free(said.others);
  memset(&said, 0, sizeof(said));
}
