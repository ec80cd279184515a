/* fields.h5: the particles, sorted by id, and the nodal fields, one group a snapshot:

     /particles/000000/<variable>   n x components; those of cl_particle_variable and io_extra; `vertex` = 0, 1, 2, ...
     /grid/000000/<field>           rows (y) x columns (x) of all grid nodes (x components), NaN where inactive

   with the attribute `time` (s) on each group and `unit` on each dataset.  The nodal fields are those the last step
   started from (projections of the particles).  The file is closed after each snapshot: a killed run leaves it
   readable. */
#include "io_private.h"

#include <string.h>
#include <unistd.h>

const NodalVariable io_nodal[] = {{"v_s", "m/s", F_VSX, 2}, {"v_w", "m/s", F_VWX, 2}, {"v_g", "m/s", F_VGX, 2},
                                  {"p_w", "Pa", F_PW, 1},   {"p_g", "Pa", F_PG, 1},   {"T", "degC", F_T, 1},
                                  {NULL, NULL, 0, 0}};

enum { X_P = 0, X_SG, X_REGION, X_ID, X_VERTEX };
const ExtraVariable io_extra[] = {[X_P] = {"p", "Pa", false, HAS_WATER},       [X_SG] = {"S_g", "-", false, HAS_GAS},
                                  [X_REGION] = {"region", "-", true, HAS_ALL}, [X_ID] = {"id", "-", true, HAS_ALL},
                                  [X_VERTEX] = {"vertex", "-", true, HAS_ALL}, {NULL, NULL, false, 0}};

/* ---------------------------------------------------------------- start and restart, rank 0 */
static PetscErrorCode Remember(Output *out, const SnapshotEntry *entry)
{
  PetscFunctionBeginUser;
  if (out->nsnapshot == out->cap) {
    out->cap = 2 * out->cap + 16;
    PetscCall(PetscRealloc(sizeof(*out->snapshot) * (size_t)out->cap, &out->snapshot));
  }
  out->snapshot[out->nsnapshot++] = *entry;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void GroupName(char name[32], const char *kind, PetscInt number)
{
  snprintf(name, 32, "/%s/%06d", kind, (int)number);
}

static bool Exists(hid_t file, const char *kind, PetscInt number)
{
  char name[32];

  GroupName(name, kind, number);
  return H5Lexists(file, kind, H5P_DEFAULT) > 0 && H5Lexists(file, name, H5P_DEFAULT) > 0;
}

static PetscErrorCode Remove(hid_t file, const char *kind, PetscInt number)
{
  char name[32];

  PetscFunctionBeginUser;
  GroupName(name, kind, number);
  if (Exists(file, kind, number))
    H5Check(H5Ldelete(file, name, H5P_DEFAULT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the snapshots 0 ... next-1 that are whole; whatever else there is goes. */
static PetscErrorCode Revise(Output *out, hid_t file, PetscInt next, hsize_t count)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < next; k++) {
    SnapshotEntry entry = {.number = k, .grid = Exists(file, "grid", k)};
    char          name[32];
    hsize_t       rows = 0;

    if (!Exists(file, "particles", k))
      continue;
    GroupName(name, "particles", k);

    const hid_t group = H5Gopen2(file, name, H5P_DEFAULT);
    const bool  whole = group >= 0 && H5ReadReal(group, "time", &entry.t) && H5Rows(group, "vertex", &rows);

    if (group >= 0)
      H5Gclose(group);
    entry.n = (PetscInt)rows;
    if (whole)
      PetscCall(Remember(out, &entry));
  }
  for (PetscInt k = next; k < next + (PetscInt)count; k++) {
    PetscCall(Remove(file, "particles", k));
    PetscCall(Remove(file, "grid", k));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Number one past the last snapshot of a kind, by name. */
static herr_t LastOne(hid_t group, const char *name, const H5L_info_t *info, void *last)
{
  const long k = strtol(name, NULL, 10) + 1;

  (void)group;
  (void)info;
  if (k > *(long *)last)
    *(long *)last = k;
  return 0;
}

static PetscErrorCode Continue(Output *out, const char *path, PetscInt next, bool *done)
{
  hid_t file;
  long  last = 0;

  PetscFunctionBeginUser;
  *done = false;
  PetscCall(H5FileOpen(path, true, &file));
  if (file < 0)
    PetscFunctionReturn(PETSC_SUCCESS);
  H5E_BEGIN_TRY
  {
    H5Literate_by_name(file, "particles", H5_INDEX_NAME, H5_ITER_NATIVE, NULL, LastOne, &last, H5P_DEFAULT);
    H5Literate_by_name(file, "grid", H5_INDEX_NAME, H5_ITER_NATIVE, NULL, LastOne, &last, H5P_DEFAULT);
  }
  H5E_END_TRY
  PetscCall(Revise(out, file, next, last > next ? (hsize_t)(last - next) : 0));
  PetscCall(H5FileClose(&file));
  *done = true;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SnapshotsStart(Output *out, bool append, PetscInt next)
{
  char  path[IO_PATH], aside[IO_PATH + 8];
  hid_t file;
  bool  done = false;

  PetscFunctionBeginUser;
  PetscCall(IoPath(out->dir, "fields.h5", path));
  if (append && access(path, F_OK) == 0) {
    PetscCall(Continue(out, path, next, &done));
    if (!done) { /* a file that HDF5 cannot read is kept beside the new one */
      snprintf(aside, sizeof(aside), "%s.old", path);
      PetscCall(IoRename(path, aside));
    }
  }
  if (done)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(H5FileCreate(path, 0, &file));
  PetscCall(H5WriteText(file, "format", "clathra fields"));
  PetscCall(H5WriteInt(file, "format_version", IO_FORMAT_VERSION));
  PetscCall(H5FileClose(&file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- writing */
typedef struct {
  hid_t          file, group; /* rank 0 */
  double        *data;        /* rank 0: one variable */
  PetscErrorCode ierr;        /* rank 0: first error; the gathering goes on */
} Writer;

static PetscErrorCode StartGroup(Writer *w, const char *kind, const StepperState *s)
{
  char name[32];

  PetscFunctionBeginUser;
  PetscCall(Remove(w->file, kind, s->next_snapshot));
  GroupName(name, kind, s->next_snapshot);
  PetscCall(H5Group(w->file, name, &w->group));
  PetscCall(H5WriteReal(w->group, "time", s->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StartFile(Writer *w, const Output *out, const StepperState *s)
{
  char path[IO_PATH];

  PetscFunctionBeginUser;
  PetscCall(IoPath(out->dir, "fields.h5", path));
  PetscCall(H5FileOpen(path, true, &w->file));
  PetscCheck(w->file >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot open %s", path);
  PetscCall(StartGroup(w, "particles", s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteVariables(Writer *w, const Model *m, Gather *g)
{
  const Particles *P = &m->P;

  PetscFunctionBeginUser;
  for (const ParticleVariable *v = cl_particle_variable; v->name; v++) {
    const hsize_t dims[2] = {(hsize_t)g->total, (hsize_t)v->nc};

    if (!ParticlesHold(P, v))
      continue;
    for (int c = 0; c < v->nc; c++)
      PetscCall(GatherReals(g, P->f[v->first + c], v->nc, w->data + (g->rank == 0 ? c : 0)));
    if (g->rank == 0 && !w->ierr) {
      w->ierr = H5Write(w->group, v->name, H5T_NATIVE_DOUBLE, v->nc > 1 ? 2 : 1, dims, w->data, v->unit, true);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteExtra(Writer *w, const Model *m, Gather *g)
{
  const Particles *P       = &m->P;
  const hsize_t    n       = (hsize_t)g->total;
  PetscInt        *integer = (PetscInt *)w->data;
  double          *local;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(P->n, &local));
  for (int k = 0; io_extra[k].name; k++) {
    const ExtraVariable *v = &io_extra[k];

    if (!(P->has & v->has))
      continue;
    for (PetscInt p = 0; p < P->n && !v->integer; p++)
      local[p] = k == X_P ? MeanPressure(P, p) : GasSaturation(P, p);
    if (!v->integer)
      PetscCall(GatherReals(g, local, 1, w->data));
    else if (k == X_REGION)
      PetscCall(GatherInts(g, P->i[PI_REGION], integer));
    if (g->rank > 0 || w->ierr)
      continue;
    for (PetscInt p = 0; p < g->total && (k == X_ID || k == X_VERTEX); p++)
      integer[p] = k == X_ID ? g->id[p] : p;
    w->ierr =
        H5Write(w->group, v->name, v->integer ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE, 1, &n, w->data, v->unit, true);
  }
  PetscCall(PetscFree(local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Owned nodes of all ranks, on rank 0: their place in the full grid and values. */
static PetscErrorCode GatherNodes(const Model *m, PetscInt *n, PetscInt **place, double **x)
{
  const Grid       *g     = &m->grid;
  const PetscMPIInt nf    = m->c->fields.n;
  const PetscMPIInt owned = m->x_n ? (PetscMPIInt)m->map.n_owned : 0;
  PetscMPIInt      *count, *start;
  PetscInt         *mine;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(g->size, &count, g->size, &start, owned, &mine));
  for (PetscInt k = 0; k < owned; k++)
    mine[k] = m->map.ij[k][1] * (g->cells[0] + 1) + m->map.ij[k][0];
  PetscCallMPI(MPI_Allgather(&owned, 1, MPI_INT, count, 1, MPI_INT, g->comm));
  *n = 0;
  for (PetscMPIInt r = 0; r < g->size; r++) {
    start[r] = (PetscMPIInt)*n;
    *n += count[r];
  }
  PetscCall(PetscMalloc1(g->rank == 0 ? *n : 0, place));
  PetscCall(PetscMalloc1(g->rank == 0 ? *n * nf : 0, x));
  PetscCallMPI(MPI_Gatherv(mine, owned, MPIU_INT, *place, count, start, MPIU_INT, 0, g->comm));
  for (PetscMPIInt r = 0; r < g->size; r++) {
    start[r] *= nf;
    count[r] *= nf;
  }
  PetscCallMPI(MPI_Gatherv(m->x_n, owned * nf, MPI_DOUBLE, *x, count, start, MPI_DOUBLE, 0, g->comm));
  PetscCall(PetscFree3(count, start, mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteNodes(Writer *w, const Grid *g, const FieldSet *fs, const StepperState *s, PetscInt n,
                                 const PetscInt *place, const double *x)
{
  const hsize_t  rows = (hsize_t)g->cells[1] + 1, columns = (hsize_t)g->cells[0] + 1;
  const PetscInt nodes = (PetscInt)(rows * columns);
  double        *full;

  PetscFunctionBeginUser;
  H5Check(H5Gclose(w->group));
  PetscCall(StartGroup(w, "grid", s));
  PetscCall(PetscMalloc1(2 * nodes, &full));
  for (const NodalVariable *v = io_nodal; v->name; v++) {
    const hsize_t dims[3] = {rows, columns, (hsize_t)v->nc};

    if (fs->at[v->first] < 0)
      continue;
    for (PetscInt k = 0; k < nodes * v->nc; k++)
      full[k] = NAN;
    for (PetscInt k = 0; k < n; k++) {
      for (int c = 0; c < v->nc; c++)
        full[place[k] * v->nc + c] = x[k * fs->n + fs->at[v->first] + c];
    }
    PetscCall(H5Write(w->group, v->name, H5T_NATIVE_DOUBLE, v->nc > 1 ? 3 : 2, dims, full, v->unit, true));
  }
  PetscCall(PetscFree(full));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Finish(Writer *w, Output *out, const Grid *g, const SnapshotEntry *entry)
{
  PetscFunctionBeginUser;
  H5Check(H5Gclose(w->group));
  PetscCall(H5FileClose(&w->file));
  while (out->nsnapshot > 0 && out->snapshot[out->nsnapshot - 1].number >= entry->number)
    out->nsnapshot--;
  PetscCall(Remember(out, entry));
  PetscCall(XdmfWrite(out, g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputSnapshot(Output *out, const Model *m, const StepperState *s)
{
  const Grid *grid = &m->grid;
  Gather      g;
  Writer      w = {.file = -1, .group = -1};
  PetscInt    nodes, *place;
  double     *x;

  PetscFunctionBeginUser;
  if (grid->rank == 0)
    w.ierr = StartFile(&w, out, s);
  PetscCall(GatherCreate(m, &g));
  if (g.rank == 0)
    PetscCall(PetscMalloc1(PetscMax(g.total, 1) * 6, &w.data)); /* 6: components of the largest variable */
  PetscCall(WriteVariables(&w, m, &g));
  PetscCall(WriteExtra(&w, m, &g));
  PetscCall(GatherNodes(m, &nodes, &place, &x));
  if (grid->rank == 0) {
    const SnapshotEntry entry = {.number = s->next_snapshot, .n = g.total, .t = s->t, .grid = nodes > 0};

    if (!w.ierr && nodes > 0)
      w.ierr = WriteNodes(&w, grid, &m->c->fields, s, nodes, place, x);
    if (!w.ierr)
      w.ierr = Finish(&w, out, grid, &entry);
  }
  PetscCall(IoAgree(grid->comm, w.ierr));
  PetscCall(PetscFree(w.data));
  PetscCall(PetscFree(place));
  PetscCall(PetscFree(x));
  PetscCall(GatherDestroy(&g));
  PetscFunctionReturn(PETSC_SUCCESS);
}
