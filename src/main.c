/* clathra CASE [PETSc options] and clathra strength CASE [options] */
#include "clathra/run.h"
#include <ctype.h>
#include <unistd.h>

static const char help[] =
    "Clathra: coupled thermo-hydro-mechanical-chemical material point simulator for methane-hydrate-bearing sediment.\n"
    "\n"
    "  clathra CASE [options]      CASE is a folder with a case.yaml, or such a file\n"
    "  clathra strength CASE       its factor of safety; so, too, sweep, calibrate, compare, plot, report: each has "
    "--help\n"
    "\n"
    "Ten options that matter:\n"
    "  -case_check                 read and check the case and its start, forecast and warnings included; write "
    "nothing\n"
    "                              (with -help, too, which lists the solver's options for this CASE)\n"
    "  -case_keys                  print every key of a case file (needs no CASE)\n"
    "  -output_dir FOLDER          where the results go; results/NAME of the case\n"
    "  -overwrite                  ... though the results of another case are there\n"
    "  -time_end \"30 d\"            end; any key of the case can be set so, with its unit\n"
    "  -grid_cells 104,1           cells along x and y\n"
    "  -stepper_type sdirk2        or euler, hybrid (waves, impact, sliding), auto (either, whichever is cheaper)\n"
    "  -stepper_tol 1e-3           tolerance of a step's error; 1e-2 for a first look\n"
    "  -restart FILE               go on from a checkpoint of the same case; -restart_as_initial: begin another with "
    "it\n"
    "  -time_limit 3500            end before so many seconds, with a checkpoint\n"
    "\n"
    "Others: --version, -quiet, -progress S, -checkpoint_wall S, -stepper_max_steps N, -newton_tol_residual 1e-9, "
    "-newton_tol_update 1e-6,\n"
    "-newton_keep_jacobian 0.01, -newton_drop 1e-6, -newton_preconditioner auto|whole|reduced, -newton_refactor N,\n"
    "-model_pmat_type aij|baij.\n"
    "Presets: -options_file options/NAME.opts (later options win); -snes_, -ksp_, -pc_ are PETSc's; docs/options.md "
    "has all.\n"
    "Equations: docs/equations.md, after \"A fully coupled THMC-MPM framework for modeling phase transition and large\n"
    "deformation in methane hydrate-bearing sediment\".\n"
    "Exit codes: 0 done, 1 bug, 2 wrong case or option, 3 gave up or could not write (last good state in\n"
    "checkpoint.h5), 4 ended by a signal (state in checkpoint.h5).\n\n";

static bool IsOption(const char *word)
{
  return word[0] == '-' && (isalpha((unsigned char)word[1]) || word[1] == '-');
}

/* The first word behind the case that is neither an option nor the value of one; NULL: there is none. */
static const char *Surplus(int argc, char **argv)
{
  for (int k = 2; k < argc; k++) {
    if (!IsOption(argv[k]) && !IsOption(argv[k - 1]))
      return argv[k];
  }
  return NULL;
}

static PetscErrorCode Main(int argc, char **argv, int *exit_code)
{
  Case        c;
  bool        ok;
  PetscBool   keys = PETSC_FALSE, check = PETSC_FALSE, curves = PETSC_FALSE, help_asked = PETSC_FALSE;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(PetscOptionsHasHelp(NULL, &help_asked));
  PetscCall(CaseKeysAsked(&keys));
  *exit_code = CL_EXIT_OK;
  if (keys || (help_asked && argc < 3)) {
    if (rank == 0)
      PetscCall(CasePrintKeys(stdout));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (argc < 2 || argv[1][0] == '-') {
    if (rank == 0)
      fprintf(stderr, "clathra: name a case: clathra CASE [options]; -help explains\n");
    *exit_code = CL_EXIT_INPUT;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (Surplus(argc, argv)) {
    if (rank == 0)
      fprintf(stderr,
              "clathra: '%s' is neither an option nor the value of one; options begin with -, as -grid_cells 50,1\n",
              Surplus(argc, argv));
    *exit_code = CL_EXIT_INPUT;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(LogStart(PETSC_COMM_WORLD));
  PetscCall(CaseRead(PETSC_COMM_WORLD, argv[1], &c, &ok));
  if (!ok) {
    PetscCall(LogEnd());
    *exit_code = CL_EXIT_INPUT;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-case_check", &check, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-case_curves", &curves, NULL));
  check = check || help_asked;
  if (curves && rank == 0)
    PetscCall(CasePrintCurves(&c.scene, stdout));
  if (check || !curves)
    PetscCall(CaseRun(PETSC_COMM_WORLD, &c, check, exit_code));
  if (check && *exit_code == CL_EXIT_OK)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s: the case is valid\n", c.file));
  PetscCall(CaseDestroy(&c));
  PetscCall(LogEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

static bool started;   /* PETSc has begun */
static bool no_memory; /* something could not be allocated */

/* PETSc's error handler.  What PETSc cannot begin with is the user's mistake, an option or its file, and memory that is
   not there is no bug: a sentence instead of a trace.  All else is PETSc's to say.  Of PETSc 3.18 what allocates has a
   number of its own instead of the error's.  One handler for all: PETSc may free its place only as it was allocated,
   and -malloc_debug changes that in between. */
static PetscErrorCode Say(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode n,
                          PetscErrorType type, const char *message, void *ctx)
{
  const bool allocates = type == PETSC_ERROR_INITIAL && (strstr(function, "Malloc") || strstr(function, "Realloc"));

  if (!started) {
    if (type == PETSC_ERROR_INITIAL)
      fprintf(stderr, "clathra: %s\n", message);
    return n;
  }
  if (n != PETSC_ERR_MEM && !allocates && !no_memory)
    return PetscTraceBackErrorHandler(comm, line, function, file, n, type, message, ctx);
  if (!no_memory)
    fprintf(stderr,
            "clathra: out of memory: fewer cells or particles, or more machines; files are whole, and a run goes "
            "on from its last checkpoint\n");
  no_memory = true;
  return n;
}

/* Exit code; of several ranks the others may wait for this one. */
static int StartFailed(void)
{
  PetscMPIInt size = 1;
  int         begun;

  MPI_Initialized(&begun);
  if (begun)
    MPI_Comm_size(MPI_COMM_WORLD, &size);
  if (size > 1)
    MPI_Abort(MPI_COMM_WORLD, CL_EXIT_INPUT);
  if (begun)
    MPI_Finalize();
  return CL_EXIT_INPUT;
}

/* The version of this program and of the PETSc that it runs with. */
static int SayVersion(void)
{
  PetscInt major, minor, patch;

  if (PetscGetVersionNumber(&major, &minor, &patch, NULL))
    return CL_EXIT_BUG;
  printf("clathra %s, PETSc %d.%d.%d\n", CLATHRA_VERSION, (int)major, (int)minor, (int)patch);
  return CL_EXIT_OK;
}

int main(int argc, char **argv)
{
  int         exit_code = CL_EXIT_BUG;
  PetscMPIInt size;

  if (!ProcessPrepare(argv))
    return CL_EXIT_INPUT;
  if (argc > 1 && strcmp(argv[1], "--version") == 0)
    return SayVersion();
  if (HandOverPython(argc, argv))
    return CL_EXIT_INPUT;
  HandOverSpace(argc, argv);
  for (int k = 1; k < argc; k++) {
    if (strcmp(argv[k], "--help") == 0)
      argv[k]++;                                             /* PETSc knows -help */
    if (strcmp(argv[k], "-help") == 0 && ProcessQuietPipe()) /* a pager that ends is no crash */
      return CL_EXIT_BUG;
  }
  if (PetscPushErrorHandler(Say, NULL) || PetscInitialize(&argc, &argv, NULL, help))
    return StartFailed();
  started = true;
  ProcessListen();
  if (Main(argc, argv, &exit_code)) {
    exit_code = no_memory ? CL_EXIT_FAILED : CL_EXIT_BUG;
    MPI_Comm_size(PETSC_COMM_WORLD, &size);
    if (size > 1) /* others may wait for this rank for ever */
      MPI_Abort(PETSC_COMM_WORLD, exit_code);
    if (no_memory) { /* libraries that end want some, and complain */
      fflush(NULL);
      _exit(exit_code);
    }
  }
  if (PetscFinalize())
    return CL_EXIT_BUG;
  return exit_code;
}
