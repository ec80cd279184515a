/* What the process hears from outside.  SIGINT, SIGTERM, SIGQUIT, SIGHUP and SIGUSR1 (which mpiexec hands on) ask for
   the end of the run after its step; a second one ends it at once.  A reader of the output that goes away, or a limit
   on the size of files, is for the write that fails to say. */
#include "clathra/run.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const int             asks[] = {SIGINT, SIGTERM, SIGQUIT, SIGHUP, SIGUSR1};
static bool                  deaf[sizeof(asks) / sizeof(*asks)]; /* ignored when the program was started: nohup, & */
static bool                  quiet; /* a reader that goes away ends the program without a word */
static volatile sig_atomic_t caught;

static void Hear(int number)
{
  if (caught) {
    signal(number, SIG_DFL);
    raise(number);
  }
  caught = number;
}

/* Threads of BLAS wait for each other at every small block of a matrix, and where others compute as well a run takes
   several times as long: one thread, unless the environment says otherwise.  BLAS reads it before main. */
static void OneThread(char **argv)
{
  if (getenv("OMP_NUM_THREADS") || getenv("OPENBLAS_NUM_THREADS"))
    return;
  if (setenv("OMP_NUM_THREADS", "1", 1) == 0)
    (void)execv("/proc/self/exe", argv);
}

/* A folder that was deleted under the shell has no path, and neither MPI nor PETSc begins in it. */
static bool HasFolder(void)
{
  char path[PATH_MAX];

  if (getcwd(path, sizeof(path)))
    return true;
  fprintf(stderr, "clathra: the folder in which it was started cannot be found (%s); change to another one\n",
          strerror(errno));
  return false;
}

bool ProcessPrepare(char **argv)
{
  struct sigaction before;

  OneThread(argv);
  for (int fd = 0; fd < 3; fd++) { /* a closed one would be given to the next file that is opened */
    if (fcntl(fd, F_GETFD) < 0)
      (void)!open("/dev/null", O_RDWR);
  }
  for (size_t k = 0; k < sizeof(asks) / sizeof(*asks); k++)
    deaf[k] = sigaction(asks[k], NULL, &before) == 0 && before.sa_handler == SIG_IGN;
  return HasFolder();
}

PetscErrorCode ProcessQuietPipe(void)
{
  quiet = true;
  signal(SIGPIPE, SIG_DFL);                                      /* ends without a word, as others do */
  return PetscOptionsSetValue(NULL, "-no_signal_handler", NULL); /* before PetscInitialize, which would take it */
}

void ProcessListen(void)
{
  struct sigaction act = {.sa_handler = Hear, .sa_flags = SA_RESTART};

  sigemptyset(&act.sa_mask);
  for (size_t k = 0; k < sizeof(asks) / sizeof(*asks); k++) {
    if (deaf[k])
      signal(asks[k], SIG_IGN);
    else
      sigaction(asks[k], &act, NULL);
  }
  signal(SIGPIPE, quiet ? SIG_DFL : SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
}

int ProcessSignal(void)
{
  return (int)caught;
}
