/* run: a case from its initial state (or -restart FILE) to its end, with all outputs. */
#pragma once

#include "clathra/case.h"

/* *exit_code: CL_EXIT_OK, CL_EXIT_INPUT (nothing written), CL_EXIT_FAILED or CL_EXIT_SIGNAL (last good state saved).
   check: says and refuses what the run would up to its first step, and writes nothing.  Collective. */
PetscErrorCode CaseRun(MPI_Comm comm, const Case *c, bool check, int *exit_code);

/* What PETSc's printer says is kept for log.txt from here on, from the command to the end (src/run/log.c). */
PetscErrorCode LogStart(MPI_Comm comm);
/* It is kept no longer; what was not written is lost. */
PetscErrorCode LogEnd(void);

/* Before MPI begins this program may become another one, see src/run/hand_over.c. */
/* `clathra strength ...`, sweep and what else Python does; true: it was asked for and could not be begun, which was
 * said. */
bool HandOverPython(int argc, char **argv);
/* A case of three axes is clathra3d's: does not return where that stands beside this program. */
void HandOverSpace(int argc, char **argv);

/* Before PETSc is initialised, and after: see src/run/process.c. */
/* May start the program again, with one thread for BLAS; false where it cannot run, which was said. */
bool ProcessPrepare(char **argv);
/* Before PetscInitialize: a reader of the output that goes away is no crash. */
PetscErrorCode ProcessQuietPipe(void);
/* Signals that ask for the end are noted from here on. */
void ProcessListen(void);
int  ProcessSignal(void); /* the signal that asked this rank to end; 0: none */
/* Prints what the laws of the materials give over their variables, a block of rows "x, y, ..." for each. */
PetscErrorCode CasePrintCurves(const Scene *c, FILE *out);
