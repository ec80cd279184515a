/* The tables of a run: probes.csv, balance.csv, meters.csv.  A restart keeps the rows up to its time. */
#include "io_private.h"
#include "clathra/words.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const struct {
  int time; /* column of the time */
  void (*header)(const Case *, FILE *);
} table[TABLE_COUNT] = {
    [TABLE_PROBES] = {0, ProbesHeader}, [TABLE_BALANCE] = {1, BalanceHeader}, [TABLE_METERS] = {0, MetersHeader}};

/* What became of the rows of a table at a restart. */
typedef struct {
  bool   there, same; /* is there a file; has it the columns of now */
  int    broken;      /* rows that are none */
  double last;        /* time of the last one that is kept; < 0: none */
} Kept;

/* The time of a whole row of so many columns; false: it is none. */
static bool RowTime(const char *line, int column, int columns, double *t)
{
  const char *at = line;
  char       *end;

  for (int k = 0; k < columns; k++, at = end + 1) {
    const double value = strtod(at, &end);

    if (end == at || *end != (k + 1 < columns ? ',' : '\n'))
      return false;
    if (k == column)
      *t = value;
  }
  return true;
}

static int Columns(const char *header)
{
  int n = 1;

  for (; *header; header++)
    n += *header == ',';
  return n;
}

/* Copies the rows of PATH that a restart at time t keeps; slack: of times as they are written.  The last one may lack
   its end.  A table with other columns is kept as PATH.old; false: it could not be read or renamed. */
static bool CopyRows(const char *path, int column, const char *header, double t, double slack, FILE *to, Kept *kept)
{
  char  *line = NULL, aside[IO_PATH + 8];
  size_t cap  = 0;
  FILE  *old  = fopen(path, "r");
  bool   good;

  *kept = (Kept){.there = old, .last = -1.0};
  if (!old)
    return errno == ENOENT || IoFailed(path, 0);
  kept->same = getline(&line, &cap, old) > 0 && strcmp(line, header) == 0;
  while (kept->same && getline(&line, &cap, old) > 0 && strchr(line, '\n')) {
    double at = 0.0;

    if (!RowTime(line, column, Columns(header), &at)) {
      kept->broken++;
    } else if (at <= t + slack * fabs(t)) {
      fputs(line, to);
      kept->last = at;
    }
  }
  good = !ferror(old) || IoFailed(path, 0);
  free(line);
  fclose(old);
  snprintf(aside, sizeof(aside), "%s.old", path);
  return good && (kept->same || IoRename(path, aside));
}

/* At a restart in their folder the rows up to its time should be there, of a balance those of its steps. */
static PetscErrorCode SayLost(const Case *c, TableId id, const char *path, const Kept *kept, double t)
{
  const double every = id == TABLE_BALANCE ? 0.0 : c->probe_every;
  const bool   ends  = kept->last > t - every - 1e-9 * t || (id == TABLE_BALANCE && t <= c->scene.t_begin);

  PetscFunctionBeginUser;
  if (!kept->there)
    PetscCall(FindingSay(PETSC_COMM_SELF, FINDING_TABLE_MISSING, "%s is missing; it begins anew at t = %s", path,
                         TimeAt(t).s));
  else if (!kept->same)
    PetscCall(FindingSay(PETSC_COMM_SELF, FINDING_TABLE_COLUMNS,
                         "%s has not the columns of this run; it is kept as %s.old and begins anew at t = %s", path,
                         path, TimeAt(t).s));
  if (kept->broken)
    PetscCall(FindingSay(PETSC_COMM_SELF, FINDING_TABLE_DAMAGED, "%s is damaged; %d of its rows are left out", path,
                         kept->broken));
  if (kept->same && !ends)
    PetscCall(FindingSay(PETSC_COMM_SELF, FINDING_TABLE_ROWS, "%s lacks the rows from t = %s to t = %s", path,
                         TimeAt(fmax(kept->last, c->scene.t_begin)).s, TimeAt(t).s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Header and kept rows take the place of the table, and it goes on at the end. */
static PetscErrorCode Open(Output *out, const Model *m, TableId id, OutputFrom from, double t)
{
  const Case  *c     = CaseOf(m->c);
  const double slack = c->nstage ? 4.0 * PETSC_MACHINE_EPSILON : 1e-12;
  char         path[IO_PATH], *header;
  Kept         kept;
  FILE        *f;

  PetscFunctionBeginUser;
  PetscCall(IoPath(out->dir, cl_table_name[id], path));
  PetscCall(RowBegin(out, &f));
  table[id].header(c, f);
  PetscCall(RowKeep(out));
  header = out->text;
  PetscCall(RowBegin(out, &f));
  fputs(header, f);
  if (from != OUTPUT_ANEW)
    out->failed = !CopyRows(path, table[id].time, header, t, slack, f, &kept);
  PetscCall(RowKeep(out));
  if (from == OUTPUT_HERE && !out->failed)
    PetscCall(SayLost(c, id, path, &kept, t));
  if (!out->failed)
    out->failed = !IoReplace(path, false, 1, &(IoPiece){out->text, out->size});
  if (!out->failed)
    out->failed = (out->fd[id] = IoOpenEnd(path)) < 0;
  free(header);
  free(out->text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TablesOpen(Output *out, const Model *m, OutputFrom from, double t)
{
  PetscFunctionBeginUser;
  for (TableId id = 0; id < TABLE_COUNT && !out->failed; id++) {
    if (id != TABLE_METERS || MetersWanted(m))
      PetscCall(Open(out, m, id, from, t));
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
