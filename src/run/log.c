/* log.txt of the output folder: the command, then what the program says on either stream, from the reading of the case
   on.  It is kept in memory and written with the snapshots and checkpoints and at the end. */
#include "run_private.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* PETSc has one printer for the process, so what it hears stands here. */
static struct {
  char  *text;
  size_t n, cap;
  bool   fresh;                                           /* nothing of it is in the file yet */
  PetscErrorCode (*print)(FILE *, const char[], va_list); /* PETSc's own */
} heard;

static void Keep(const char *text, size_t n)
{
  if (heard.n + n > heard.cap) {
    const size_t cap  = 2 * heard.cap + n + 4096;
    char        *more = realloc(heard.text, cap);

    if (!more)
      return; /* it was said all the same */
    heard.text = more;
    heard.cap  = cap;
  }
  memcpy(heard.text + heard.n, text, n);
  heard.n += n;
}

/* As C prints: PETSc's own printer makes 40 of %g "40.", as no integer would look. */
static PetscErrorCode SayAndKeep(FILE *f, const char format[], va_list args)
{
  va_list again;
  char    line[4096];

  PetscFunctionBeginUser;
  va_copy(again, args);
  (void)vfprintf(f, format, args); /* a reader that went away is no error */
  (void)fflush(f);
  if (f == stdout || f == stderr) {
    vsnprintf(line, sizeof(line), format, again);
    Keep(line, strlen(line));
  }
  va_end(again);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A word of the command as a shell reads it, behind a space. */
static void PutWord(FILE *f, const char *word)
{
  const bool plain = *word && !word[strcspn(word, " \t\n\"'\\$`&|;<>()[]{}*?#~!")];

  fputs(plain ? " " : " '", f);
  for (; *word; word++)
    fputs(*word == '\'' ? "'\\''" : (char[]){*word, '\0'}, f);
  if (!plain)
    fputc('\'', f);
}

/* Does this option say how a run begins, which a restart says otherwise? */
static bool Begins(const char *word)
{
  static const char *const begins[] = {"-restart", "-restart_as_initial", "-overwrite"};

  for (size_t k = 0; k < sizeof(begins) / sizeof(*begins); k++) {
    if (!strcmp(word, begins[k]))
      return true;
  }
  return false;
}

PetscErrorCode CommandOptions(char **text)
{
  char **argv;
  int    argc;
  size_t n;
  FILE  *f = open_memstream(text, &n);

  PetscFunctionBeginUser;
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  PetscCall(PetscGetArgs(&argc, &argv));
  for (int k = 2; k < argc; k++) { /* behind the program and its case */
    if (!Begins(argv[k]))
      PutWord(f, argv[k]);
    else if (k + 1 < argc && argv[k + 1][0] != '-')
      k++;
  }
  PetscCheck(fclose(f) == 0, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LogStart(MPI_Comm comm)
{
  const time_t now = time(NULL);
  PetscMPIInt  size;
  int          argc;
  size_t       n;
  char       **argv, day[64], *command;
  struct tm    local;
  FILE        *f = open_memstream(&command, &n);

  PetscFunctionBeginUser;
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscGetArgs(&argc, &argv));
  strftime(day, sizeof(day), "# %Y-%m-%d %H:%M:%S\n$", localtime_r(&now, &local));
  fputs(day, f);
  if (size > 1)
    fprintf(f, " mpiexec -n %d", (int)size);
  for (int k = 0; k < argc; k++)
    PutWord(f, argv[k]);
  fputc('\n', f);
  PetscCheck(fclose(f) == 0, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  heard.n     = 0;
  heard.fresh = true;
  Keep(command, n);
  free(command);
  heard.print   = PetscVFPrintf;
  PetscVFPrintf = SayAndKeep;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LogWrite(MPI_Comm comm, const char *dir, bool append, bool *ok)
{
  PetscFunctionBeginUser;
  PetscCall(FolderAppendText(comm, dir, "log.txt", !append && heard.fresh, heard.text, heard.n, ok));
  heard.fresh = false;
  heard.n     = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LogEnd(void)
{
  PetscFunctionBeginUser;
  PetscVFPrintf = heard.print;
  free(heard.text);
  heard.text = NULL;
  heard.n = heard.cap = 0;
  FindingForget();
  PetscFunctionReturn(PETSC_SUCCESS);
}
