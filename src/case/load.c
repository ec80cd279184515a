/* load: the case file into a reader. */
#include "case_private.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A case may be given as a folder. */
static PetscErrorCode FilePath(Reader *r, const char *path)
{
  struct stat info;
  size_t      len;

  PetscFunctionBeginUser;
  snprintf(r->file, sizeof r->file, "%.*s", (int)sizeof r->file - 16, path);
  if (r->rank == 0 && !stat(r->file, &info) && S_ISDIR(info.st_mode)) {
    len = strlen(r->file);
    while (len > 1 && r->file[len - 1] == '/')
      r->file[--len] = 0;
    snprintf(r->file + len, sizeof r->file - len, "/case.yaml");
  }
  PetscCallMPI(MPI_Bcast(r->file, sizeof r->file, MPI_CHAR, 0, r->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReaderLoad(Reader *r, const char *path)
{
  char *text, why[CASE_WHY];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(r->comm, &r->rank));
  PetscCall(FilePath(r, path));
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
