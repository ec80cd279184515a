/* io_private: shared by the files of src/io.  HDF5 runs on rank 0 alone: data are gathered there, in the order of the
   particles' ids, one variable at a time, so that files do not depend on the number of ranks.  Limit: rank 0 must hold
   one variable of all particles (snapshot, checkpoint) or all of them (reading a checkpoint, 0.4 kB a particle). */
#pragma once

#include "clathra/io.h"

#include <hdf5.h>
#include <stdio.h>

#define IO_PATH (PETSC_MAX_PATH_LEN + 64)
#define IO_FORMAT_VERSION 1 /* of fields.h5 */

typedef struct {
  PetscInt number, n; /* of the snapshot; particles in it */
  double   t;         /* s */
  bool     grid;      /* holds nodal fields */
} SnapshotEntry;

struct Output {
  char           dir[PETSC_MAX_PATH_LEN];
  FILE          *probes, *balance, *meters; /* rank 0; meters NULL if there are none */
  double        *reach;                     /* [nprobe] widening of each probe's neighbourhood */
  PetscInt       nsnapshot, cap;            /* rank 0: what fields.h5 holds */
  SnapshotEntry *snapshot;
  FieldSet       fields;
};

/* Nodal fields of a snapshot. */
typedef struct {
  const char *name, *unit;
  int         first, nc; /* in F_COUNT */
} NodalVariable;
extern const NodalVariable io_nodal[]; /* NULL name ends it */

/* Variables of a snapshot beside cl_particle_variable. */
typedef struct {
  const char *name, *unit;
  bool        integer;
  unsigned    has; /* fields any of which it goes with */
} ExtraVariable;
extern const ExtraVariable io_extra[]; /* NULL name ends it */

/* p = s_w p_w + s_g p_g with s = S/(1 - S_h), Pa. */
static inline double MeanPressure(const Particles *P, PetscInt p)
{
  if (!P->f[P_PG])
    return P->f[P_PW][p];
  const double sw = P->f[P_SW][p] / (1.0 - P->f[P_SH][p]);

  return sw * P->f[P_PW][p] + (1.0 - sw) * P->f[P_PG][p];
}

static inline double GasSaturation(const Particles *P, PetscInt p)
{
  return 1.0 - P->f[P_SH][p] - P->f[P_SW][p];
}

/* ---------------------------------------------------------------- output.c */
PetscErrorCode IoPath(const char *dir, const char *name, char path[IO_PATH]);
/* Shares the error of what rank 0 did alone; collective. */
PetscErrorCode IoAgree(MPI_Comm comm, PetscErrorCode ierr);
PetscErrorCode IoFlush(FILE *f, const char *name);
PetscErrorCode IoRename(const char *from, const char *to);

/* ---------------------------------------------------------------- probes.c, balance.c, meters.c: header lines, rank 0
 */
void ProbesHeader(const Case *c, FILE *f);
void BalanceHeader(const Case *c, FILE *f);
void MetersHeader(const Case *c, FILE *f);

/* Stages may take seconds after years: their times are told apart to the last digit. */
static inline void IoTime(const Case *c, FILE *f, double t)
{
  fprintf(f, c->nstage ? "%.16e" : "%.12e", t);
}

/* ---------------------------------------------------------------- snapshot.c, xdmf.c: rank 0 */
PetscErrorCode SnapshotsStart(Output *out, bool append, PetscInt next);
PetscErrorCode XdmfWrite(const Output *out, const Grid *g);

/* ---------------------------------------------------------------- h5util.c */
#define H5Check(expr) PetscCheck((expr) >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "HDF5 failed at %s", #expr)

PetscErrorCode H5FileCreate(const char *path, hsize_t user_block, hid_t *file);
PetscErrorCode H5FileOpen(const char *path, bool write, hid_t *file); /* *file < 0: it cannot be opened */
PetscErrorCode H5FileClose(hid_t *file);
PetscErrorCode H5Group(hid_t file, const char *path, hid_t *group); /* with all above it */
/* dims has nd entries; unit NULL = none; compressed when large and `compress`. */
PetscErrorCode H5Write(hid_t where, const char *name, hid_t type, int nd, const hsize_t dims[], const void *data,
                       const char *unit, bool compress);
PetscErrorCode H5WriteReal(hid_t where, const char *attribute, double value);
PetscErrorCode H5WriteInt(hid_t where, const char *attribute, PetscInt value);
PetscErrorCode H5WriteText(hid_t where, const char *attribute, const char *value);
bool           H5ReadReal(hid_t where, const char *attribute, double *value);
bool           H5ReadInt(hid_t where, const char *attribute, PetscInt *value);
/* Reads a dataset that must have these dimensions and hold integers or reals as `type` does. */
bool H5Read(hid_t where, const char *name, hid_t type, int nd, const hsize_t dims[], void *data);
/* Number of rows of a dataset; false if there is no such dataset. */
bool H5Rows(hid_t where, const char *name, hsize_t *rows);

/* Particles of all ranks on rank 0, sorted by id. */
typedef struct {
  MPI_Comm    comm;
  PetscMPIInt rank, size, *count, *start; /* rank 0: of each rank */
  PetscInt    n, total;                   /* local; all (rank 0) */
  PetscInt   *order, *id;                 /* rank 0: order of arrival of the k-th by id; its id */
  void       *buffer;                     /* rank 0 */
} Gather;
PetscErrorCode GatherCreate(const Model *m, Gather *g);
PetscErrorCode GatherDestroy(Gather *g);
/* sorted[k * stride] on rank 0; elsewhere sorted may be NULL. */
PetscErrorCode GatherReals(Gather *g, const double *local, PetscInt stride, double *sorted);
PetscErrorCode GatherInts(Gather *g, const PetscInt *local, PetscInt *sorted);

/* ---------------------------------------------------------------- seal.c */
#define SEAL_BYTES 512 /* HDF5 user block in front of a checkpoint */
#define CHECKPOINT_VERSION 5
#define FNV_START UINT64_C(14695981039346656037)
uint64_t HashBytes(uint64_t hash, const void *data, size_t bytes); /* FNV-1a, 64 bits */
/* Physics of a case: grid, gravity, basis, regions, materials, boundary conditions, meters, and what stages
   change of it.  Names, outputs,
   numerics of the solver and of time are left out. */
uint64_t CaseFingerprint(const Case *c);
/* Writes version, case, length and checksum of the whole file into the user block, and syncs it to the disk. */
PetscErrorCode SealWrite(const char *path, uint64_t fingerprint);
/* Is the file a whole, undamaged checkpoint of this version?  Else the reason. */
PetscErrorCode SealCheck(const char *path, uint64_t *fingerprint, bool *ok, char *why, size_t size);

/* ---------------------------------------------------------------- checkpoint.c: fields of StepperState */
typedef struct {
  const char *name;
  size_t      offset;
  int         n;
  bool        integer;
} StateField;
extern const StateField io_state_field[]; /* NULL name ends it */
