/* Second pass: from the new nodal velocities the rates of mass and heat at every particle, and what a change of
   pressure and temperature makes of them; docs/equations.md, section 12. */
#include "clathra/laws_batch.h"
#include "clathra/point_reaction.h"
#include "gathered.h"
#include "storage.h"

/* (313): with layers nodes give what the slip per permeability changes by. */
INLINE void Slips(const Explicit *e, const Set s, Run r, Gathered *g)
{
  for (int q = 0; q < r.n; q++) {
    const double conduct = Conductance(e, s, r.p + q);
    double      *v       = g->value[q];

    for (int k = 0; k < s.fluids; k++) {
      double *dv = &v[B_Fluid(s, k) + B_DV];

      Drive(e, s, r.p + q, dv);
      for (int d = 0; d < CL_DIM; d++)
        dv[d] = conduct * dv[d] + (s.solid ? v[B_DVs(s) + d] : 0.0);
    }
  }
}

INLINE void Velocities(Explicit *e, const Set s, Run r, Gathered *g)
{
  if (s.layers)
    Slips(e, s, r, g);
  for (int d = 0; d < CL_DIM; d++) {
    if (s.solid)
      AddChange(r.n, e->m->P.f[P_VS + d] + r.p, &g->value[0][B_DVs(s) + d], GATHERED);
    for (int k = 0; k < s.fluids; k++)
      AddChange(r.n, e->m->P.f[VectorAt(P_VW, k, d)] + r.p, &g->value[0][B_Fluid(s, k) + B_DV + d], GATHERED);
  }
}

/* Volumes of a block's particles at the end of the step, with the hydrate of t_n. */
typedef struct {
  double rho_h[BLOCK], pore[BLOCK], open[BLOCK], phi[BLOCK], Sh[BLOCK];
  double open_T[BLOCK], sg_T[BLOCK]; /* slopes in T */
} Volumes;

/* (320) in these volumes, which change S_h; so does T. */
INLINE void SharesOf(Explicit *e, Run r, const double *restrict rho_s, Volumes *o)
{
  const Material *mat       = r.mat;
  double *const  *f         = e->m->P.f;
  const double *restrict pw = f[P_PW] + r.p, *restrict pg = f[P_PG] + r.p, *restrict ms = f[P_MS] + r.p;
  double *restrict sg = e->t[T_SG] + r.p, *restrict ds = e->t[T_DS] + r.p;
  double pc[BLOCK];

  for (int q = 0; q < r.n; q++)
    pc[q] = pg[q] - pw[q];
  RetentionGasShareBatch(&mat->retention, r.n, pc, o->Sh, sg, ds);
  for (int q = 0; q < r.n; q++) {
    const double Sh_T = o->Sh[q] * (mat->hydrate.beta + mat->solid.beta * ms[q] / (rho_s[q] * o->pore[q]));

    o->sg_T[q] = RetentionHydrateSlope(&mat->retention, pc[q], o->Sh[q], ds[q]) * Sh_T;
  }
}

INLINE void VolumesOf(Explicit *e, const Set s, Run r, const double *restrict T, const Gathered *g, double dt,
                      Volumes *o)
{
  const Material *mat      = r.mat;
  double *const  *f        = e->m->P.f;
  const double *restrict V = f[P_V] + r.p, *restrict ms = f[P_MS] + r.p, *restrict mh = f[P_MH] + r.p;
  double *restrict V_new = e->t[T_V] + r.p;
  double       rho_s[BLOCK], zero[BLOCK] = {0.0};
  const double beta_s = mat->solid.beta, beta_h = mat->hydrate.beta;

  LiquidDensityBatch(&mat->solid, r.n, zero, T, rho_s);
  LiquidDensityBatch(&mat->hydrate, r.n, zero, T, o->rho_h);
  for (int q = 0; q < r.n; q++) {
    double J = 1.0;

    if (s.solid) {
      double F[CL_DIM][CL_DIM], cof[CL_DIM][CL_DIM];

      for (int i = 0; i < CL_DIM; i++) {
        for (int j = 0; j < CL_DIM; j++)
          F[i][j] = (i == j ? 1.0 : 0.0) + dt * g->grad[j][q][i];
      }
      J = CofactorOf(F, cof) * (CL_DIM == 2 ? 1.0 + dt * g->swell[q] : 1.0);
    }
    V_new[q]      = V[q] * J;
    const Pores v = PoresOf(V_new[q], ms[q], rho_s[q], mh[q], o->rho_h[q]);

    o->pore[q]   = v.pore;
    o->open[q]   = v.open;
    o->phi[q]    = v.phi;
    o->Sh[q]     = v.Sh;
    o->open_T[q] = -beta_s * ms[q] / rho_s[q] - beta_h * mh[q] / o->rho_h[q];
    o->sg_T[q]   = 0.0;
  }
  if (s.fluids == 2 && mat->retention.hydrate > 0.0)
    SharesOf(e, r, rho_s, o);
}

/* The mass of a fluid that the laws give in these volumes at the old pressures, with its slopes in p_w, p_g, T. */
INLINE void Masses(Explicit *e, const Set s, Run r, int k, const Volumes *v)
{
  const double none[BLOCK] = {0.0}, *sg = s.fluids == 2 ? e->t[T_SG] + r.p : none,
               *ds = s.fluids == 2 ? e->t[T_DS] + r.p : none, *pg = k ? e->m->P.f[P_PG] + r.p : none;
  const double *rho = e->t[k ? T_HELD : T_RHO] + r.p, *rho_p = k ? e->t[T_GAS] + r.p : none,
               *rho_T = k ? e->t[T_GAS + 1] + r.p : none;
  const double   H = r.mat->gas.trace, per_K = 1.0 / r.mat->water.K, beta = r.mat->water.beta;
  double *const *slope = &e->t[T_SLOPE + 3 * k];
  double *mass = e->t[T_EOS + k] + r.p, *own = slope[k] + r.p, *other = slope[1 - k] + r.p, *in_T = slope[2] + r.p;

  INDEPENDENT
  for (int q = 0; q < r.n; q++) {
    const Content   c = k ? MethaneContent(H, sg[q], rho[q], pg[q]) : WaterContent(sg[q], rho[q]);
    const FluidMass m = MassOf(c, v->open[q], v->open_T[q], k ? ds[q] : -ds[q], v->sg_T[q],
                               k ? rho_p[q] : per_K * rho[q], k ? rho_T[q] : -beta * rho[q]);

    mass[q]  = m.v;
    own[q]   = m.own;
    other[q] = m.other;
    in_T[q]  = m.T;
  }
}

/* (381) with the faster of both ways; zero where it is off. */
INLINE void Held(const Explicit *e, const Set s, Run r, const Gathered *g, double dt, const double *restrict T,
                 const double *restrict pw, const double *restrict pg, const double *restrict Kd,
                 const double *restrict pe, const double *restrict dpe, const double *restrict forms, const Volumes *v,
                 double *restrict held)
{
  const Material *mat       = r.mat;
  const double    kappas[4] = {mat->kappa_s, mat->kappa_h, mat->kappa_w, mat->kappa_g}, *sg = e->t[T_SG] + r.p;
  const double   *V = e->t[T_V] + r.p, *heat = e->m->P.f[P_HEAT] ? e->m->P.f[P_HEAT] + r.p : NULL;
  double *const  *f = e->m->P.f;
  double          kappa[BLOCK], sw[BLOCK], L[BLOCK], C[BLOCK];

  for (int q = 0; q < r.n; q++) {
    held[q] = 0.0;
    sw[q]   = 1.0 - sg[q];
  }
  if (!SceneReactsWithHeat(e->m->c) || e->o.paper)
    return;
  LatentHeatBatch(&mat->latent, r.n, T, L);
  MixtureAverageBatch(r.n, v->phi, v->Sh, sw, kappas, kappa);
  Capacities(e, s, r, C);
  for (int q = 0; q < r.n; q++) {
    const PetscInt p     = r.p + q;
    const double   melts = KineticsMeltingArea(&mat->kinetics, v->phi[q], v->Sh[q]);
    double         h[CL_DIM];
    HeldParticle   x = {.h       = h,
                        .by      = ReactionPressure(mat->gas.trace, sg[q], pw[q], pg[q]),
                        .pe      = pe[q],
                        .dpe_dT  = dpe[q],
                        .heat    = mat->kinetics.M_h * Kd[q] * fmax(forms[q], melts) * L[q],
                        .kappa   = kappa[q],
                        .C       = C[q] / V[q],
                        .plastic = heat ? heat[q] / (dt * V[q]) : 0.0,
                        .since   = e->m->t_n - e->m->c->t_begin,
                        .rate    = {f[P_RATE][p], f[P_RATE_PG][p]}};

    for (int d = 0; d < CL_DIM; d++)
      h[d] = LinesWidthAt(&e->m->grid.line[d], f[P_X + d][p]);
    GradientOf(g, q, B_T(s), x.g_T);
    for (int k = 0; k < PHASE_COUNT; k++)
      GradientOf(g, q, B_P(s, k), x.g_p[k]);
    held[q] = ReactionHeldAt(&x);
  }
}

/* Variance of T over the nodes of particle q, and its covariances with p_w and p_g. */
INLINE void SpreadOverNodes(const Explicit *e, const Set s, const Gathered *g, const Weights *w, int q, NodesSeen *x)
{
  const int    *slot = &e->slot[w->first[q]], width = LANES * Rows(B_Count(s)), T = B_T(s);
  const double *own = g->value[q];

  for (int k = 0; k < PATCH_ROWS; k++) {
    const PatchRow at = PatchRowOf(e, w, q, k);

    for (int a = 0; a < 3; a++) {
      const double *row = &e->B[slot[at.at + a] * width], warmer = row[T] - own[T], S = w->S[0][a][q] * at.S;

      x->variance += S * warmer * warmer;
      for (int f = 0; f < PHASE_COUNT; f++)
        x->covariance[f] += S * warmer * (row[B_P(s, f)] - own[B_P(s, f)]);
    }
  }
}

/* (424) of t_n; in the bare form particles see no nodes. */
INLINE void Chords(const Explicit *e, const Set s, Run r, const Gathered *g, const Weights *w, const double *restrict T,
                   const double *restrict dpe, const double *restrict pw, const double *restrict pg,
                   double *restrict pe)
{
  const Equilibrium *law    = &r.mat->kinetics.equilibrium;
  const double *restrict sg = e->t[T_SG] + r.p;
  double warmer[BLOCK], pe_warmer[BLOCK], beyond[BLOCK];

  if (!SceneReactsWithHeat(e->m->c) || e->o.paper)
    return;
  for (int q = 0; q < r.n; q++)
    warmer[q] = T[q] + CL_CURVES;
  EquilibriumPressureBatch(law, r.n, warmer, pe_warmer, beyond);
  for (int q = 0; q < r.n; q++) {
    NodesSeen x = {.p         = ReactionPressure(r.mat->gas.trace, sg[q], pw[q], pg[q]),
                   .pe        = pe[q],
                   .dpe_dT    = dpe[q],
                   .curvature = EquilibriumCurvatureOf(dpe[q], beyond[q])};

    SpreadOverNodes(e, s, g, w, q, &x);
    pe[q] += ReactionChord(&x);
  }
}

/* Gain of hydrate over the step at the nodal p and T, and its slopes: dissociation implicit in S_h, formation
   on the surface at t_n. */
INLINE void Reaction(Explicit *e, const Set s, Run r, const Gathered *g, const Weights *w, double dt,
                     const double *restrict T, const Volumes *v)
{
  const Kinetics k          = r.mat->kinetics;
  const double   H          = r.mat->gas.trace;
  double *const *f          = e->m->P.f;
  const bool     own        = e->o.paper;
  const double *restrict sg = e->t[T_SG] + r.p, *restrict V = e->t[T_V] + r.p, *restrict mh = f[P_MH] + r.p;
  const double *restrict own_w = f[P_PW] + r.p, *restrict own_g = f[P_PG] + r.p;
  double *restrict gain = e->t[T_GAIN] + r.p, *restrict gain_w = e->t[T_GAIN_W] + r.p,
                   *restrict gain_g = e->t[T_GAIN_G] + r.p, *restrict gain_T = e->t[T_GAIN_T] + r.p;
  double pw[BLOCK], pg[BLOCK], sw[BLOCK], wet[BLOCK], T_r[BLOCK], Kd[BLOCK], dK[BLOCK], pe[BLOCK], dpe[BLOCK],
      area[BLOCK], held[BLOCK];

  for (int q = 0; q < r.n; q++) {
    sw[q]  = 1.0 - sg[q];
    pw[q]  = own ? own_w[q] : g->value[q][B_P(s, 0)];
    pg[q]  = own ? own_g[q] : g->value[q][B_P(s, 1)];
    T_r[q] = s.heat ? g->value[q][B_T(s)] : T[q];
  }
  KineticsRateConstantBatch(&k, r.n, T_r, Kd, dK);
  EquilibriumPressureBatch(&k.equilibrium, r.n, T_r, pe, dpe);
  Chords(e, s, r, g, w, T_r, dpe, pw, pg, pe);
  for (int q = 0; q < r.n; q++) {
    const double over = ReactionPressure(H, sg[q], pw[q], pg[q]).v - pe[q];

    wet[q] = ReactionWet(r.mat, v->phi[q], v->Sh[q], pg[q] - pw[q], fmax(over, 0.0)).v; /* falls with p: at t_n */
  }
  KineticsFormationAreaBatch(&k, r.n, sw, wet, v->Sh, area);
  Held(e, s, r, g, dt, T_r, pw, pg, Kd, pe, dpe, area, v, held);
  INDEPENDENT
  for (int q = 0; q < r.n; q++) {
    const Driving d = ReactionDriving(H, sg[q], pw[q], pg[q], pe[q]);
    const Growth  growth =
        ReactionGrowth(&k, dt, held[q], &d, (OfTemperature){Kd[q], dK[q]}, (OfTemperature){pe[q], dpe[q]});
    double       slope;
    const double per_mass = k.A_geo / v->rho_h[q], to = V[q] * area[q],
                 gone = ReactionDissociated(mh[q], -per_mass * growth.v, &slope), by = d.forms ? to : -per_mass * slope;

    gain[q]   = d.forms ? to * growth.v : gone;
    gain_w[q] = by * growth.p * d.p.pw;
    gain_g[q] = by * growth.p * d.p.pg;
    gain_T[q] = by * growth.T;
  }
}

/* (352): what the water carries, with p_g of t_n. */
INLINE void CarriedFlux(const Explicit *e, Run r, Given *o)
{
  const double *restrict pg = e->m->P.f[P_PG] + r.p, *restrict rho = e->t[T_RHO + PHASE_W] + r.p;

  for (int q = 0; q < r.n; q++) {
    const double share = CarriedShare(r.mat->gas.carried, pg[q], rho[q]);

    for (int d = 0; d < CL_DIM; d++)
      o->force[d][q][PHASE_G] += share * o->force[d][q][PHASE_W];
  }
}

/* Row of one fluid: mass missing, mass flux, matrix. */
INLINE void FluidRow(const Explicit *e, const Set s, Run r, int k, const Gathered *g, double dt, Given *o)
{
  double *const *f  = e->m->P.f;
  const int      at = B_Fluid(s, k), n = Scalars(s), grad = VectorAt(P_GW, k, 0);
  const double   bracket = e->o.paper ? 0.0 : 1.0, scale = e->o.mass_scaling / dt;
  const double *restrict V = f[P_V] + r.p, *restrict rho = e->t[T_RHO + k] + r.p,
                         *restrict drag = e->t[T_DRAG + k] + r.p;
  const double *restrict m = f[P_MW + k] + r.p, *restrict eos = e->t[T_EOS + k] + r.p;

  INDEPENDENT
  for (int q = 0; q < r.n; q++) {
    const double *v = g->value[q], tau = bracket * TauOf(1.0, drag[q], rho[q], scale).v, rt = rho[q] * tau,
                 conduct = Conductance(e, s, r.p + q);
    double own[CL_DIM], J[CL_DIM], b[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      own[d] = f[grad + d][r.p + q];
    Unweighed(e, s, rho[q], own);
    for (int d = 0; d < CL_DIM; d++) {
      J[d] = conduct * v[at + B_J + d];
      b[d] = v[at + B_PROJ + d] - own[d];
    }
    Drive(e, s, r.p + q, J);
    Drive(e, s, r.p + q, b);
    o->value[q][k] = m[q] - eos[q];
    for (int d = 0; d < CL_DIM; d++)
      o->force[d][q][k] = MassFlux(dt * V[q], rho[q], rt, J[d], b[d]);
  }
  if (k == PHASE_G && r.mat->gas.carried > 0.0)
    CarriedFlux(e, r, o);
  for (int i = 0; i < n; i++) {
    const double *restrict slope = e->t[T_SLOPE + 3 * k + (i < s.fluids ? i : 2)] + r.p;

    for (int q = 0; q < r.n; q++)
      o->value[q][R_Matrix(s) + k * n + i] = slope[q];
  }
}

/* (440) of a particle. */
INLINE double AlternatesAt(const Explicit *e, const Weights *w, int q, const double h[CL_DIM],
                           const double K[CL_SYMMETRIC])
{
  const int *slot                            = &e->slot[w->first[q]];
  double     mean[CL_DIM][ALTERNATION_COUNT] = {{0.0}};

  for (int n = 0; n < CL_NODES; n++) {
    const PatchRow row   = PatchRowOf(e, w, q, n / 3);
    const double   S     = w->S[0][n % 3][q] * row.S;
    const double  *share = &e->alternates[slot[row.at + n % 3] * CL_DIM * ALTERNATION_COUNT];

    for (int d = 0; d < CL_DIM; d++) {
      for (int k = 0; k < ALTERNATION_COUNT; k++)
        mean[d][k] += S * share[d * ALTERNATION_COUNT + k];
    }
  }
  return AlternationOf(mean, h, K);
}

/* (293) where T alternates (440). */
INLINE void UpwindHeat(const Explicit *e, const Set s, Run r, const Gathered *g, const Weights *w, double dt,
                       const double *restrict kappa, Given *o)
{
  const int row = s.fluids, at = B_T(s);

  for (int q = 0; q < r.n; q++) {
    const double V         = e->m->P.f[P_V][r.p + q];
    double       a[CL_DIM] = {0.0}, h[CL_DIM], K[CL_SYMMETRIC];

    for (int d = 0; d < CL_DIM; d++)
      h[d] = LinesWidthAt(&e->m->grid.line[d], e->m->P.f[P_X + d][r.p + q]);
    for (int k = 0; k < s.fluids; k++) {
      for (int d = 0; d < CL_DIM; d++)
        a[d] += SpecificHeat(r.mat, k) * o->force[d][q][k] / (dt * V);
    }
    if (!HeatUpwind(kappa[q], a, h, K))
      continue;
    const double theta = AlternatesAt(e, w, q, h, K);

    for (int i = 0; i < CL_DIM; i++) {
      for (int j = 0; j < CL_DIM; j++)
        o->force[i][q][row] -= dt * V * theta * K[cl_symmetric[i][j]] * g->grad[j][q][at];
    }
  }
}

/* (444): straight to the rows of heat, since neither S nor G is its weight. */
INLINE void LongCells(Explicit *e, const Set s, Run r, const Weights *w, double dt, const double *restrict kappa)
{
  const int rows = LANES * Rows(R_Count(s)), nodes = LANES * Rows(B_Count(s));

  for (int q = 0; q < r.n; q++) {
    const int *slot = &e->slot[w->first[q]];
    double     h[CL_DIM], twist[CL_NODES], T_xy = 0.0;

    for (int d = 0; d < CL_DIM; d++)
      h[d] = LinesWidthAt(&e->m->grid.line[d], e->m->P.f[P_X + d][r.p + q]);
    const double stiff = dt * e->m->P.f[P_V][r.p + q] * LongCellConductivity(kappa[q], h);
    if (stiff == 0.0)
      continue;
    for (int n = 0; n < CL_NODES; n++) {
      const PatchRow row = PatchRowOf(e, w, q, n / 3);

      twist[n] = w->D[0][n % 3][q] * row.D[1];
      T_xy += twist[n] * e->B[slot[row.at + n % 3] * nodes + B_T(s)];
    }
    for (int n = 0; n < CL_NODES; n++)
      e->R[slot[PatchRowOf(e, w, q, n / 3).at + n % 3] * rows + s.fluids] -= stiff * twist[n] * T_xy;
  }
}

/* Flux of mass of a fluid through the particle over the step, kg m, that its row has. */
INLINE void GivenFlux(const Given *o, int q, int k, double flux[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    flux[d] = o->force[d][q][k];
}

/* Row of heat (21): conduction, advection with the fluxes above, capacity. */
INLINE void HeatRow(Explicit *e, const Set s, Run r, const Gathered *g, const Weights *w, double dt, const Volumes *v,
                    Given *o)
{
  const Material mat = *r.mat;
  const int      n = Scalars(s), row = s.fluids, at = B_T(s);
  const double *restrict V = e->m->P.f[P_V] + r.p, *restrict sg = s.fluids == 2 ? e->t[T_SG] + r.p : NULL;
  const double kappas[4] = {mat.kappa_s, mat.kappa_h, mat.kappa_w, mat.kappa_g};
  double       kappa[BLOCK], sw[BLOCK], advected[BLOCK], C[BLOCK];

  Capacities(e, s, r, C);
  for (int q = 0; q < r.n; q++)
    sw[q] = s.fluids == 2 ? 1.0 - sg[q] : s.fluids ? 1.0 : 0.0;
  MixtureAverageBatch(r.n, v->phi, v->Sh, sw, kappas, kappa);
  INDEPENDENT
  for (int q = 0; q < r.n; q++) {
    double gT[CL_DIM], flux[CL_DIM];

    GradientOf(g, q, at, gT);
    advected[q] = 0.0;
#pragma GCC unroll 2
    for (int k = 0; k < s.fluids; k++) {
      GivenFlux(o, q, k, flux);
      advected[q] += AdvectedHeat(SpecificHeat(&mat, k), flux, gT);
    }
    o->value[q][row] = -advected[q];
    for (int d = 0; d < CL_DIM; d++)
      o->force[d][q][row] = -dt * V[q] * kappa[q] * gT[d];
    o->value[q][R_Matrix(s) + row * n + row] = C[q];
  }
  for (int i = 0; i < s.fluids; i++) {
    for (int q = 0; q < r.n; q++)
      o->value[q][R_Matrix(s) + row * n + i] = 0.0;
  }
  e->advected += Sum(r.n, advected);
  if (e->alternates)
    UpwindHeat(e, s, r, g, w, dt, kappa, o);
  if (e->long_cells)
    LongCells(e, s, r, w, dt, kappa);
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
      const double   beta  = k == PHASE_W ? r.mat->water.beta : GasExpansionAt(&r.mat->gas, rho, T[q]);
      const double   share = rho > 0.0 ? ThrottlingOf(beta * TK, rho).v : 0.0;
      double         flux[CL_DIM], g_p[CL_DIM];

      GivenFlux(o, q, k, flux);
      GradientOf(g, q, at, g_p);
      const double taken = ThrottledHeat(share, flux, g_p, b);

      o->value[q][row] -= taken;
      e->squeezed -= taken;
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

/* What a kg of hydrate gained takes off every row: kg of the fluids, and with the sign of the heat that it gives, J. */
INLINE void PerGain(const Explicit *e, const Set s, Run r, const double *restrict T, const double *restrict rho_h,
                    double c[3][BLOCK])
{
  const Kinetics *k               = &r.mat->kinetics;
  const double    nu[PHASE_COUNT] = {KineticsWater(k), KineticsMethane(k)};
  double          held[PHASE_COUNT][BLOCK], L[BLOCK];

  LatentHeatBatch(&r.mat->latent, r.n, T, L);
  PerHydrateVolume(e, r, e->m->P.f[P_PW] + r.p, e->m->P.f[P_PG] + r.p, held);
  for (int row = 0; row < Scalars(s); row++) {
    for (int q = 0; q < r.n; q++)
      c[row][q] = row < s.fluids ? nu[row] + Displaced(held[row][q], rho_h[q]) : -L[q];
  }
}

/* What the reaction adds to all rows: gain = gain_0 + gain_w dp_w + gain_g dp_g + gain_T dT. */
INLINE void ReactionRows(const Explicit *e, const Set s, Run r, const double *restrict T, const Volumes *v, Given *o)
{
  const int n                 = Scalars(s);
  const double *restrict gain = e->t[T_GAIN] + r.p, *restrict gain_w = e->t[T_GAIN_W] + r.p,
                         *restrict gain_g = e->t[T_GAIN_G] + r.p, *restrict gain_T = e->t[T_GAIN_T] + r.p;
  double c[3][BLOCK];

  PerGain(e, s, r, T, v->rho_h, c);
  for (int row = 0; row < n; row++) {
    INDEPENDENT
    for (int q = 0; q < r.n; q++) {
      double *a = &o->value[q][R_Matrix(s) + row * n];

      o->value[q][row] -= c[row][q] * gain[q];
      a[PHASE_W] += c[row][q] * gain_w[q];
      a[PHASE_G] += c[row][q] * gain_g[q];
      if (s.heat)
        a[s.fluids] += c[row][q] * gain_T[q];
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

      a[1] = RelativeColumn(a, p[q]);
    }
  }
}

/* beta of (413), with the slopes above. */
INLINE void ConsistentShares(Explicit *e, const Set s, Run r, const Volumes *v)
{
  const double *restrict ww = e->t[T_SLOPE] + r.p, *restrict wg = e->t[T_SLOPE + 1] + r.p,
                         *restrict gw = e->t[T_SLOPE + 3] + r.p, *restrict gg = e->t[T_SLOPE + 4] + r.p;
  const double *restrict V = e->m->P.f[P_V] + r.p, *restrict sg = s.fluids == 2 ? e->t[T_SG] + r.p : NULL;
  const double t = e->stable, drags = e->o.drag_implicit ? 1.0 : 0.0, per_scale = 1.0 / e->o.mass_scaling;
  double *restrict beta = e->t[T_CONSISTENT] + r.p;
  double k2[BLOCK], open[BLOCK], f[BLOCK] = {0.0};

  for (int q = 0; q < r.n; q++) {
    double x[CL_DIM];

    ParticlePlace(&e->m->P, r.p + q, x);
    k2[q]   = GridHighest2At(&e->m->grid, x);
    open[q] = drags * Openness(s, r.mat, v->phi[q], v->Sh[q]);
  }
  for (int k = 0; k < s.fluids; k++) {
    const double *restrict drag = e->t[T_DRAG + k] + r.p, *restrict rho = e->t[T_RHO + k] + r.p;

    INDEPENDENT
    for (int q = 0; q < r.n; q++) {
      const double s_k  = s.fluids == 1 ? 1.0
                          : k           ? sg[q]
                                        : 1.0 - sg[q],
                   fill = v->phi[q] * (1.0 - v->Sh[q]) * s_k * per_scale;
      const double own  = s.fluids == 1 ? 1.0 / ww[q] : (k ? ww[q] : gg[q]) / (ww[q] * gg[q] - wg[q] * gw[q]);

      f[q] += FluidGrowth(t, k2[q] * V[q] * fill * own, open[q] * drag[q] * fill / rho[q]);
    }
  }
  for (int q = 0; q < r.n; q++)
    beta[q] = ConsistentShare(f[q]);
}

/* Divergence of a fluid's Darcy flux at the particle, 1/s. */
INLINE double Divergence(const Explicit *e, const Set s, const Weights *w, int q, int k)
{
  const int  width = LANES * Rows(B_Count(s)), at = B_Fluid(s, k) + B_J;
  const int *slot = &e->slot[w->first[q]];
  double     div  = 0.0;

  for (int n = 0; n < CL_NODES; n++) {
    const PatchRow row = PatchRowOf(e, w, q, n / 3);
    double         G[CL_DIM];

    PatchGradient(w, q, &row, n % 3, G);
    div += VectorDot(G, &e->B[slot[row.at + n % 3] * width + at]);
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
      o->value[q][k] = 0.0;
      for (int d = 0; d < CL_DIM; d++)
        o->force[d][q][k] = 0.0;
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
  Volumes               v;
  const double         *T = s.heat ? e->m->P.f[P_T] + r.p : e->t[T_T] + r.p;

  WeightsOf(e, r, &w);
  Gather(e, e->B, Rows(B_Count(s)), 1, r, &w, &g);
  MeanMotion(e, s, r, &w, 0, &g);
  Velocities(e, s, r, &g);
  GiveNothing(r, R_Count(s), 0, &o);
  VolumesOf(e, s, r, T, &g, dt, &v);
  if (s.fluids)
    Masses(e, s, r, PHASE_W, &v);
  if (s.fluids == 2)
    Masses(e, s, r, PHASE_G, &v);
  if (Corrects(e))
    ConsistentShares(e, s, r, &v);
  for (int k = 0; k < s.fluids; k++)
    FluidRow(e, s, r, k, &g, dt, &o);
  if (s.heat)
    HeatRow(e, s, r, &g, &w, dt, &v, &o);
  if (s.heat && e->m->c->compression_heat)
    CompressionRow(e, s, r, &g, T, &o);
  if (s.heat && s.solid && r.mat->plasticity.heat > 0.0)
    PlasticHeat(e, s, r, &o);
  if (s.fluids == 2 && r.mat->reacts) {
    Reaction(e, s, r, &g, &w, dt, T, &v);
    ReactionRows(e, s, r, T, &v, &o);
  }
  if (s.fluids && e->o.paper)
    Keep(e, s, r, dt, &w, &o);
  if (Relative(e, s))
    RelativeColumns(e, s, r, &o);
  Scatter(e, e->R, R_Count(s), CARRY_NOTHING, Scalars(s), true, r, &w, &o);
}

MAKE_LOOPS(RatesRun)

void Rates(Explicit *e, double dt)
{
  ForRuns(e, RatesRun_loops, dt);
}
