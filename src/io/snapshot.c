/* A snapshot, fields/000000.h5: the particles, sorted by id, and the nodal fields.

     /particles/<variable>   n x components; those of cl_particle_variable, io_derived and io_whole; `vertex` = 0, 1, 2,
   ... /grid/<field>           rows (y) x columns (x) of all grid nodes (x components), NaN where inactive

   with the attribute `time` (s) on file and groups and `unit` on each dataset.  The nodal fields are those the last
   step started from (projections of the particles).  A file each, for a file that is rewritten may be lost with all. */
#include "io_private.h"

const NodalVariable io_nodal[] = {{"v_s", "m/s", F_VS, 2}, {"v_w", "m/s", F_VW, 2}, {"v_g", "m/s", F_VG, 2},
                                  {"p_w", "Pa", F_PW, 1},  {"p_g", "Pa", F_PG, 1},  {"T", "degC", F_T, 1},
                                  {NULL, NULL, 0, 0}};

const char *const io_whole[WHOLE_COUNT] = {"region", "id", "vertex"};

typedef struct {
  hid_t          file, group; /* rank 0 */
  PetscErrorCode ierr;        /* rank 0: first error; the gathering goes on */
} Writer;

static PetscErrorCode StartGroup(Writer *w, const char *kind, const StepperState *s)
{
  PetscFunctionBeginUser;
  PetscCall(H5Group(w->file, kind, &w->group));
  PetscCall(H5WriteReal(w->group, "time", s->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StartFile(Writer *w, const StepperState *s)
{
  PetscFunctionBeginUser;
  PetscCall(H5ImageCreate(0, &w->file));
  PetscCall(H5WriteText(w->file, "format", "clathra fields"));
  PetscCall(H5WriteInt(w->file, "format_version", IO_FORMAT_VERSION));
  PetscCall(H5WriteReal(w->file, "time", s->t));
  PetscCall(StartGroup(w, "/particles", s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteDerived(Writer *w, const Model *m, Gather *g)
{
  const hsize_t n = (hsize_t)g->total;
  double       *local;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m->P.n, &local));
  for (const DerivedQuantity *v = io_derived; v->name; v++) {
    if (!v->snapshots || !(m->P.has & v->has))
      continue;
    for (PetscInt p = 0; p < m->P.n; p++)
      local[p] = v->of(m, p);
    PetscCall(GatherReals(g, local, 1, g->data));
    if (g->rank == 0 && !w->ierr)
      w->ierr = H5Write(w->group, v->name, H5T_NATIVE_DOUBLE, 1, &n, g->data, v->unit, true);
  }
  PetscCall(PetscFree(local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteWhole(Writer *w, const Particles *P, Gather *g)
{
  const hsize_t n     = (hsize_t)g->total;
  PetscInt     *whole = (PetscInt *)g->data;

  PetscFunctionBeginUser;
  for (int k = 0; k < WHOLE_COUNT; k++) {
    if (k == WHOLE_REGION)
      PetscCall(GatherInts(g, P->i[PI_REGION], whole));
    if (g->rank > 0 || w->ierr)
      continue;
    for (PetscInt p = 0; p < g->total && k != WHOLE_REGION; p++)
      whole[p] = k == WHOLE_ID ? g->id[p] : p;
    w->ierr = H5Write(w->group, io_whole[k], H5T_NATIVE_INT, 1, &n, whole, "-", true);
  }
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
  PetscCall(StartGroup(w, "/grid", s));
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

/* The file first, then what lists it: a run that is killed between them leaves no link to what is not there. */
static PetscErrorCode Finish(Writer *w, Output *out, const Grid *g, const SnapshotEntry *entry)
{
  char    path[IO_PATH], name[64];
  IoPiece image;

  PetscFunctionBeginUser;
  H5Check(H5Gclose(w->group));
  PetscCall(H5ImageBytes(w->file, &image));
  snprintf(name, sizeof(name), SNAPSHOT_NAME, (int)entry->number);
  PetscCall(IoPath(out->dir, name, path));
  if (!out->failed)
    out->failed = !IoReplace(path, false, 1, &image);
  PetscCall(H5FileClose(&w->file)); /* one image at a time */
  if (!out->failed)
    PetscCall(SeriesAdd(out, entry));
  PetscCall(SeriesWrite(out, g));
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
    w.ierr = StartFile(&w, s);
  PetscCall(GatherCreate(m, &g));
  PetscCall(GatherVariables(&g, &m->P, true, w.group, &w.ierr));
  PetscCall(WriteDerived(&w, m, &g));
  PetscCall(WriteWhole(&w, &m->P, &g));
  PetscCall(GatherNodes(m, &nodes, &place, &x));
  if (grid->rank == 0) {
    const SnapshotEntry entry = {.number = s->next_snapshot, .n = g.total, .t = s->t, .grid = nodes > 0};

    if (!w.ierr && nodes > 0)
      w.ierr = WriteNodes(&w, grid, &m->c->fields, s, nodes, place, x);
    if (!w.ierr)
      w.ierr = Finish(&w, out, grid, &entry);
    PetscCall(H5FileClose(&w.file));
  }
  PetscCall(IoAgree(grid->comm, w.ierr));
  PetscCall(PetscFree(place));
  PetscCall(PetscFree(x));
  PetscCall(GatherDestroy(&g));
  PetscFunctionReturn(PETSC_SUCCESS);
}
