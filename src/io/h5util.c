/* HDF5 with checked calls.  What is written is made in memory, so that HDF5 never sees a failing disk: it does not
   outlive one. */
#include "io_private.h"

#define COMPRESS_FROM 65536 /* bytes; smaller datasets are not compressed */
#define CHUNK_ROWS 16384
#define CHUNK_NODES 128 /* along each axis */

#define CHUNK_LISTS 4 /* half of how many chunks a list of them has room for, which small datasets have for nothing */

#define GROW ((size_t)1 << 22) /* bytes by which an image grows */

static bool no_memory; /* HDF5 could not allocate something */

static herr_t LookForMemory(unsigned n, const H5E_error2_t *error, void *ctx)
{
  (void)n, (void)ctx;
  no_memory = no_memory || error->min_num == H5E_NOSPACE || error->min_num == H5E_CANTALLOC;
  return 0;
}

/* Says what HDF5 has noted, unless it is memory that is not there: a sentence, which is main's, says that. */
static herr_t Note(hid_t stack, void *ctx)
{
  (void)ctx;
  H5Ewalk2(stack, H5E_WALK_DOWNWARD, LookForMemory, NULL);
  return no_memory ? 0 : H5Eprint2(stack, stderr);
}

PetscErrorCode H5Failure(void)
{
  return no_memory ? PETSC_ERR_MEM : PETSC_ERR_LIB;
}

/* A viewer that holds the file open must not stop the run: no locking.  Closing a file closes everything in it. */
static PetscErrorCode Access(hid_t *access)
{
  PetscFunctionBeginUser;
  H5Check(H5Eset_auto2(H5E_DEFAULT, Note, NULL));
  H5Check(*access = H5Pcreate(H5P_FILE_ACCESS));
  H5Check(H5Pset_fclose_degree(*access, H5F_CLOSE_STRONG));
  H5Check(H5Pset_file_locking(*access, 0, 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(const char *name, hsize_t user_block, hid_t access, hid_t *file)
{
  hid_t create;

  PetscFunctionBeginUser;
  H5Check(create = H5Pcreate(H5P_FILE_CREATE));
  H5Check(H5Pset_istore_k(create, CHUNK_LISTS));
  if (user_block > 0)
    H5Check(H5Pset_userblock(create, user_block));
  H5Check(*file = H5Fcreate(name, H5F_ACC_TRUNC, create, access));
  H5Check(H5Pclose(create));
  H5Check(H5Pclose(access));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5ImageCreate(hsize_t user_block, hid_t *file)
{
  hid_t access;

  PetscFunctionBeginUser;
  PetscCall(Access(&access));
  H5Check(H5Pset_fapl_core(access, GROW, 0));
  PetscCall(Create("image", user_block, access, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5SharedCreate(MPI_Comm comm, const char *path, hsize_t user_block, hid_t *file)
{
  hid_t access;

  PetscFunctionBeginUser;
  PetscCall(Access(&access));
  H5Check(H5Pset_fapl_mpio(access, comm, MPI_INFO_NULL));
  H5Check(H5Pset_coll_metadata_write(access, 1));
  PetscCall(Create(path, user_block, access, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5ImageBytes(hid_t image, IoPiece *piece)
{
  void   *handle;
  hid_t   create;
  hsize_t block;
  ssize_t bytes; /* that are used behind the user block; room is taken in steps of GROW */

  PetscFunctionBeginUser;
  H5Check(H5Fflush(image, H5F_SCOPE_GLOBAL));
  H5Check(bytes = H5Fget_file_image(image, NULL, 0));
  H5Check(create = H5Fget_create_plist(image));
  H5Check(H5Pget_userblock(create, &block));
  H5Check(H5Pclose(create));
  H5Check(H5Fget_vfd_handle(image, H5P_DEFAULT, &handle));
  piece->data  = *(void **)handle;
  piece->bytes = (size_t)block + (size_t)bytes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5FileOpen(const char *path, hid_t *file)
{
  hid_t access;

  PetscFunctionBeginUser;
  PetscCall(Access(&access));
  H5E_BEGIN_TRY
  {
    *file = H5Fopen(path, H5F_ACC_RDONLY, access);
  }
  H5E_END_TRY
  H5Check(H5Pclose(access));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5FileClose(hid_t *file)
{
  PetscFunctionBeginUser;
  if (*file >= 0)
    H5Check(H5Fclose(*file));
  *file = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5Group(hid_t file, const char *path, hid_t *group)
{
  hid_t link;

  PetscFunctionBeginUser;
  H5Check(link = H5Pcreate(H5P_LINK_CREATE));
  H5Check(H5Pset_create_intermediate_group(link, 1));
  H5Check(*group = H5Gcreate2(file, path, link, H5P_DEFAULT, H5P_DEFAULT));
  H5Check(H5Pclose(link));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is kept for readers has a checksum in every chunk, which HDF5 checks for whoever reads it. */
static PetscErrorCode Layout(hid_t type, const H5Part *part, int nc, bool keep, hid_t *create)
{
  hsize_t       chunk[CL_DIM + 1] = {0}, bytes = H5Tget_size(type) * (hsize_t)nc;
  const hsize_t most = part->nd > 1 ? CHUNK_NODES : CHUNK_ROWS;

  PetscFunctionBeginUser;
  H5Check(*create = H5Pcreate(H5P_DATASET_CREATE));
  for (int d = 0; d < part->nd; d++) {
    bytes *= part->all[d];
    chunk[d] = part->all[d] > most ? most : part->all[d];
  }
  chunk[part->nd] = (hsize_t)nc;
  if (keep && bytes > 0) {
    H5Check(H5Pset_chunk(*create, part->nd + (nc > 1), chunk));
    if (bytes >= COMPRESS_FROM && H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0) {
      H5Check(H5Pset_shuffle(*create));
      H5Check(H5Pset_deflate(*create, 4));
    }
    H5Check(H5Pset_fletcher32(*create));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

size_t H5Room(const H5Part *part, int n, int components)
{
  const hsize_t most = part->nd > 1 ? CHUNK_NODES : CHUNK_ROWS;
  size_t        all  = sizeof(double) * (size_t)components;

  for (int d = 0; d < part->nd; d++)
    all *= part->all[d] > most ? (part->all[d] / most + 1) * most : part->all[d];
  return all + 4096 * (size_t)n;
}

/* Of memory and of the file; nothing of either where this rank has no part. */
static PetscErrorCode Spaces(const H5Part *part, int nc, hid_t *memory, hid_t *space)
{
  hsize_t all[CL_DIM + 1], start[CL_DIM + 1] = {0}, count[CL_DIM + 1], here = 1;

  PetscFunctionBeginUser;
  all[part->nd] = count[part->nd] = (hsize_t)nc;
  for (int d = 0; d < part->nd; d++) {
    all[d]   = part->all[d];
    start[d] = part->start[d];
    count[d] = part->count[d];
    here *= count[d];
  }
  H5Check(*space = H5Screate_simple(part->nd + (nc > 1), all, NULL));
  H5Check(*memory = H5Screate_simple(part->nd + (nc > 1), count, NULL));
  if (here > 0)
    H5Check(H5Sselect_hyperslab(*space, H5S_SELECT_SET, start, NULL, count, NULL));
  else {
    H5Check(H5Sselect_none(*space));
    H5Check(H5Sselect_none(*memory));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Was the file opened by several ranks? */
static PetscErrorCode Shared(hid_t where, bool *shared)
{
  hid_t file, access;

  PetscFunctionBeginUser;
  H5Check(file = H5Iget_file_id(where));
  H5Check(access = H5Fget_access_plist(file));
  *shared = H5Pget_driver(access) == H5FD_MPIO;
  H5Check(H5Pclose(access));
  H5Check(H5Fclose(file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Transfer(hid_t where, hid_t *transfer)
{
  bool shared;

  PetscFunctionBeginUser;
  PetscCall(Shared(where, &shared));
  H5Check(*transfer = H5Pcreate(H5P_DATASET_XFER));
  if (shared)
    H5Check(H5Pset_dxpl_mpio(*transfer, H5FD_MPIO_COLLECTIVE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5WritePart(hid_t where, const char *name, const H5Part *part, const H5Values *values, bool keep)
{
  hid_t memory, space, create, transfer = H5P_DEFAULT, set;

  PetscFunctionBeginUser;
  PetscCall(Layout(values->type, part, values->nc, keep, &create));
  PetscCall(Spaces(part, values->nc, &memory, &space));
  PetscCall(Transfer(where, &transfer));
  H5Check(set = H5Dcreate2(where, name, values->type, space, H5P_DEFAULT, create, H5P_DEFAULT));
  H5Check(H5Dwrite(set, values->type, memory, space, transfer, values->data));
  if (values->unit)
    PetscCall(H5WriteText(set, "unit", values->unit));
  H5Check(H5Dclose(set));
  H5Check(H5Pclose(transfer));
  H5Check(H5Sclose(space));
  H5Check(H5Sclose(memory));
  H5Check(H5Pclose(create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5Write(hid_t where, const char *name, hid_t type, hsize_t n, const void *data, const char *unit)
{
  H5Part      part = {.nd = 1, .all = {n}, .count = {n}};
  PetscMPIInt rank;
  bool        shared;

  PetscFunctionBeginUser;
  PetscCall(Shared(where, &shared));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  if (shared && rank > 0)
    part.count[0] = 0;
  PetscCall(H5WritePart(where, name, &part, &(H5Values){type, 1, data, unit}, false));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteAttribute(hid_t where, const char *attribute, hid_t type, const void *value)
{
  hid_t space, a;

  PetscFunctionBeginUser;
  H5Check(space = H5Screate(H5S_SCALAR));
  H5Check(a = H5Acreate2(where, attribute, type, space, H5P_DEFAULT, H5P_DEFAULT));
  H5Check(H5Awrite(a, type, value));
  H5Check(H5Aclose(a));
  H5Check(H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5WriteReal(hid_t where, const char *attribute, double value)
{
  PetscFunctionBeginUser;
  PetscCall(WriteAttribute(where, attribute, H5T_NATIVE_DOUBLE, &value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5WriteInt(hid_t where, const char *attribute, PetscInt value)
{
  PetscFunctionBeginUser;
  PetscCall(WriteAttribute(where, attribute, H5_INT, &value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5WriteText(hid_t where, const char *attribute, const char *value)
{
  hid_t type;

  PetscFunctionBeginUser;
  H5Check(type = H5Tcopy(H5T_C_S1));
  H5Check(H5Tset_size(type, strlen(value) + 1));
  H5Check(H5Tset_cset(type, H5T_CSET_UTF8));
  PetscCall(WriteAttribute(where, attribute, type, value));
  H5Check(H5Tclose(type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static bool ReadAttribute(hid_t where, const char *attribute, hid_t type, void *value)
{
  bool ok = false;

  H5E_BEGIN_TRY
  {
    const hid_t a = H5Aopen(where, attribute, H5P_DEFAULT), space = a >= 0 ? H5Aget_space(a) : -1;

    ok = space >= 0 && H5Sget_simple_extent_npoints(space) == 1 && H5Aread(a, type, value) >= 0;
    if (space >= 0)
      H5Sclose(space);
    if (a >= 0)
      H5Aclose(a);
  }
  H5E_END_TRY
  return ok;
}

bool H5ReadReal(hid_t where, const char *attribute, double *value)
{
  return ReadAttribute(where, attribute, H5T_NATIVE_DOUBLE, value);
}

bool H5ReadInt(hid_t where, const char *attribute, PetscInt *value)
{
  return ReadAttribute(where, attribute, H5_INT, value);
}

/* Dimensions of an open dataset; 0 if it has more than two. */
static int Shape(hid_t set, hsize_t dims[2])
{
  const hid_t space = H5Dget_space(set);
  const int   nd    = H5Sget_simple_extent_ndims(space);
  const bool  ok    = nd >= 1 && nd <= 2 && H5Sget_simple_extent_dims(space, dims, NULL) == nd;

  H5Sclose(space);
  return ok ? nd : 0;
}

bool H5ReadPart(hid_t where, const char *name, hid_t type, const H5Part *part, int nc, void *data)
{
  const int nd = part->nd + (nc > 1);
  bool      ok = false;

  H5E_BEGIN_TRY
  {
    const hid_t set    = H5Dopen2(where, name, H5P_DEFAULT);
    hsize_t     has[2] = {0, 0};

    if (set >= 0) {
      const hid_t stored = H5Dget_type(set);
      hid_t       memory = -1, space = -1;

      ok = Shape(set, has) == nd && H5Tget_class(stored) == H5Tget_class(type) && has[0] == part->all[0] &&
           (nd == 1 || has[1] == (hsize_t)nc);
      ok = ok && Spaces(part, nc, &memory, &space) == PETSC_SUCCESS &&
           H5Dread(set, type, memory, space, H5P_DEFAULT, data) >= 0;
      H5Sclose(memory);
      H5Sclose(space);
      H5Tclose(stored);
      H5Dclose(set);
    }
  }
  H5E_END_TRY
  return ok;
}

bool H5Read(hid_t where, const char *name, hid_t type, hsize_t n, void *data)
{
  return H5ReadPart(where, name, type, &(H5Part){.nd = 1, .all = {n}, .count = {n}}, 1, data);
}

bool H5Rows(hid_t where, const char *name, hsize_t *rows)
{
  bool ok = false;

  H5E_BEGIN_TRY
  {
    const hid_t set    = H5Dopen2(where, name, H5P_DEFAULT);
    hsize_t     has[2] = {0, 0};

    if (set >= 0) {
      ok    = Shape(set, has) > 0;
      *rows = has[0];
      H5Dclose(set);
    }
  }
  H5E_END_TRY
  return ok;
}
