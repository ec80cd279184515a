/* Second pass: from the new nodal velocities the rates of mass and heat at every particle, and what a change of
   pressure and temperature makes of them; docs/equations.md, section 12. */
#include "lanes.h"
#include "clathra/laws_batch.h"

typedef struct {
  double value[BLOCK][3 * LANES], dx[BLOCK][LANES], dy[BLOCK][LANES]; /* at the particle; gradients of the first row */
} Gathered;

INLINE void Gather(const Explicit *e, const Set s, Run r, const Weights *w, Gathered *g)
{
  const int rows = Rows(B_Count(s)), stride = (int)e->m->grid.gm[0];

  for (int q = 0; q < r.n; q++) {
    const int *slot = &e->slot[w->first[q]];
    Lanes      v[3] = {{0.0}, {0.0}, {0.0}}, x = {0.0}, y = {0.0};

    for (int b = 0; b < 3; b++) {
      const double Sy = w->S[1][b][q], Dy = w->D[1][b][q];

      for (int a = 0; a < 3; a++) {
        const Lanes *row = (const Lanes *)e->B + (size_t)slot[b * stride + a] * (size_t)rows;
        const double S   = w->S[0][a][q] * Sy;

        x += row[0] * (w->D[0][a][q] * Sy);
        y += row[0] * (w->S[0][a][q] * Dy);
        for (int z = 0; z < rows; z++)
          v[z] += row[z] * S;
      }
    }
    for (int z = 0; z < rows; z++)
      *(Lanes *)&g->value[q][z * LANES] = v[z];
    *(Lanes *)g->dx[q] = x;
    *(Lanes *)g->dy[q] = y;
  }
}

INLINE void Velocities(Explicit *e, const Set s, Run r, Gathered *g)
{
  const int width = 3 * LANES;

  for (int d = 0; d < CL_DIM; d++) {
    if (s.solid)
      Blend(e->o.flip, r.n, e->m->P.f[P_VS + d] + r.p, &g->value[0][B_DVs(s) + d], &g->value[0][d], width);
    for (int k = 0; k < s.fluids; k++)
      Blend(e->o.flip, r.n, e->m->P.f[(k ? P_VG : P_VW) + d] + r.p, &g->value[0][B_Fluid(s, k) + B_DV + d],
            &g->value[0][B_Fluid(s, k) + B_VEL + d], width);
  }
}

typedef struct {
  double value[BLOCK][2 * LANES], force[CL_DIM][BLOCK][LANES];
} Given;

/* New volume, and the masses the laws give there at the old pressures, with their slopes (9). */
INLINE void Masses(Explicit *e, const Set s, Run r, const double *restrict T, const Gathered *g, double dt,
                   double *restrict pore, double *restrict open)
{
  const Material *mat      = r.mat;
  double *const  *f        = e->m->P.f;
  const double *restrict V = f[P_V] + r.p, *restrict ms = f[P_MS] + r.p, *restrict mh = f[P_MH] + r.p;
  double *restrict V_new = e->t[T_V] + r.p;
  double rho_s[BLOCK], rho_h[BLOCK], zero[BLOCK] = {0.0};

  LiquidDensityBatch(&mat->solid, r.n, zero, T, rho_s);
  LiquidDensityBatch(&mat->hydrate, r.n, zero, T, rho_h);
  for (int q = 0; q < r.n; q++) {
    double J = 1.0;

    if (s.solid)
      J = (1.0 + dt * g->dx[q][0]) * (1.0 + dt * g->dy[q][1]) - dt * dt * g->dy[q][0] * g->dx[q][1];
    V_new[q] = V[q] * J;
    pore[q]  = V_new[q] - ms[q] / rho_s[q];
    open[q]  = pore[q] - mh[q] / rho_h[q];
  }
  if (!s.fluids)
    return;
  const double *restrict rho_w = e->t[T_RHO] + r.p;
  double *restrict eos = e->t[T_EOS] + r.p, *restrict ww = e->t[T_SLOPE] + r.p, *restrict wg = e->t[T_SLOPE + 1] + r.p,
                   *restrict wT = e->t[T_SLOPE + 2] + r.p;
  const double per_K            = 1.0 / mat->water.K;

  for (int q = 0; q < r.n; q++) {
    const double sg = s.fluids == 2 ? e->t[T_SG][r.p + q] : 0.0, ds = s.fluids == 2 ? e->t[T_DS][r.p + q] : 0.0;
    const double V_T =
        -mat->solid.beta * ms[q] / rho_s[q] - mat->hydrate.beta * mh[q] / rho_h[q]; /* open pores, warmed */

    eos[q] = open[q] * (1.0 - sg) * rho_w[q];
    ww[q]  = open[q] * rho_w[q] * ((1.0 - sg) * per_K + ds);
    wg[q]  = -open[q] * rho_w[q] * ds;
    wT[q]  = rho_w[q] * (1.0 - sg) * (V_T - open[q] * mat->water.beta);
    if (s.fluids == 2) { /* (101) */
      const double rho = e->t[T_RHO + 1][r.p + q], rho_p = e->t[T_GAS][r.p + q], rho_T = e->t[T_GAS + 1][r.p + q];
      const double H = mat->gas.trace, pg = f[P_PG][r.p + q], held = sg * rho + (1.0 - sg) * H * pg;

      e->t[T_EOS + 1][r.p + q]   = open[q] * held;
      e->t[T_SLOPE + 3][r.p + q] = -open[q] * (rho - H * pg) * ds;
      e->t[T_SLOPE + 4][r.p + q] = open[q] * ((rho - H * pg) * ds + sg * rho_p + (1.0 - sg) * H);
      e->t[T_SLOPE + 5][r.p + q] = held * V_T + open[q] * sg * rho_T;
    }
  }
}

/* Gain of hydrate over the step at the nodal p and T, and its slopes (11)-(13): dissociation implicit in S_h, formation
   on the surface at t_n. */
INLINE void Reaction(Explicit *e, const Set s, Run r, const Gathered *g, double dt, const double *restrict T,
                     const double *restrict pore, const double *restrict open)
{
  const Kinetics *k     = &r.mat->kinetics;
  double *restrict gain = e->t[T_GAIN] + r.p, *restrict gain_p = e->t[T_GAIN_P] + r.p,
                   *restrict gain_T = e->t[T_GAIN_T] + r.p;

  for (int q = 0; q < r.n; q++) {
    const PetscInt p  = r.p + q;
    const double   sg = e->t[T_SG][p], V = e->t[T_V][p], mh = e->m->P.f[P_MH][p], Sh = 1.0 - open[q] / pore[q];
    const bool     own = e->o.particle_pressures;
    const double   pw  = own ? e->m->P.f[P_PW][p] : g->value[q][B_P(s, 0)],
                 pg    = own ? e->m->P.f[P_PG][p] : g->value[q][B_P(s, 1)];
    const double p_r = (1.0 - sg) * pw + sg * pg, T_r = s.heat ? g->value[q][B_T(s)] : T[q];
    double       dK, dpe, dw, dA;
    const double Kd = KineticsRateConstant(k, T_r, &dK), pe = EquilibriumPressure(&k->equilibrium, T_r, &dpe),
                 drive = pe - p_r;

    if (drive >= 0.0) {
      const double rho_h = mh > 0.0 ? mh / (pore[q] * Sh) : 1.0, c = dt * k->M_h * k->A_geo / rho_h, a = c * Kd * drive;

      gain[q]   = -mh * a / (1.0 + a);
      gain_p[q] = mh * c * Kd / ((1.0 + a) * (1.0 + a));
      gain_T[q] = -mh * c * (Kd * dpe + dK * drive) / ((1.0 + a) * (1.0 + a));
    } else {
      const double c = dt * V * k->M_h * Kd * KineticsFormationArea(k, 1.0 - sg, Sh, &dw, &dA);

      gain[q]   = -c * drive;
      gain_p[q] = c;
      gain_T[q] = -c * dpe;
    }
  }
}

/* Row of one fluid: mass missing, mass flux (18)-(20), matrix. */
INLINE void FluidRow(const Explicit *e, const Set s, Run r, int k, const Gathered *g, double dt, Given *o)
{
  double *const *f  = e->m->P.f;
  const int      at = B_Fluid(s, k), n = Scalars(s), grad = k ? P_GG : P_GW;
  const double   bracket   = e->m->c->flux_interpolation && !e->o.particle_pressures ? 1.0 : 0.0,
               scale       = e->o.mass_scaling / dt;
  const double *restrict V = f[P_V] + r.p, *restrict rho = e->t[T_RHO + k] + r.p,
                         *restrict drag = e->t[T_DRAG + k] + r.p;
  const double *restrict m = f[P_MW + k] + r.p, *restrict eos = e->t[T_EOS + k] + r.p;
  const double *restrict gx = f[grad] + r.p, *restrict gy = f[grad + 1] + r.p;

  for (int q = 0; q < r.n; q++) {
    const double *v = g->value[q], tau = bracket / (drag[q] + rho[q] * scale), c = dt * V[q] * rho[q];

    o->value[q][k]    = m[q] - eos[q];
    o->force[0][q][k] = c * (v[at + B_J] + tau * (v[at + B_PROJ] - gx[q]));
    o->force[1][q][k] = c * (v[at + B_J + 1] + tau * (v[at + B_PROJ + 1] - gy[q]));
    for (int i = 0; i < s.fluids; i++)
      o->value[q][R_Matrix(s) + k * n + i] = e->t[T_SLOPE + 3 * k + i][r.p + q];
    if (s.heat)
      o->value[q][R_Matrix(s) + k * n + s.fluids] = e->t[T_SLOPE + 3 * k + 2][r.p + q];
  }
}

/* Row of heat (21): conduction, advection with the fluxes above, capacity. */
INLINE void HeatRow(Explicit *e, const Set s, Run r, const Gathered *g, double dt, const double *restrict pore,
                    const double *restrict open, Given *o)
{
  const Material *mat = r.mat;
  double *const  *f   = e->m->P.f;
  const int       n = Scalars(s), row = s.fluids, at = B_T(s);

  for (int q = 0; q < r.n; q++) {
    const PetscInt p   = r.p + q;
    const double   phi = pore[q] / e->t[T_V][p], Sh = 1.0 - open[q] / pore[q];
    const double   sw    = s.fluids == 2 ? 1.0 - e->t[T_SG][p] : s.fluids ? 1.0 : 0.0;
    const double   fluid = sw * mat->kappa_w + (1.0 - sw) * mat->kappa_g;
    const double   kappa = (1.0 - phi) * mat->kappa_s + phi * (Sh * mat->kappa_h + (1.0 - Sh) * fluid), V = f[P_V][p];
    double         advected = 0.0;

    for (int k = 0; k < s.fluids; k++)
      advected += (k ? mat->c_g : mat->c_w) * (o->force[0][q][k] * g->dx[q][at] + o->force[1][q][k] * g->dy[q][at]);
    o->value[q][row] = -advected;
    e->advected += advected;
    o->force[0][q][row] = -dt * V * kappa * g->dx[q][at];
    o->force[1][q][row] = -dt * V * kappa * g->dy[q][at];
    if (e->m->c->heat_upwind) {
      double a[CL_DIM] = {0.0}, K[3];

      for (int k = 0; k < s.fluids; k++) {
        for (int d = 0; d < CL_DIM; d++)
          a[d] += (k ? mat->c_g : mat->c_w) * o->force[d][q][k] / (dt * V);
      }
      HeatUpwind(kappa, a, e->m->grid.h, K);
      o->force[0][q][row] -= dt * V * (K[0] * g->dx[q][at] + K[2] * g->dy[q][at]);
      o->force[1][q][row] -= dt * V * (K[2] * g->dx[q][at] + K[1] * g->dy[q][at]);
    }
    for (int i = 0; i < s.fluids; i++)
      o->value[q][R_Matrix(s) + row * n + i] = 0.0;
    o->value[q][R_Matrix(s) + row * n + row] = Capacity(e, s, mat, p);
  }
}

/* (290): throttling with the fluxes above, and in the matrix what a rise of pressure gives. */
INLINE void CompressionRow(Explicit *e, const Set s, Run r, const Gathered *g, const double *restrict T, Given *o)
{
  const double *b   = e->m->bc.gravity;
  const int     row = s.fluids, n = Scalars(s);

  for (int k = 0; k < s.fluids; k++) {
    const int at = B_P(s, k);

    for (int q = 0; q < r.n; q++) {
      const PetscInt p   = r.p + q;
      const double   rho = e->t[T_RHO + k][p], TK = T[q] + CL_ZERO_CELSIUS;
      const double   beta  = k == 0 ? r.mat->water.beta : rho > 0.0 ? -e->t[T_GAS + 1][p] / rho : 1.0 / TK;
      const double   share = rho > 0.0 ? (1.0 - beta * TK) / rho : 0.0;
      const double   given =
          o->force[0][q][k] * (b[0] - share * g->dx[q][at]) + o->force[1][q][k] * (b[1] - share * g->dy[q][at]);

      o->value[q][row] += given;
      e->squeezed += given;
      e->t[T_WARM + k][p] = rho > 0.0 ? beta * TK * e->t[T_EOS + k][p] / rho : 0.0;
      o->value[q][R_Matrix(s) + row * n + k] -= e->t[T_WARM + k][p];
    }
  }
}

/* Heat of the plastic work of the step before. */
INLINE void PlasticHeat(Explicit *e, const Set s, Run r, Given *o)
{
  for (int q = 0; q < r.n; q++) {
    const double heat = e->m->P.f[P_HEAT][r.p + q];

    o->value[q][s.fluids] += heat;
    e->latent += heat;
  }
}

/* What the reaction adds to all rows: gain = gain_0 + gain_p (s . dp) + gain_T dT. */
INLINE void ReactionRows(const Explicit *e, const Set s, Run r, const double *restrict T, Given *o)
{
  const Kinetics *k               = &r.mat->kinetics;
  const int       n               = Scalars(s);
  const double    nu[PHASE_COUNT] = {k->N_h * k->M_w / k->M_h, k->M_g / k->M_h};
  double          zero[BLOCK]     = {0.0}, rho_h[BLOCK];

  LiquidDensityBatch(&r.mat->hydrate, r.n, zero, T, rho_h);
  for (int q = 0; q < r.n; q++) {
    const PetscInt p  = r.p + q;
    const double   sg = e->t[T_SG][p], share[PHASE_COUNT] = {1.0 - sg, sg};
    const double   gain = e->t[T_GAIN][p], gain_p = e->t[T_GAIN_P][p], gain_T = e->t[T_GAIN_T][p];
    double         dL, held[PHASE_COUNT];

    PerOpenVolume(e, r.mat, p, e->m->P.f[P_PG][p], held);
    for (int row = 0; row < n; row++) {
      const double c = row < s.fluids ? nu[row] - held[row] / rho_h[q] : -LatentHeatEvaluate(&r.mat->latent, T[q], &dL);

      o->value[q][row] -= c * gain;
      for (int i = 0; i < s.fluids; i++)
        o->value[q][R_Matrix(s) + row * n + i] += c * gain_p * share[i];
      if (s.heat)
        o->value[q][R_Matrix(s) + row * n + s.fluids] += c * gain_T;
    }
  }
}

/* (151): the columns of dp_w, dp_g for those of -dp_c and of the relative change of p_g. */
INLINE void RelativeColumns(const Explicit *e, const Set s, Run r, Given *o)
{
  const int n              = Scalars(s);
  const double *restrict p = e->m->P.f[P_PG] + r.p;

  for (int q = 0; q < r.n; q++) {
    for (int row = 0; row < n; row++) {
      double *a = &o->value[q][R_Matrix(s) + row * n];

      a[1] = (a[0] + a[1]) * (p[q] / PRESSURE_UNIT);
    }
  }
}

INLINE void Scatter(Explicit *e, const Set s, Run r, const Weights *w, const Given *o)
{
  const int rows = Rows(R_Count(s)), stride = (int)e->m->grid.gm[0];

  for (int q = 0; q < r.n; q++) {
    const int   *slot  = &e->slot[w->first[q]];
    const Lanes *value = (const Lanes *)o->value[q], fx = *(const Lanes *)o->force[0][q],
                fy = *(const Lanes *)o->force[1][q];

    for (int b = 0; b < 3; b++) {
      const double Sy = w->S[1][b][q], Dy = w->D[1][b][q];

      for (int a = 0; a < 3; a++) {
        const double S   = w->S[0][a][q] * Sy;
        Lanes       *row = (Lanes *)e->R + (size_t)slot[b * stride + a] * (size_t)rows;

        row[0] += value[0] * S + fx * (w->D[0][a][q] * Sy) + fy * (w->S[0][a][q] * Dy);
        for (int z = 1; z < rows; z++)
          row[z] += value[z] * S;
      }
    }
  }
}

/* Divergence of a fluid's Darcy flux at the particle, 1/s. */
INLINE double Divergence(const Explicit *e, const Set s, const Weights *w, int q, int k)
{
  const int  width = LANES * Rows(B_Count(s)), stride = (int)e->m->grid.gm[0], at = B_Fluid(s, k) + B_J;
  const int *slot = &e->slot[w->first[q]];
  double     div  = 0.0;

  for (int b = 0; b < 3; b++) {
    for (int a = 0; a < 3; a++) {
      const double *J = &e->B[slot[b * stride + a] * width + at];

      div += w->D[0][a][q] * w->S[1][b][q] * J[0] + w->S[0][a][q] * w->D[1][b][q] * J[1];
    }
  }
  return div;
}

/* The paper's bare form (P72): the balances of mass stay at the particle, with the divergence of the flux there;
 * nodes see the heat alone. */
INLINE void Keep(Explicit *e, const Set s, Run r, double dt, const Weights *w, Given *o)
{
  const int n = Scalars(s);

  for (int q = 0; q < r.n; q++) {
    const PetscInt p = r.p + q;

    for (int k = 0; k < s.fluids; k++) {
      double *row = &o->value[q][R_Matrix(s) + k * n];

      e->t[T_MISS + k][p] = o->value[q][k] - dt * e->m->P.f[P_V][p] * e->t[T_RHO + k][p] * Divergence(e, s, w, q, k);
      for (int i = 0; i < n; i++) {
        e->t[T_LOCAL + 3 * k + (i < s.fluids ? i : 2)][p] = row[i];
        row[i]                                            = i == k ? 1.0 : 0.0;
      }
      o->value[q][k] = o->force[0][q][k] = o->force[1][q][k] = 0.0;
      if (s.heat)
        o->value[q][R_Matrix(s) + s.fluids * n + k] = 0.0;
    }
  }
}

INLINE void RatesRun(Explicit *e, const Set s, Run r, double dt)
{
  _Alignas(64) Gathered g;
  _Alignas(64) Given    o;
  Weights               w;
  CellMean              mean;
  double                pore[BLOCK], open[BLOCK];
  const double         *T = s.heat ? e->m->P.f[P_T] + r.p : e->t[T_T] + r.p;

  const bool shared = CellMeanOf(e, &mean);
  WeightsOf(e, r, &w);
  Gather(e, s, r, &w, &g);
  for (int q = 0; q < r.n && shared; q++)
    MeanMotion(e, &mean, &w, q, e->B, LANES * Rows(B_Count(s)), g.dx[q], g.dy[q]);
  Velocities(e, s, r, &g);
  for (int q = 0; q < r.n; q++) {
    for (int k = 0; k < LANES; k++)
      o.force[0][q][k] = o.force[1][q][k] = 0.0;
    for (int k = R_Count(s); k < LANES * Rows(R_Count(s)); k++)
      o.value[q][k] = 0.0;
  }
  Masses(e, s, r, T, &g, dt, pore, open);
  for (int k = 0; k < s.fluids; k++)
    FluidRow(e, s, r, k, &g, dt, &o);
  if (s.heat)
    HeatRow(e, s, r, &g, dt, pore, open, &o);
  if (s.heat && e->m->c->compression_heat)
    CompressionRow(e, s, r, &g, T, &o);
  if (s.heat && s.solid && r.mat->plasticity.heat > 0.0)
    PlasticHeat(e, s, r, &o);
  if (s.fluids == 2 && r.mat->reacts) {
    Reaction(e, s, r, &g, dt, T, pore, open);
    ReactionRows(e, s, r, T, &o);
  }
  if (s.fluids && e->o.particle_pressures)
    Keep(e, s, r, dt, &w, &o);
  if (Relative(e, s))
    RelativeColumns(e, s, r, &o);
  Scatter(e, s, r, &w, &o);
}

MAKE_LOOPS(RatesRun)

void Rates(Explicit *e, double dt)
{
  static const LoopTable table = LOOPS(RatesRun);

  ForRuns(e, table, dt);
}
