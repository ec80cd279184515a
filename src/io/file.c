/* Writing files such that a failure is seen, said in one sentence (file, reason, what is missing), and leaves what was
   there: a file as a whole aside, onto the disk, then renamed; a row of a table in one piece or not at all. */
#include "io_private.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
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
  PetscCheck(!failed, comm, PETSC_ERR_LIB, "rank 0 failed");
  PetscFunctionReturn(PETSC_SUCCESS);
}

bool IoFailed(const char *path, size_t bytes) /* errno stays */
{
  const int      why      = errno;
  char           need[96] = "", folder[IO_PATH + 8];
  struct statvfs disk;

  snprintf(folder, sizeof(folder), "%s", path);
  if ((why == ENOSPC || why == EDQUOT) && bytes && statvfs(dirname(folder), &disk) == 0)
    snprintf(need, sizeof(need), " (needs %zu bytes, %.0f are free)", bytes,
             (double)disk.f_bavail * (double)disk.f_frsize);
  fprintf(stderr, "clathra: cannot write %s: %s%s\n", path, strerror(why), need);
  errno = why;
  return false;
}

/* write(2) until all is out; errno tells why not. */
static bool WriteAll(int fd, const void *data, size_t bytes)
{
  const char *at = data;

  while (bytes > 0) {
    const ssize_t n = write(fd, at, bytes);

    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0) {
      errno = n == 0 ? ENOSPC : errno;
      return false;
    }
    at += n;
    bytes -= (size_t)n;
  }
  return true;
}

/* Some files and file systems cannot be synced; they are then as safe as they are. */
static bool Sync(int fd)
{
  return fsync(fd) == 0 || errno == EINVAL || errno == ENOTSUP;
}

static void SyncFolder(const char *path)
{
  char copy[IO_PATH + 8];
  int  fd;

  snprintf(copy, sizeof(copy), "%s", path);
  fd = open(dirname(copy), O_RDONLY | O_CLOEXEC);
  if (fd < 0)
    return;
  (void)Sync(fd);
  close(fd);
}

/* PATH stays whole at every instant: it gets a second name before the new file takes its own. */
static bool KeepOld(const char *path)
{
  char old[IO_PATH + 8];

  snprintf(old, sizeof(old), "%s.old", path);
  if (access(path, F_OK) != 0)
    return true;
  if (unlink(old) != 0 && errno != ENOENT)
    return false;
  if (link(path, old) == 0)
    return true;
  return (errno == EPERM || errno == ENOTSUP || errno == EMLINK) && rename(path, old) == 0; /* no links here */
}

void IoAside(const char *path, char aside[IO_PATH + 8])
{
  snprintf(aside, IO_PATH + 8, "%s.tmp", path);
}

/* What was written aside, as far as it was good, takes its place: closed, on the disk, renamed. */
static bool Settle(const char *path, const char *aside, bool keep_old, int fd, bool good, size_t bytes)
{
  good = good && Sync(fd);
  if (fd >= 0) {
    const int why = errno;

    if (close(fd) != 0)
      good = false;
    else if (!good)
      errno = why;
  }
  good = good && (!keep_old || KeepOld(path)) && rename(aside, path) == 0;
  if (!good) {
    IoFailed(path, bytes);
    (void)unlink(aside); /* gives its room back */
    return false;
  }
  SyncFolder(path);
  return true;
}

bool IoAdopt(const char *path, bool keep_old, const IoPiece *block)
{
  char aside[IO_PATH + 8];
  int  fd;

  IoAside(path, aside);
  fd = open(aside, O_WRONLY | O_CLOEXEC);
  return Settle(path, aside, keep_old, fd, fd >= 0 && (!block || WriteAll(fd, block->data, block->bytes)), 0);
}

bool IoReplace(const char *path, bool keep_old, int n, const IoPiece piece[])
{
  char   aside[IO_PATH + 8];
  size_t bytes = 0;
  int    fd;
  bool   good;

  IoAside(path, aside);
  fd   = open(aside, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
  good = fd >= 0;
  for (int k = 0; k < n; k++) {
    bytes += piece[k].bytes;
    good = good && WriteAll(fd, piece[k].data, piece[k].bytes);
  }
  return Settle(path, aside, keep_old, fd, good, bytes);
}

bool IoRename(const char *from, const char *to)
{
  return rename(from, to) == 0 || IoFailed(to, 0);
}

bool IoMakeFolder(const char *dir)
{
  char path[IO_PATH];

  snprintf(path, sizeof(path), "%s", dir);
  for (char *c = path + 1; path[0]; c++) {
    const char end = *c;

    if (end != '/' && end != '\0')
      continue;
    *c = '\0';
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
      return IoFailed(path, 0);
    *c = end;
    if (end == '\0')
      break;
  }
  return true;
}

int IoOpenEnd(const char *path)
{
  const int fd = open(path, O_WRONLY | O_APPEND | O_CLOEXEC);

  if (fd < 0)
    IoFailed(path, 0);
  return fd;
}

bool IoAppend(int fd, const char *path, const char *text, size_t bytes)
{
  const off_t end = lseek(fd, 0, SEEK_END);

  if (WriteAll(fd, text, bytes))
    return true;
  IoFailed(path, bytes);
  if (end >= 0)
    (void)!ftruncate(fd, end); /* no half rows; if this fails, too, a restart drops what has no line break */
  return false;
}

bool IoSync(int fd, const char *path)
{
  return Sync(fd) || IoFailed(path, 0);
}

bool IoClose(int fd, const char *path)
{
  const bool good = IoSync(fd, path);

  if (close(fd) != 0 && good)
    return IoFailed(path, 0);
  return good;
}
