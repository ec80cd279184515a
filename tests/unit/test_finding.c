/* A finding is said once, on the first rank, with what to try; summary and log have it once, too. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "clathra/finding.h"
#include "clathra/run.h"
#include "ranks.h"
#include "run/run_private.h"

static char terminal[4096];

/* Instead of to the terminal, as PETSc offers it. */
static PetscErrorCode Keep(FILE *to, const char format[], va_list list)
{
  const size_t n = strlen(terminal);

  (void)to;
  vsnprintf(terminal + n, sizeof(terminal) - n, format, list);
  return PETSC_SUCCESS;
}

static PetscErrorCode (*plain)(FILE *, const char[], va_list);

static int Listen(void **state)
{
  plain         = PetscVFPrintf;
  PetscVFPrintf = Keep;
  terminal[0]   = '\0';
  FindingForget();
  return 0;
}

static int Hush(void **state)
{
  FindingForget();
  PetscVFPrintf = plain;
  return 0;
}

static int Times(const char *text, const char *word)
{
  int n = 0;

  for (const char *at = text; (at = strstr(at, word)); at += strlen(word))
    n++;
  return n;
}

/* Said three times, twice of one number. */
static void SaySnapshots(void)
{
  for (int k = 0; k < 3; k++)
    Call(FindingSay(PETSC_COMM_WORLD, FINDING_SNAPSHOT_MISSING, "%06d.h5 is missing", k / 2));
}

static void OnceOnTheFirstRank(void **state)
{
  SaySnapshots();
  Check(FindingTimes(FINDING_SNAPSHOT_MISSING) == 2);
  if (world_rank == 0)
    Check(!strcmp(terminal, "clathra: warning: 000000.h5 is missing\nclathra: warning: 000001.h5 is missing\n"));
  else
    Check(!terminal[0]);
  FindingForget();
  Check(FindingTimes(FINDING_SNAPSHOT_MISSING) == 0);
  SaySnapshots();
  Check(FindingTimes(FINDING_SNAPSHOT_MISSING) == 2);
}

static void WithItsPlaceAndWhatToTry(void **state)
{
  Call(FindingSayOf(PETSC_COMM_SELF, FINDING_IDLE_KEYS, "a.yaml:3", NULL, "1 key does nothing"));
  Call(FindingSay(PETSC_COMM_SELF, FINDING_TENSION, "the pressure was -1 MPa"));
  Call(FindingSayOf(PETSC_COMM_SELF, FINDING_GIVEN_UP, NULL, "less of it", "3 s: too much"));
  Check(strstr(terminal, "a.yaml:3: note: 1 key does nothing\nclathra: warning: the pressure was -1 MPa\n"
                         "  What to try, in this order: finer cells, "));
  Check(strstr(terminal, " (docs/giving_up.md)\nGiven up at t = 3 s: too much\n"
                         "  What to try, in this order: less of it (docs/giving_up.md)\n"));
}

static void TheSummaryBeginsWithItsLines(void **state)
{
  char *text;

  SaySnapshots();
  Call(FindingSay(PETSC_COMM_WORLD, FINDING_RESULTS, "  results in here"));
  Call(FindingSummary(&text));
  Check(!strcmp(text, "  results in here\nclathra: warning: 000000.h5 is missing\n"
                      "clathra: warning: 000001.h5 is missing\n"));
  free(text);
}

/* What the report reads. */
static void TheLogHasItOnce(void **state)
{
  char  dir[32] = "findings.XXXXXX", path[64], text[4096] = "";
  bool  ok;
  FILE *f;

  if (world_rank == 0)
    Check(mkdtemp(dir) != NULL);
  MPI_Bcast(dir, sizeof(dir), MPI_CHAR, 0, PETSC_COMM_WORLD);
  snprintf(path, sizeof(path), "%s/log.txt", dir);
  Call(LogStart(PETSC_COMM_WORLD));
  SaySnapshots();
  Call(LogWrite(PETSC_COMM_WORLD, dir, false, &ok));
  Call(LogEnd());
  Check(ok);
  if (world_rank)
    return;
  Check((f = fopen(path, "r")) != NULL);
  text[fread(text, 1, sizeof(text) - 1, f)] = '\0';
  fclose(f);
  remove(path);
  rmdir(dir);
  Check(Times(text, "clathra: warning: 000000.h5 is missing\n") == 1);
  Check(Times(text, "clathra: warning: 000001.h5 is missing\n") == 1);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test_setup_teardown(OnceOnTheFirstRank, Listen, Hush),
                                     cmocka_unit_test_setup_teardown(WithItsPlaceAndWhatToTry, Listen, Hush),
                                     cmocka_unit_test_setup_teardown(TheSummaryBeginsWithItsLines, Listen, Hush),
                                     cmocka_unit_test_setup_teardown(TheLogHasItOnce, Listen, Hush)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
