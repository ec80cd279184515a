/* Between the second and the third pass: what the particles take up of each balance (37) with the increments that their
   nodes have so far, (413); the heat capacity aside, which is a node's own. */
#include "gains.h"

/* Of the masses, by their slopes. */
INLINE void StoredMasses(const Explicit *e, const Set s, Run r, const Gathered *g, Given *o)
{
  for (int k = 0; k < s.fluids; k++) {
    for (int i = 0; i < Scalars(s); i++) {
      const double *restrict slope = e->t[T_SLOPE + 3 * k + (i < s.fluids ? i : 2)] + r.p;

      for (int q = 0; q < r.n; q++)
        o->value[q][k] += slope[q] * g->value[q][i];
    }
    for (int q = 0; q < r.n && s.heat && e->m->c->compression_heat; q++) /* compression (290) */
      o->value[q][s.fluids] -= e->t[T_WARM + k][r.p + q] * g->value[q][k];
  }
}

/* Of all rows, by what the increments make of the gain of hydrate. */
INLINE void StoredGain(const Explicit *e, const Set s, Run r, const Gathered *g, Given *o)
{
  const double *T = s.heat ? e->m->P.f[P_T] + r.p : e->t[T_T] + r.p;
  double        c[3][BLOCK], rho_h[BLOCK], zero[BLOCK] = {0.0};

  LiquidDensityBatch(&r.mat->hydrate, r.n, zero, T, rho_h);
  PerGain(e, s, r, T, rho_h, c);
  for (int q = 0; q < r.n; q++) {
    const PetscInt p    = r.p + q;
    const double   gain = e->t[T_GAIN_W][p] * g->value[q][0] + e->t[T_GAIN_G][p] * g->value[q][1] +
                        (s.heat ? e->t[T_GAIN_T][p] * g->value[q][2] : 0.0);

    for (int row = 0; row < Scalars(s); row++)
      o->value[q][row] += c[row][q] * gain;
  }
}

INLINE void StoredRun(Explicit *e, const Set s, Run r, double dt)
{
  _Alignas(64) Gathered g;
  _Alignas(64) Given    o;
  Weights               w;

  (void)dt;
  WeightsOf(e, r, &w);
  Gather(e, e->C, Rows(C_Count(s)), 0, r, &w, &g);
  GiveNothing(r, Scalars(s), 0, &o);
  for (int q = 0; q < r.n; q++)
    memset(o.value[q], 0, sizeof(Lanes));
  for (int q = 0; q < r.n && Relative(e, s); q++) {
    const double y[2] = {g.value[q][0], g.value[q][1]};

    PressuresOf(e->m->P.f[P_PG][r.p + q], y, g.value[q]);
  }
  StoredMasses(e, s, r, &g, &o);
  if (s.fluids == 2 && r.mat->reacts)
    StoredGain(e, s, r, &g, &o);
  Scatter(e, e->given, Scalars(s), CARRY_NOTHING, 0, false, r, &w, &o);
}

MAKE_LOOPS(StoredRun)

void Stored(Explicit *e)
{
  ForRuns(e, StoredRun_loops, 0.0);
}
