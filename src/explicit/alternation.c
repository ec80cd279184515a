/* Where T alternates from node to node, so that its heat is carried with the flow (440). */
#include "clathra/point_heat.h"
#include "nodes.h"

/* (440) of T at t_n; heat is carried the way of the fluids' capacities, of which one material speaks for all. */
PetscErrorCode HeatAlternation(Explicit *e)
{
  const Set       s     = e->set;
  const Material *mat   = &e->m->c->material[0];
  const int       width = LANES * Rows(B_Count(s));
  const PetscInt  n     = e->map.n_local;
  double         *T, *flow, dp, dT;

  PetscFunctionBeginUser;
  if (!e->alternates)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(n, &T, n * CL_DIM, &flow));
  for (PetscInt I = 0; I < n; I++) {
    const double *b = &e->B[I * width];

    T[I] = Volume(e, s, I) > 0.0 ? b[B_T(s)] : INFINITY;
    for (int k = 0; k < s.fluids && isfinite(T[I]); k++) {
      const double rho = k == PHASE_W ? mat->water.rho0 : GasDensity(&mat->gas, b[B_P(s, k)], T[I], &dp, &dT);

      for (int d = 0; d < CL_DIM; d++)
        flow[I * CL_DIM + d] += SpecificHeat(mat, k) * rho * b[B_Fluid(s, k) + B_J + d];
    }
  }
  PetscCall(NodeMapAlternation(&e->m->grid, &e->map, &(NodalField){T, flow, HEAT_LEAST_T, false}, e->alternates));
  PetscCall(PetscFree2(T, flow));
  PetscFunctionReturn(PETSC_SUCCESS);
}
