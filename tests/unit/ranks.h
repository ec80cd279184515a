/* Shared by the unit tests that run on several ranks: checks that end all of them.  Include after cmocka.h and PETSc.
 */
#pragma once

#include <stdio.h>

static PetscMPIInt world_rank, world_size;

/* A rank that fails must not leave the others waiting. */
#define Check(condition)                                                                                               \
  do {                                                                                                                 \
    if (!(condition)) {                                                                                                \
      fprintf(stderr, "%s:%d: rank %d: failed: %s\n", __FILE__, __LINE__, world_rank, #condition);                     \
      if (world_size > 1)                                                                                              \
        MPI_Abort(MPI_COMM_WORLD, 1);                                                                                  \
      fail();                                                                                                          \
    }                                                                                                                  \
  } while (0)
#define Call(expr) Check((expr) == 0)
