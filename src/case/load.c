/* load: the case file into a reader. */
#include "case_private.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

void CaseFile(const char *given, char *file, size_t size)
{
  struct stat info;

  snprintf(file, size, "%.*s", (int)size - 16, given);
  if (!stat(file, &info) && S_ISDIR(info.st_mode)) {
    size_t len = strlen(file);

    while (len > 1 && file[len - 1] == '/')
      file[--len] = 0;
    snprintf(file + len, size - len, "/case.yaml");
  }
}

PetscErrorCode ReaderLoad(Reader *r, const char *path)
{
  char *text, why[CASE_WHY];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(r->comm, &r->rank));
  if (r->rank == 0)
    CaseFile(path, r->file, sizeof r->file);
  PetscCallMPI(MPI_Bcast(r->file, sizeof r->file, MPI_CHAR, 0, r->comm));
  PetscCall(ReaderText(r, r->file, &text, why));
  if (!text) {
    ReaderError(r, NULL, NULL, "%s", why);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  ReaderParse(r, text);
  free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReaderDestroy(Reader *r)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < r->nentry; i++) {
    free(r->entry[i].name);
    free(r->entry[i].value);
  }
  for (PetscInt i = 0; i < PetscMin(r->nerror, CASE_ERRORS); i++)
    free(r->error[i]);
  free(r->entry);
  PetscCall(LikeDestroy(r));
  memset(r, 0, sizeof *r);
  PetscFunctionReturn(PETSC_SUCCESS);
}
