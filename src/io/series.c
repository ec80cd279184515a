/* The list of a run's snapshots.  fields.h5 holds nothing but links into the files of the folder `fields`,
   particles.xdmf and grid.xdmf name them; all are made anew from the files at a restart and at every snapshot, so none
   can be lost. */
#include "io_private.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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

PetscErrorCode SeriesAdd(Output *out, const SnapshotEntry *entry)
{
  PetscFunctionBeginUser;
  while (out->nsnapshot > 0 && out->snapshot[out->nsnapshot - 1].number >= entry->number)
    out->nsnapshot--;
  PetscCall(Remember(out, entry));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- start and restart */
/* Number of the snapshot that a file of the folder holds; -1 if it is no such file. */
static PetscInt NumberOf(const char *name)
{
  char      *end;
  const long number = strtol(name, &end, 10);

  return end > name && name[0] >= '0' && name[0] <= '9' && !strcmp(end, ".h5") && number < PETSC_MAX_INT
             ? (PetscInt)number
             : -1;
}

/* Takes away the snapshots from number `next` on, and what a killed run left half written. */
static bool RemoveFrom(const char *dir, PetscInt next)
{
  DIR           *d = opendir(dir);
  struct dirent *e;
  bool           good = true;

  if (!d)
    return errno == ENOENT || IoFailed(dir, 0);
  while (good && (e = readdir(d))) {
    char path[2 * IO_PATH];

    if (NumberOf(e->d_name) < next && !strstr(e->d_name, ".h5.tmp"))
      continue;
    snprintf(path, sizeof(path), "%s/%s", dir, e->d_name);
    good = unlink(path) == 0 || IoFailed(path, 0);
  }
  closedir(d);
  return good;
}

/* Lists a snapshot if its file is whole; a damaged one is set aside with a sentence. */
static PetscErrorCode Look(Output *out, OutputFrom from, PetscInt number)
{
  char          path[IO_PATH], name[64], kept[IO_PATH + 16];
  SnapshotEntry entry = {.number = number};
  hsize_t       rows  = 0;
  hid_t         file;
  bool          whole;

  PetscFunctionBeginUser;
  snprintf(name, sizeof(name), SNAPSHOT_NAME, (int)number);
  PetscCall(IoPath(out->dir, name, path));
  snprintf(kept, sizeof(kept), "%s.damaged", path);
  if (access(path, F_OK) != 0) {
    if (from == OUTPUT_HERE && access(kept, F_OK) != 0)
      PetscCall(
          FindingSay(PETSC_COMM_SELF, FINDING_SNAPSHOT_MISSING, "%s is missing; it is left out of fields.h5", path));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(H5FileOpen(path, &file));
  whole = file >= 0 && H5ReadReal(file, "time", &entry.t) && H5Rows(file, "particles/vertex", &rows);
  if (file >= 0)
    entry.grid = H5Lexists(file, "grid", H5P_DEFAULT) > 0;
  PetscCall(H5FileClose(&file));
  entry.n = (PetscInt)rows;
  if (whole) {
    PetscCall(Remember(out, &entry));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(FindingSay(PETSC_COMM_SELF, FINDING_SNAPSHOT_DAMAGED,
                       "%s is damaged; it is set aside as %s and left out of fields.h5", path, kept));
  out->failed = !IoRename(path, kept);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SeriesStart(Output *out, OutputFrom from, PetscInt next)
{
  char dir[IO_PATH];

  PetscFunctionBeginUser;
  PetscCall(IoPath(out->dir, "fields", dir));
  if (!out->failed)
    out->failed = !IoMakeFolder(dir) || !RemoveFrom(dir, from == OUTPUT_ANEW ? 0 : next);
  for (PetscInt k = 0; from != OUTPUT_ANEW && k < next && !out->failed; k++)
    PetscCall(Look(out, from, k));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- writing */
static PetscErrorCode Link(hid_t group, PetscInt number, const char *kind)
{
  char file[64], name[32];

  PetscFunctionBeginUser;
  snprintf(file, sizeof(file), SNAPSHOT_NAME, (int)number);
  snprintf(name, sizeof(name), "%06d", (int)number);
  H5Check(H5Lcreate_external(file, kind, group, name, H5P_DEFAULT, H5P_DEFAULT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* /lines/x, /lines/y (, /lines/z): where the lines of the grid are. */
static PetscErrorCode LinesWrite(hid_t file, const Grid *g)
{
  hid_t group;

  PetscFunctionBeginUser;
  PetscCall(H5Group(file, "/lines", &group));
  for (int d = 0; d < CL_DIM; d++) {
    const char name[] = {"xyz"[d], '\0'};
    double    *x;

    PetscCall(PetscMalloc1(g->cells[d] + 1, &x));
    for (PetscInt i = 0; i <= g->cells[d]; i++)
      x[i] = GridNode(g, d, i);
    PetscCall(H5Write(group, name, H5T_NATIVE_DOUBLE, (hsize_t)g->cells[d] + 1, x, "m"));
    PetscCall(PetscFree(x));
  }
  H5Check(H5Gclose(group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode IndexWrite(Output *out, const Grid *g, const char *path)
{
  hid_t   file, particles, grid = -1;
  IoPiece image;

  PetscFunctionBeginUser;
  PetscCall(H5ImageCreate(0, &file));
  PetscCall(H5WriteText(file, "format", "clathra fields"));
  PetscCall(H5WriteInt(file, "format_version", IO_FORMAT_VERSION));
  PetscCall(LinesWrite(file, g));
  PetscCall(H5Group(file, "/particles", &particles));
  for (PetscInt k = 0; k < out->nsnapshot; k++) {
    PetscCall(Link(particles, out->snapshot[k].number, "/particles"));
    if (!out->snapshot[k].grid)
      continue;
    if (grid < 0)
      PetscCall(H5Group(file, "/grid", &grid));
    PetscCall(Link(grid, out->snapshot[k].number, "/grid"));
  }
  if (grid >= 0)
    H5Check(H5Gclose(grid));
  H5Check(H5Gclose(particles));
  PetscCall(H5ImageBytes(file, &image));
  out->failed = !IoReplace(path, false, 1, &image);
  PetscCall(H5FileClose(&file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode XdmfWrite(Output *out, const Grid *g, XdmfKind kind)
{
  char   path[IO_PATH], name[32], *text;
  size_t size;
  FILE  *f = open_memstream(&text, &size);

  PetscFunctionBeginUser;
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  XdmfPrint(f, out, g, kind);
  PetscCheck(fclose(f) == 0, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  snprintf(name, sizeof(name), "%s.xdmf", xdmf_name[kind]);
  PetscCall(IoPath(out->dir, name, path));
  if (!out->failed)
    out->failed = !IoReplace(path, false, 1, &(IoPiece){text, size});
  free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SeriesWrite(Output *out, const Grid *g)
{
  char path[IO_PATH];

  PetscFunctionBeginUser;
  PetscCall(IoPath(out->dir, "fields.h5", path));
  if (!out->failed)
    PetscCall(IndexWrite(out, g, path));
  for (XdmfKind kind = XDMF_PARTICLES; kind < XDMF_COUNT; kind++)
    PetscCall(XdmfWrite(out, g, kind));
  PetscFunctionReturn(PETSC_SUCCESS);
}
