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

/* (313): with layers nodes give the slip per permeability, and what it changes by. */
INLINE void Slips(const Explicit *e, const Set s, Run r, Gathered *g)
{
  const double k0 = Conductance(s, e->m->c, r.mat);

  for (int q = 0; q < r.n; q++) {
    double *v = g->value[q];

    for (int k = 0; k < s.fluids; k++) {
      for (int d = 0; d < CL_DIM; d++) {
        v[B_Fluid(s, k) + B_DV + d]  = k0 * v[B_Fluid(s, k) + B_DV + d] + (s.solid ? v[B_DVs(s) + d] : 0.0);
        v[B_Fluid(s, k) + B_VEL + d] = k0 * v[B_Fluid(s, k) + B_VEL + d] + (s.solid ? v[d] : 0.0);
      }
    }
  }
}

INLINE void Velocities(Explicit *e, const Set s, Run r, Gathered *g)
{
  const int width = 3 * LANES;

  if (s.layers)
    Slips(e, s, r, g);
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

/* (101) and its slopes; V_T: slope of the open pores' volume in T. */
INLINE void GasMasses(Explicit *e, Run r, const double *restrict V_T, const double *restrict open)
{
  const double *restrict sg = e->t[T_SG] + r.p, *restrict ds = e->t[T_DS] + r.p, *restrict rho = e->t[T_RHO + 1] + r.p;
  const double *restrict rho_p = e->t[T_GAS] + r.p, *restrict rho_T = e->t[T_GAS + 1] + r.p,
                         *restrict pg = e->m->P.f[P_PG] + r.p;
  double *restrict eos = e->t[T_EOS + 1] + r.p, *restrict gw = e->t[T_SLOPE + 3] + r.p,
                   *restrict gg = e->t[T_SLOPE + 4] + r.p, *restrict gT = e->t[T_SLOPE + 5] + r.p;
  const double H = r.mat->gas.trace;

#pragma GCC ivdep
  for (int q = 0; q < r.n; q++) {
    const double held = sg[q] * rho[q] + (1.0 - sg[q]) * H * pg[q], over = (rho[q] - H * pg[q]) * ds[q];

    eos[q] = open[q] * held;
    gw[q]  = -open[q] * over;
    gg[q]  = open[q] * (over + sg[q] * rho_p[q] + (1.0 - sg[q]) * H);
    gT[q]  = held * V_T[q] + open[q] * sg[q] * rho_T[q];
  }
}

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
  const bool gas               = s.fluids == 2;
  const double *restrict rho_w = e->t[T_RHO] + r.p, *restrict sg = gas ? e->t[T_SG] + r.p : zero,
                         *restrict ds = gas ? e->t[T_DS] + r.p : zero;
  double *restrict eos = e->t[T_EOS] + r.p, *restrict ww = e->t[T_SLOPE] + r.p, *restrict wg = e->t[T_SLOPE + 1] + r.p,
                   *restrict wT = e->t[T_SLOPE + 2] + r.p;
  const double per_K = 1.0 / mat->water.K, beta_w = mat->water.beta, beta_s = mat->solid.beta,
               beta_h = mat->hydrate.beta;
  double V_T[BLOCK]; /* open pores, warmed */

#pragma GCC ivdep
  for (int q = 0; q < r.n; q++) {
    V_T[q] = -beta_s * ms[q] / rho_s[q] - beta_h * mh[q] / rho_h[q];
    eos[q] = open[q] * (1.0 - sg[q]) * rho_w[q];
    ww[q]  = open[q] * rho_w[q] * ((1.0 - sg[q]) * per_K + ds[q]);
    wg[q]  = -open[q] * rho_w[q] * ds[q];
    wT[q]  = rho_w[q] * (1.0 - sg[q]) * (V_T[q] - open[q] * beta_w);
  }
  if (gas)
    GasMasses(e, r, V_T, open);
}

/* Gain of hydrate over the step at the nodal p and T, and its slopes (11)-(13): dissociation implicit in S_h, formation
   on the surface at t_n. */
INLINE void Reaction(Explicit *e, const Set s, Run r, const Gathered *g, double dt, const double *restrict T,
                     const double *restrict pore, const double *restrict open)
{
  const Kinetics k          = r.mat->kinetics;
  double *const *f          = e->m->P.f;
  const bool     own        = e->o.particle_pressures;
  const double *restrict sg = e->t[T_SG] + r.p, *restrict V = e->t[T_V] + r.p, *restrict mh = f[P_MH] + r.p;
  const double *restrict own_w = f[P_PW] + r.p, *restrict own_g = f[P_PG] + r.p;
  double *restrict gain = e->t[T_GAIN] + r.p, *restrict gain_p = e->t[T_GAIN_P] + r.p,
                   *restrict gain_T = e->t[T_GAIN_T] + r.p;
  double p_r[BLOCK] = {0.0}, Sh[BLOCK] = {0.0}, sw[BLOCK], T_r[BLOCK], Kd[BLOCK], dK[BLOCK], pe[BLOCK], dpe[BLOCK],
         area[BLOCK];

  for (int q = 0; q < r.n; q++) {
    const double pw = own ? own_w[q] : g->value[q][B_P(s, 0)], pg = own ? own_g[q] : g->value[q][B_P(s, 1)];

    sw[q]  = 1.0 - sg[q];
    Sh[q]  = 1.0 - open[q] / pore[q];
    p_r[q] = sw[q] * pw + sg[q] * pg;
    T_r[q] = s.heat ? g->value[q][B_T(s)] : T[q];
  }
  KineticsRateConstantBatch(&k, r.n, T_r, Kd, dK);
  EquilibriumPressureBatch(&k.equilibrium, r.n, T_r, pe, dpe);
  KineticsFormationAreaBatch(&k, r.n, sw, Sh, area);
#pragma GCC ivdep
  for (int q = 0; q < r.n; q++) {
    const double drive = pe[q] - p_r[q];
    const double rho_h = mh[q] > 0.0 ? mh[q] / (pore[q] * Sh[q]) : 1.0, c = dt * k.M_h * k.A_geo / rho_h,
                 a = c * Kd[q] * drive, per = 1.0 / (1.0 + a);
    const double forms = dt * V[q] * k.M_h * Kd[q] * area[q];
    const bool   goes  = drive >= 0.0;

    gain[q]   = goes ? -mh[q] * a * per : -forms * drive;
    gain_p[q] = goes ? mh[q] * c * Kd[q] * per * per : forms;
    gain_T[q] = goes ? -mh[q] * c * (Kd[q] * dpe[q] + dK[q] * drive) * per * per : -forms * dpe[q];
  }
}

/* Row of one fluid: mass missing, mass flux (18)-(20), matrix. */
INLINE void FluidRow(const Explicit *e, const Set s, Run r, int k, const Gathered *g, double dt, Given *o)
{
  double *const *f  = e->m->P.f;
  const int      at = B_Fluid(s, k), n = Scalars(s), grad = k ? P_GG : P_GW;
  const double   bracket = e->m->c->flux_interpolation && !e->o.particle_pressures ? 1.0 : 0.0,
               scale = e->o.mass_scaling / dt, k0 = Conductance(s, e->m->c, r.mat);
  const double *restrict V = f[P_V] + r.p, *restrict rho = e->t[T_RHO + k] + r.p,
                         *restrict drag = e->t[T_DRAG + k] + r.p;
  const double *restrict m = f[P_MW + k] + r.p, *restrict eos = e->t[T_EOS + k] + r.p;
  const double *restrict gx = f[grad] + r.p, *restrict gy = f[grad + 1] + r.p;

#pragma GCC ivdep
  for (int q = 0; q < r.n; q++) {
    const double *v = g->value[q], tau = bracket / (drag[q] + rho[q] * scale), c = dt * V[q] * rho[q];

    o->value[q][k]    = m[q] - eos[q];
    o->force[0][q][k] = c * (k0 * v[at + B_J] + tau * (v[at + B_PROJ] - gx[q]));
    o->force[1][q][k] = c * (k0 * v[at + B_J + 1] + tau * (v[at + B_PROJ + 1] - gy[q]));
  }
  for (int i = 0; i < n; i++) {
    const double *restrict slope = e->t[T_SLOPE + 3 * k + (i < s.fluids ? i : 2)] + r.p;

    for (int q = 0; q < r.n; q++)
      o->value[q][R_Matrix(s) + k * n + i] = slope[q];
  }
}

/* (293) */
INLINE void UpwindHeat(const Explicit *e, const Set s, Run r, const Gathered *g, double dt,
                       const double *restrict kappa, Given *o)
{
  const int row = s.fluids, at = B_T(s);

  for (int q = 0; q < r.n; q++) {
    const double V         = e->m->P.f[P_V][r.p + q];
    double       a[CL_DIM] = {0.0}, K[3];

    for (int k = 0; k < s.fluids; k++) {
      for (int d = 0; d < CL_DIM; d++)
        a[d] += (k ? r.mat->c_g : r.mat->c_w) * o->force[d][q][k] / (dt * V);
    }
    HeatUpwind(kappa[q], a, e->m->grid.h, K);
    o->force[0][q][row] -= dt * V * (K[0] * g->dx[q][at] + K[2] * g->dy[q][at]);
    o->force[1][q][row] -= dt * V * (K[2] * g->dx[q][at] + K[1] * g->dy[q][at]);
  }
}

/* Row of heat (21): conduction, advection with the fluxes above, capacity. */
INLINE void HeatRow(Explicit *e, const Set s, Run r, const Gathered *g, double dt, const double *restrict pore,
                    const double *restrict open, Given *o)
{
  const Material mat = *r.mat;
  const int      n = Scalars(s), row = s.fluids, at = B_T(s);
  const double *restrict V = e->m->P.f[P_V] + r.p, *restrict V_new = e->t[T_V] + r.p,
                         *restrict sg = s.fluids == 2 ? e->t[T_SG] + r.p : NULL;
  double kappa[BLOCK], advected[BLOCK], C[BLOCK];

  Capacities(e, s, r, C);
#pragma GCC ivdep
  for (int q = 0; q < r.n; q++) {
    const double phi = pore[q] / V_new[q], Sh = 1.0 - open[q] / pore[q];
    const double sw    = s.fluids == 2 ? 1.0 - sg[q] : s.fluids ? 1.0 : 0.0;
    const double fluid = sw * mat.kappa_w + (1.0 - sw) * mat.kappa_g;

    kappa[q]    = (1.0 - phi) * mat.kappa_s + phi * (Sh * mat.kappa_h + (1.0 - Sh) * fluid);
    advected[q] = 0.0;
    if (s.fluids)
      advected[q] += mat.c_w * (o->force[0][q][0] * g->dx[q][at] + o->force[1][q][0] * g->dy[q][at]);
    if (s.fluids == 2)
      advected[q] += mat.c_g * (o->force[0][q][1] * g->dx[q][at] + o->force[1][q][1] * g->dy[q][at]);
    o->value[q][row]                         = -advected[q];
    o->force[0][q][row]                      = -dt * V[q] * kappa[q] * g->dx[q][at];
    o->force[1][q][row]                      = -dt * V[q] * kappa[q] * g->dy[q][at];
    o->value[q][R_Matrix(s) + row * n + row] = C[q];
  }
  for (int i = 0; i < s.fluids; i++) {
    for (int q = 0; q < r.n; q++)
      o->value[q][R_Matrix(s) + row * n + i] = 0.0;
  }
  e->advected += Sum(r.n, advected);
  if (e->m->c->heat_upwind)
    UpwindHeat(e, s, r, g, dt, kappa, o);
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
  const double *restrict sg = e->t[T_SG] + r.p, *restrict gain = e->t[T_GAIN] + r.p,
                         *restrict gain_p = e->t[T_GAIN_P] + r.p, *restrict gain_T = e->t[T_GAIN_T] + r.p;
  double zero[BLOCK] = {0.0}, rho_h[BLOCK], held[PHASE_COUNT][BLOCK], L[BLOCK];

  LiquidDensityBatch(&r.mat->hydrate, r.n, zero, T, rho_h);
  LatentHeatBatch(&r.mat->latent, r.n, T, L);
  PerOpenVolume(e, r, e->m->P.f[P_PG] + r.p, held);
  for (int row = 0; row < n; row++) {
#pragma GCC ivdep
    for (int q = 0; q < r.n; q++) {
      const double c = row < s.fluids ? nu[row] - held[row][q] / rho_h[q] : -L[q];
      double      *a = &o->value[q][R_Matrix(s) + row * n];

      o->value[q][row] -= c * gain[q];
      a[PHASE_W] += c * gain_p[q] * (1.0 - sg[q]);
      a[PHASE_G] += c * gain_p[q] * sg[q];
      if (s.heat)
        a[s.fluids] += c * gain_T[q];
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
