/* Rows of the tables of a run, printed into memory and then written at once. */
#include "io_private.h"
#include <stdlib.h>

const char *const cl_table_name[TABLE_COUNT] = {
    [TABLE_PROBES] = "probes.csv", [TABLE_BALANCE] = "balance.csv", [TABLE_METERS] = "meters.csv"};

PetscErrorCode RowBegin(Output *out, FILE **f)
{
  PetscFunctionBeginUser;
  *f = out->row = open_memstream(&out->text, &out->size);
  PetscCheck(*f, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RowKeep(Output *out)
{
  PetscFunctionBeginUser;
  PetscCheck(fclose(out->row) == 0, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RowEnd(Output *out, TableId id)
{
  char path[IO_PATH];

  PetscFunctionBeginUser;
  PetscCall(RowKeep(out));
  PetscCall(IoPath(out->dir, cl_table_name[id], path));
  if (!out->failed)
    out->failed = !IoAppend(out->fd[id], path, out->text, out->size);
  free(out->text);
  PetscFunctionReturn(PETSC_SUCCESS);
}
