/* io: what a run writes and reads.  HDF5 + XDMF time series, probes.csv, meters.csv, balance.csv,
   checkpoint. */
#pragma once

#include "clathra/stepper.h"

typedef struct Output Output;

/* Creates the output folder's files (rank 0 writes text; HDF5 through rank 0 or collectively).  append: continue the
   files of a run that was restarted at state->t: rows and snapshots later than t are dropped. */
PetscErrorCode OutputCreate(const Model *m, const StepperState *s, bool append, Output **out);
PetscErrorCode OutputDestroy(Output **out);
/* One row of probes.csv: means over the particles nearest to each probe. */
PetscErrorCode OutputProbes(Output *out, const Model *m, const StepperState *s);
/* One row of meters.csv, if the case has meters. */
PetscErrorCode OutputMeters(Output *out, const Model *m, const StepperState *s);
/* One row of balance.csv. */
PetscErrorCode OutputBalance(Output *out, const Model *m, const StepperState *s, const StepInfo *info);
/* Particles (all history variables, p, mass-weighted ids) and nodes as snapshot number s->next_snapshot of fields.h5
 * and fields.xdmf. */
PetscErrorCode OutputSnapshot(Output *out, const Model *m, const StepperState *s);

/* Checkpoint: written aside, then renamed; the previous one is kept as NAME.old.  Holds the state, all particle
   variables and integers in order of id, a format version and a fingerprint of the case (grid, regions, materials,
   conditions, meters). */
PetscErrorCode CheckpointWrite(const Model *m, const StepperState *s, const char *path);
/* Reads it onto any number of ranks; a damaged or foreign file is refused with a reason (*ok = false, message printed,
   model untouched). */
PetscErrorCode CheckpointRead(Model *m, StepperState *s, const char *path, bool *ok);
