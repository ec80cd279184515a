/* Between the second and the third pass: what particles store of the increments that their nodes have, where it is not
   what lumped storage (37) says; (413). */
#include "gathered.h"

INLINE void StoredRun(Explicit *e, const Set s, Run r, double dt)
{
  _Alignas(64) Gathered g;
  _Alignas(64) Given    o;
  Weights               w;
  const int             n    = s.fluids;
  double                most = 0.0;

  (void)dt;
  for (int q = 0; q < r.n; q++)
    most = Largest(most, e->t[T_CONSISTENT][r.p + q]);
  if (most == 0.0)
    return;
  WeightsOf(e, r, &w);
  Gather(e, e->C, Rows(C_Count(s)), 0, r, &w, &g);
  GiveNothing(r, Stored_Count(s), 0, &o);
  for (int q = 0; q < r.n; q++) {
    const PetscInt p = r.p + q;

    for (int k = 0; k < n; k++) {
      double *a = &o.value[q][Stored_Matrix(s) + k * n];

      for (int j = 0; j < n; j++)
        a[j] = e->t[T_CONSISTENT][p] * e->t[T_SLOPE + 3 * k + j][p];
      if (Relative(e, s))
        a[1] = RelativeColumn(a, e->m->P.f[P_PG][p]);
      o.value[q][k] = 0.0;
      for (int j = 0; j < n; j++)
        o.value[q][k] += a[j] * g.value[q][j];
    }
  }
  Scatter(e, e->given, Stored_Count(s), CARRY_NOTHING, 0, false, r, &w, &o);
}

MAKE_LOOPS(StoredRun)

void Stored(Explicit *e)
{
  ForRuns(e, StoredRun_loops, 0.0);
}
