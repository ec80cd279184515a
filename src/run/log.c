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

/* A word of the command as a shell reads it. */
static void KeepWord(const char *word)
{
  const bool plain = *word && !word[strcspn(word, " \t\n\"'\\$`&|;<>()[]{}*?#~!")];

  Keep(" ", 1);
  if (!plain)
    Keep("'", 1);
  for (; *word; word++)
    Keep(*word == '\'' ? "'\\''" : word, *word == '\'' ? 4 : 1);
  if (!plain)
    Keep("'", 1);
}

PetscErrorCode LogStart(MPI_Comm comm)
{
  const time_t now = time(NULL);
  PetscMPIInt  size;
  int          argc;
  char       **argv, text[128];
  struct tm    local;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscGetArgs(&argc, &argv));
  strftime(text, sizeof(text), "# %Y-%m-%d %H:%M:%S\n$", localtime_r(&now, &local));
  heard.n     = 0;
  heard.fresh = true;
  Keep(text, strlen(text));
  if (size > 1) {
    snprintf(text, sizeof(text), " mpiexec -n %d", (int)size);
    Keep(text, strlen(text));
  }
  for (int k = 0; k < argc; k++)
    KeepWord(argv[k]);
  Keep("\n", 1);
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
  PetscFunctionReturn(PETSC_SUCCESS);
}
