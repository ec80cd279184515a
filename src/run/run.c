/* Runs a case: builds the model, steps it, writes what the case asks for, and says how it went. */
#include "run_private.h"
#include "plastic.h"
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

typedef struct {
  Output   *out;
  char      checkpoint[PETSC_MAX_PATH_LEN];
  double    clock_start; /* s of the wall */
  StageLog *log;
  bool      quiet;
} Run;

double Wall(void)
{
  struct timespec t;

  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* First multiple of `every` after t, counted from the begin of the stage. */
static double NextMultiple(const Case *c, double every, double t)
{
  const double at = t - c->t_begin + 4.0 * PETSC_MACHINE_EPSILON * fabs(t);

  return every > 0.0 ? c->t_begin + every * (floor(at / every * (1.0 + 1e-12) + 1e-9) + 1.0) : INFINITY;
}

static double NextSnapshot(const Case *c, double t)
{
  double next = NextMultiple(c, c->every, t);

  for (PetscInt k = 0; k < c->ntimes; k++) {
    if (c->times[k] > t + CaseTimeSlack(c, t))
      next = fmin(next, c->times[k]);
  }
  return next;
}

static bool IsTime(const Case *c, double event, double t)
{
  return fabs(event - t) <= 1e-9 * fabs(t - c->t_begin) + CaseTimeSlack(c, t);
}

/* Steps end exactly on events, so t is one of them or is not. */
static bool AtMultiple(const Case *c, double every, double t)
{
  return every > 0.0 && IsTime(c, c->t_begin + every * round((t - c->t_begin) / every), t);
}

static bool AtSnapshot(const Case *c, double t)
{
  bool at = AtMultiple(c, c->every, t);

  for (PetscInt k = 0; k < c->ntimes; k++)
    at = at || IsTime(c, c->times[k], t);
  return at;
}

static double NextEvent(const Stepper *s, void *ctx)
{
  const Case  *c = s->model->c;
  const double t = s->state.t;

  (void)ctx;
  return fmin(NextSnapshot(c, t), fmin(NextMultiple(c, c->probe_every, t), NextMultiple(c, c->checkpoint_every, t)));
}

static PetscErrorCode Progress(const Stepper *s, const StepInfo *info, const Run *run)
{
  const double t_begin = s->model->c->t_begin;
  double       done, left;
  char         cuts[32] = "", error[32] = "", solved[48], stage[80], begin[32] = "", yields[128];

  PetscFunctionBeginUser;
  if (run->quiet)
    PetscFunctionReturn(PETSC_SUCCESS);
  StageLogProgress(run->log, s, &done, &left);
  StepperStageWords(s, stage);
  if (t_begin > 0.0)
    PetscCall(PetscSNPrintf(begin, sizeof(begin), "%g s + ", t_begin));
  PetscCall(YieldText(s->model, yields));
  if (info->cuts)
    PetscCall(PetscSNPrintf(cuts, sizeof(cuts), ", after %" PetscInt_FMT " refused", info->cuts));
  if (s->explicit)
    PetscCall(PetscSNPrintf(solved, sizeof(solved), "%s rules", cl_limit_word[s->limit.rules]));
  else
    PetscCall(PetscSNPrintf(solved, sizeof(solved), "%2" PetscInt_FMT " Newton iterations", info->newton));
  if (s->adaptive && !s->explicit)
    PetscCall(PetscSNPrintf(error, sizeof(error), ", error %.2g of tolerance", info->err));
  PetscCall(PetscPrintf(s->model->grid.comm,
                        "%sstep %4" PetscInt_FMT ": t = %s%-10.6g s (%5.1f %%), dt = %-9.4g s, %s%s%s%s, %.0f s left\n",
                        stage, s->state.step, begin, s->state.t - t_begin, 100.0 * done, info->dt, solved, error, cuts,
                        yields, left));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After every accepted step: ledger, probes, meters, snapshot, checkpoint, progress. */
static PetscErrorCode Monitor(Stepper *s, const StepInfo *info, void *ctx)
{
  Run         *run  = (Run *)ctx;
  const Case  *c    = s->model->c;
  const double t    = s->state.t;
  const bool   last = CaseAtEnd(c, t); /* of the run, or of a stage */

  PetscFunctionBeginUser;
  StageLogStep(run->log, s, info);
  PetscCall(OutputBalance(run->out, s->model, &s->state, info));
  if (c->probe_every == 0.0 || AtMultiple(c, c->probe_every, t) || last) {
    PetscCall(OutputProbes(run->out, s->model, &s->state));
    PetscCall(OutputMeters(run->out, s->model, &s->state));
  }
  if (AtSnapshot(c, t) || last) {
    PetscCall(OutputSnapshot(run->out, s->model, &s->state));
    s->state.next_snapshot++;
  }
  if (AtMultiple(c, c->checkpoint_every, t))
    PetscCall(CheckpointWrite(s->model, &s->state, run->checkpoint));
  PetscCall(Progress(s, info, run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeFolder(MPI_Comm comm, const char *path, bool *ok)
{
  char        part[PETSC_MAX_PATH_LEN];
  PetscMPIInt rank, good = 1;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) {
    struct stat st;

    PetscCall(PetscStrncpy(part, path, sizeof(part)));
    for (char *p = part + 1; *p; p++) {
      if (*p != '/')
        continue;
      *p = '\0';
      mkdir(part, 0777);
      *p = '/';
    }
    mkdir(part, 0777);
    good = stat(path, &st) == 0 && S_ISDIR(st.st_mode) && access(path, W_OK | X_OK) == 0;
    if (good) { /* root may be allowed what the file system is not */
      PetscCall(PetscSNPrintf(part, sizeof(part), "%s/case.yaml", path));
      FILE *f = fopen(part, "a");
      good    = f != NULL;
      if (f)
        fclose(f);
    }
    if (!good)
      fprintf(stderr, "clathra: cannot write into the output folder %s\n", path);
  }
  PetscCallMPI(MPI_Bcast(&good, 1, MPI_INT, 0, comm));
  *ok = good;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Relative to the initial store; absolute where there was none. */
static double Relative(double missing, double store)
{
  return store > 0.0 ? missing / store : missing;
}

/* What an integrator without matrices has to say at the end. */
static PetscErrorCode LocalSummary(const Stepper *s, char text[512])
{
  const double scaling     = s->model->c->mass_scaling;
  char         scaled[128] = "";

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (!s->explicit)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (scaling > 1.0)
    PetscCall(PetscSNPrintf(scaled, sizeof(scaled), "; mass scaling %g added inertia of up to %.2g of the forces",
                            scaling, ExplicitMassScalingError(s->explicit)));
  PetscCall(PetscSNPrintf(text, 512, "  stable step %.4g s at the end (%s rules); %.0f B a particle%s\n", s->limit.dt,
                          cl_limit_word[s->limit.rules], ExplicitBytesPerParticle(s->explicit), scaled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Summary(const Stepper *s, const Run *run)
{
  const StepperState *z = &s->state;
  char                path[PETSC_MAX_PATH_LEN], text[2048], local[512], yields[256], *stages;
  ModelTotals         t;
  PetscMPIInt         rank;

  PetscFunctionBeginUser;
  PetscCall(ModelComputeTotals(s->model, &t));
  PetscCall(LocalSummary(s, local));
  PetscCall(YieldSummary(s->model, yields));
  PetscCall(PetscSNPrintf(text, sizeof(text),
                          "%s: %s at t = %g s\n"
                          "  integrator %s, %" PetscInt_FMT " steps, %" PetscInt_FMT " refused, %" PetscInt_FMT
                          " Newton iterations, %.2f s\n%s"
                          "  balance errors: water %.2e, methane %.2e of the initial mass, heat %.2e K\n"
                          "  hydrate %.6e kg; hydrate positivity limiter acted %" PetscInt_FMT " times\n%s"
                          "  results in %s\n",
                          s->model->c->title, StepperDone(s) ? "finished" : "stopped", z->t,
                          s->model->c->nstage ? "by stage" : s->scheme->name, z->step, z->failures_total,
                          z->newton_total, Wall() - run->clock_start, local,
                          Relative(t.water + z->out[PHASE_W] - z->water0, z->water0),
                          Relative(t.methane + z->out[PHASE_G] - z->methane0, z->methane0),
                          Relative(z->heat_gain - z->heat_in - z->heat_source, z->capacity0), t.hydrate,
                          z->limited_total, yields, s->model->c->output_dir));
  PetscCall(StageLogSummary(run->log, s, &stages));
  PetscCall(PetscPrintf(s->model->grid.comm, "%s%s", text, stages));
  PetscCallMPI(MPI_Comm_rank(s->model->grid.comm, &rank));
  if (rank == 0) {
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/summary.txt", s->model->c->output_dir));
    FILE *f = fopen(path, "w");
    if (f) {
      fputs(text, f);
      fputs(stages, f);
      fclose(f);
    }
  }
  PetscCall(PetscFree(stages));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Go(const Case *c, Stepper *s, Run *run, const char *restart, int *exit_code)
{
  char path[PETSC_MAX_PATH_LEN];
  bool ok;

  PetscFunctionBeginUser;
  if (restart[0]) {
    PetscCall(CheckpointRead(s->model, &s->state, restart, &ok));
    if (!ok) {
      *exit_code = CL_EXIT_INPUT;
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
  PetscCall(StepperReady(s, &ok));
  if (!ok) {
    *exit_code = CL_EXIT_INPUT;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(MakeFolder(s->model->grid.comm, c->output_dir, &ok));
  if (!ok) {
    *exit_code = CL_EXIT_INPUT;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/case.yaml", c->output_dir));
  PetscCall(CaseWriteResolved(c, path));
  PetscCall(PetscSNPrintf(run->checkpoint, sizeof(run->checkpoint), "%s/checkpoint.h5", c->output_dir));
  PetscCall(OutputCreate(s->model, &s->state, restart[0] != '\0', &run->out));
  if (!restart[0]) {
    PetscCall(InitialWarnings(s->model->grid.comm, s->model->c, &s->model->P));
    PetscCall(OutputProbes(run->out, s->model, &s->state));
    PetscCall(OutputMeters(run->out, s->model, &s->state));
    PetscCall(OutputSnapshot(run->out, s->model, &s->state));
    s->state.next_snapshot++;
  }
  run->clock_start = Wall();
  PetscCall(StageLogCreate(s, &run->log));
  PetscCall(StepperRun(s, &ok));
  if (!AtMultiple(s->model->c, s->model->c->checkpoint_every, s->state.t))
    PetscCall(CheckpointWrite(s->model, &s->state, run->checkpoint));
  if (!ok)
    PetscCall(PetscPrintf(s->model->grid.comm, "The last good state (t = %g s) is saved in %s\n", s->state.t,
                          run->checkpoint));
  PetscCall(Summary(s, run));
  PetscCall(StageLogDestroy(&run->log));
  PetscCall(OutputDestroy(&run->out));
  *exit_code = ok ? CL_EXIT_OK : CL_EXIT_FAILED;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Options of ours that nobody read are misspelt; the solver reads its own later, so those are only warned about at the
 * end. */
static PetscErrorCode CheckOptions(MPI_Comm comm, bool ours, PetscInt *unknown)
{
  static const char *const prefix[] = {"stepper_", "newton_", "model_", "output_", "checkpoint_", "case_"};
  char                   **name, **value;
  PetscInt                 n;

  PetscFunctionBeginUser;
  *unknown = 0;
  PetscCall(PetscOptionsLeftGet(NULL, &n, &name, &value));
  for (PetscInt k = 0; k < n; k++) {
    PetscBool mine = PETSC_FALSE;

    for (size_t q = 0; !mine && q < sizeof(prefix) / sizeof(*prefix); q++)
      PetscCall(PetscStrbeginswith(name[k], prefix[q], &mine));
    if (mine != (PetscBool)ours)
      continue;
    (*unknown)++;
    PetscCall(PetscFPrintf(comm, stderr,
                           ours ? "clathra: there is no option -%s; see -help\n"
                                : "clathra: warning: option -%s was not used\n",
                           name[k]));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &name, &value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CaseRun(MPI_Comm comm, const Case *c, int *exit_code)
{
  Run       run = {0};
  Model     model;
  Stepper   stepper;
  char      restart[PETSC_MAX_PATH_LEN] = "";
  PetscBool quiet                       = PETSC_FALSE;
  PetscInt  unknown;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-quiet", &quiet, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-restart", restart, sizeof(restart), NULL));
  run.quiet = quiet;
  PetscCall(ModelCreate(comm, c, &model));
  PetscCall(StepperCreate(&model, &stepper));
  stepper.monitor     = Monitor;
  stepper.monitor_ctx = &run;
  stepper.next_event  = NextEvent;
  PetscCall(CheckOptions(comm, true, &unknown));
  if (unknown) {
    *exit_code = CL_EXIT_INPUT;
  } else {
    char fields[128];

    FieldSetPrint(&c->fields, fields, sizeof(fields));
    PetscCall(PetscPrintf(comm,
                          "%s\n  %" PetscInt_FMT " x %" PetscInt_FMT
                          " cells%s, %s, to t = %g s\n  fields: %s; %d unknowns "
                          "a node\n",
                          c->title, c->cells[0], c->cells[1], c->axisymmetric ? " about an axis" : "",
                          c->nstage ? "in stages" : c->stepper, c->t_end, fields, c->fields.n));
    PetscCall(PrintStrength(c, comm));
    PetscCall(Go(c, &stepper, &run, restart, exit_code));
    PetscCall(CheckOptions(comm, false, &unknown));
  }
  PetscCall(StepperDestroy(&stepper));
  PetscCall(ModelDestroy(&model));
  PetscFunctionReturn(PETSC_SUCCESS);
}
