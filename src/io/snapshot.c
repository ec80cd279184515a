/* A snapshot, fields/000000.h5: the particles, sorted by id, and the nodal fields.

     /particles/<variable>   n x components; those of cl_particle_variable, io_derived and io_whole; `vertex` = 0, 1, 2,
   ... /grid/<field>           (layers (z) x) rows (y) x columns (x) of all grid nodes (x components), NaN where
   inactive

   with the attribute `time` (s) on file and groups and `unit` on each dataset.  The nodal fields are those the last
   step started from (projections of the particles).  A file each, for a file that is rewritten may be lost with all. */
#include "io_private.h"

const NodalVariable io_nodal[] = {{"v_s", "m/s", F_VS, CL_DIM},
                                  {"v_w", "m/s", F_VW, CL_DIM},
                                  {"v_g", "m/s", F_VG, CL_DIM},
                                  {"p_w", "Pa", F_PW, 1},
                                  {"p_g", "Pa", F_PG, 1},
                                  {"T", "degC", F_T, 1},
                                  {NULL, NULL, 0, 0}};

const char *const io_whole[WHOLE_COUNT] = {"region", "id", "vertex"};

static PetscErrorCode OpenGroup(hid_t file, const char *kind, const StepperState *s, hid_t *group)
{
  PetscFunctionBeginUser;
  PetscCall(H5Group(file, kind, group));
  PetscCall(H5WriteReal(*group, "time", s->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static bool Has(const Model *m, const DerivedQuantity *v)
{
  return v->snapshots && (m->P.has & v->has);
}

static PetscErrorCode WriteDerived(const Model *m, Slab *s, hid_t group)
{
  double *local;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m->P.n, &local));
  for (const DerivedQuantity *v = io_derived; v->name; v++) {
    if (!Has(m, v))
      continue;
    for (PetscInt p = 0; p < m->P.n; p++)
      local[p] = v->of(m, p);
    PetscCall(SlabReals(s, local, 1, 0, 1));
    PetscCall(SlabWrite(s, group, v->name, 1, v->unit, true));
  }
  PetscCall(PetscFree(local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteWhole(const Particles *P, Slab *s, hid_t group)
{
  PetscInt *vertex = (PetscInt *)s->data;

  PetscFunctionBeginUser;
  PetscCall(SlabInts(s, P->i[PI_REGION]));
  PetscCall(SlabWriteInts(s, group, io_whole[WHOLE_REGION], "-", true));
  PetscCall(SlabInts(s, P->i[PI_ID]));
  PetscCall(SlabWriteInts(s, group, io_whole[WHOLE_ID], "-", true));
  for (PetscInt k = 0; k < s->rows; k++)
    vertex[k] = (PetscInt)s->part.start[0] + k;
  PetscCall(SlabWriteInts(s, group, io_whole[WHOLE_VERTEX], "-", true));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteNodes(const Model *m, Slab *s, hid_t group)
{
  const FieldSet *fs = &m->c->fields;
  const double   *x  = ModelStart(m);

  PetscFunctionBeginUser;
  for (const NodalVariable *v = io_nodal; v->name; v++) {
    if (fs->at[v->first] < 0)
      continue;
    for (int c = 0; c < v->nc; c++)
      PetscCall(SlabReals(s, x ? x + fs->at[v->first] + c : NULL, fs->n, c, v->nc));
    PetscCall(SlabWrite(s, group, v->name, v->nc, v->unit, true));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteAll(const Model *m, const StepperState *state, Slab *particles, Slab *nodes, hid_t file)
{
  hid_t group;

  PetscFunctionBeginUser;
  PetscCall(H5WriteText(file, "format", "clathra fields"));
  PetscCall(H5WriteInt(file, "format_version", IO_FORMAT_VERSION));
  PetscCall(H5WriteReal(file, "time", state->t));
  PetscCall(OpenGroup(file, "/particles", state, &group));
  PetscCall(SlabWriteVariables(particles, &m->P, true, group));
  PetscCall(WriteDerived(m, particles, group));
  PetscCall(WriteWhole(&m->P, particles, group));
  H5Check(H5Gclose(group));
  if (nodes->total > 0) {
    PetscCall(OpenGroup(file, "/grid", state, &group));
    PetscCall(WriteNodes(m, nodes, group));
    H5Check(H5Gclose(group));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static size_t Room(const Model *m, const Slab *particles, const Slab *nodes)
{
  int derived = WHOLE_COUNT;

  for (const DerivedQuantity *v = io_derived; v->name; v++)
    derived += Has(m, v);
  return ((size_t)1 << 16) + SlabRoomVariables(particles, &m->P) + H5Room(&particles->part, derived, derived) +
         (nodes->total ? H5Room(&nodes->part, (int)m->c->fields.n, (int)m->c->fields.n) : 0);
}

static PetscErrorCode Write(const Model *m, const StepperState *s, const char *path, SnapshotEntry *entry, bool *ok)
{
  Slab       particles, nodes;
  SharedFile f;

  PetscFunctionBeginUser;
  PetscCall(SlabParticles(m, &particles));
  PetscCall(SlabNodes(m, &nodes));
  *entry = (SnapshotEntry){.number = s->next_snapshot, .n = particles.total, .t = s->t, .grid = nodes.total > 0};
  PetscCall(SharedCreate(m->grid.comm, path, 0, Room(m, &particles, &nodes), &f, ok));
  if (*ok) {
    PetscCall(WriteAll(m, s, &particles, &nodes, f.file));
    PetscCall(SharedFinish(&f, false, NULL, NULL, ok));
  }
  PetscCall(SlabDestroy(&particles));
  PetscCall(SlabDestroy(&nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The file first, then what lists it: a run that is killed between them leaves no link to what is not there. */
PetscErrorCode OutputSnapshot(Output *out, const Model *m, const StepperState *s)
{
  PetscErrorCode ierr = PETSC_SUCCESS;
  SnapshotEntry  entry;
  char           path[IO_PATH], name[64];
  bool           ok;

  PetscFunctionBeginUser;
  PetscCall(OutputGood(out, m->grid.comm, &ok));
  if (!ok)
    PetscFunctionReturn(PETSC_SUCCESS);
  snprintf(name, sizeof(name), SNAPSHOT_NAME, (int)s->next_snapshot);
  PetscCall(IoPath(out->dir, name, path));
  PetscCall(Write(m, s, path, &entry, &ok));
  if (!ok)
    out->failed = true;
  if (m->grid.rank == 0) {
    if (ok)
      ierr = SeriesAdd(out, &entry);
    if (!ierr)
      ierr = SeriesWrite(out, &m->grid);
  }
  PetscCall(IoAgree(m->grid.comm, ierr));
  PetscFunctionReturn(PETSC_SUCCESS);
}
