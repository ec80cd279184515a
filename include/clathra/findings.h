/* findings: looks for what a run has to say beside its progress; the table is that of finding.h. */
#pragma once

#include "clathra/finding.h"
#include "clathra/stepper.h"

/* How a stage goes: its steps in this process, the share of it that is done, steps left as the run itself shows (NAN:
   not known), s of the wall for one, so far, and to the end if time went on as in the last steps (NAN: not known). */
typedef struct {
  PetscInt taken;
  double   done, left, step, spent, flat;
} Pace;
/* Steps of the stage, and s of the wall, before which nothing is said of a slow run. */
typedef struct {
  double   next, clock;
  PetscInt stage, refused;
  bool     begun, said;
} Slow;

/* Temperatures that start and conditions of the run lead to, degC. */
typedef struct {
  double low, high;
  bool   known; /* by the first look, for none of this changes */
} Acted;

/* What is looked at, and what one look keeps for the next. */
typedef struct {
  const Case     *c; /* of the run; that of the stage is StepperCase(s) */
  Stepper        *s;
  MPI_Comm        comm;
  const StepInfo *info; /* of the step just taken */
  Pace            pace; /* ... and how the stage goes after it */
  bool            ends; /* set by a look: the run is to end here */
  Slow            slow;
  Acted           acted;
} Findings;

/* Looks for all findings of this moment and says them.  Collective. */
PetscErrorCode FindingsAt(Findings *f, FindingWhen when);
/* ", 120 particles yield, 3 at the apex (tearing)" for a line of progress; empty where nothing can.  Collective. */
PetscErrorCode FindingsYieldText(const Model *m, char text[128]);
