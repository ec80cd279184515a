/* The seal of a checkpoint: a few lines of text in front of the HDF5 data that say what it is, how long, and its
   checksum.  It is checked byte by byte before HDF5 sees the file, so that a damaged one never reaches the library. */
#include "io_private.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>
#include <sys/stat.h>

#define MAGIC "clathra checkpoint\n"

typedef struct {
  int      version;
  uint64_t fingerprint, run, bytes, checksum;
} Seal;

/* ---------------------------------------------------------------- the block itself */
static void Format(const Seal *seal, bool with_checksum, char block[SEAL_BYTES])
{
  int n;

  memset(block, 0, SEAL_BYTES);
  n = snprintf(block, SEAL_BYTES, MAGIC "version %d\ncase %016" PRIx64 "\nrun %016" PRIx64 "\nbytes %" PRIu64 "\n",
               seal->version, seal->fingerprint, seal->run, seal->bytes);
  if (with_checksum)
    snprintf(block + n, SEAL_BYTES - (size_t)n, "fnv1a64 %016" PRIx64 "\n", seal->checksum);
}

static bool Parse(const char block[SEAL_BYTES], Seal *seal)
{
  return block[SEAL_BYTES - 1] == '\0' &&
         sscanf(block, MAGIC "version %d case %16" SCNx64 " run %16" SCNx64 " bytes %20" SCNu64 " fnv1a64 %16" SCNx64,
                &seal->version, &seal->fingerprint, &seal->run, &seal->bytes, &seal->checksum) == 5;
}

/* ---------------------------------------------------------------- checksum */
#define SHARE ((size_t)1 << 20) /* bytes hashed as one */

/* Of the k-th share.  The checksum is the exclusive or of all, so that ranks sum theirs up in any order. */
static uint64_t ShareSum(uint64_t k, const void *data, size_t bytes)
{
  return HashBytes(HashBytes(FNV_START, &k, sizeof(k)), data, bytes);
}

uint64_t SealSum(const void *data, size_t bytes)
{
  uint64_t sum = 0;

  for (size_t at = 0; at < bytes; at += SHARE)
    sum ^= ShareSum(at / SHARE, (const char *)data + at, bytes - at < SHARE ? bytes - at : SHARE);
  return sum;
}

/* Shares `rank`, `rank + size`, ... of what stands behind the user block. */
static PetscErrorCode SumShares(FILE *f, size_t block, uint64_t bytes, PetscMPIInt rank, PetscMPIInt size,
                                uint64_t *sum, bool *good)
{
  char *buffer;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc(SHARE, &buffer));
  for (uint64_t k = (uint64_t)rank; *good && block + k * SHARE < bytes; k += (uint64_t)size) {
    const uint64_t at = block + k * SHARE;
    const size_t   n  = bytes - at < SHARE ? (size_t)(bytes - at) : SHARE;

    *good = fseeko(f, (off_t)at, SEEK_SET) == 0 && fread(buffer, 1, n, f) == n;
    *sum ^= ShareSum(k, buffer, n);
  }
  PetscCall(PetscFree(buffer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SealSumFile(MPI_Comm comm, const char *path, size_t block, uint64_t *sum, uint64_t *bytes, bool *good)
{
  struct stat st;
  FILE       *f = fopen(path, "rb");
  PetscMPIInt rank, size;
  int         all;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  *sum   = 0;
  *good  = f && fstat(fileno(f), &st) == 0;
  *bytes = *good ? (uint64_t)st.st_size : 0;
  if (*good)
    PetscCall(SumShares(f, block, *bytes, rank, size, sum, good));
  if (!*good)
    fprintf(stderr, "clathra: cannot read %s: %s\n", path, errno ? strerror(errno) : "it is too short");
  if (f)
    fclose(f);
  all = *good;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 1, MPI_UINT64_T, MPI_BXOR, comm));
  *good = all;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- making and checking */
/* With the checksum of the block itself. */
static uint64_t Whole(const Seal *seal, uint64_t sum)
{
  char block[SEAL_BYTES];

  Format(seal, false, block);
  return HashBytes(FNV_START, block, SEAL_BYTES) ^ sum;
}

void SealMake(char block[SEAL_BYTES], uint64_t fingerprint, uint64_t run, uint64_t bytes, uint64_t sum)
{
  Seal seal = {.version = CHECKPOINT_VERSION, .fingerprint = fingerprint, .run = run, .bytes = bytes};

  seal.checksum = Whole(&seal, sum);
  Format(&seal, true, block);
}

/* All of it but the checksum, on rank 0. */
static void CheckBlock(FILE *f, uint64_t bytes, Seal *seal, char *why, size_t size)
{
  char block[SEAL_BYTES], expected[SEAL_BYTES] = {0};

  if (fread(block, 1, sizeof(MAGIC) - 1, f) != sizeof(MAGIC) - 1 || memcmp(block, MAGIC, sizeof(MAGIC) - 1)) {
    snprintf(why, size, "it is not a checkpoint of Clathra");
    return;
  }
  if (fread(block + sizeof(MAGIC) - 1, sizeof(block) - (sizeof(MAGIC) - 1), 1, f) != 1) {
    snprintf(why, size, "it is cut off after %" PRIu64 " bytes", bytes);
    return;
  }
  if (sscanf(block, MAGIC "version %d", &seal->version) == 1 && seal->version != CHECKPOINT_VERSION) {
    snprintf(why, size, "it has format version %d; this program reads version %d", seal->version, CHECKPOINT_VERSION);
    return;
  }
  if (Parse(block, seal))
    Format(seal, true, expected);
  if (memcmp(block, expected, SEAL_BYTES) != 0)
    snprintf(why, size, "its first %d bytes are damaged", SEAL_BYTES);
  else if (bytes != seal->bytes)
    snprintf(why, size, "it has %" PRIu64 " bytes instead of %" PRIu64, bytes, seal->bytes);
}

static void CheckFile(const char *path, Seal *seal, char *why, size_t size)
{
  struct stat st;
  FILE       *f = NULL;

  if (stat(path, &st) == 0 && !S_ISREG(st.st_mode)) /* to open a pipe is to wait for who writes into it */
    snprintf(why, size, "it is not a file");
  else if (!(f = fopen(path, "rb")) || fstat(fileno(f), &st) != 0)
    snprintf(why, size, "%s", strerror(errno));
  else
    CheckBlock(f, (uint64_t)st.st_size, seal, why, size);
  if (f)
    fclose(f);
}

PetscErrorCode SealCheck(MPI_Comm comm, const char *path, uint64_t *fingerprint, uint64_t *run, bool *ok, char *why,
                         size_t size)
{
  Seal        seal = {0};
  uint64_t    sum, bytes;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  why[0] = '\0';
  if (rank == 0)
    CheckFile(path, &seal, why, size);
  PetscCallMPI(MPI_Bcast(why, (PetscMPIInt)size, MPI_CHAR, 0, comm));
  PetscCallMPI(MPI_Bcast(&seal, sizeof(seal), MPI_BYTE, 0, comm));
  *ok = why[0] == '\0';
  if (*ok) {
    PetscCall(SealSumFile(comm, path, SEAL_BYTES, &sum, &bytes, ok));
    *ok = *ok && bytes == seal.bytes && Whole(&seal, sum) == seal.checksum;
    if (!*ok)
      snprintf(why, size, "it is damaged: its checksum is wrong");
  }
  *fingerprint = seal.fingerprint;
  *run         = seal.run;
  PetscFunctionReturn(PETSC_SUCCESS);
}
