/* The files of a run: created, or cut back to the time of a restart and continued. */
#include "io_private.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

PetscErrorCode IoPath(const char *dir, const char *name, char path[IO_PATH])
{
  const int n = snprintf(path, IO_PATH, "%s/%s", dir, name);

  PetscFunctionBeginUser;
  PetscCheck(n > 0 && n < IO_PATH, PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ, "the path %s/%s is too long", dir, name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode IoAgree(MPI_Comm comm, PetscErrorCode ierr)
{
  int failed = ierr != 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, comm));
  PetscCheck(!failed, comm, PETSC_ERR_FILE_WRITE, "rank 0 could not write the run's files");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode IoFlush(FILE *f, const char *name)
{
  PetscFunctionBeginUser;
  PetscCheck(fflush(f) == 0 && !ferror(f), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write %s: %s", name,
             strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode IoRename(const char *from, const char *to)
{
  PetscFunctionBeginUser;
  PetscCheck(rename(from, to) == 0, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot rename %s to %s: %s", from, to,
             strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The folder with all above it. */
static PetscErrorCode MakeFolder(const char *dir)
{
  char path[IO_PATH];

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(path, dir, sizeof(path)));
  for (char *c = path + 1; path[0]; c++) {
    const char end = *c;

    if (end != '/' && end != '\0')
      continue;
    *c = '\0';
    PetscCheck(mkdir(path, 0777) == 0 || errno == EEXIST, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE,
               "cannot create the folder %s: %s", path, strerror(errno));
    *c = end;
    if (end == '\0')
      break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- text files */
typedef struct {
  const char *name;
  int         time; /* column of the time */
  void (*header)(const Case *, FILE *);
} Table;

static PetscErrorCode Header(const Model *m, const Table *table, char **text, size_t *size)
{
  FILE *f = open_memstream(text, size);

  PetscFunctionBeginUser;
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  table->header(m->c, f);
  PetscCheck(fclose(f) == 0, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A whole line with a time not later than t; slack: of times as they are written. */
static bool Keep(const char *line, int column, double t, double slack)
{
  char  *end;
  double value;

  if (!strchr(line, '\n'))
    return false;
  for (; column > 0; column--) {
    line = strchr(line, ',');
    if (!line)
      return false;
    line++;
  }
  value = strtod(line, &end);
  return end != line && (*end == ',' || *end == '\n') && value <= t + slack * fabs(t);
}

/* Copies the rows of `old` that a restart at time t keeps; *same = false if its columns are others. */
static PetscErrorCode CopyRows(FILE *old, const Table *table, const char *header, double t, double slack, FILE *f,
                               bool *same)
{
  char  *line = NULL;
  size_t cap  = 0;

  PetscFunctionBeginUser;
  *same = getline(&line, &cap, old) > 0 && strcmp(line, header) == 0;
  while (*same && getline(&line, &cap, old) > 0) {
    if (Keep(line, table->time, t, slack))
      fputs(line, f);
  }
  free(line);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes header and kept rows aside, renames, and goes on at the end.  A table with other columns is kept as NAME.old.
 */
static PetscErrorCode OpenTable(const Model *m, const char *dir, const Table *table, bool append, double t, FILE **f)
{
  char   path[IO_PATH], aside[IO_PATH + 8], *header = NULL;
  size_t size;
  FILE  *old  = NULL;
  bool   same = true;

  PetscFunctionBeginUser;
  PetscCall(IoPath(dir, table->name, path));
  snprintf(aside, sizeof(aside), "%s.tmp", path);
  PetscCall(Header(m, table, &header, &size));
  *f = fopen(aside, "w");
  PetscCheck(*f, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write %s: %s", aside, strerror(errno));
  fputs(header, *f);
  if (append)
    old = fopen(path, "r");
  if (old) {
    PetscCall(CopyRows(old, table, header, t, m->c->nstage ? 4.0 * PETSC_MACHINE_EPSILON : 1e-12, *f, &same));
    fclose(old);
  }
  PetscCall(IoFlush(*f, table->name));
  if (!same) {
    char kept[IO_PATH + 8];

    snprintf(kept, sizeof(kept), "%s.old", path);
    PetscCall(IoRename(path, kept));
  }
  PetscCall(IoRename(aside, path)); /* the open stream follows the file */
  free(header);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode OpenFiles(Output *out, const Model *m, const StepperState *s, bool append)
{
  const Table probes = {"probes.csv", 0, ProbesHeader}, balance = {"balance.csv", 1, BalanceHeader};
  const Table meters = {"meters.csv", 0, MetersHeader};

  PetscFunctionBeginUser;
  PetscCall(MakeFolder(out->dir));
  PetscCall(OpenTable(m, out->dir, &probes, append, s->t, &out->probes));
  PetscCall(OpenTable(m, out->dir, &balance, append, s->t, &out->balance));
  if (m->c->nmeter > 0)
    PetscCall(OpenTable(m, out->dir, &meters, append, s->t, &out->meters));
  PetscCall(SnapshotsStart(out, append, s->next_snapshot));
  PetscCall(XdmfWrite(out, &m->grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputCreate(const Model *m, const StepperState *s, bool append, Output **result)
{
  PetscErrorCode ierr = PETSC_SUCCESS;
  Output        *out;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&out));
  out->fields = m->c->fields;
  PetscCall(PetscStrncpy(out->dir, m->c->output_dir, sizeof(out->dir)));
  PetscCall(PetscMalloc1(m->c->nprobe, &out->reach));
  for (PetscInt k = 0; k < m->c->nprobe; k++)
    out->reach[k] = 1.0;
  if (m->grid.rank == 0)
    ierr = OpenFiles(out, m, s, append);
  PetscCall(IoAgree(m->grid.comm, ierr));
  *result = out;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputDestroy(Output **result)
{
  Output *out = *result;

  PetscFunctionBeginUser;
  if (!out)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (out->probes)
    fclose(out->probes);
  if (out->balance)
    fclose(out->balance);
  if (out->meters)
    fclose(out->meters);
  PetscCall(PetscFree(out->reach));
  PetscCall(PetscFree(out->snapshot));
  PetscCall(PetscFree(*result));
  PetscFunctionReturn(PETSC_SUCCESS);
}
