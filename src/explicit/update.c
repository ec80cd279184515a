/* Third pass: increments of pressure and temperature back to the particles; strain, stress, hydrate, masses, motion;
   docs/equations.md, section 12. */
#include "lanes.h"
#include "clathra/laws_batch.h"
#include "clathra/point_reaction.h"

/* What a loop over particles finds wrong: of the width of its numbers, so that the loop stays vector code. */
typedef int64_t Wrong;
#define WRONG_UNLESS(condition) ((condition) ? (Wrong)0 : (Wrong)1)

#define LARGEST_STRAIN 0.1 /* of one step: beyond it the series below lose digits, and the step is no small one */

typedef struct {
  double value[BLOCK][LANES], dx[BLOCK][LANES], dy[BLOCK][LANES];
} Gathered;

INLINE void Gather(const Explicit *e, Run r, const Weights *w, Gathered *g)
{
  const int stride = (int)e->m->grid.gm[0];

  for (int q = 0; q < r.n; q++) {
    const int *slot = &e->slot[w->first[q]];
    Lanes      v = {0.0}, x = {0.0}, y = {0.0};

    for (int b = 0; b < 3; b++) {
      const double Sy = w->S[1][b][q], Dy = w->D[1][b][q];

      for (int a = 0; a < 3; a++) {
        const Lanes row = ((const Lanes *)e->C)[slot[b * stride + a]];

        v += row * (w->S[0][a][q] * Sy);
        x += row * (w->D[0][a][q] * Sy);
        y += row * (w->S[0][a][q] * Dy);
      }
    }
    *(Lanes *)g->value[q] = v;
    *(Lanes *)g->dx[q]    = x;
    *(Lanes *)g->dy[q]    = y;
  }
}

/* Bare form, the paper's (P72): increments of pressure from the particle's own balances, with the new temperature. */
INLINE void OwnPressures(const Explicit *e, const Set s, Run r, Gathered *g)
{
  for (int q = 0; q < r.n; q++) {
    const PetscInt p  = r.p + q;
    double *const *L  = (double *const *)&e->t[T_LOCAL];
    const double   dT = s.heat ? g->value[q][s.fluids] : 0.0, w = e->t[T_MISS][p] - L[2][p] * dT;

    if (s.fluids == 1) {
      g->value[q][0] = w / L[0][p];
      continue;
    }
    const double gas = e->t[T_MISS + 1][p] - L[5][p] * dT, det = L[0][p] * L[4][p] - L[1][p] * L[3][p];
    g->value[q][0] = (w * L[4][p] - gas * L[1][p]) / det;
    g->value[q][1] = (gas * L[0][p] - w * L[3][p]) / det;
  }
}

/* (151) */
INLINE void Pressures(const Explicit *e, Run r, Gathered *g)
{
  const double *restrict p = e->m->P.f[P_PG] + r.p;

  for (int q = 0; q < r.n; q++) {
    const double y[2] = {g->value[q][0], g->value[q][1]};

    PressuresOf(p[q], y, g->value[q]);
  }
}

/* Particle of a block with the largest value; NaN is larger than all. */
static PetscInt Worst(Run r, const double size[])
{
  int worst = 0;

  for (int q = 1; q < r.n && !isnan(size[worst]); q++) {
    if (!(size[q] <= size[worst]))
      worst = q;
  }
  return r.p + worst;
}

typedef struct {
  double c[BLOCK], s[BLOCK], xx[BLOCK], yy[BLOCK], xy[BLOCK], stretch[CL_DIM][BLOCK], J[BLOCK], log_J[BLOCK],
      H[CL_DIM][CL_DIM][BLOCK];
} Strain;

/* (7) without branches: rotation c, s and logarithmic strain 1/2 ln F F^T by series in small increments; false if one
 * is not small. */
INLINE bool StrainOf(const Set s, int n, const Gathered *g, double dt, Strain *o)
{
  const int at    = C_Vs(s);
  Wrong     large = 0;

  for (int q = 0; q < n; q++) {
    const double Hxx = dt * g->dx[q][at], Fxy = dt * g->dy[q][at], Fyx = dt * g->dx[q][at + 1],
                 Hyy = dt * g->dy[q][at + 1], Fxx = 1.0 + Hxx, Fyy = 1.0 + Hyy;
    const double a = Fxx + Fyy, b = Fyx - Fxy, per = 1.0 / sqrt(a * a + b * b), c = a * per, si = b * per;
    const double bxx = Fxx * Fxx + Fxy * Fxy, byy = Fyx * Fyx + Fyy * Fyy, off = Fxx * Fyx + Fxy * Fyy;
    const double m = 0.5 * (bxx + byy), d = 0.5 * (bxx - byy), y = (d * d + off * off) / (m * m);
    const double J = Fxx * Fyy - Fxy * Fyx, z = (J - 1.0) / (J + 1.0), z2 = z * z;
    const double lnJ =
        2.0 * z * (1.0 + z2 * (1.0 / 3.0 + z2 * (1.0 / 5.0 + z2 * (1.0 / 7.0 + z2 * (1.0 / 9.0 + z2 / 11.0)))));
    const double ratio =
        1.0 + y * (1.0 / 3.0 + y * (1.0 / 5.0 + y * (1.0 / 7.0 + y * (1.0 / 9.0 + y * (1.0 / 11.0 + y / 13.0)))));

    large |= WRONG_UNLESS((fabs(J - 1.0) < LARGEST_STRAIN) & (y < LARGEST_STRAIN * LARGEST_STRAIN) & (a > 1.0));
    o->c[q]          = c;
    o->s[q]          = si;
    o->xx[q]         = 0.5 * lnJ + 0.5 * ratio * d / m;
    o->yy[q]         = 0.5 * lnJ - 0.5 * ratio * d / m;
    o->xy[q]         = 0.5 * ratio * off / m;
    o->H[0][0][q]    = Hxx;
    o->H[0][1][q]    = Fxy;
    o->H[1][0][q]    = Fyx;
    o->H[1][1][q]    = Hyy;
    o->J[q]          = J;
    o->log_J[q]      = lnJ;
    o->stretch[0][q] = c * Fxx + si * Fyx;
    o->stretch[1][q] = -si * Fxy + c * Fyy;
  }
  return !large; /* NaN is wrong as well */
}

/* The particle of a block that is strained most. */
static PetscInt Strained(Run r, const Strain *n)
{
  double size[BLOCK];

  for (int q = 0; q < r.n; q++)
    size[q] = n->xx[q] * n->xx[q] + n->yy[q] * n->yy[q] + 2.0 * n->xy[q] * n->xy[q];
  return Worst(r, size);
}

#define FARTHEST 1e15 /* Pa, degC: beyond it a field has left its range */

static double Least(const Material *mat, int field)
{
  return field == 0 || (field == 1 && mat->gas.trace > 0.0) ? -FARTHEST : field == 1 ? 0.0 : -CL_ZERO_CELSIUS;
}

/* The first particle of a block with a field outside its range. */
static PetscInt OutOfRange(const Explicit *e, const Set s, Run r)
{
  for (int q = 0; q < r.n; q++) {
    for (int k = 0; k < Scalars(s); k++) {
      const int    field = k < s.fluids ? k : 2;
      const double y     = e->m->P.f[P_PW + field][r.p + q];

      if (!(y > Least(r.mat, field) && y < FARTHEST))
        return r.p + q;
    }
  }
  return r.p;
}

/* p_w, p_g, T and their gradients; false if one leaves its range. */
INLINE bool Fields(Explicit *e, const Set s, Run r, const Gathered *g)
{
  static const int grad[3] = {P_GW, P_GG, P_GT};
  Wrong            out     = 0;

  for (int k = 0; k < Scalars(s); k++) {
    const int field    = k < s.fluids ? k : 2;
    double *restrict y = e->m->P.f[P_PW + field] + r.p, *restrict gx = e->m->P.f[grad[field]] + r.p,
                     *restrict gy = e->m->P.f[grad[field] + 1] + r.p;
    const double least            = Least(r.mat, field);

    for (int q = 0; q < r.n; q++) {
      y[q] += g->value[q][k];
      gx[q] = g->dx[q][C_End(s) + k];
      gy[q] = g->dy[q][C_End(s) + k];
      out |= WRONG_UNLESS((y[q] > least) & (y[q] < FARTHEST));
    }
  }
  return !out;
}

/* (105): where a step takes p_c further than the law is straight, p_g is what belongs to the particle's methane, which
   (40) has given it: between the old one and that of the linear relation. */
INLINE void GasOfMethane(Explicit *e, const Set s, Run r, const Gathered *g)
{
  double *const *f     = e->m->P.f;
  const double   p0    = r.mat->retention.p0;
  bool           bends = false;

  for (int q = 0; q < r.n; q++)
    bends |= fabs(g->value[q][1] - g->value[q][0]) > STRAIGHT * p0;
  for (int q = 0; bends && q < r.n; q++) {
    const PetscInt p  = r.p + q;
    const double   dp = g->value[q][1], pg = f[P_PG][p], T = s.heat ? f[P_T][p] : e->t[T_T][p];
    double         drho, dT;

    if (fabs(dp - g->value[q][0]) <= STRAIGHT * p0)
      continue;
    const double open = PoresOf(e->t[T_V][p], f[P_MS][p], LiquidDensity(&r.mat->solid, 0.0, T, &drho, &dT), f[P_MH][p],
                                LiquidDensity(&r.mat->hydrate, 0.0, T, &drho, &dT))
                            .open;

    f[P_PG][p] = PointGasPressure(r.mat, f[P_MG][p] / open, f[P_PW][p], T, pg - dp, pg);
  }
}

/* (97): p_w, p_g, T tend to what the nodes have at the particle. */
INLINE void Relax(Explicit *e, const Set s, Run r, const Gathered *g, double dt)
{
  const double share = -expm1(-dt / e->o.relaxation);

  for (int k = 0; share > 0.0 && k < Scalars(s); k++) {
    double *restrict y = e->m->P.f[P_PW + (k < s.fluids ? k : 2)] + r.p;

    for (int q = 0; q < r.n; q++)
      y[q] += share * (g->value[q][C_End(s) + k] - y[q]);
  }
}

/* Gain of hydrate in a block's particles, what was wanted of it and what there is (40). */
INLINE void GainOf(const Explicit *e, const Set s, Run r, const Gathered *g, double *restrict wanted,
                   double *restrict gain)
{
  const double *restrict gain_0 = e->t[T_GAIN] + r.p, *restrict gain_p = e->t[T_GAIN_P] + r.p,
                         *restrict gain_T = e->t[T_GAIN_T] + r.p;
  const double *restrict sg = e->t[T_SG] + r.p, *restrict mh = e->m->P.f[P_MH] + r.p;

#pragma GCC ivdep
  for (int q = 0; q < r.n; q++) {
    const double dp = (1.0 - sg[q]) * g->value[q][0] + sg[q] * g->value[q][1];

    wanted[q] = gain_0[q] + gain_p[q] * dp + (s.heat ? gain_T[q] * g->value[q][2] : 0.0);
    gain[q]   = Largest(wanted[q], -mh[q]);
  }
}

/* Its heat, with T of t_n; what was missing goes back to the particle. */
INLINE void HeatOf(Explicit *e, const Set s, Run r, const double *restrict T, const double *restrict wanted,
                   const double *restrict gain)
{
  double *restrict now = e->m->P.f[P_T] + r.p;
  double L[BLOCK], C[BLOCK], heat[BLOCK];

  LatentHeatBatch(&r.mat->latent, r.n, T, L);
  Capacities(e, s, r, C);
#pragma GCC ivdep
  for (int q = 0; q < r.n; q++) {
    now[q] += L[q] * (gain[q] - wanted[q]) / C[q];
    heat[q] = L[q] * wanted[q];
  }
  e->latent += Sum(r.n, heat);
}

/* Mass of hydrate, what the fluids and heat give for it (40). */
INLINE void HydrateOf(Explicit *e, const Set s, Run r, const Gathered *g, double *restrict kept, PetscInt *limited)
{
  double *const  *f               = e->m->P.f;
  const Kinetics *kin             = &r.mat->kinetics;
  const double    nu[PHASE_COUNT] = {KineticsWater(kin), KineticsMethane(kin)};
  double         *mw = f[P_MW] + r.p, *mg = f[P_MG] + r.p, *mh = f[P_MH] + r.p; /* read by HeatOf, too */
  const double   *pg = f[P_PG] + r.p, *now = s.heat ? f[P_T] + r.p : e->t[T_T] + r.p;
  double wanted[BLOCK], gain[BLOCK], T[BLOCK], p[BLOCK], rho_h[BLOCK], zero[BLOCK] = {0.0}, held[PHASE_COUNT][BLOCK];
  int    fewer = 0;

  GainOf(e, s, r, g, wanted, gain);
  for (int q = 0; q < r.n; q++) { /* at t_n */
    T[q] = now[q] - (s.heat ? g->value[q][2] : 0.0);
    p[q] = pg[q] - g->value[q][1];
  }
  LiquidDensityBatch(&r.mat->hydrate, r.n, zero, T, rho_h);
  PerOpenVolume(e, r, p, held);
#pragma GCC ivdep
  for (int q = 0; q < r.n; q++) {
    mw[q] += -held[PHASE_W][q] / rho_h[q] * wanted[q] + nu[PHASE_W] * (wanted[q] - gain[q]);
    mg[q] += -held[PHASE_G][q] / rho_h[q] * wanted[q] + nu[PHASE_G] * (wanted[q] - gain[q]);
  }
  if (s.heat)
    HeatOf(e, s, r, T, wanted, gain);
#pragma GCC ivdep
  for (int q = 0; q < r.n; q++) {
    fewer += gain[q] != wanted[q];
    kept[q] = KeptHydrate(mh[q], mh[q] + gain[q]).v;
    mh[q] += gain[q];
  }
  *limited += fewer;
}

/* (40): masses of the fluids, what the laws' slopes make of the increments, so that the sum over particles is what the
   nodal balances say; the gain of hydrate likewise.  Where hydrate runs out, the missing part is taken back from the
   fluids and from the heat. */
INLINE void MassesOf(Explicit *e, const Set s, Run r, const Gathered *g, double *restrict kept, PetscInt *limited)
{
  double *const *f = e->m->P.f;

  for (int k = 0; k < s.fluids; k++) {
    double *restrict m         = f[P_MW + k] + r.p;
    const double *restrict eos = e->t[T_EOS + k] + r.p;

    for (int q = 0; q < r.n; q++)
      m[q] = eos[q];
    for (int i = 0; i < Scalars(s); i++) {
      const double *restrict slope = e->t[T_SLOPE + 3 * k + (i < s.fluids ? i : 2)] + r.p;

#pragma GCC ivdep
      for (int q = 0; q < r.n; q++)
        m[q] += slope[q] * g->value[q][i];
    }
  }
  if (s.fluids == 2 && r.mat->reacts)
    HydrateOf(e, s, r, g, kept, limited);
}

/* (290): what the rise of the pressures gave. */
INLINE void CountCompression(Explicit *e, const Set s, Run r, const Gathered *g)
{
  for (int k = 0; k < s.fluids; k++) {
    for (int q = 0; q < r.n; q++)
      e->squeezed += e->t[T_WARM + k][r.p + q] * g->value[q][k];
  }
}

/* Volume and saturation of hydrate at the end of the step; false if no open pores are left. */
INLINE bool PoresAfter(Explicit *e, const Set s, Run r, const Strain *n, const double *restrict T, double *restrict phi)
{
  double *const *f     = e->m->P.f;
  const bool     known = s.fluids || s.heat; /* the volume, from the pass before */
  double *restrict V = f[P_V] + r.p, *restrict Sh = f[P_SH] + r.p;
  const double *restrict at = known ? e->t[T_V] + r.p : V, *restrict ms = f[P_MS] + r.p, *restrict mh = f[P_MH] + r.p;
  double rho_s[BLOCK], rho_h[BLOCK], zero[BLOCK]                                                      = {0.0};
  Wrong  full = 0;

  LiquidDensityBatch(&r.mat->solid, r.n, zero, T, rho_s);
  LiquidDensityBatch(&r.mat->hydrate, r.n, zero, T, rho_h);
#pragma GCC ivdep
  for (int q = 0; q < r.n; q++) {
    const double volume = known ? at[q] : V[q] * n->J[q];
    const Pores  v      = PoresOf(volume, ms[q], rho_s[q], mh[q], rho_h[q]);

    full |= WRONG_UNLESS(v.open > 0.0);
    phi[q] = v.phi;
    Sh[q]  = v.Sh;
    V[q]   = volume;
  }
  return !full;
}

/* Mean thermal strain of skeleton and hydrate. */
INLINE void ThermalStrain(const Explicit *e, const Set s, Run r, const Gathered *g, const double *restrict phi,
                          double *restrict thermal)
{
  const double *restrict Sh = e->m->P.f[P_SH] + r.p;

  for (int q = 0; q < r.n; q++)
    thermal[q] = s.heat ? SolidExpansivity(r.mat, phi[q], Sh[q]).v * g->value[q][s.fluids] / 3.0 : 0.0;
}

/* (92): work of the pressures, trapezoidal, and of the ambient one as the particles of a block expand and move. */
INLINE void ExpansionWork(Explicit *e, const Set s, Run r, const Gathered *g, const Strain *n, double dt)
{
  const Ambient *ambient   = &e->m->bc.ambient;
  double *const *f         = e->m->P.f;
  const double *restrict V = f[P_V] + r.p;
  double inside = 0.0, outside = 0.0;

  for (int q = 0; s.fluids && q < r.n; q++) {
    const PetscInt p   = r.p + q;
    const double   dpw = g->value[q][0], pw = f[P_PW][p] - 0.5 * dpw;
    double         mean = pw;

    if (s.fluids == 2) {
      const double dpg = g->value[q][1], pg = f[P_PG][p] - 0.5 * dpg;

      mean = PorePressureOf(e->t[T_SG][p] + 0.5 * e->t[T_DS][p] * (dpg - dpw), pw, pg).v;
    }
    inside += mean * V[q] * (n->J[q] - 1.0);
  }
  for (int q = 0; ambient->on && q < r.n; q++) {
    const double  x[CL_DIM] = {f[P_X][r.p + q], f[P_X + 1][r.p + q]};
    const double *v         = &g->value[q][C_Vs(s)];
    double        gradient[CL_DIM];

    outside += V[q] * (AmbientPressure(ambient, x, gradient) * (n->J[q] - 1.0) +
                       dt * (gradient[0] * v[0] + gradient[1] * v[1]));
  }
  e->work[WORK_PRESSURE] += inside;
  e->work[WORK_LOADS] -= outside;
}

/* Elastic energy that goes with the stiffness, J. */
static double Released(const Elasticity *el, const SkeletonBlock *b, const double *restrict V)
{
  const double *E = b->E, *E_n = b->E_n;
  double        sum     = 0.0;
  Wrong         changes = 0;

  for (int q = 0; q < b->n; q++)
    changes |= WRONG_UNLESS(E[q] == E_n[q]);
  for (int q = 0; changes && q < b->n; q++) {
    SkeletonHistory h;

    SkeletonTake(&b->store, q, &h);
    sum += V[q] * SkeletonReleased(el, b->E_n[q], b->E[q], b->kept ? b->kept[q] : 1.0, &h);
  }
  return sum;
}

/* What plastic flow dissipated, J, and the share of it that the next step gives to the nodes as heat. */
static void PlasticWork(Explicit *e, Run r, const double *work)
{
  double *const *f = e->m->P.f;

  for (int q = 0; q < r.n; q++) {
    const PetscInt p = r.p + q;

    f[P_WP][p] += f[P_V][p] * work[q];
    f[P_HEAT][p] = r.mat->plasticity.heat * f[P_V][p] * work[q];
  }
}

/* New effective stress and history of the skeleton; kept: share of hydrate that is still there (93). */
INLINE void StressOf(Explicit *e, const Set s, Run r, const Gathered *g, const Strain *n, const double *restrict T,
                     const double *kept)
{
  const Elasticity *el     = &r.mat->elasticity;
  const double     *Sh     = e->m->P.f[P_SH] + r.p;
  const bool        yields = r.mat->plasticity.type != PLASTICITY_NONE;
  double            E_old[BLOCK], E[BLOCK], phi[BLOCK] = {0.0}, thermal[BLOCK], work[BLOCK];
  const char       *why = NULL;

  ElasticityYoungBatch(el, r.n, Sh, E_old);
  if (!PoresAfter(e, s, r, n, T, phi))
    ModelNoteFailure(e->m, CL_DOMAIN, "no open pores are left", Worst(r, Sh)); /* S_h >= 1 */
  ElasticityYoungBatch(el, r.n, Sh, E);
  ThermalStrain(e, s, r, g, phi, thermal);
  const SkeletonBlock block = {.n       = r.n,
                               .c       = n->c,
                               .s       = n->s,
                               .xx      = n->xx,
                               .yy      = n->yy,
                               .xy      = n->xy,
                               .thermal = thermal,
                               .E_n     = E_old,
                               .E       = E,
                               .Sh      = Sh,
                               .kept    = kept,
                               .work    = yields ? work : NULL,
                               .store   = ParticlesSkeleton(&e->m->P, r.p, e->ahead)};
  e->m->released += Released(el, &block, e->m->P.f[P_V] + r.p);
  if (!SkeletonUpdateBlock(r.mat, &block, &why))
    ModelNoteFailure(e->m, CL_DOMAIN, why, Worst(r, work));
  if (yields)
    PlasticWork(e, r, work);
}

/* The particle of a block that moves farthest, in cells, or stands outside the grid. */
static PetscInt Farthest(const Explicit *e, const Set s, Run r, const Gathered *g, double dt)
{
  const Grid *grid = &e->m->grid;
  double      size[BLOCK];

  for (int q = 0; q < r.n; q++) {
    size[q] = 0.0;
    for (int d = 0; d < CL_DIM; d++) {
      const GridLines *line = &grid->line[d];
      const double     x = LinesPlace(line, e->m->P.f[P_X + d][r.p + q]), u = dt * g->value[q][C_Vs(s) + d];

      size[q] = fmax(size[q], fabs(u) / LinesLeastAt(line, e->m->P.f[P_X + d][r.p + q] - u));
      if (!(x >= 0.0 && x <= (double)grid->cells[d]))
        size[q] = NAN;
    }
  }
  return Worst(r, size);
}

/* Does a particle, now at x, come from more than half a cell away, or leave the grid? */
INLINE Wrong Strays(const GridLines *line, int n, const double *restrict u, const double *restrict x)
{
  const double h = line->h, lower = line->lower, upper = LinesAt(line, line->cells);
  Wrong        far = 0;

  if (!line->x) {
    for (int q = 0; q < n; q++)
      far |= WRONG_UNLESS((fabs(u[q]) < 0.5 * h) & (x[q] >= lower) & (x[q] <= upper));
    return far;
  }
  for (int q = 0; q < n; q++)
    far |= WRONG_UNLESS((fabs(u[q]) < 0.5 * LinesLeastAt(line, x[q] - u[q])) & (x[q] >= lower) & (x[q] <= upper));
  return far;
}

/* Makes the motion history; false if a particle crosses half a cell or leaves the grid. */
INLINE bool Move(Explicit *e, const Set s, Run r, const Gathered *g, const Strain *n, double dt)
{
  const Grid    *grid   = &e->m->grid;
  const bool     grows  = e->m->c->basis == BASIS_CPGIMP;
  ParticleMotion motion = {.log_J = n->log_J};
  double         u[CL_DIM][BLOCK];
  Wrong          far = 0;

  for (int d = 0; d < CL_DIM; d++) {
    for (int q = 0; q < r.n; q++)
      u[d][q] = dt * g->value[q][C_Vs(s) + d];
    motion.u[d]       = u[d];
    motion.H[d][0]    = n->H[d][0];
    motion.H[d][1]    = n->H[d][1];
    motion.stretch[d] = grows ? n->stretch[d] : NULL;
  }
  ParticlesKeep(&e->m->P, r.p, r.n, &motion);
  for (int d = 0; d < CL_DIM; d++) {
    far |= Strays(&grid->line[d], r.n, u[d], e->m->P.f[P_X + d] + r.p);
  }
  return !far;
}

INLINE void UpdateRun(Explicit *e, const Set s, Run r, double dt)
{
  _Alignas(64) Gathered g;
  Weights               w;
  Strain                n;
  CellMean              mean;
  double *const        *f = e->m->P.f;
  double                kept[BLOCK];
  const double         *T;

  for (int q = 0; q < BLOCK; q++)
    kept[q] = 1.0;
  const bool shared = CellMeanOf(e, &mean);
  WeightsOf(e, r, &w);
  Gather(e, r, &w, &g);
  for (int q = 0; q < r.n && shared; q++)
    MeanMotion(e, &mean, &w, q, &e->C[C_Vs(s)], LANES, &g.dx[q][C_Vs(s)], &g.dy[q][C_Vs(s)]);
  if (s.fluids && e->o.particle_pressures)
    OwnPressures(e, s, r, &g);
  if (Relative(e, s))
    Pressures(e, r, &g);
  if (!Fields(e, s, r, &g))
    ModelNoteFailure(e->m, CL_NONFINITE, "a pressure or temperature left its range", OutOfRange(e, s, r));
  MassesOf(e, s, r, &g, kept, &e->m->limited);
  if (s.heat && e->m->c->compression_heat)
    CountCompression(e, s, r, &g);
  if (s.fluids == 2 && r.mat->gas.trace > 0.0)
    GasOfMethane(e, s, r, &g);
  Relax(e, s, r, &g, dt);
  T = s.heat ? f[P_T] + r.p : e->t[T_T] + r.p;
  if (!s.solid) {
    ParticlesKeep(&e->m->P, r.p, r.n, NULL);
    return;
  }
  if (!StrainOf(s, r.n, &g, dt, &n))
    ModelNoteFailure(e->m, CL_DOMAIN, "the strain of one step exceeds 10 % or is not finite", Strained(r, &n));
  ExpansionWork(e, s, r, &g, &n, dt);
  StressOf(e, s, r, &g, &n, T, kept);
  if (!Scalars(s)) {
    for (int d = 0; d < CL_DIM; d++)
      Blend(e->o.flip, r.n, f[P_VS + d] + r.p, &g.value[0][C_DVs(s) + d], &g.value[0][C_Vs(s) + d], LANES);
  }
  if (!Move(e, s, r, &g, &n, dt))
    ModelNoteFailure(e->m, CL_TOO_FAR, "a particle moves more than half a cell in one step, or leaves the grid",
                     Farthest(e, s, r, &g, dt));
}

MAKE_LOOPS(UpdateRun)

void Update(Explicit *e, double dt)
{
  static const LoopTable table = LOOPS(UpdateRun);

  ForRuns(e, table, dt);
}
