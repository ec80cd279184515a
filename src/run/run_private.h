/* run_private: shared by the files of src/run. */
#pragma once

#include "clathra/findings.h"
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
bool   AtMultiple(const Case *c, double every, double t);
bool   AtSnapshot(const Case *c, double t);

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
void StageLogPace(const StageLog *log, const Stepper *s, Pace *pace);
/* A line for every stage that was entered and every integrator that worked in it, each behind a line's end; PetscFree
   it. */
PetscErrorCode StageLogSummary(const StageLog *log, const Stepper *s, char **text);

/* ---------------------------------------------------------------- phases.c */
/* Curve and pressure of equilibrium of each region that reacts, at its temperature. */
PetscErrorCode PrintEquilibrium(const Scene *c, MPI_Comm comm);
/* Methane in the water of the materials, mol/(m^3 Pa). */
PetscErrorCode PrintSolubility(const Scene *c, MPI_Comm comm);

/* ---------------------------------------------------------------- plastic.c */
PetscErrorCode PrintStrength(const Scene *c, MPI_Comm comm); /* the strength each region starts with */
