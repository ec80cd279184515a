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

/* Checksum of the block without it, and of the rest of the stream. */
static PetscErrorCode Checksum(FILE *f, const Seal *seal, uint64_t *hash)
{
  const size_t size = 1 << 20;
  char         block[SEAL_BYTES], *buffer;
  size_t       n;

  PetscFunctionBeginUser;
  Format(seal, false, block);
  *hash = HashBytes(FNV_START, block, SEAL_BYTES);
  PetscCall(PetscMalloc(size, &buffer));
  while ((n = fread(buffer, 1, size, f)) > 0)
    *hash = HashBytes(*hash, buffer, n);
  PetscCall(PetscFree(buffer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SealMake(char block[SEAL_BYTES], uint64_t fingerprint, uint64_t run, const void *data, size_t bytes)
{
  Seal seal = {
      .version = CHECKPOINT_VERSION, .fingerprint = fingerprint, .run = run, .bytes = (uint64_t)bytes + SEAL_BYTES};

  Format(&seal, false, block);
  seal.checksum = HashBytes(HashBytes(FNV_START, block, SEAL_BYTES), data, bytes);
  Format(&seal, true, block);
}

static PetscErrorCode CheckStream(FILE *f, uint64_t bytes, Seal *seal, bool *ok, char *why, size_t size)
{
  char     block[SEAL_BYTES], expected[SEAL_BYTES] = {0};
  uint64_t hash = 0;

  PetscFunctionBeginUser;
  *ok = false;
  if (fread(block, 1, sizeof(MAGIC) - 1, f) != sizeof(MAGIC) - 1 || memcmp(block, MAGIC, sizeof(MAGIC) - 1)) {
    snprintf(why, size, "it is not a checkpoint of Clathra");
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (fread(block + sizeof(MAGIC) - 1, sizeof(block) - (sizeof(MAGIC) - 1), 1, f) != 1) {
    snprintf(why, size, "it is cut off after %" PRIu64 " bytes", bytes);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (sscanf(block, MAGIC "version %d", &seal->version) == 1 && seal->version != CHECKPOINT_VERSION) {
    snprintf(why, size, "it has format version %d; this program reads version %d", seal->version, CHECKPOINT_VERSION);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  *ok = Parse(block, seal);
  if (*ok)
    Format(seal, true, expected);
  *ok = *ok && memcmp(block, expected, SEAL_BYTES) == 0;
  if (!*ok)
    snprintf(why, size, "its first %d bytes are damaged", SEAL_BYTES);
  else if (bytes != seal->bytes)
    snprintf(why, size, "it has %" PRIu64 " bytes instead of %" PRIu64, bytes, seal->bytes);
  else {
    PetscCall(Checksum(f, seal, &hash));
    if (hash != seal->checksum)
      snprintf(why, size, "it is damaged: its checksum is wrong");
  }
  *ok = *ok && bytes == seal->bytes && hash == seal->checksum;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SealCheck(const char *path, uint64_t *fingerprint, uint64_t *run, bool *ok, char *why, size_t size)
{
  struct stat st;
  Seal        seal = {0};
  FILE       *f    = fopen(path, "rb");

  PetscFunctionBeginUser;
  *ok = false;
  if (!f || fstat(fileno(f), &st) != 0)
    snprintf(why, size, "%s", strerror(errno));
  else if (!S_ISREG(st.st_mode))
    snprintf(why, size, "it is not a file");
  else
    PetscCall(CheckStream(f, (uint64_t)st.st_size, &seal, ok, why, size));
  if (f)
    fclose(f);
  *fingerprint = seal.fingerprint;
  *run         = seal.run;
  PetscFunctionReturn(PETSC_SUCCESS);
}
