/* run_private: shared by the files of src/run. */
#pragma once

#include "clathra/io.h"
#include "clathra/run.h"
#include "clathra/words.h"

/* ---------------------------------------------------------------- log.c: log.txt */
/* What was said since the last time goes into the folder; append: after what a run before wrote.  Collective. */
PetscErrorCode LogWrite(MPI_Comm comm, const char *dir, bool append, bool *ok);
/* The options of the command as a shell reads them, each behind a space, but those that say how the run begins; to be
   freed. */
PetscErrorCode CommandOptions(char **text);

/* ---------------------------------------------------------------- watch.c: seconds of the clock on the wall */
double Wall(void); /* now, s */
typedef struct {
  double limit, often, line;                  /* -time_limit, -checkpoint_wall, -progress */
  double begun, saved, before, said, longest; /* when; the longest step so far */
  bool   over;                                /* it was time to end */
} Watch;
PetscErrorCode WatchStart(Watch *w);
/* After a step: is it time for a checkpoint; would two steps more, as long as the longest, pass the limit?  Collective.
 */
PetscErrorCode WatchStep(MPI_Comm comm, Watch *w, bool *save, bool *end);
void           WatchSaved(Watch *w);
bool           WatchLine(Watch *w, bool last); /* is it time for a line?  The last one always comes */

/* ---------------------------------------------------------------- start.c */
/* Particles of a checkpoint as the initial ones (340); what is counted from the start counts from them.  *ok = false: a
   sentence was printed.  Collective. */
PetscErrorCode StartFromState(Stepper *s, const char *path, bool *ok);

/* ---------------------------------------------------------------- memory.c */
Place CellsWords(const Scene *c, const char *between); /* "52 x 1": cells along each axis */
/* *ok = false: the run would need more than the machine has, or than the process may take, and a sentence was printed.
   m: NULL before there is one; then multigrid is what is counted, which takes less than LU.  Collective. */
PetscErrorCode MemoryLook(MPI_Comm comm, const Case *c, const Model *m, bool *ok);

/* ---------------------------------------------------------------- times.c */
/* After t, s; INFINITY if there is none.  Multiples of `every` count from the begin of the stage. */
double NextMultiple(const Case *c, double every, double t);
double NextSnapshot(const Case *c, double t);
/* Notes of times between outputs that are longer than the run or a stage. */
PetscErrorCode EveryNotes(MPI_Comm comm, const Case *c);
bool           AtMultiple(const Case *c, double every, double t);
bool           AtSnapshot(const Case *c, double t);

/* ---------------------------------------------------------------- stages.c */
/* What each stage took in this process. */
typedef struct StageLog StageLog;
PetscErrorCode          StageLogCreate(const Stepper *s, StageLog **log);
PetscErrorCode          StageLogDestroy(StageLog **log);
PetscErrorCode          StageLogStep(StageLog *log, const Stepper *s, const StepInfo *info); /* an accepted step */
/* Steps and s of the wall that the rest of it will take, and the latter if time went
   on as in the last steps (421); NAN: not known yet, as before 5 % unless the stage has taken all of its forecast. */
typedef struct {
  double steps, time, flat;
} Left;
void StageLogProgress(const StageLog *log, const Stepper *s, Left *left);
/* Steps taken in the stage by this process, and s of the wall. */
PetscInt StageLogTaken(const StageLog *log);
double   StageLogSpent(const StageLog *log);
/* How a stage goes: share of it that is done, steps left as the run itself shows (NAN: not known), s of the wall for
   one, so far, and to the end if time went on as in the last steps (NAN: not known). */
typedef struct {
  double done, left, step, spent, flat;
} Pace;
void StageLogPace(const StageLog *log, const Stepper *s, Pace *pace);
/* A line for every stage that was entered and every integrator that worked in it; empty where there was one only.
   PetscFree it. */
PetscErrorCode StageLogSummary(const StageLog *log, const Stepper *s, char **text);

/* ---------------------------------------------------------------- slow.c */
typedef struct {
  double   next, clock; /* steps of the stage, and s of the wall, before which nothing is said */
  PetscInt stage, refused;
  bool     said;
} Slow;
/* At the begin of a run. */
void SlowBegin(Slow *slow, const Stepper *s);
/* Is far more left than was forecast, in steps or s of the wall, after far more than was forecast? */
bool SlowIs(const Slow *slow, const Forecast *f, PetscInt taken, const Pace *pace);
/* After a step that the log knows: a line if the stage takes far more steps, or longer, than was forecast, again when
   it has taken twice as many steps and twice as long. */
PetscErrorCode SlowLook(Slow *slow, const Stepper *s, const StepInfo *info, const StageLog *log);

/* ---------------------------------------------------------------- summary.c: lines of the summary, empty where there
   is nothing to say */
void           LocalSummary(const Stepper *s, char text[512]); /* of an integrator without matrices */
void           LeftSummary(const Stepper *s, char text[128]);  /* what Newton's method left (277) */
void           HydrateSummary(const StepperState *z, double now, char text[160]); /* now: kg in the body */
void           GoneSummary(const StepperState *z, char text[512]);   /* particles that left the grid (373) */
void           LooseSummary(const Stepper *s, char text[512]);       /* largest error, and those put up with */
void           UnevenSummary(const StepperState *z, char text[256]); /* steps without exchange within cells (353) */
PetscErrorCode LongSummary(const Model *m, char text[256]);          /* domains longer than a cell; collective */
void           IceSummary(const Stepper *s, char text[256]);         /* water below its melting point */
PetscErrorCode RanksSummary(const Model *m, char text[128]); /* how evenly ranks share the particles; collective */

/* ---------------------------------------------------------------- borders.c */
/* One of the last lines: borders of layers that have left the grid's lines; collective. */
PetscErrorCode NoteBorders(const Stepper *s);

/* ---------------------------------------------------------------- still.c */
#define STILL_WORDS 2048
/* After a step: at the end of a stage, or of a run without stages, a line with the conditions and meters of which
   nothing came in all of it.  Collective. */
PetscErrorCode StillLook(Stepper *s);

/* ---------------------------------------------------------------- ranges.c */
/* Lines of the summary: the extremes of p and T. */
PetscErrorCode RangeSummary(const Stepper *s, char text[512]);
/* The last lines of a run: what lies outside of what started and acted, errors far above the tolerance, borders. */
PetscErrorCode EndWarnings(const Stepper *s);
/* Temperatures that start and conditions lead to, degC, and whether one beyond them and hydrate's was told of. */
typedef struct {
  double low, high;
  bool   said;
} Ranges;
/* At the begin of a run. */
void RangesBegin(Ranges *r, const Stepper *s);
/* After a step: a warning, once, if a particle's temperature is some kelvin beyond. */
PetscErrorCode RangesLook(Ranges *r, const Stepper *s);

/* ---------------------------------------------------------------- phases.c */
/* Curve and pressure of equilibrium of each region that reacts, at its temperature. */
PetscErrorCode PrintEquilibrium(const Scene *c, MPI_Comm comm);
/* Methane in the water of the materials, mol/(m^3 Pa). */
PetscErrorCode PrintSolubility(const Scene *c, MPI_Comm comm);
/* Counts the particles below the melting point of their water, (127), after a step or a burst, and says so the first
   time; *ends: the case wants the run to end there.  Collective. */
PetscErrorCode IceLook(Stepper *s, bool *ends);
