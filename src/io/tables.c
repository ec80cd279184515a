/* The tables of a run: probes.csv, balance.csv, meters.csv.  A restart keeps the rows up to its time. */
#include "io_private.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const struct {
  int time; /* column of the time */
  void (*header)(const Case *, FILE *);
} table[TABLE_COUNT] = {
    [TABLE_PROBES] = {0, ProbesHeader}, [TABLE_BALANCE] = {1, BalanceHeader}, [TABLE_METERS] = {0, MetersHeader}};

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

/* Copies the rows of PATH that a restart at time t keeps.  A table with other columns is kept as PATH.old; false: it
   could not be read or renamed. */
static bool CopyRows(const char *path, int column, const char *header, double t, double slack, FILE *to)
{
  char  *line = NULL, kept[IO_PATH + 8];
  size_t cap  = 0;
  FILE  *old  = fopen(path, "r");
  bool   same, good;

  if (!old)
    return errno == ENOENT || IoFailed(path, 0);
  same = getline(&line, &cap, old) > 0 && strcmp(line, header) == 0;
  while (same && getline(&line, &cap, old) > 0) {
    if (Keep(line, column, t, slack))
      fputs(line, to);
  }
  good = !ferror(old) || IoFailed(path, 0);
  free(line);
  fclose(old);
  snprintf(kept, sizeof(kept), "%s.old", path);
  return good && (same || IoRename(path, kept));
}

/* Header and kept rows take the place of the table, and it goes on at the end. */
static PetscErrorCode Open(Output *out, const Model *m, TableId id, bool append, double t)
{
  const double slack = CaseOf(m->c)->nstage ? 4.0 * PETSC_MACHINE_EPSILON : 1e-12;
  char         path[IO_PATH], *header;
  FILE        *f;

  PetscFunctionBeginUser;
  PetscCall(IoPath(out->dir, cl_table_name[id], path));
  PetscCall(RowBegin(out, &f));
  table[id].header(CaseOf(m->c), f);
  PetscCall(RowKeep(out));
  header = out->text;
  PetscCall(RowBegin(out, &f));
  fputs(header, f);
  if (append)
    out->failed = !CopyRows(path, table[id].time, header, t, slack, f);
  PetscCall(RowKeep(out));
  if (!out->failed)
    out->failed = !IoReplace(path, false, 1, &(IoPiece){out->text, out->size});
  if (!out->failed)
    out->failed = (out->fd[id] = IoOpenEnd(path)) < 0;
  free(header);
  free(out->text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TablesOpen(Output *out, const Model *m, bool append, double t)
{
  PetscFunctionBeginUser;
  for (TableId id = 0; id < TABLE_COUNT && !out->failed; id++) {
    if (id != TABLE_METERS || MetersWanted(m))
      PetscCall(Open(out, m, id, append, t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void TablesSync(Output *out)
{
  for (TableId id = 0; id < TABLE_COUNT && !out->failed; id++) {
    char path[IO_PATH + 16];

    snprintf(path, sizeof(path), "%s/%s", out->dir, cl_table_name[id]);
    if (out->fd[id] >= 0)
      out->failed = !IoSync(out->fd[id], path);
  }
}

void TablesClose(Output *out)
{
  for (TableId id = 0; id < TABLE_COUNT; id++) {
    char path[IO_PATH + 16];

    snprintf(path, sizeof(path), "%s/%s", out->dir, cl_table_name[id]);
    if (out->fd[id] >= 0 && !IoClose(out->fd[id], path))
      out->failed = true;
    out->fd[id] = -1;
  }
}
