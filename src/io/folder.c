/* The output folder: one run at a time, files of one history, and of one case unless -overwrite.

   run.lock is locked (flock) while a run lives; the kernel gives it back when the process dies, however it dies.

   run.id lists the runs whose rows and snapshots the folder holds, one a line: identity and first time.  A restart at
   time t from a checkpoint of run k keeps the lines up to k and adds its own with t, as the tables are cut back to t.
   So a checkpoint of run k at t belongs to the folder when k is listed and the run after it, if any, began at t or
   later.
 */
#include "io_private.h"
#include "clathra/words.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <time.h>
#include <unistd.h>

#define HEAD (PETSC_MAX_PATH_LEN + 16) /* of a line of a resolved case */

typedef struct {
  int    n;
  Origin run[64]; /* the last ones */
} History;

static uint64_t NewIdentity(void)
{
  uint64_t id = 0;

  if (getrandom(&id, sizeof(id), GRND_NONBLOCK) != sizeof(id)) {
    struct timespec now;
    const pid_t     pid = getpid();

    clock_gettime(CLOCK_REALTIME, &now);
    id = HashBytes(HashBytes(FNV_START, &now, sizeof(now)), &pid, sizeof(pid));
  }
  return id;
}

/* ---------------------------------------------------------------- the lock */
static void SayTaken(const char *dir, int fd)
{
  char          who[128] = "";
  const ssize_t n        = pread(fd, who, sizeof(who) - 1, 0);

  who[n > 0 ? n : 0]      = '\0';
  who[strcspn(who, "\n")] = '\0';
  fprintf(stderr,
          "clathra: another run%s%s%s is writing into the output folder %s; wait for it or give another "
          "-output_dir\n",
          who[0] ? " (" : "", who, who[0] ? ")" : "", dir);
}

/* A disk that has no room is no mistake of the user's. */
static int NoFolder(void)
{
  return errno == ENOSPC || errno == EDQUOT || errno == EIO ? CL_EXIT_FAILED : CL_EXIT_INPUT;
}

/* Exit code. */
static int Lock(const char *dir, int *lock)
{
  char path[PETSC_MAX_PATH_LEN + 16], host[64] = "", who[128];

  snprintf(path, sizeof(path), "%s/run.lock", dir);
  if (!IoMakeFolder(dir))
    return NoFolder();
  *lock = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (*lock < 0) {
    const int code = NoFolder();

    if (errno == ELOOP)
      fprintf(stderr, "clathra: %s is a symbolic link, and what it points to would be written over; remove it\n", path);
    else
      IoFailed(path, 0);
    return code;
  }
  if (flock(*lock, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) {
      SayTaken(dir, *lock);
      return CL_EXIT_INPUT;
    }
    (void)FindingSay(PETSC_COMM_SELF, FINDING_FOLDER_NOT_LOCKED,
                     "%s cannot be locked (%s): see to it that no other run writes there", path, strerror(errno));
  }
  gethostname(host, sizeof(host) - 1);
  snprintf(who, sizeof(who), "process %ld on %s\n", (long)getpid(), host);
  (void)(!ftruncate(*lock, 0) && pwrite(*lock, who, strlen(who), 0)); /* a note for people only */
  return CL_EXIT_OK;
}

/* ---------------------------------------------------------------- the history */
/* false: there is none, or none that can be read. */
static bool ReadHistory(const char *path, History *h)
{
  char  line[128];
  FILE *f = fopen(path, "r");

  h->n = 0;
  if (!f)
    return false;
  while (fgets(line, sizeof(line), f)) {
    Origin o = {0};

    if (sscanf(line, "%16" SCNx64 " %lf", &o.run, &o.t) != 2)
      continue;
    if (h->n == 64)
      memmove(h->run, h->run + 1, sizeof(*h->run) * (size_t)--h->n);
    h->run[h->n++] = o;
  }
  fclose(f);
  return h->n > 0;
}

static bool WriteHistory(const char *path, const History *h)
{
  char text[64 * 64 + 128];
  int  n = snprintf(text, sizeof(text), "# runs whose results are here: identity, from when on (s)\n");

  for (int k = 0; k < h->n; k++)
    n += snprintf(text + n, sizeof(text) - (size_t)n, "%016" PRIx64 " %.17g\n", h->run[k].run, h->run[k].t);
  return IoReplace(path, false, 1, &(IoPiece){text, (size_t)n});
}

/* Cuts the history back to where the checkpoint is from; false: it is of something else. */
static bool Join(const char *dir, const Origin *from, History *h)
{
  for (int k = h->n - 1; k >= 0; k--) {
    if (h->run[k].run != from->run)
      continue;
    if (k + 1 < h->n && h->run[k + 1].t < from->t) {
      fprintf(
          stderr,
          "clathra: the checkpoint, of t = %s, does not belong to the files in %s any more: a later run has gone on "
          "there from t = %s; restart from a checkpoint of that one, or give another -output_dir\n",
          TimeAt(from->t).s, dir, TimeAt(h->run[k + 1].t).s);
      return false;
    }
    h->n = k + 1;
    return true;
  }
  fprintf(stderr,
          "clathra: the checkpoint was not written by the run whose files are in %s; give another -output_dir to go on "
          "from it\n",
          dir);
  return false;
}

#define MARK "# " /* before the path */

/* The first lines of a resolved case say of which file it is (1) and its title (2). */
static void Head(FILE *f, char line[3][HEAD])
{
  memset(line, 0, sizeof(char[3][HEAD]));
  for (int k = 0; f && k < 3 && fgets(line[k], HEAD, f); k++)
    line[k][strcspn(line[k], "\n")] = '\0';
  if (f)
    fclose(f);
}

/* Do both files exist and hold the same? */
static bool SameFile(const char *a, const char *b)
{
  FILE *f = fopen(a, "r"), *g = fopen(b, "r");
  bool  same = f && g;

  for (int c = 0; same && c != EOF;) {
    c    = getc(f);
    same = c == getc(g);
  }
  if (f)
    fclose(f);
  if (g)
    fclose(g);
  return same;
}

/* Would a run write over a case that no run has written?  That is the user's own. */
static bool HoldsOwn(const char *path, char held[3][HEAD], char ours[3][HEAD])
{
  if (access(path, F_OK) || !strcmp(held[0], ours[0]))
    return false;
  fprintf(stderr,
          "clathra: %s is a case of your own, over which the run would write its own form of the case; give another "
          "-output_dir\n",
          path);
  return true;
}

/* A case may have moved to another place with its folder, or have been copied: then its title tells, unless its old
   file is still there and says something else. */
static bool HoldsOther(const char *dir, char held[3][HEAD], char ours[3][HEAD])
{
  const bool there = access(held[1] + strlen(MARK), R_OK) == 0, titled = strcmp(ours[2], "title: ''") != 0;

  if (strcmp(held[0], ours[0]) || !strcmp(held[1], ours[1]) ||
      (titled && !strcmp(held[2], ours[2]) && (!there || SameFile(held[1] + strlen(MARK), ours[1] + strlen(MARK)))))
    return false;
  fprintf(stderr,
          "clathra: %s holds the results of another case, %s; give another -output_dir, or -overwrite to lose them\n",
          dir, held[1] + strlen(MARK));
  return true;
}

PetscErrorCode FolderCheckCase(MPI_Comm comm, const char *dir, char *resolved, size_t bytes, bool keeps, bool *ok)
{
  char        path[IO_PATH], held[3][HEAD], ours[3][HEAD];
  PetscMPIInt rank;
  int         other = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) {
    snprintf(path, sizeof(path), "%s/case.yaml", dir);
    Head(fopen(path, "r"), held);
    Head(fmemopen(resolved, bytes, "r"), ours);
    other = HoldsOwn(path, held, ours) || (keeps && HoldsOther(dir, held, ours));
  }
  PetscCallMPI(MPI_Bcast(&other, 1, MPI_INT, 0, comm));
  *ok = !other;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int Enter(const char *dir, const Origin *from, Folder *folder)
{
  char    path[PETSC_MAX_PATH_LEN + 16], rows[PETSC_MAX_PATH_LEN + 16];
  History h;

  snprintf(path, sizeof(path), "%s/run.id", dir);
  snprintf(rows, sizeof(rows), "%s/balance.csv", dir);
  folder->here = from && (ReadHistory(path, &h) || access(rows, F_OK) == 0);
  if (folder->here && !Join(dir, from, &h))
    return CL_EXIT_INPUT;
  if (!folder->here)
    h.n = 0;
  if (h.n == 64)
    memmove(h.run, h.run + 1, sizeof(*h.run) * (size_t)--h.n);
  h.run[h.n++] = (Origin){.run = folder->run, .t = from ? from->t : 0.0};
  return WriteHistory(path, &h) ? CL_EXIT_OK : CL_EXIT_FAILED;
}

PetscErrorCode FolderTake(MPI_Comm comm, const char *dir, const Origin *from, Folder *folder, int *exit_code)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  *folder = (Folder){.lock = -1};
  if (rank == 0) {
    folder->run = NewIdentity();
    *exit_code  = Lock(dir, &folder->lock);
    if (*exit_code == CL_EXIT_OK)
      *exit_code = Enter(dir, from, folder);
    if (*exit_code != CL_EXIT_OK)
      PetscCall(FolderRelease(folder));
  }
  PetscCallMPI(MPI_Bcast(exit_code, 1, MPI_INT, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FolderRelease(Folder *folder)
{
  PetscFunctionBeginUser;
  if (folder->lock >= 0)
    close(folder->lock);
  folder->lock = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FolderAppendText(MPI_Comm comm, const char *dir, const char *name, bool fresh, const char *text,
                                size_t bytes, bool *ok)
{
  char        path[IO_PATH];
  PetscMPIInt rank;
  int         good = 1;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(IoPath(dir, name, path));
  if (rank == 0 && (fresh || access(path, F_OK) != 0)) {
    good = IoReplace(path, false, 1, &(IoPiece){text, bytes});
  } else if (rank == 0) {
    const int fd = IoOpenEnd(path);

    good = fd >= 0 && IoAppend(fd, path, text, bytes);
    good = fd >= 0 && IoClose(fd, path) && good;
  }
  PetscCallMPI(MPI_Bcast(&good, 1, MPI_INT, 0, comm));
  *ok = good;
  PetscFunctionReturn(PETSC_SUCCESS);
}
