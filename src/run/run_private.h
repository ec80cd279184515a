/* run_private: shared by the files of src/run. */
#pragma once

#include "clathra/io.h"
#include "clathra/run.h"

double Wall(void); /* s */

/* What each stage took in this process. */
typedef struct StageLog StageLog;
PetscErrorCode          StageLogCreate(const Stepper *s, StageLog **log);
PetscErrorCode          StageLogDestroy(StageLog **log);
void                    StageLogStep(StageLog *log, const Stepper *s, const StepInfo *info); /* an accepted step */
/* Share of the stage that is done, and the seconds the rest of it will take. */
void StageLogProgress(const StageLog *log, const Stepper *s, double *done, double *left);
/* A line for every stage that was entered; empty without stages.  PetscFree it. */
PetscErrorCode StageLogSummary(const StageLog *log, const Stepper *s, char **text);
