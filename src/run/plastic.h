/* Private to run/: what a run says of a skeleton that yields. */
#pragma once

#include "clathra/stepper.h"

/* The strength each region starts with. */
PetscErrorCode PrintStrength(const Scene *c, MPI_Comm comm);
/* ", 120 particles yield, 3 at the apex (tearing)" for a line of progress; empty where nothing can.  Collective. */
PetscErrorCode YieldText(const Model *m, char text[128]);
/* The line of the summary, with the largest plastic strain and the work dissipated.  Collective. */
PetscErrorCode YieldSummary(const Model *m, char text[256]);
