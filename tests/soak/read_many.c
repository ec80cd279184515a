/* Reads and checks the cases whose paths come on standard input, one a line, in one process: for scripts/soak.py. After
   what a case has to say follows a line \001CODE on standard error: 0 valid, 2 refused, 1 an error of PETSc. */
#include "clathra/case.h"
#include <stdio.h>
#include <string.h>

int main(int argc, char **argv)
{
  char path[PETSC_MAX_PATH_LEN];

  if (PetscInitialize(&argc, &argv, NULL, NULL))
    return 1;
  while (fgets(path, sizeof path, stdin)) {
    Case c;
    bool ok   = false;
    int  code = CL_EXIT_BUG;

    path[strcspn(path, "\n")] = 0;
    if (CaseRead(PETSC_COMM_SELF, path, &c, &ok) == 0)
      code = ok ? CL_EXIT_OK : CL_EXIT_INPUT;
    if (ok && CaseDestroy(&c))
      code = CL_EXIT_BUG;
    fprintf(stderr, "\001%d\n", code);
    fflush(stderr);
  }
  return PetscFinalize() != 0;
}
