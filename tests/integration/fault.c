/* Preloaded: counts the system calls that change what is below FAULT_DIR and makes the FAULT_AT-th go wrong.

     FAULT_HOW=kill     the process dies there, in the middle of a write
     FAULT_HOW=full     from there on there is no room: half a write, then none; no new file
     FAULT_HOW=gone     from there on nothing can be changed (read-only)
     FAULT_HOW=once     that call alone fails (input/output error)
     FAULT_HOW=wait     that call takes a minute
     FAULT_HOW=room     that request for room in a file fails (they alone are counted)
     FAULT_COUNT=FILE   the number of calls goes there at the end */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

static long calls, requests;

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static bool Here(const char *path)
{
  const char *dir = getenv("FAULT_DIR");

  return dir && path && !strncmp(path, dir, strlen(dir));
}

static bool HereFd(int fd)
{
  char    link[64], path[PATH_MAX];
  ssize_t n;

  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  n = readlink(link, path, sizeof path - 1);
  if (n <= 0)
    return false;
  path[n] = 0;
  return Here(path);
}

/* errno of the call that is about to be made; 0: it may go on.  room: it needs some. */
static int Fault(bool room)
{
  const char *how = getenv("FAULT_HOW"), *at = getenv("FAULT_AT");
  const long  n = at ? atol(at) : 0;

  calls++;
  if (!how || !strcmp(how, "room") || n <= 0 || calls < n)
    return 0;
  if (!strcmp(how, "kill"))
    kill(getpid(), SIGKILL);
  if (!strcmp(how, "wait")) {
    if (calls == n)
      for (int k = 0; k < 60; k++)
        sleep(1); /* a signal that is handled cuts one short */
    return 0;
  }
  if (!strcmp(how, "full"))
    return room ? ENOSPC : 0;
  if (!strcmp(how, "gone"))
    return EROFS;
  return calls == n ? EIO : 0;
}

/* The call that FAULT_AT names is a write: half of it comes through. */
static bool Half(void)
{
  const char *how = getenv("FAULT_HOW"), *at = getenv("FAULT_AT");

  return how && at && calls + 1 == atol(at) && (!strcmp(how, "kill") || !strcmp(how, "full"));
}

#define FAIL(here, room)                                                                                               \
  do {                                                                                                                 \
    const int why_ = (here) ? Fault(room) : 0;                                                                         \
    if (why_) {                                                                                                        \
      errno = why_;                                                                                                    \
      return -1;                                                                                                       \
    }                                                                                                                  \
  } while (0)

ssize_t write(int fd, const void *data, size_t n)
{
  const bool here = HereFd(fd);

  if (here && Half() && n > 1) {
    const ssize_t half = REAL(write)(fd, data, n / 2);

    if (!strcmp(getenv("FAULT_HOW"), "full")) {
      calls++;
      return half;
    }
  }
  FAIL(here, true);
  return REAL(write)(fd, data, n);
}

ssize_t pwrite64(int fd, const void *data, size_t n, off64_t at)
{
  const bool here = HereFd(fd);

  if (here && Half() && n > 1)
    REAL(pwrite64)(fd, data, n / 2, at);
  FAIL(here, true);
  return REAL(pwrite64)(fd, data, n, at);
}

ssize_t pwrite(int fd, const void *data, size_t n, off_t at)
{
  return pwrite64(fd, data, n, at);
}

int posix_fallocate64(int fd, off64_t at, off64_t n)
{
  const char *how = getenv("FAULT_HOW"), *which = getenv("FAULT_AT");

  if (how && which && !strcmp(how, "room") && HereFd(fd) && ++requests == atol(which))
    return ENOSPC;
  return REAL(posix_fallocate64)(fd, at, n);
}

int posix_fallocate(int fd, off_t at, off_t n)
{
  return posix_fallocate64(fd, at, n);
}

int ftruncate64(int fd, off64_t size)
{
  FAIL(HereFd(fd), false);
  return REAL(ftruncate64)(fd, size);
}

int ftruncate(int fd, off_t size)
{
  return ftruncate64(fd, size);
}

int fsync(int fd)
{
  FAIL(HereFd(fd), false);
  return REAL(fsync)(fd);
}

int close(int fd)
{
  const int why = HereFd(fd) ? Fault(false) : 0, done = REAL(close)(fd);

  if (why && why != EROFS) {
    errno = why;
    return -1;
  }
  return done;
}

int rename(const char *from, const char *to)
{
  FAIL(Here(to), false);
  return REAL(rename)(from, to);
}

int link(const char *from, const char *to)
{
  FAIL(Here(to), true);
  return REAL(link)(from, to);
}

int unlink(const char *path)
{
  FAIL(Here(path), false);
  return REAL(unlink)(path);
}

int mkdir(const char *path, mode_t mode)
{
  FAIL(Here(path) && access(path, F_OK) != 0, true);
  return REAL(mkdir)(path, mode);
}

static int Open(const char *path, int flags, mode_t mode)
{
  FAIL(Here(path) && (flags & O_ACCMODE) != O_RDONLY, (flags & O_CREAT) && access(path, F_OK) != 0);
  return REAL(open64)(path, flags, mode);
}

int open64(const char *path, int flags, ...)
{
  va_list args;
  mode_t  mode;

  va_start(args, flags);
  mode = flags & O_CREAT ? va_arg(args, mode_t) : 0;
  va_end(args);
  return Open(path, flags, mode);
}

int open(const char *path, int flags, ...)
{
  va_list args;
  mode_t  mode;

  va_start(args, flags);
  mode = flags & O_CREAT ? va_arg(args, mode_t) : 0;
  va_end(args);
  return Open(path, flags, mode);
}

__attribute__((destructor)) static void Count(void)
{
  const char *name = getenv("FAULT_COUNT");
  FILE       *f    = name && calls ? fopen(name, "w") : NULL; /* helpers of MPI end, too */

  if (!f)
    return;
  fprintf(f, "%ld\n", calls);
  fclose(f);
}
