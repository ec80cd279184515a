/* reader: the entries of the case file and the options that win over them, text of files, and the list of errors. */
#include "case_private.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#define FILE_MAX 1000000

/* Line of a key, or of the map it belongs to; 0 if neither is in the file. */
static PetscInt KeyLine(const Reader *r, const char *name)
{
  char path[256], *cut;

  snprintf(path, sizeof path, "%s", name);
  do {
    for (PetscInt i = 0; i < r->nentry; i++)
      if (!strcasecmp(r->entry[i].name, path))
        return r->entry[i].line;
    cut = strrchr(path, '_');
    if (cut)
      *cut = 0;
  } while (cut);
  return 0;
}

/* Is it the command line that gives this key of a case? */
static bool Commanded(const char *key)
{
  char      option[256];
  PetscBool given = PETSC_FALSE;

  if (!key || !*key || *key == '-')
    return false;
  snprintf(option, sizeof option, "-%s", key);
  PetscCallAbort(PETSC_COMM_SELF, PetscOptionsHasName(NULL, NULL, option, &given));
  return given;
}

/* A key that is none: "line 12". */
static bool IsLine(const char *key)
{
  return key && !strncmp(key, "line ", 5);
}

typedef struct {
  char s[PETSC_MAX_PATH_LEN + 16];
} Where;

/* Where a key is given: "file:12", "file" if no line is known, or "command line". */
static Where WhereGiven(const Reader *r, const char *key)
{
  Where where;

  if (IsLine(key))
    snprintf(where.s, sizeof where.s, "%s:%s", r->file, key + 5);
  else if (Commanded(key) || (key && *key == '-'))
    snprintf(where.s, sizeof where.s, "command line");
  else if (key && *key && KeyLine(r, key))
    snprintf(where.s, sizeof where.s, "%s:%d", r->file, (int)KeyLine(r, key));
  else
    snprintf(where.s, sizeof where.s, "%s", r->file);
  return where;
}

void ReaderWarn(const Reader *r, FindingId id, const char *key, const char *format, ...)
{
  char    what[1024];
  va_list args;

  va_start(args, format);
  vsnprintf(what, sizeof what, format, args);
  va_end(args);
  PetscCallAbort(PETSC_COMM_SELF, FindingSayOf(r->comm, id, WhereGiven(r, key).s, NULL, "%s", what));
}

void ReaderError(Reader *r, const char *key, const char *value, const char *format, ...)
{
  const Where where = WhereGiven(r, key);
  const char *named = key && !IsLine(key) ? key : "";
  char        what[1024], *text;
  size_t      size;
  va_list     args;

  va_start(args, format);
  vsnprintf(what, sizeof what, format, args);
  va_end(args);
  size = strlen(where.s) + strlen(what) + strlen(named) + (value ? strnlen(value, 80) : 0) + 16;
  text = malloc(size);
  snprintf(text, size, "%s: %s%s", where.s, *named && Commanded(named) ? "-" : "", named);
  if (value)
    snprintf(text + strlen(text), size - strlen(text), " = '%.80s'", value);
  snprintf(text + strlen(text), size - strlen(text), "%s%s", *named ? ": " : "", what);
  for (PetscInt i = 0; i < PetscMin(r->nerror, CASE_ERRORS); i++) {
    if (strcmp(r->error[i], text))
      continue;
    free(text); /* said already, of an instance that is like this one */
    return;
  }
  if (r->nerror++ < CASE_ERRORS)
    r->error[r->nerror - 1] = text;
  else
    free(text);
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
    snprintf(why, CASE_WHY, "has %ld bytes; at most %d are read", (long)info.st_size, FILE_MAX);
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
    snprintf(why, CASE_WHY, "is too large");
  else if (memchr(text, 0, n))
    snprintf(why, CASE_WHY, "holds a zero byte; it is not a text file");
  else if (strspn(text, " \t\r\n") == n)
    snprintf(why, CASE_WHY, "is empty");
  else
    return text;
  free(text);
  return NULL;
}

PetscErrorCode ReaderText(Reader *r, const char *path, char **text, char why[CASE_WHY])
{
  int size = 0;

  PetscFunctionBeginUser;
  *text  = NULL;
  why[0] = '\0';
  if (r->rank == 0) {
    *text = FileText(path, why);
    size  = *text ? (int)strlen(*text) + 1 : 0;
  }
  PetscCallMPI(MPI_Bcast(&size, 1, MPI_INT, 0, r->comm));
  PetscCallMPI(MPI_Bcast(why, CASE_WHY, MPI_CHAR, 0, r->comm));
  if (!size)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (r->rank)
    *text = calloc((size_t)size, 1);
  PetscCallMPI(MPI_Bcast(*text, size, MPI_CHAR, 0, r->comm));
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
    if (r->entry[i].map || strcasecmp(r->entry[i].name, name))
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
