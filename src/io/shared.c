/* Files that all ranks write together: whole in their place, or not at all. */
#include "io_private.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

static PetscErrorCode Agree(MPI_Comm comm, bool *good)
{
  int all = *good;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, comm));
  *good = all;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The file aside: made (room 0), or given its room, by rank 0. */
static bool TakeRoom(const char *path, size_t room)
{
  char aside[IO_PATH + 8];
  int  fd, why;

  IoAside(path, aside);
  fd = open(aside, O_WRONLY | O_CLOEXEC | O_NOFOLLOW | (room ? 0 : O_CREAT | O_TRUNC), 0666);
  if (fd < 0)
    return IoFailed(path, 0);
  why = room ? posix_fallocate(fd, 0, (off_t)room) : 0;
  close(fd);
  errno = why;
  return why == 0 || IoFailed(path, room);
}

static PetscErrorCode GiveUp(SharedFile *f, PetscMPIInt rank)
{
  char aside[IO_PATH + 8];

  PetscFunctionBeginUser;
  PetscCall(H5FileClose(&f->file));
  IoAside(f->path, aside);
  if (rank == 0)
    (void)unlink(aside);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* HDF5 empties the file when it creates it, so its room is taken afterwards, and what is too much given back when it is
   closed. */
PetscErrorCode SharedCreate(MPI_Comm comm, const char *path, hsize_t block, size_t room, SharedFile *f, bool *ok)
{
  char        aside[IO_PATH + 8];
  PetscMPIInt rank, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  *f  = (SharedFile){.comm = comm, .file = -1, .image = size == 1};
  *ok = true;
  PetscCall(PetscStrncpy(f->path, path, sizeof(f->path)));
  if (f->image) {
    PetscCall(H5ImageCreate(block, &f->file));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  *ok = rank > 0 || TakeRoom(path, 0);
  PetscCall(Agree(comm, ok));
  if (!*ok)
    PetscFunctionReturn(PETSC_SUCCESS);
  IoAside(path, aside);
  PetscCall(H5SharedCreate(comm, aside, block, &f->file));
  *ok = rank > 0 || TakeRoom(path, (size_t)block + room);
  PetscCall(Agree(comm, ok));
  if (!*ok)
    PetscCall(GiveUp(f, rank));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FinishImage(SharedFile *f, bool keep_old, SharedSeal seal, const void *ctx, bool *ok)
{
  char    block[SEAL_BYTES];
  IoPiece image;

  PetscFunctionBeginUser;
  PetscCall(H5ImageBytes(f->file, &image));
  if (seal) {
    const IoPiece rest = {(const char *)image.data + SEAL_BYTES, image.bytes - SEAL_BYTES};

    seal(SealSum(rest.data, rest.bytes), image.bytes, ctx, block);
    *ok = IoReplace(f->path, keep_old, 2, (IoPiece[]){{block, SEAL_BYTES}, rest});
  } else
    *ok = IoReplace(f->path, keep_old, 1, &image);
  PetscCall(H5FileClose(&f->file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SharedFinish(SharedFile *f, bool keep_old, SharedSeal seal, const void *ctx, bool *ok)
{
  char          aside[IO_PATH + 8], block[SEAL_BYTES];
  const IoPiece piece = {block, SEAL_BYTES};
  uint64_t      sum = 0, bytes = 0;
  PetscMPIInt   rank;

  PetscFunctionBeginUser;
  if (f->image) {
    PetscCall(FinishImage(f, keep_old, seal, ctx, ok));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCallMPI(MPI_Comm_rank(f->comm, &rank));
  PetscCall(H5FileClose(&f->file));
  IoAside(f->path, aside);
  *ok = true;
  if (seal)
    PetscCall(SealSumFile(f->comm, aside, SEAL_BYTES, &sum, &bytes, ok));
  if (rank == 0 && *ok) {
    if (seal)
      seal(sum, bytes, ctx, block);
    *ok = IoAdopt(f->path, keep_old, seal ? &piece : NULL);
  }
  PetscCall(Agree(f->comm, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}
