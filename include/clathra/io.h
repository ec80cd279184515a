/* io: what a run writes and reads.  HDF5 + XDMF snapshots, probes.csv, meters.csv, balance.csv, checkpoint.
   What cannot be written (a full disk, a folder gone) is no error of PETSc: it is said in one sentence, nothing more is
   written, what was there stays whole, and the caller hears of it through *ok (the same on all ranks). */
#pragma once

#include "clathra/stepper.h"

typedef struct Output Output;

/* Files of a run: new ones, or those of a run that a restart goes on with; in a folder without any (a checkpoint of
   another folder), or where they should be: what is missing of them is said. */
typedef enum { OUTPUT_ANEW = 0, OUTPUT_ELSEWHERE, OUTPUT_HERE } OutputFrom;

/* Which run and from when on: the origin of a checkpoint. */
typedef struct {
  uint64_t run; /* its identity */
  double   t;   /* s */
  Unseen   unseen;
} Origin;

/* The output folder, taken by this run: nobody else writes into it until it is released or the process dies. */
typedef struct {
  int      lock; /* rank 0 */
  uint64_t run;  /* a new identity */
  bool     here; /* rank 0: it holds the files of the run that is gone on with */
} Folder;

/* Makes the folder, takes it, and notes the new run in its run.id.  Otherwise a sentence is printed and nothing
   changed: CL_EXIT_INPUT, it cannot be written, another run writes into it, or `from` (the checkpoint that is gone on
   from, NULL for a new run) does not belong to the files that are there; CL_EXIT_FAILED, the disk has no room.
   Collective. */
PetscErrorCode FolderTake(MPI_Comm comm, const char *dir, const Origin *from, Folder *folder, int *exit_code);
/* Gives the folder back: others may write into it. */
PetscErrorCode FolderRelease(Folder *folder);
/* May a run of the case whose resolved form this is write into the folder?  Not where it holds a case of the user's
   own, nor, if it keeps those, results of another case: a sentence says so.  Collective. */
PetscErrorCode FolderCheckCase(MPI_Comm comm, const char *dir, char *resolved, size_t bytes, bool keeps, bool *ok);
/* Adds to the end of a text file of the folder, on rank 0; fresh: a new file in its place, whole, or as it was.
   Collective. */
PetscErrorCode FolderAppendText(MPI_Comm comm, const char *dir, const char *name, bool fresh, const char *text,
                                size_t bytes, bool *ok);

/* Creates the output folder's files (through rank 0), or goes on with those of a run that was restarted at state->t:
   rows and snapshots later than t are dropped. */
PetscErrorCode OutputCreate(const Model *m, const StepperState *s, OutputFrom from, Output **out);
/* Has all been written so far?  Collective. */
PetscErrorCode OutputGood(const Output *out, MPI_Comm comm, bool *ok);
/* The rows so far are brought onto the disk: before a checkpoint that takes them for granted.  Collective. */
PetscErrorCode OutputSync(Output *out, MPI_Comm comm, bool *ok);
/* Closes all; *ok = false if rows were lost by then.  Collective. */
PetscErrorCode OutputDestroy(Output **out, MPI_Comm comm, bool *ok);
/* One row of probes.csv: means over the particles nearest to each probe. */
PetscErrorCode OutputProbes(Output *out, const Model *m, const StepperState *s);
/* One row of meters.csv, if the case has meters. */
PetscErrorCode OutputMeters(Output *out, const Model *m, const StepperState *s);
/* One row of balance.csv. */
PetscErrorCode OutputBalance(Output *out, const Model *m, const StepperState *s, const StepInfo *info);
/* Particles (all history variables, p, mass-weighted ids) and nodes as snapshot number s->next_snapshot: a file in the
   folder fields, listed by fields.h5, particles.xdmf and grid.xdmf. */
PetscErrorCode OutputSnapshot(Output *out, const Model *m, const StepperState *s);

/* Checkpoint: written aside, then renamed; the previous one is kept as NAME.old.  Holds the state, all particle
   variables and integers in order of id, a format version, the run, and a fingerprint of the case. */
PetscErrorCode CheckpointWrite(const Model *m, const StepperState *s, uint64_t run, const char *path, bool *ok);
/* Reads it onto any number of ranks; a damaged or foreign file is refused with a reason (*ok = false, message printed,
   model untouched). */
PetscErrorCode CheckpointRead(Model *m, StepperState *s, const char *path, Origin *origin, bool *ok);
/* Only its particles, as the initial ones (340) of a case that may differ in all but what CaseWriteState says; origin:
   the run and time they are of. */
PetscErrorCode CheckpointReadInitial(Model *m, const char *path, Origin *origin, bool *ok);
