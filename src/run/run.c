/* Runs a case: builds the model, steps it, writes what the case asks for, and says how it went. */
#include "run_private.h"
#include "clathra/words.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STANDS 10.0 /* times the time that is left, if steps stay as they are: a line says so */

typedef struct {
  Output   *out;
  Folder    folder;
  Watch     watch;
  StageLog *log;
  Findings  findings;
  char     checkpoint[PETSC_MAX_PATH_LEN + 16], saved[PETSC_MAX_PATH_LEN]; /* to write; last that was written or read */
  char     restart[PETSC_MAX_PATH_LEN], initial[PETSC_MAX_PATH_LEN];       /* -restart, -restart_as_initial */
  double   t_saved;                                                        /* of that */
  PetscInt taken;                                                          /* steps before this process */
  double   t_shown;                                                        /* of the last snapshot, s */
  double   clock_start;                                                    /* s of the wall */
  bool     check;                                                          /* ends before anything is written */
  bool     quiet, restarted;
  bool     written, lost; /* a checkpoint by this run; not all could be written */
} Run;

static double NextEvent(const Stepper *s, void *ctx)
{
  const Case  *c = StepperCase(s);
  const double t = s->state.t;

  (void)ctx;
  return fmin(NextSnapshot(c, t), fmin(NextMultiple(c, c->probe_every, t), NextMultiple(c, c->checkpoint_every, t)));
}

/* "about 80 steps, 2 min left"; where that counts on steps that grow again, also how long without. */
static PetscErrorCode LeftWords(const Left *left, char words[128])
{
  PetscFunctionBeginUser;
  if (isnan(left->time))
    PetscFunctionReturn(PETSC_SUCCESS);
  if (left->steps > 0.0)
    snprintf(words, 128, "about %s step%s, %s left", CountWords(fmax(left->steps, 1.0)).s, left->steps < 1.5 ? "" : "s",
             TimeWords(left->time, left->time < 10.0 ? 2 : 3).s);
  else
    snprintf(words, 128, "%s left", TimeWords(left->time, left->time < 10.0 ? 2 : 3).s);
  if (left->flat > STANDS * left->time) {
    PetscCall(PetscStrlcat(words, " if steps grow again, ", 128));
    PetscCall(PetscStrlcat(words, TimeWords(left->flat, 2).s, 128));
    PetscCall(PetscStrlcat(words, " if not", 128));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Progress(const Stepper *s, const StepInfo *info, Run *run)
{
  const Case  *c       = StepperCase(s);
  const double t_begin = c->scene.t_begin, done = (s->state.t - t_begin) / (c->t_end - t_begin);
  Left         left;
  char         cuts[32] = "", error[160] = "", solved[48], stage[80], begin[48] = "", yields[128];
  char         rest[128] = "time left not known yet";

  PetscFunctionBeginUser;
  if (run->quiet || !WatchLine(&run->watch, CaseAtEnd(c, s->state.t) || s->stop))
    PetscFunctionReturn(PETSC_SUCCESS);
  StageLogProgress(run->log, s, &left);
  StepperStageWords(s, stage);
  if (t_begin > 0.0) {
    snprintf(begin, sizeof(begin), "%s + ", TimeWords(t_begin, 6).s);
  }
  PetscCall(LeftWords(&left, rest));
  PetscCall(FindingsYieldText(s->model, yields));
  if (info->cuts)
    snprintf(cuts, sizeof(cuts), ", after %" PetscInt_FMT " refused", info->cuts);
  if (s->explicit)
    snprintf(solved, sizeof(solved), "%s rules", cl_limit_word[s->limit.rules]);
  else
    snprintf(solved, sizeof(solved), "%2" PetscInt_FMT " Newton iterations", info->newton);
  if (s->adaptive && !s->explicit)
    snprintf(error, sizeof(error), ", error %.2g of tolerance (%s), at worst %.2g (%s near %s)", info->err,
             stepper_error_word[info->rules], info->peak.err, stepper_error_word[info->peak.of],
             PlaceWords(info->peak.at).s);
  PetscCall(PetscPrintf(s->model->grid.comm, "%sstep %4" PetscInt_FMT ": t = %s%s (%.1f %%), dt = %s, %s%s%s%s, %s\n",
                        stage, s->state.step, begin, TimeWordsAs(s->state.t - t_begin, c->t_end - t_begin, 6).s,
                        100.0 * done, TimeWords(info->dt, 6).s, solved, error, cuts, yields, rest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteLog(const Case *c, MPI_Comm comm, Run *run)
{
  bool ok = true;

  PetscFunctionBeginUser;
  if (!run->lost)
    PetscCall(LogWrite(comm, c->output_dir, run->restarted, &ok));
  run->lost = run->lost || !ok;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rows first: a restart from this checkpoint takes them for granted. */
static PetscErrorCode Save(Stepper *s, Run *run)
{
  bool ok;

  PetscFunctionBeginUser;
  PetscCall(OutputSync(run->out, s->model->grid.comm, &ok));
  if (ok)
    PetscCall(CheckpointWrite(s->model, &s->state, run->folder.run, run->checkpoint, &ok));
  if (ok) {
    PetscCall(PetscStrncpy(run->saved, run->checkpoint, sizeof(run->saved)));
    run->t_saved = s->state.t;
    run->written = true;
    WatchSaved(&run->watch);
  }
  run->lost = run->lost || !ok;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After every accepted step: ledger, probes, meters, snapshot, checkpoint, progress. */
static PetscErrorCode Monitor(Stepper *s, const StepInfo *info, void *ctx)
{
  Run         *run  = (Run *)ctx;
  const Case  *c    = StepperCase(s);
  const double t    = s->state.t;
  const bool   last = CaseAtEnd(c, t); /* of the run, or of a stage */
  bool         ok, save, end;

  PetscFunctionBeginUser;
  PetscCall(WatchStep(s->model->grid.comm, &run->watch, &save, &end));
  PetscCall(StageLogStep(run->log, s, info));
  run->findings.info = info;
  StageLogPace(run->log, s, &run->findings.pace);
  PetscCall(FindingsAt(&run->findings, FINDING_AT_STEP));
  PetscCall(OutputBalance(run->out, s->model, &s->state, info));
  if (c->probe_every == 0.0 || AtMultiple(c, c->probe_every, t) || last) {
    PetscCall(OutputProbes(run->out, s->model, &s->state));
    PetscCall(OutputMeters(run->out, s->model, &s->state));
  }
  if (AtSnapshot(c, t) || last) {
    PetscCall(OutputSnapshot(run->out, s->model, &s->state));
    s->state.next_snapshot++;
    run->t_shown = t;
    PetscCall(WriteLog(c, s->model->grid.comm, run));
  }
  PetscCall(OutputGood(run->out, s->model->grid.comm, &ok));
  run->lost = run->lost || !ok;
  if (!run->lost && (save || AtMultiple(c, c->checkpoint_every, t)))
    PetscCall(Save(s, run));
  s->stop = s->stop || run->lost || run->findings.ends || end;
  PetscCall(Progress(s, info, run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the run took and found, on stdout and in summary.txt. */
static PetscErrorCode Summary(const Stepper *s, Run *run)
{
  const MPI_Comm      comm      = s->model->grid.comm;
  const StepperState *z         = &s->state;
  char                above[64] = "", since[64] = "", *stages, *text;
  ModelTotals         t;
  double              error[3];
  bool                ok;

  PetscFunctionBeginUser;
  PetscCall(ModelComputeTotals(s->model, &t));
  StepperErrors(z, &t, error);
  if (run->restarted)
    snprintf(since, sizeof(since), " for the %" PetscInt_FMT " steps since the restart", z->step - run->taken);
  if (z->loose_total)
    snprintf(above, sizeof(above), "; %" PetscInt_FMT " steps above the tolerance", z->loose_total);
  PetscCall(FindingSay(
      comm, FINDING_RUN,
      "%s: %s at t = %s\n"
      "  integrator %s, %" PetscInt_FMT " steps, %" PetscInt_FMT " refused, %" PetscInt_FMT
      " Newton iterations, %.2f s%s%s\n"
      "  balance errors: water %.2e, methane %.2e of the initial mass, heat %.2e of what warms the body by 1 K",
      StepperCase(s)->title, StepperDone(s) ? "finished" : "stopped", TimeAt(z->t).s,
      StepperCase(s)->nstage ? "by stage"
      : s->auto_.on          ? case_integrator[StepperCase(s)->integrator]
                             : StepperName(s),
      z->step, z->failures_total, z->newton_total, Wall() - run->clock_start, since, above, error[0], error[1],
      error[2]));
  PetscCall(FindingsAt(&run->findings, FINDING_AT_SUMMARY));
  PetscCall(StageLogSummary(run->log, s, &stages));
  PetscCall(FindingSay(comm, FINDING_RESULTS, "  results in %s%s", StepperCase(s)->output_dir, stages));
  PetscCall(FindingsAt(&run->findings, FINDING_AT_END));
  PetscCall(FindingSummary(&text));
  PetscCall(FolderAppendText(comm, StepperCase(s)->output_dir, "summary.txt", true, text, strlen(text), &ok));
  run->lost = run->lost || !ok;
  PetscCall(PetscFree(stages));
  free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- from the first row to the last */
static PetscErrorCode WriteCase(MPI_Comm comm, const Case *c, Run *run)
{
  char  *text;
  size_t size;
  bool   ok;

  PetscFunctionBeginUser;
  PetscCall(CaseText(c, CaseWriteResolved, &text, &size));
  PetscCall(FolderAppendText(comm, c->output_dir, "case.yaml", true, text, size, &ok));
  free(text);
  run->lost = run->lost || !ok;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A run does not write over a case of the user's own, nor a new one over another case's results unless it is told to.
 */
static PetscErrorCode CheckFolder(MPI_Comm comm, const Case *c, bool restart, bool *ok)
{
  PetscBool overwrite = PETSC_FALSE;
  char     *text;
  size_t    size;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-overwrite", &overwrite, NULL));
  PetscCall(CaseText(c, CaseWriteResolved, &text, &size));
  PetscCall(FolderCheckCase(comm, c->output_dir, text, size, !restart && !overwrite, ok));
  free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a user should know of the start; -case_check says it, too. */
static PetscErrorCode FindStart(Run *run)
{
  PetscFunctionBeginUser;
  PetscCall(FindingsAt(&run->findings, FINDING_AT_START));
  if (!run->restart[0] && !run->initial[0])
    PetscCall(FindingsAt(&run->findings, FINDING_AT_SEEDING));
  if (!run->restart[0])
    PetscCall(FindingsAt(&run->findings, FINDING_AT_BEGIN));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Begin(const Case *c, Stepper *s, Run *run, bool restart)
{
  const Model *m = s->model;
  bool         ok;

  PetscFunctionBeginUser;
  PetscCall(WriteCase(m->grid.comm, c, run));
  PetscCall(OutputCreate(m, &s->state,
                         !restart           ? OUTPUT_ANEW
                         : run->folder.here ? OUTPUT_HERE
                                            : OUTPUT_ELSEWHERE,
                         &run->out));
  if (!restart) {
    PetscCall(OutputProbes(run->out, m, &s->state));
    PetscCall(OutputMeters(run->out, m, &s->state));
    PetscCall(OutputSnapshot(run->out, m, &s->state));
    s->state.next_snapshot++;
  }
  run->t_shown = s->state.t; /* or there is nothing newer to show */
  PetscCall(OutputGood(run->out, m->grid.comm, &ok));
  run->lost = run->lost || !ok;
  PetscCall(WriteLog(c, m->grid.comm, run));
  run->clock_start = Wall();
  PetscCall(StageLogCreate(s, &run->log));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Why the run ends here, and what there is to go on from. */
static PetscErrorCode SayEnd(const Stepper *s, const Run *run, bool ok)
{
  const MPI_Comm comm = s->model->grid.comm;
  const double   t    = s->state.t;
  const char    *why  = run->lost  ? "not all could be written; see to it"
                        : s->empty ? "no particle is left in the grid"
                                   : "the state is not finite";
  char          *options;

  PetscFunctionBeginUser;
  PetscCall(CommandOptions(&options));
  if ((run->lost || s->broken) && run->saved[0]) {
    PetscCall(PetscFPrintf(comm, stderr,
                           "clathra: stopped at t = %s: %s.  The last checkpoint, of t = %s, is whole: go on with "
                           "-restart %s%s\n",
                           TimeAt(t).s, why, TimeAt(run->t_saved).s, run->saved, options));
  } else if (run->lost || s->broken) {
    PetscCall(PetscFPrintf(
        comm, stderr, "clathra: stopped at t = %s: %s, and there is no checkpoint of this run yet: start it anew\n",
        TimeAt(t).s, why));
  } else if (s->signal && !StepperDone(s)) {
    PetscCall(PetscPrintf(comm, "Ended by signal %d (%s) at t = %s; go on with -restart %s%s\n", s->signal,
                          strsignal(s->signal), TimeAt(t).s, run->saved, options));
  } else if (run->watch.over && !run->findings.ends && ok && !StepperDone(s)) {
    PetscCall(PetscPrintf(comm, "Ended at t = %s, before -time_limit %g s is over; go on with -restart %s%s\n",
                          TimeAt(t).s, run->watch.limit, run->saved, options));
  } else if (!ok || run->findings.ends) {
    PetscCall(PetscPrintf(comm, "The last good state (t = %s) is saved in %s\n", TimeAt(t).s, run->saved));
  }
  free(options);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A run that is ended on its way leaves a snapshot of its last state, behind its last checkpoint, which knows nothing
   of it: a restart takes it back. */
static PetscErrorCode ShowEnd(const Stepper *s, Run *run)
{
  bool ok;

  PetscFunctionBeginUser;
  if (run->lost || s->broken || run->t_shown == s->state.t)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(OutputSnapshot(run->out, s->model, &s->state));
  PetscCall(OutputGood(run->out, s->model->grid.comm, &ok));
  run->lost = run->lost || !ok;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advance(Stepper *s, Run *run, int *exit_code)
{
  bool ok = true, closed;

  PetscFunctionBeginUser;
  if (!run->lost)
    PetscCall(StepperRun(s, &ok));
  if (!ok)
    PetscCall(FindingsAt(&run->findings, FINDING_AT_GIVING_UP));
  if (!run->lost &&
      !(run->written && run->t_saved == s->state.t)) /* after a loss it would promise rows that are not there */
    PetscCall(Save(s, run));
  PetscCall(ShowEnd(s, run));
  PetscCall(Summary(s, run));
  PetscCall(StageLogDestroy(&run->log));
  PetscCall(OutputDestroy(&run->out, s->model->grid.comm, &closed));
  run->lost = run->lost || !closed;
  PetscCall(SayEnd(s, run, ok));
  PetscCall(WriteLog(StepperCase(s), s->model->grid.comm, run));
  if (run->lost || run->findings.ends || !ok)
    *exit_code = CL_EXIT_FAILED;
  else if ((s->signal || run->watch.over) && !StepperDone(s))
    *exit_code = CL_EXIT_SIGNAL;
  else
    *exit_code = CL_EXIT_OK;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Go(const Case *c, Stepper *s, Run *run, int *exit_code)
{
  const char *restart = run->restart;
  Origin      origin;
  bool        ok = true;
  PetscBool   help;

  PetscFunctionBeginUser;
  *exit_code = CL_EXIT_INPUT;
  if (!run->check)
    PetscCall(CheckFolder(s->model->grid.comm, c, restart[0], &ok));
  if (!ok)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (restart[0]) {
    PetscCall(CheckpointRead(s->model, &s->state, restart, &origin, &ok));
    if (!ok)
      PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(PetscStrncpy(run->saved, restart, sizeof(run->saved)));
    run->t_saved   = s->state.t;
    run->taken     = s->state.step;
    run->restarted = true;
  } else {
    run->t_saved = NAN;
    if (run->initial[0])
      PetscCall(StartFromState(s, run->initial, &ok));
    if (!ok)
      PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(StepperReady(s, &ok));
  if (!ok)
    PetscFunctionReturn(PETSC_SUCCESS);
  run->findings = (Findings){.c = c, .s = s, .comm = s->model->grid.comm};
  PetscCall(FindStart(run));
  if (run->check) {
    PetscCall(PetscOptionsHasHelp(NULL, &help));
    if (help && (s->scheme->tableau || s->auto_.on))
      PetscCall(ModelReadySolver(s->model));
    *exit_code = CL_EXIT_OK;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(FolderTake(s->model->grid.comm, c->output_dir, restart[0] ? &origin : NULL, &run->folder, exit_code));
  if (*exit_code != CL_EXIT_OK)
    PetscFunctionReturn(PETSC_SUCCESS);
  snprintf(run->checkpoint, sizeof(run->checkpoint), "%s/checkpoint.h5", c->output_dir);
  PetscCall(Begin(c, s, run, restart[0] != '\0'));
  PetscCall(Advance(s, run, exit_code));
  PetscCall(FolderRelease(&run->folder));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Options of ours that nobody read are misspelt; the solver reads its own later. */
static PetscErrorCode CheckOptions(MPI_Comm comm, PetscInt *unknown)
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
    if (!mine)
      continue;
    (*unknown)++;
    PetscCall(PetscFPrintf(comm, stderr, "clathra: there is no option -%s; see -help\n", name[k]));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &name, &value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An option that is given without its path: a sentence. */
static PetscErrorCode CheckPath(MPI_Comm comm, const char *option, bool given, const char *path, bool *ok)
{
  PetscFunctionBeginUser;
  if (!given || path[0])
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFPrintf(
      comm, stderr, "clathra: %s needs the path of a checkpoint, e.g. %s results/bp2/checkpoint.h5\n", option, option));
  *ok = false;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CaseRun(MPI_Comm comm, const Case *c, bool check, int *exit_code)
{
  Run         run = {0};
  Model       model;
  Stepper     stepper;
  PetscBool   quiet = PETSC_FALSE, given;
  PetscInt    unknown;
  PetscMPIInt size;
  bool        ok = true;

  PetscFunctionBeginUser;
  run.check = check;
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-quiet", &quiet, NULL));
  run.quiet = quiet;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-restart", run.restart, sizeof(run.restart), &given));
  PetscCall(CheckPath(comm, "-restart", given, run.restart, &ok));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-restart_as_initial", run.initial, sizeof(run.initial), &given));
  PetscCall(CheckPath(comm, "-restart_as_initial", given, run.initial, &ok));
  if (!ok) {
    *exit_code = CL_EXIT_INPUT;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (run.restart[0] && run.initial[0]) {
    PetscCall(PetscFPrintf(comm, stderr,
                           "clathra: -restart goes on with a run, -restart_as_initial begins another one: give one of "
                           "them\n"));
    *exit_code = CL_EXIT_INPUT;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(WatchStart(&run.watch));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (!GridFits(size, c->scene.cells)) {
    PetscCall(PetscFPrintf(comm, stderr,
                           "clathra: %s: grid_cells = %s: too few for %d ranks (each needs a part of at least 3 nodes "
                           "along every axis that is shared); use fewer ranks\n",
                           c->file, CellsWords(&c->scene, ", ").s, (int)size));
    *exit_code = CL_EXIT_INPUT;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(MemoryLook(comm, c, NULL, &ok));
  if (!ok) {
    *exit_code = CL_EXIT_INPUT;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ModelCreate(comm, &c->scene, &CaseInStage(c, 0)->scene, &model));
  PetscCall(MemoryLook(comm, c, &model, &ok));
  if (!ok) {
    PetscCall(ModelDestroy(&model));
    *exit_code = CL_EXIT_INPUT;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(StepperCreate(&model, &stepper));
  stepper.monitor     = Monitor;
  stepper.monitor_ctx = &run;
  stepper.next_event  = NextEvent;
  stepper.interrupted = ProcessSignal;
  PetscCall(CheckOptions(comm, &unknown));
  if (unknown) {
    *exit_code = CL_EXIT_INPUT;
  } else {
    char fields[128];

    FieldSetPrint(&c->scene.fields, fields, sizeof(fields));
    PetscCall(PetscPrintf(comm, "%s\n  %s cells%s, %s, to t = %s\n  fields: %s; %d unknowns a node\n", c->title,
                          CellsWords(&c->scene, " x ").s, c->scene.axisymmetric ? " about an axis" : "",
                          c->nstage ? "in stages" : case_integrator[c->integrator], TimeAt(c->t_end).s, fields,
                          c->scene.fields.n));
    PetscCall(PrintStrength(&c->scene, comm));
    PetscCall(PrintEquilibrium(&c->scene, comm));
    PetscCall(PrintSolubility(&c->scene, comm));
    PetscCall(Go(c, &stepper, &run, exit_code));
  }
  PetscCall(StepperDestroy(&stepper));
  PetscCall(ModelDestroy(&model));
  PetscFunctionReturn(PETSC_SUCCESS);
}
