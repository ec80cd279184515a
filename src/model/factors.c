/* Who factorises. */
#include "solver.h"

/* UMFPACK's factorisation beats MUMPS only on small problems: 3.3 against 3.9 ms for a strip of 900 unknowns, 4.1
   against 0.36 s for a block of 10,000. */
#define UMFPACK_MOST 4000

bool FactorsSmall(const Model *m, int n)
{
  return m->grid.size == 1 && m->map.n_global * n <= UMFPACK_MOST;
}

MatSolverType FactorsPackage(const Model *m, int n)
{
  return FactorsSmall(m, n) ? MATSOLVERUMFPACK : MATSOLVERMUMPS;
}
