/* Shared by the unit tests that run with PETSc: checks that end all ranks, and what main() does.  Include after
   cmocka.h and PETSc. */
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

/* Runs tests with PETSc; returns what main() should: the number of tests that failed, 1 where PETSc does not start or
   end.  setup, teardown: before and after all of them, or NULL. */
static inline int RunWithPetsc(int argc, char **argv, const char *group, const struct CMUnitTest *test, size_t n,
                               CMFixtureFunction setup, CMFixtureFunction teardown)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL) || MPI_Comm_rank(PETSC_COMM_WORLD, &world_rank) ||
      MPI_Comm_size(PETSC_COMM_WORLD, &world_size))
    return 1;
  const int failed = _cmocka_run_group_tests(group, test, n, setup, teardown);
  return PetscFinalize() ? 1 : failed;
}
#define RunTests(argc, argv, tests, setup, teardown)                                                                   \
  RunWithPetsc(argc, argv, #tests, tests, sizeof(tests) / sizeof *(tests), setup, teardown)
