/* Who factorises. */
#include "solver.h"

/* UMFPACK with its solves beats MUMPS only on small problems: 0.8 against 2.4 ms a factorisation of a strip of 500
   unknowns, 58 against 30 ms of a block of 3400. */
#define UMFPACK_MOST 2500

bool FactorsSmall(const Model *m, int n)
{
  return m->grid.size == 1 && m->map.n_global * n <= UMFPACK_MOST;
}

MatSolverType FactorsPackage(const Model *m, int n)
{
  return FactorsSmall(m, n) ? MATSOLVERUMFPACK : MATSOLVERMUMPS;
}
