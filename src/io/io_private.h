/* io_private: shared by the files of src/io.  Snapshots and checkpoints are written by all ranks: each gets a slab of
   the particles in the order of their ids and a strip of the nodes, one variable at a time, and puts it into the file
   at its place, so that files do not depend on the number of ranks and no rank holds all of them.  Tables, lists and
   whatever else is small are written by rank 0. */
#pragma once

#include "clathra/finding.h"
#include "clathra/io.h"

#include <hdf5.h>
#include <stdio.h>

#ifndef H5_HAVE_PARALLEL
  #error "Clathra needs an HDF5 that was built with MPI"
#endif
#if defined(PETSC_USE_64BIT_INDICES) /* PetscInt, in files as in memory; either is read as the other */
  #define H5_INT H5T_NATIVE_INT64
#else
  #define H5_INT H5T_NATIVE_INT
#endif

#define IO_PATH (PETSC_MAX_PATH_LEN + 64)
#define IO_FORMAT_VERSION 1 /* of fields.h5 */

typedef struct {
  PetscInt number, n; /* of the snapshot; particles in it */
  double   t;         /* s */
  bool     grid;      /* holds nodal fields */
} SnapshotEntry;

typedef enum { TABLE_PROBES = 0, TABLE_BALANCE, TABLE_METERS, TABLE_COUNT } TableId;

struct Output {
  char           dir[PETSC_MAX_PATH_LEN];
  bool           failed;          /* rank 0: something could not be written, which was said */
  int            fd[TABLE_COUNT]; /* rank 0; < 0 if there is no such table */
  FILE          *row;             /* rank 0: of the table to be written next */
  char          *text;
  size_t         size;
  double        *reach;          /* [nprobe] widening of each probe's neighbourhood */
  PetscInt       nsnapshot, cap; /* rank 0: what fields.h5 lists */
  SnapshotEntry *snapshot;
  FieldSet       fields;
};

/* Nodal fields of a snapshot. */
typedef struct {
  const char *name, *unit;
  int         first, nc; /* in F_COUNT */
} NodalVariable;
extern const NodalVariable io_nodal[]; /* NULL name ends it */

/* What is computed from a particle's state: columns of probes and, but for some, variables of a snapshot (derived.c).
 */
enum {
  DERIVED_P = 0,
  DERIVED_SG,
  DERIVED_MEAN,
  DERIVED_Q,
  DERIVED_SHEAR,
  DERIVED_MARGIN,
  DERIVED_YIELDS,
  DERIVED_COUNT
};
typedef struct {
  const char *name, *unit;
  unsigned    has; /* fields any of which it goes with */
  double (*of)(const Model *m, PetscInt p);
  bool snapshots;
} DerivedQuantity;
extern const DerivedQuantity io_derived[]; /* NULL name ends it */

/* Integers of a particle in a snapshot. */
enum { WHOLE_REGION = 0, WHOLE_ID, WHOLE_VERTEX, WHOLE_COUNT };
extern const char *const io_whole[WHOLE_COUNT];

/* ---------------------------------------------------------------- file.c: rank 0.  false: stderr has the reason */
typedef struct {
  const void *data;
  size_t      bytes;
} IoPiece;
PetscErrorCode IoPath(const char *dir, const char *name, char path[IO_PATH]);
/* Shares the error of what rank 0 did alone; collective. */
PetscErrorCode IoAgree(MPI_Comm comm, PetscErrorCode ierr);
bool           IoFailed(const char *path, size_t bytes); /* says what errno means; false */
/* A whole new file in the place of PATH, or PATH as it was; keep_old: the one before becomes PATH.old. */
bool IoReplace(const char *path, bool keep_old, int n, const IoPiece piece[]);
/* The file aside, PATH.tmp, as IoReplace would have written it, into the place of PATH; block: what it begins with. */
bool IoAdopt(const char *path, bool keep_old, const IoPiece *block);
void IoAside(const char *path, char aside[IO_PATH + 8]);
bool IoRename(const char *from, const char *to);
bool IoMakeFolder(const char *dir); /* with all above it */
int  IoOpenEnd(const char *path);   /* < 0: it was said why not */
bool IoAppend(int fd, const char *path, const char *text, size_t bytes);
bool IoSync(int fd, const char *path); /* to the disk */
bool IoClose(int fd, const char *path);

/* ---------------------------------------------------------------- rows.c: rank 0.  A row is printed into memory, then
   written; nothing more is written after a failure. */
extern const char *const cl_table_name[TABLE_COUNT];
PetscErrorCode           RowBegin(Output *out, FILE **f);
PetscErrorCode           RowKeep(Output *out); /* as out->text, of out->size, to be freed */
PetscErrorCode           RowEnd(Output *out, TableId id);

/* ---------------------------------------------------------------- tables.c: rank 0 */
PetscErrorCode TablesOpen(Output *out, const Model *m, OutputFrom from, double t);
void           TablesSync(Output *out);
void           TablesClose(Output *out);

/* ---------------------------------------------------------------- probes.c, balance.c, meters.c: header lines, rank 0
 */
/* Columns of a probe that others name: in the order of the table in columns.c. */
enum {
  PROBE_P       = 0,
  PROBE_PW      = 1, /* p_w, p_g, T */
  PROBE_SG      = 6,
  PROBE_X       = 7 + CL_DIM + CL_TENSOR, /* behind displacement and stress */
  PROBE_HISTORY = PROBE_X + CL_DIM,       /* of the skeleton, component by component */
  PROBE_MEAN    = PROBE_HISTORY + OWN_COUNT,
  PROBE_Q,
  PROBE_STRAIN,
  PROBE_SHEAR,
  PROBE_MARGIN,
  PROBE_YIELDS,
  PROBE_COUNT
};
bool   ProbeWanted(const Case *c, int q);
double ProbeQuantity(const Model *m, PetscInt p, int q);
/* means.c: is this probe one?  This rank's sums of weights times values, and of weights (m^3 or m^2), of all that are.
 */
static inline bool ProbeIsMean(const Probe *p)
{
  return !isfinite(p->x[0]);
}
PetscErrorCode MeansAdd(const Model *m, double value[][PROBE_COUNT], double *weight);
void           ProbesHeader(const Case *c, FILE *f);
void           BalanceHeader(const Case *c, FILE *f);
void           MetersHeader(const Case *c, FILE *f);
bool           MetersWanted(const Model *m); /* is there anything to write? */

/* Stages may take seconds after years: their times are told apart to the last digit. */
static inline void IoTime(const Case *c, FILE *f, double t)
{
  fprintf(f, c->nstage ? "%.16e" : "%.12e", t);
}

/* ---------------------------------------------------------------- snapshot.c, series.c, xdmf.c: rank 0 */
#define SNAPSHOT_NAME "fields/%06d.h5"
PetscErrorCode SeriesStart(Output *out, OutputFrom from, PetscInt next);
PetscErrorCode SeriesAdd(Output *out, const SnapshotEntry *entry);
PetscErrorCode SeriesWrite(Output *out, const Grid *g); /* fields.h5, particles.xdmf and grid.xdmf */
typedef enum { XDMF_PARTICLES = 0, XDMF_GRID, XDMF_COUNT } XdmfKind;
extern const char *const xdmf_name[];
void                     XdmfPrint(FILE *f, const Output *out, const Grid *g, XdmfKind kind);

/* ---------------------------------------------------------------- h5util.c */
#define H5Check(expr) PetscCheck((expr) >= 0, PETSC_COMM_SELF, H5Failure(), "HDF5 failed at %s", #expr)

PetscErrorCode H5Failure(void); /* of the last call: PETSC_ERR_MEM or PETSC_ERR_LIB */

PetscErrorCode H5ImageCreate(hsize_t user_block, hid_t *file); /* a file in memory */
/* A file that all ranks write; the calls that make groups, attributes and datasets of it are collective. */
PetscErrorCode H5SharedCreate(MPI_Comm comm, const char *path, hsize_t user_block, hid_t *file);
PetscErrorCode H5ImageBytes(hid_t image, IoPiece *piece);           /* valid until it is closed; user block and all */
PetscErrorCode H5FileOpen(const char *path, hid_t *file);           /* to read; *file < 0: it cannot be opened */
PetscErrorCode H5FileClose(hid_t *file);                            /* also an image, also one that is not open */
PetscErrorCode H5Group(hid_t file, const char *path, hid_t *group); /* with all above it */
/* The part of a dataset that this rank writes or reads: along the first one (rows) or as many as space has (nodes). */
typedef struct {
  int     nd;
  hsize_t all[CL_DIM], start[CL_DIM], count[CL_DIM];
} H5Part;
/* What is written there: nc components an entry, those of one as the last axis; unit NULL: none. */
typedef struct {
  hid_t       type;
  int         nc;
  const void *data;
  const char *unit;
} H5Values;
/* keep: in a file that readers see, with checksums, compressed when large.  Collective if the file is. */
PetscErrorCode H5WritePart(hid_t where, const char *name, const H5Part *part, const H5Values *values, bool keep);
/* Most bytes of n such datasets of `components` reals an entry in all, whole chunks and what describes them included.
 */
size_t H5Room(const H5Part *part, int n, int components);
/* n numbers; those of rank 0 where several write. */
PetscErrorCode H5Write(hid_t where, const char *name, hid_t type, hsize_t n, const void *data, const char *unit);
PetscErrorCode H5WriteReal(hid_t where, const char *attribute, double value);
PetscErrorCode H5WriteInt(hid_t where, const char *attribute, PetscInt value);
PetscErrorCode H5WriteText(hid_t where, const char *attribute, const char *value);
bool           H5ReadReal(hid_t where, const char *attribute, double *value);
bool           H5ReadInt(hid_t where, const char *attribute, PetscInt *value);
/* Reads from a dataset that must have these dimensions and hold integers or reals as `type` does. */
bool H5ReadPart(hid_t where, const char *name, hid_t type, const H5Part *part, int nc, void *data);
bool H5Read(hid_t where, const char *name, hid_t type, hsize_t n, void *data); /* all of one of n numbers */
/* Number of rows of a dataset; false if there is no such dataset. */
bool H5Rows(hid_t where, const char *name, hsize_t *rows);

/* ---------------------------------------------------------------- shared.c */
/* A file that all ranks write together.  One rank makes it in memory; several write it aside, PATH.tmp, in room that
   was taken for it beforehand, so that HDF5 sees no full disk: it does not outlive one. */
typedef struct {
  MPI_Comm comm;
  hid_t    file;
  char     path[IO_PATH];
  bool     image;
} SharedFile;
/* sum: a checksum of all behind the user block (seal.c), bytes: the length of the whole file. */
typedef void (*SharedSeal)(uint64_t sum, uint64_t bytes, const void *ctx, char *block);
/* block: bytes of the user block; room: most bytes of the file.  *ok = false (on all ranks): it was said why not.
   Collective. */
PetscErrorCode SharedCreate(MPI_Comm comm, const char *path, hsize_t block, size_t room, SharedFile *f, bool *ok);
/* Closes it and puts it in the place of PATH as IoReplace does; seal fills the user block, NULL: there is none.
   Collective. */
PetscErrorCode SharedFinish(SharedFile *f, bool keep_old, SharedSeal seal, const void *ctx, bool *ok);

/* ---------------------------------------------------------------- slab.c */
/* Numbers of particles or nodes, wherever they are, on the ranks that write them: particles in the order of their ids,
   nodes as they lie on the grid, an equal share on each rank. */
typedef struct {
  PetscSF     sf; /* from what is here to the slots of what this rank writes */
  PetscMPIInt size;
  PetscInt    n, n_slots; /* items here; slots */
  PetscInt    total;      /* items of all ranks */
  PetscInt    rows, *row; /* written by this rank: the slot of each, NULL: as they come */
  void       *out, *come; /* one component: of the items here, in the slots */
  double     *data;       /* one variable of up to P_MOST components, by row */
  H5Part      part;
} Slab;
PetscErrorCode SlabParticles(const Model *m, Slab *s);
PetscErrorCode SlabNodes(const Model *m, Slab *s); /* without items: slots that get nothing stay NaN */
PetscErrorCode SlabDestroy(Slab *s);
/* Component c of nc of the rows from local[p * stride]. */
PetscErrorCode SlabReals(Slab *s, const double *local, PetscInt stride, int c, int nc);
PetscErrorCode SlabInts(Slab *s, const PetscInt *local);
/* The rows as a dataset; of integers after SlabInts. */
PetscErrorCode SlabWrite(const Slab *s, hid_t group, const char *name, int nc, const char *unit, bool keep);
PetscErrorCode SlabWriteInts(const Slab *s, hid_t group, const char *name, const char *unit, bool keep);
/* All variables of the particles into a group. */
PetscErrorCode SlabWriteVariables(Slab *s, const Particles *P, bool keep, hid_t group);
size_t         SlabRoomVariables(const Slab *s, const Particles *P); /* as H5Room */

/* ---------------------------------------------------------------- seal.c */
#define SEAL_BYTES 512 /* HDF5 user block in front of a checkpoint */
#define CHECKPOINT_VERSION 21
/* Checksum of what follows the user block: of data[bytes], and of a file, each rank reading its share (collective;
 *good = false: it cannot be read). */
uint64_t       SealSum(const void *data, size_t bytes);
PetscErrorCode SealSumFile(MPI_Comm comm, const char *path, size_t block, uint64_t *sum, uint64_t *bytes, bool *good);
/* The user block: version, case, run, length of the file and a checksum of it and of the block. */
void SealMake(char block[SEAL_BYTES], uint64_t fingerprint, uint64_t run, uint64_t bytes, uint64_t sum);
/* Is the file a whole, undamaged checkpoint of this version?  Else the reason.  Collective, the same on all ranks. */
PetscErrorCode SealCheck(MPI_Comm comm, const char *path, uint64_t *fingerprint, uint64_t *run, bool *ok, char *why,
                         size_t size);

/* ---------------------------------------------------------------- bound.c */
/* Why the case that a checkpoint was written by is not c: its keys that differ, with both values, as far as it says. */
PetscErrorCode BoundDiffers(hid_t file, const Case *c, char *why, size_t size);

/* ---------------------------------------------------------------- checkpoint.c: fields of StepperState */
typedef struct {
  const char *name;
  size_t      offset;
  int         n;
  bool        integer;
} StateField;
extern const StateField io_state_field[]; /* NULL name ends it */
