/* yaml: loading a case file through PETSc's YAML reader into a private database, and the list of errors. */
#include "case_private.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#define FILE_MAX 1000000

/* Line of a key, or of the map it belongs to; 0 if neither is in the file. */
static PetscInt MarkLine(const Reader *r, const char *name)
{
  char path[256], *cut;

  snprintf(path, sizeof path, "%s", name);
  do {
    for (PetscInt i = 0; i < r->nmark; i++)
      if (!strcasecmp(r->mark[i].name, path))
        return r->mark[i].line;
    cut = strrchr(path, '_');
    if (cut)
      *cut = 0;
  } while (cut);
  return 0;
}

void ReaderError(Reader *r, const char *key, const char *value, const char *format, ...)
{
  char    what[1024], where[PETSC_MAX_PATH_LEN + 16], *text;
  size_t  size;
  va_list args;
  bool    on_line = key && !strncmp(key, "line ", 5), command_line = key && *key == '-';

  if (r->nerror++ >= CASE_ERRORS)
    return;
  va_start(args, format);
  vsnprintf(what, sizeof what, format, args);
  va_end(args);
  snprintf(where, sizeof where, "%s", command_line ? "command line" : r->file);
  if (on_line)
    snprintf(where, sizeof where, "%s:%s", r->file, key + 5);
  else if (key && *key && MarkLine(r, key))
    snprintf(where, sizeof where, "%s:%d", r->file, (int)MarkLine(r, key));
  size = strlen(where) + strlen(what) + (key ? strlen(key) : 0) + (value ? strnlen(value, 80) : 0) + 16;
  text = malloc(size);
  snprintf(text, size, "%s: %s", where, on_line || !key || !*key ? "" : key);
  if (value)
    snprintf(text + strlen(text), size - strlen(text), " = '%.80s'", value);
  snprintf(text + strlen(text), size - strlen(text), "%s%s", on_line || !key || !*key ? "" : ": ", what);
  r->error[r->nerror - 1] = text;
}

/* Reads the whole file; NULL and a reason if it cannot be a case. */
static char *FileText(const char *path, char why[CASE_WHY])
{
  struct stat info;
  FILE       *f;
  char       *text;
  size_t      n;

  if (stat(path, &info)) {
    snprintf(why, CASE_WHY, "there is no such file");
    return NULL;
  }
  if (!S_ISREG(info.st_mode)) {
    snprintf(why, CASE_WHY, "is not a regular file");
    return NULL;
  }
  if (info.st_size > FILE_MAX) {
    snprintf(why, CASE_WHY, "has %ld bytes; a case file has at most %d", (long)info.st_size, FILE_MAX);
    return NULL;
  }
  f = fopen(path, "rb");
  if (!f) {
    snprintf(why, CASE_WHY, "cannot be opened for reading");
    return NULL;
  }
  text = calloc(FILE_MAX + 2, 1);
  n    = fread(text, 1, FILE_MAX + 1, f);
  fclose(f);
  if (n > FILE_MAX)
    snprintf(why, CASE_WHY, "is too large for a case file");
  else if (memchr(text, 0, n))
    snprintf(why, CASE_WHY, "holds a zero byte; it is not a text file");
  else if (strspn(text, " \t\r\n") == n)
    snprintf(why, CASE_WHY, "is empty");
  else
    return text;
  free(text);
  return NULL;
}

/* Reads on rank 0 and shares; *text is NULL on all ranks if there was an error. */
static PetscErrorCode FileShare(Reader *r, char **text)
{
  char why[CASE_WHY] = "";
  int  size          = 0;

  PetscFunctionBeginUser;
  *text = NULL;
  if (r->rank == 0) {
    *text = FileText(r->file, why);
    size  = *text ? (int)strlen(*text) + 1 : 0;
  }
  PetscCallMPI(MPI_Bcast(&size, 1, MPI_INT, 0, r->comm));
  PetscCallMPI(MPI_Bcast(why, CASE_WHY, MPI_CHAR, 0, r->comm));
  if (!size) {
    ReaderError(r, NULL, NULL, "%s", why);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (r->rank)
    *text = calloc((size_t)size, 1);
  PetscCallMPI(MPI_Bcast(*text, size, MPI_CHAR, 0, r->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps PETSc's own message instead of printing it. */
static PetscErrorCode KeepMessage(MPI_Comm comm, int line, const char *fun, const char *file, PetscErrorCode n,
                                  PetscErrorType p, const char *mess, void *ctx)
{
  char *kept = ctx;

  (void)comm, (void)line, (void)fun, (void)file;
  if (p == PETSC_ERROR_INITIAL && mess)
    snprintf(kept, CASE_WHY, "%s", mess);
  return n;
}

static bool Parses(PetscOptions db, const char *text, char why[CASE_WHY])
{
  PetscErrorCode ierr;

  if (PetscPushErrorHandler(KeepMessage, why))
    return false;
  ierr = PetscOptionsInsertStringYAML(db, text);
  if (PetscPopErrorHandler())
    return false;
  return ierr == 0;
}

/* The longest run of leading lines that PETSc can read ends before the error. */
static PetscErrorCode LastGoodLine(char *text, PetscInt *good)
{
  PetscInt line = 0;
  char     why[CASE_WHY];

  PetscFunctionBeginUser;
  *good = 0;
  if (strlen(text) > 50000)
    PetscFunctionReturn(PETSC_SUCCESS);
  for (char *p = text; (p = strchr(p, '\n')) && line < 1000; p++) {
    PetscOptions db;
    char         keep = p[1];

    line++;
    PetscCall(PetscOptionsCreate(&db));
    p[1] = 0;
    if (Parses(db, text, why))
      *good = line;
    p[1] = keep;
    PetscCall(PetscOptionsDestroy(&db));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode KeepEntries(Reader *r, PetscOptions db)
{
  PetscInt n;
  char   **names, **values;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsLeftGet(db, &n, &names, &values)); /* nothing was used yet: all of them */
  r->entry = realloc(r->entry, (size_t)(r->nentry + n + 1) * sizeof *r->entry);
  for (PetscInt i = 0; i < n; i++) {
    Entry *e = &r->entry[r->nentry++];
    e->name  = strdup(names[i]);
    e->value = values[i] && *values[i] ? strdup(values[i]) : NULL;
    e->used  = false;
  }
  PetscCall(PetscOptionsLeftRestore(db, &n, &names, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc 3.18 holds 512 options: a larger case is read one top-level key at a time. */
static PetscErrorCode LoadParts(Reader *r, char *text, char why[CASE_WHY], bool *ok)
{
  PetscInt begin = -1;

  PetscFunctionBeginUser;
  *ok = true;
  for (PetscInt i = 0; i <= r->nmark && *ok; i++) {
    PetscInt     end = i < r->nmark ? r->mark[i].offset : (PetscInt)strlen(text);
    PetscOptions db;
    char         keep;

    if (end < 0)
      continue;
    if (begin >= 0) {
      PetscCall(PetscOptionsCreate(&db));
      keep      = text[end];
      text[end] = 0;
      *ok       = Parses(db, text + begin, why);
      text[end] = keep;
      if (*ok)
        PetscCall(KeepEntries(r, db));
      PetscCall(PetscOptionsDestroy(&db));
    }
    begin = end;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadText(Reader *r, char *text)
{
  PetscOptions db;
  PetscInt     good;
  char         why[CASE_WHY] = "";
  bool         ok, large;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsCreate(&db));
  ok = Parses(db, text, why);
  if (ok)
    PetscCall(KeepEntries(r, db));
  PetscCall(PetscOptionsDestroy(&db));
  large = !ok && strstr(why, "max number of options");
  if (large)
    PetscCall(LoadParts(r, text, why, &ok));
  if (ok)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (large && strstr(why, "max number of options")) {
    ReaderError(r, NULL, NULL, "has more than 512 values below one key, which PETSc cannot read");
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(LastGoodLine(text, &good));
  ReaderError(r, NULL, NULL, "is not readable as YAML (%s); the first %d lines are well-formed", why, (int)good);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A case may be given as a folder. */
static PetscErrorCode FilePath(Reader *r, const char *path)
{
  struct stat info;
  size_t      len;

  PetscFunctionBeginUser;
  snprintf(r->file, sizeof r->file, "%.*s", (int)sizeof r->file - 16, path);
  if (r->rank == 0 && !stat(r->file, &info) && S_ISDIR(info.st_mode)) {
    len = strlen(r->file);
    while (len > 1 && r->file[len - 1] == '/')
      r->file[--len] = 0;
    snprintf(r->file + len, sizeof r->file - len, "/case.yaml");
  }
  PetscCallMPI(MPI_Bcast(r->file, sizeof r->file, MPI_CHAR, 0, r->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReaderLoad(Reader *r, const char *path)
{
  char *text;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(r->comm, &r->rank));
  PetscCall(FilePath(r, path));
  PetscCall(FileShare(r, &text));
  if (!text)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (ReaderScan(r, text))
    PetscCall(LoadText(r, text));
  free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReaderDestroy(Reader *r)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < r->nentry; i++) {
    free(r->entry[i].name);
    free(r->entry[i].value);
  }
  for (PetscInt i = 0; i < r->nmark; i++)
    free(r->mark[i].name);
  for (PetscInt i = 0; i < PetscMin(r->nerror, CASE_ERRORS); i++)
    free(r->error[i]);
  free(r->entry);
  free(r->mark);
  memset(r, 0, sizeof *r);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReaderFind(Reader *r, const char *name, const char **value, bool *found, bool *from_file)
{
  char        option[256];
  const char *given;
  PetscBool   set;

  PetscFunctionBeginUser;
  *found = *from_file = false;
  *value              = NULL;
  for (PetscInt i = 0; i < r->nentry; i++) {
    if (strcasecmp(r->entry[i].name, name))
      continue;
    r->entry[i].used = true;
    *found = *from_file = true;
    *value              = r->entry[i].value;
  }
  snprintf(option, sizeof option, "-%s", name);
  PetscCall(PetscOptionsFindPair(NULL, NULL, option, &given, &set));
  if (set) {
    *found     = true;
    *from_file = false;
    *value     = given && *given ? given : NULL;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
