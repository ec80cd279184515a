/* Runs the cases that standard input names, one a line with its options, in one process, for scripts/soak.py: starting
   MPI and PETSc costs more than a small scene.  After what a case has to say follows a line \001CODE, an exit code of
   clathra.  With -case_check a case is read and checked, and its start is not built. */
#include "clathra/run.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static PetscErrorCode Run(const char *path, int *code)
{
  PetscBool check = PETSC_FALSE;
  Case      c;
  bool      ok = false;

  PetscFunctionBeginUser;
  *code = CL_EXIT_INPUT;
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-case_check", &check, NULL));
  PetscCall(CaseRead(PETSC_COMM_WORLD, path, &c, &ok));
  if (!ok)
    PetscFunctionReturn(PETSC_SUCCESS);
  *code = CL_EXIT_OK;
  if (!check)
    PetscCall(CaseRun(PETSC_COMM_WORLD, &c, false, code));
  PetscCall(CaseDestroy(&c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The next line on all ranks; those that wait for it sleep.  False at the end. */
static bool NextLine(char *line, int size, int rank)
{
  MPI_Request request;
  int         there = 0;

  if (rank == 0 && !fgets(line, size, stdin))
    line[0] = 0;
  MPI_Ibcast(line, size, MPI_CHAR, 0, PETSC_COMM_WORLD, &request);
  for (;;) {
    MPI_Test(&request, &there, MPI_STATUS_IGNORE);
    if (there)
      break;
    usleep(2000);
  }
  line[strcspn(line, "\n")] = 0;
  return line[0] != 0;
}

int main(int argc, char **argv)
{
  static char line[3 * PETSC_MAX_PATH_LEN];
  PetscMPIInt rank;

  ProcessPrepare(argv);
  if (PetscInitialize(&argc, &argv, NULL, NULL))
    return CL_EXIT_BUG;
  ProcessListen();
  dup2(STDOUT_FILENO, STDERR_FILENO); /* one stream, so that the mark comes after what was said */
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  while (NextLine(line, sizeof line, rank)) {
    char *options = line + strcspn(line, " ");
    int   code    = CL_EXIT_BUG;

    if (*options)
      *options++ = 0;
    if (PetscOptionsClear(NULL) || PetscOptionsInsertString(NULL, options) || Run(line, &code))
      code = CL_EXIT_BUG;
    fflush(stdout);
    fflush(stderr);
    MPI_Barrier(PETSC_COMM_WORLD);
    if (rank == 0) {
      printf("\001%d\n", code);
      fflush(stdout);
    }
  }
  return PetscFinalize() ? CL_EXIT_BUG : CL_EXIT_OK;
}
