/* First pass: masses, momenta, forces, pressures and temperature of the particles to their nodes; docs/equations.md,
 * section 12. */
#include "clathra/laws_batch.h"
#include "clathra/tensor.h"
#include "gathered.h"

typedef struct {
  double phi[BLOCK], Sh[BLOCK], open[BLOCK], sw[BLOCK], rho[PHASE_COUNT][BLOCK], p[BLOCK];
  double resist[PHASE_COUNT][BLOCK], kr[PHASE_COUNT][BLOCK]; /* mu/k_a, k_r */
} Fluids;

/* (323): where no pressure of water sets it, the density of the gas in the pores. */
static void FlowingGas(const Material *mat, int n, const double *pw, const double *pg, const double *T,
                       const double *restrict held, double *restrict rho)
{
  double p[BLOCK], slope[2][BLOCK];
  bool   by_water = false;

  for (int q = 0; q < n; q++) {
    const bool here = GasFlowsByWater(mat->gas.trace, pw[q], pg[q]);

    p[q]   = here ? CL_GAS_FLOWS * pw[q] : pg[q];
    rho[q] = held[q];
    by_water |= here;
  }
  if (by_water)
    GasDensityBatch(&mat->gas, n, p, T, rho, slope[0], slope[1]);
}

/* Shares, densities and drags at t_n (8)-(10), (16). */
INLINE void State(Explicit *e, const Set s, Run r, const double *restrict T, Fluids *w)
{
  const Material *mat      = r.mat;
  double *const  *f        = e->m->P.f;
  const double *restrict V = f[P_V] + r.p, *restrict ms = f[P_MS] + r.p, *restrict mh = f[P_MH] + r.p;
  double rho_s[BLOCK], rho_h[BLOCK], zero[BLOCK]                                      = {0.0}, ka[BLOCK], mu[BLOCK];

  LiquidDensityBatch(&mat->solid, r.n, zero, T, rho_s);
  LiquidDensityBatch(&mat->hydrate, r.n, zero, T, rho_h);
  for (int q = 0; q < r.n; q++) {
    const Pores v = PoresOf(V[q], ms[q], rho_s[q], mh[q], rho_h[q]);

    w->phi[q]  = v.phi;
    w->Sh[q]   = v.Sh;
    w->open[q] = v.open;
    w->sw[q]   = s.fluids ? 1.0 : 0.0;
    w->p[q]    = 0.0;
  }
  if (!s.fluids)
    return;
  const double *restrict pw = f[P_PW] + r.p;
  double *restrict sg = e->t[T_SG] + r.p, *restrict ds = e->t[T_DS] + r.p;

  LiquidDensityBatch(&mat->water, r.n, pw, T, w->rho[PHASE_W]);
  PermeabilityBatch(&mat->permeability, r.n, w->phi, w->Sh, ka);
  WaterViscosityBatch(&mat->mu_w, r.n, T, mu);
  for (int q = 0; s.layers && q < r.n; q++)
    e->t[T_CONDUCT][r.p + q] = SceneConductance(e->m->c, mat, w->Sh[q]);
  for (int q = 0; q < r.n; q++) {
    w->p[q]               = pw[q];
    w->resist[PHASE_W][q] = mu[q] / ka[q];
    w->kr[PHASE_W][q]     = 1.0;
  }
  if (s.fluids == 2) {
    const double *restrict pg = f[P_PG] + r.p;
    const bool of_pores       = mat->relperm.of_pores;
    double     pc[BLOCK], x[PHASE_COUNT][BLOCK];

    for (int q = 0; q < r.n; q++)
      pc[q] = pg[q] - pw[q];
    RetentionGasShareBatch(&mat->retention, r.n, pc, w->Sh, sg, ds);
    GasDensityBatch(&mat->gas, r.n, pg, T, e->t[T_HELD] + r.p, e->t[T_GAS] + r.p, e->t[T_GAS + 1] + r.p);
    FlowingGas(mat, r.n, pw, pg, T, e->t[T_HELD] + r.p, w->rho[PHASE_G]);
    for (int q = 0; q < r.n; q++) {
      w->sw[q]      = 1.0 - sg[q];
      w->p[q]       = PorePressureOf(sg[q], pw[q], pg[q]).v;
      x[PHASE_W][q] = KrArgumentOf(of_pores, w->sw[q], w->Sh[q]).v;
      x[PHASE_G][q] = KrArgumentOf(of_pores, sg[q], w->Sh[q]).v;
    }
    RelPermWaterBatch(&mat->relperm, r.n, x[PHASE_W], w->kr[PHASE_W]);
    RelPermGasBatch(&mat->relperm, r.n, x[PHASE_G], w->kr[PHASE_G]);
    for (int k = 0; k < PHASE_COUNT; k++) {
      for (int q = 0; q < r.n; q++)
        w->kr[k][q] = KrFloored(w->kr[k][q]);
    }
    GasViscosityBatch(&mat->mu_g, r.n, w->rho[PHASE_G], T, mu);
    for (int q = 0; q < r.n; q++)
      w->resist[PHASE_G][q] = mu[q] / ka[q];
  }
  for (int k = 0; k < s.fluids; k++) {
    double *restrict rho = e->t[T_RHO + k] + r.p, *restrict drag = e->t[T_DRAG + k] + r.p;

    for (int q = 0; q < r.n; q++) {
      rho[q]  = w->rho[k][q];
      drag[q] = w->resist[k][q] / w->kr[k][q];
    }
  }
}

/* What a particle counts in the pressures of its nodes (449). */
INLINE void Stores(const Explicit *e, const Set s, Run r, const Fluids *w, double stores[BLOCK])
{
  const double *restrict V = e->m->P.f[P_V] + r.p;
  const double compliance  = Largest(1.0 / r.mat->water.K, CL_LEAST_COMPLIANCE);

  for (int q = 0; q < r.n; q++)
    stores[q] = s.fluids == 2 ? V[q] : V[q] * w->open[q] * compliance;
}

/* Of particle q from the first node of its patch along d, m: S_1 + third S_2 units on (weights reproduce the middle).
 */
INLINE double FromFirst(const Weights *w, int d, int q)
{
  return (w->S[d][1][q] + w->third[d][q] * w->S[d][2][q]) * w->unit[d][q];
}

/* V (p + g . (x_I - x_p)) at the lowest left node of the patch, and its growth from node to node (2). */
INLINE void Carried(Run r, int lane, const double *restrict weight, const double *restrict y,
                    const double *const g[CL_DIM], const Weights *w, Given *v)
{
  for (int q = 0; q < r.n; q++) {
    double at = y[q];

    for (int d = 0; d < CL_DIM; d++) {
      at -= g[d][q] * FromFirst(w, d, q);
      v->carry[d][q][lane] = weight[q] * g[d][q] * w->unit[d][q];
    }
    v->value[q][lane] = weight[q] * at;
  }
}

/* Likewise V b (x_I - x_p) (y_I - y_p) (395) for a pair c of axes x, y, on top of that. */
INLINE void CarriedCross(Run r, int lane, const double *restrict weight, const double *restrict b, int c,
                         const Weights *w, Given *v)
{
  const int i = cl_pair[c][0], j = cl_pair[c][1];

  for (int q = 0; q < r.n; q++) {
    const double more = weight[q] * b[q], x = FromFirst(w, i, q), y = FromFirst(w, j, q);

    v->value[q][lane] += more * x * y;
    v->carry[i][q][lane] -= more * y * w->unit[i][q];
    v->carry[j][q][lane] -= more * x * w->unit[j][q];
    v->cross[c][q][lane] = more * w->unit[i][q] * w->unit[j][q];
  }
}

/* Likewise with mixed derivative c, of all axes of space (446). */
INLINE void CarriedAll(Run r, int lane, const double *restrict weight, const double *restrict b, int c,
                       const Weights *w, Given *v)
{
  for (int q = 0; q < r.n; q++) {
    const double more = weight[q] * b[q];
    double       from[CL_DIM], unit[CL_DIM];

    for (int d = 0; d < CL_DIM; d++) {
      from[d] = -FromFirst(w, d, q);
      unit[d] = w->unit[d][q];
    }
    v->value[q][lane] += MixedProduct(c, more, from);
    for (int d = 0; d < CL_DIM; d++)
      v->carry[d][q][lane] += more * unit[d] * from[(d + 1) % CL_DIM] * from[(d + 2) % CL_DIM];
    for (int k = 0; k < CL_PAIRS; k++)
      v->cross[k][q][lane] += MixedProduct(k, more, unit) * from[CL_DIM - cl_pair[k][0] - cl_pair[k][1]];
    v->cross[c][q][lane] = MixedProduct(c, more, unit);
  }
}

/* (42): ambient pressure and V times its gradient at the particles of a block. */
typedef struct {
  double p[BLOCK], weight[CL_DIM][BLOCK];
} Around;

INLINE void AmbientAt(const Explicit *e, Run r, Around *a)
{
  const Ambient *ambient = &e->m->bc.ambient;
  double *const *f       = e->m->P.f;

  for (int q = 0; q < r.n; q++) {
    a->p[q] = 0.0;
    for (int d = 0; d < CL_DIM; d++)
      a->weight[d][q] = 0.0;
  }
  for (int q = 0; ambient->on && q < r.n; q++) {
    double x[CL_DIM], g[CL_DIM];

    ParticlePlace(&e->m->P, r.p + q, x);
    a->p[q] = AmbientPressure(ambient, x, g);
    for (int d = 0; d < CL_DIM; d++)
      a->weight[d][q] = f[P_V][r.p + q] * g[d];
  }
}

INLINE void MixtureValues(const Explicit *e, const Set s, Run r, const Fluids *w, Given *v)
{
  double *const *f = e->m->P.f;
  Around         a;
  const int      at        = A_Force(s);
  const double *restrict V = f[P_V] + r.p, *restrict ms = f[P_MS] + r.p, *restrict mh = f[P_MH] + r.p;
  double *const *sig = f + P_SIG;

  AmbientAt(e, r, &a);
  for (int q = 0; q < r.n; q++) {
    const double m = ms[q] + mh[q], p = w->p[q] - a.p[q];

    v->value[q][A_M(s)] = m;
    v->across[q]        = CL_DIM == 2 ? -V[q] * (sig[ZZ][r.p + q] - p) : 0.0;
    for (int i = 0; i < CL_DIM; i++) {
      v->value[q][at + i] = -a.weight[i][q];
      for (int j = 0; j < CL_DIM; j++)
        v->force[j][q][at + i] = -V[q] * (sig[voigt[i][j]][r.p + q] - (i == j ? p : 0.0));
    }
  }
}

INLINE void FluidValues(const Explicit *e, const Set s, Run r, int k, const Fluids *w, Given *v)
{
  double *const *f  = e->m->P.f;
  const int      at = A_Fluid(s, k), grad = VectorAt(P_GW, k, 0);
  const double *restrict V = f[P_V] + r.p, *restrict m = f[P_MW + k] + r.p;

  for (int q = 0; q < r.n; q++) {
    const double share = k ? 1.0 - w->sw[q] : w->sw[q], mass = Largest(m[q], 0.0); /* a trace may be none (101) */
    const double conduct = Conductance(e, s, r.p + q), Vk = V[q] * conduct;

    double g[CL_DIM];

    v->value[q][at + FL_M] = mass;
    for (int d = 0; d < CL_DIM; d++)
      g[d] = f[grad + d][r.p + q];
    Unweighed(e, s, w->rho[k][q], g);
    Drive(e, s, r.p + q, g);
    for (int d = 0; d < CL_DIM; d++)
      v->value[q][at + FL_G + d] = -Vk * g[d];
    v->value[q][at + FL_MI]   = Vk * w->rho[k][q];
    v->value[q][at + FL_DRAG] = Vk * w->resist[k][q];
    v->value[q][at + FL_W]    = w->open[q] * share;
    if (s.fluids == 2)
      v->value[q][at + FL_ROOT] = Vk * sqrt(w->kr[k][q]);
    if (s.layers)
      v->value[q][at + FL_Inertia(s)] = conduct * Vk * w->rho[k][q];
  }
}

/* Momenta, carried by the skeleton's velocity gradient (451). */
INLINE void Momenta(const Explicit *e, const Set s, Run r, const Weights *w, Given *v)
{
  double *const *f = e->m->P.f;
  double         m[BLOCK];

  for (int phase = s.solid ? 0 : 1; phase <= s.fluids; phase++) {
    for (int q = 0; q < r.n; q++)
      m[q] = phase ? Largest(f[P_MW + phase - 1][r.p + q], 0.0) : f[P_MS][r.p + q] + f[P_MH][r.p + q];
    for (int i = 0; i < CL_DIM; i++) {
      const int     lane = A_Momentum(s, phase) + i;
      const double *y    = f[VectorAt(P_VS, phase, i)] + r.p, *g[CL_DIM];

      for (int d = 0; s.solid && d < CL_DIM; d++)
        g[d] = f[VectorAt(P_GV, i, d)] + r.p;
      if (s.solid)
        Carried(r, lane, m, y, g, w, v);
      for (int q = 0; !s.solid && q < r.n; q++)
        v->value[q][lane] = m[q] * y[q];
    }
  }
}

/* Permeability of bedding planes (306). */
INLINE void BedsValues(const Explicit *e, const Set s, Run r, Given *v)
{
  for (int q = 0; s.layers && q < r.n; q++) {
    const PetscInt p  = r.p + q;
    const double   Vk = e->m->P.f[P_V][p] * Conductance(e, s, p);

    for (int k = 0; k < CL_SYMMETRIC; k++)
      v->value[q][A_Beds(s) + k] = Vk * e->beds[p].A[k];
  }
}

/* (88), (160): part of the stress acts through the mean motion of the particle's cells. */
INLINE void CellForces(Explicit *e, const Set s, Run r, const Weights *w, Given *v)
{
  const CellShare take = CellShareOf(e);
  const int       at   = A_Force(s);

  for (int q = 0; q < r.n; q++) {
    const double V    = e->m->P.f[P_V][r.p + q];
    double       more = v->across[q], share[CL_DIM][CL_DIM];
    AxisParts    part[CL_DIM];

    for (int i = 0; i < CL_DIM; i++)
      more += v->force[i][q][at + i];
    more *= take.volume;
    PartsOf(w, q, part);
    for (int i = 0; i < CL_DIM; i++) {
      for (int j = 0; j < CL_DIM; j++) {
        share[i][j] = take.strain * v->force[j][q][at + i];
        v->force[j][q][at + i] -= (share[i][j] + (i == j ? more : 0.0)) / part[j].whole;
      }
    }
    for (int c = 0; c < CL_CORNERS; c++) {
      const double weight = PartMoment(part, c, 0);

      if (!(weight > 0.0))
        continue;
      const int row = e->slot[w->first[q] + CornerAt(e, c)];
      double   *sum = &e->cell[row * CELL_MEAN];
      for (int k = 0; k < CELL_PRESSURE; k++)
        sum[k] += V * PartMoment(part, c, k);
      sum[CELL_PRESSURE] += weight * more;
      for (int i = 0; take.strain > 0.0 && i < CL_DIM; i++) {
        for (int j = 0; j < CL_DIM; j++)
          e->part[row][i][j] += weight * share[i][j];
      }
    }
  }
}

/* The paper's (P60e) per unit of the fluid's volume: V p_p G, by parts; the bare form only. */
INLINE void WeakForces(Explicit *e, const Set s, Run r, const Weights *w)
{
  const int width = LANES * Rows(A_Count(s));

  for (int q = 0; q < r.n; q++) {
    const int *slot = &e->slot[w->first[q]];

    for (int n = 0; n < CL_NODES; n++) {
      const PatchRow at  = PatchRowOf(e, w, q, n / 3);
      double        *row = &e->A[slot[at.at + n % 3] * width], G[CL_DIM];

      PatchGradient(w, q, &at, n % 3, G);
      for (int k = 0; k < s.fluids; k++) {
        const double Vp = e->m->P.f[P_V][r.p + q] * e->m->P.f[P_PW + k][r.p + q];

        for (int d = 0; d < CL_DIM; d++)
          row[A_Fluid(s, k) + FL_G + d] += Vp * G[d];
      }
    }
  }
}

INLINE void DepositRun(Explicit *e, const Set s, Run r, double dt)
{
  _Alignas(64) Given v;
  Weights            w;
  Fluids             state;
  double *const     *f = e->m->P.f;
  const double      *T = s.heat ? f[P_T] + r.p : e->t[T_T] + r.p, *restrict V = f[P_V] + r.p;
  double             C[BLOCK], stores[BLOCK];

  (void)dt;
  WeightsOf(e, r, &w);
  GiveNothing(r, A_Count(s), Rows(A_Acting(s)), &v);
  for (int q = 0; q < r.n; q++)
    v.value[q][A_V(s)] = V[q];
  State(e, s, r, T, &state);
  if (s.fluids)
    Stores(e, s, r, &state, stores);
  for (int q = 0; s.fluids && q < r.n; q++)
    v.value[q][A_Stores(s)] = stores[q];
  for (int q = 0; s.layers && q < r.n; q++)
    v.value[q][A_K(s)] = V[q] * Conductance(e, s, r.p + q);
  BedsValues(e, s, r, &v);
  for (int k = 0; k < s.fluids; k++) {
    const double *g[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      g[d] = f[VectorAt(P_GW, k, d)] + r.p;
    Carried(r, k, stores, f[P_PW + k] + r.p, g, &w, &v);
    FluidValues(e, s, r, k, &state, &v);
  }
  if (s.heat) {
    const double *g[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      g[d] = f[P_GT + d] + r.p;
    Capacities(e, s, r, C);
    for (int q = 0; q < r.n; q++)
      v.value[q][A_C(s)] = C[q];
    Carried(r, s.fluids, C, T, g, &w, &v);
    for (int c = 0; c < CL_PAIRS; c++)
      CarriedCross(r, s.fluids, C, f[P_BT + c] + r.p, c, &w, &v);
    for (int c = CL_PAIRS; c < CL_MIXED; c++)
      CarriedAll(r, s.fluids, C, f[P_BT + c] + r.p, c, &w, &v);
  }
  Momenta(e, s, r, &w, &v);
  if (s.solid)
    MixtureValues(e, s, r, &state, &v);
  if (s.solid && TakesCellMean(e))
    CellForces(e, s, r, &w, &v);
  if (s.fluids && e->o.paper) {
    for (int q = 0; q < r.n; q++) {
      for (int k = 0; k < s.fluids; k++) {
        for (int d = 0; d < CL_DIM; d++)
          v.value[q][A_Fluid(s, k) + FL_G + d] = 0.0;
      }
    }
    WeakForces(e, s, r, &w);
  }
  Scatter(e, e->A, A_Count(s), s.heat ? CARRY_BILINEAR : CARRY_LINEAR, A_Acting(s), s.solid, r, &w, &v);
}

MAKE_LOOPS(DepositRun)

void Deposit(Explicit *e)
{
  ForRuns(e, DepositRun_loops, 0.0);
}
