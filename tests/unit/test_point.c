/* Unit tests of src/point: kinematics, the consistent tangent at random states, objectivity, the hydrate solve. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>
#include "clathra/point.h"
#include "clathra/point_reaction.h"
#include "clathra/tensor.h"
#include "random.h"
#include "sediment.h"

#define PI 3.14159265358979323846

/* ---------------------------------------------------------------- random states */
typedef struct {
  Material     mat;
  PointHistory h;
  double       in[IN_COUNT];
} Particle;

typedef enum {
  NO_KINETICS = 0,
  DISSOCIATING,
  FORMING,
  JUST_BELOW,
  JUST_ABOVE,
  NO_HYDRATE,
  LIMITED,
  NO_GAS,
  LITTLE_GAS,
  REGIMES
} Regime;
static const char *const regime_name[REGIMES] = {"no kinetics", "dissociating", "forming", "p_e - 0.1 %", "p_e + 0.1 %",
                                                 "no hydrate",  "m_h* below 0", "no gas",  "little gas"};

static Material RandomMaterial(Rng *r, Regime regime)
{
  Material m = SedimentMaterial();

  assert_true(RetentionSetType(&m.retention, RetentionTypes()[RngPick(r, 3)]));
  assert_true(PermeabilitySetHydrateType(&m.permeability, PermeabilityHydrateTypes()[RngPick(r, 3)]));
  assert_true(PermeabilitySetPorosityType(&m.permeability, PermeabilityPorosityTypes()[RngPick(r, 3)]));
  assert_true(EquilibriumSetType(&m.kinetics.equilibrium, EquilibriumTypes()[RngPick(r, 4)]));
  m.gas.trace   = regime == NO_GAS || regime == LITTLE_GAS ? GasTrace(&m.gas) : 0.0;
  m.gas.carried = regime == LITTLE_GAS && RngPick(r, 2) ? 3e-7 : 0.0;
  if (m.gas.carried > 0.0)
    m.gas.trace = m.gas.carried;
  m.retention.p0     = RngLog(r, regime == NO_GAS || regime == LITTLE_GAS ? 1e5 : 1e3, 1e6);
  m.retention.m      = RngBetween(r, 0.2, 0.8);
  m.retention.lambda = RngBetween(r, 0.5, 3.0);
  m.relperm.nw       = RngBetween(r, 1.0, 6.0);
  m.relperm.ng       = RngBetween(r, 1.0, 4.0);
  m.relperm.of_pores = m.relperm.nw > 3.5;
  if (regime != JUST_ABOVE) /* there rounding of p_e - p, by S_h, would be that of s_g */
    m.retention.hydrate = m.relperm.ng > 2.0 ? m.relperm.ng - 1.0 : 0.0;
  assert_true(GasSetType(&m.gas, GasTypes()[m.relperm.ng > 2.5]));
  m.kinetics.equilibrium.shift = m.relperm.ng > 3.0 ? 0.0 : 1.2;
  m.mu_w.law                   = m.relperm.nw > 3.0;
  m.mu_g.law                   = m.relperm.nw > 2.5;
  m.latent.kirchhoff           = m.relperm.ng > 2.0;
  m.latent.dc                  = 300.0;
  m.permeability.k0            = RngLog(r, 1e-18, 1e-10);
  m.solid.beta                 = RngBetween(r, -1e-4, 3e-4);
  m.hydrate.beta               = RngBetween(r, 1e-5, 5e-4);
  m.water.beta                 = RngBetween(r, 0.0, 5e-4);
  m.kinetics.K0                = RngLog(r, 1e-11, 1e-8);
  m.kinetics.dE                = RngPick(r, 2) ? 0.0 : 20.0;
  m.elasticity.bh              = RngPick(r, 2) ? 1.0 : RngBetween(r, 0.5, 3.0);
  m.elasticity.change          = RngPick(r, 3);
  m.reacts                     = regime != NO_KINETICS;
  if (RngPick(r, 2)) {
    m.kinetics.dE = 78151.0;
    m.kinetics.K0 *= exp(78151.0 / (8.314 * 280.0));
  }
  return m;
}

/* Pressures with mean pore pressure `p` and capillary pressure pc. */
static void SetPressures(Particle *q, double p, double pc, double Sh)
{
  const double sg = GasShareOf(&q->mat, pc, Sh);

  q->in[IN_P]     = p - sg * pc;
  q->in[IN_P + 1] = q->in[IN_P] + pc;
}

static void SetPressureOfRegime(Rng *r, Particle *q, Regime regime, double Sh)
{
  static const double lo[REGIMES] = {0.5, 0.3, 1.05, 0.9989, 1.0009, 0.5, 0.5, 0.3, 1.05};
  static const double hi[REGIMES] = {2.0, 0.95, 2.0, 0.9991, 1.0011, 2.0, 2.0, 0.95, 2.0};
  double              d;
  const double        pe = EquilibriumPressure(&q->mat.kinetics.equilibrium, q->in[IN_T] + q->h.shift[2], &d);
  const double        p0 = q->mat.retention.p0;
  double              pc = RngPick(r, 4) ? RngLog(r, 0.1, 10.0) * p0 : -0.5 * p0;

  if (regime == NO_GAS || regime == LITTLE_GAS)
    pc = p0 * (regime == NO_GAS ? RngBetween(r, -40.0, -20.0) : RngBetween(r, -0.3, 0.3));
  SetPressures(q, RngBetween(r, lo[regime], hi[regime]) * pe, pc, Sh);
  for (int f = 0; f < PHASE_COUNT; f++) /* what the reaction sees is the same */
    q->in[IN_P + f] -= q->h.shift[0];
}

/* A fluid around the body whose pressure changes within millimetres, so that differences see it. */
static const Ambient sea = {.on = true, .pressure = 2e6, .weight = {3e8, -7e8}, .head = -5e6};

/* A state and a history from which it could have come. */
static void RandomParticle(Rng *r, Regime regime, Particle *q)
{
  const double V = RngLog(r, 1e-6, 1.0), phi = RngBetween(r, 0.25, 0.6), Sh = RngBetween(r, 0.02, 0.5);

  q->mat        = RandomMaterial(r, regime);
  q->in[IN_T]   = RngBetween(r, 2.0, 15.0);
  q->h          = (PointHistory){.V = V, .dt = RngLog(r, 1.0, 1e4), .spread = {3e-13, 2e-12}};
  q->h.T_n      = q->in[IN_T] + RngBetween(r, -2.0, 2.0);
  q->h.Sh_n     = Sh * RngBetween(r, 0.8, 1.2);
  q->h.shift[0] = q->h.shift[1] = RngBetween(r, -5e4, 5e4);
  if (regime != JUST_BELOW && regime != JUST_ABOVE)
    q->h.shift[1] += RngBetween(r, -2e4, 2e4);
  q->h.shift[2]   = RngBetween(r, -0.5, 0.5);
  const double tw = RngBetween(r, -0.3, 0.3);
  for (int k = 0; k < MOTION_COUNT; k++)
    q->in[IN_GRADU + k] = RngBetween(r, -0.03, 0.03);
  q->in[IN_GRADU + 1] -= tw;
  q->in[IN_GRADU + 2] += tw;
  SetPressureOfRegime(r, q, regime, Sh);
  InitialMasses(&q->mat, V, phi, Sh, q->in[IN_P], q->in[IN_P + 1], q->in[IN_T], &q->h.m_s, &q->h.m_star[0],
                &q->h.m_star[1], &q->h.m_star[2]);
  for (int k = 0; k < 3; k++)
    q->h.m_star[k] *= RngBetween(r, 0.97, 1.03);
  if (regime == NO_HYDRATE || regime == LIMITED)
    q->h.m_star[0] *= regime == LIMITED ? -0.01 : 0.0;
  if (regime == NO_HYDRATE && RngPick(r, 2))
    q->h.Sh_n = 0.0;
  for (int k = 0; k < 4; k++) { /* where hydrate bears a stress of its own */
    q->h.skeleton.from.sig[k]              = RngBetween(r, -5e6, 5e6);
    q->h.skeleton.from.strain[k]           = RngBetween(r, -1e-3, 1e-3);
    q->h.skeleton.from.own[OWN_P_BOND + k] = RngBetween(r, -5e6, 5e6);
  }
  for (int k = 0; k < 6; k++) {
    q->h.skeleton.sig[k]  = RngBetween(r, -5e6, 5e6);
    q->h.skeleton.sig0[k] = RngBetween(r, -2e6, 2e6);
  }
  for (int k = 0; k < 4; k++) {
    q->in[IN_GP + k]        = RngBetween(r, -1e6, 1e6);
    q->h.proj[k / 2][k % 2] = RngBetween(r, -1e6, 1e6);
    q->in[IN_J + k]         = RngBetween(r, -1.0, 1.0) * 1e-5;
    q->in[IN_GT + (k & 1)]  = RngBetween(r, -50.0, 50.0);
    q->in[IN_U + (k & 1)]   = RngBetween(r, -1e-3, 1e-3);
  }
  q->h.ambient     = &sea;
  q->h.upwind[0]   = 3.0;
  q->h.upwind[1]   = 0.7;
  q->h.upwind[2]   = -0.9;
  q->h.compression = RngPick(r, 2) != 0;
  for (int f = 0; f < PHASE_COUNT; f++) {
    q->h.p_star[f]  = q->in[IN_P + f] + RngBetween(r, -2e6, 2e6);
    q->h.gravity[f] = RngBetween(r, -20.0, 20.0);
  }
}

static ClStatus Evaluate(const Particle *q, bool tangent, PointState *s, PointOutput *o)
{
  const char    *why    = NULL;
  const ClStatus status = PointEvaluate(&(PointInput){AllFields(), &q->mat, &q->h, q->in}, tangent, s, o, &why);

  assert_true((status == CL_OK) == (why == NULL));
  return status;
}

/* ---------------------------------------------------------------- kinematics */
typedef struct {
  double g[MOTION_COUNT];
  int    which;
} KinematicsContext;

static bool KinematicsRows(void *ctx, double x, double y[RIDDERS_ROWS])
{
  KinematicsContext *c = (KinematicsContext *)ctx;
  double             g[MOTION_COUNT];
  Kinematics         k;

  memcpy(g, c->g, sizeof(g));
  g[c->which] = x;
  if (!KinematicsEvaluate(g, &k))
    return false;
  y[0] = atan2(k.turn.s, k.turn.c);
  y[1] = k.J;
  for (int i = 0; i < 4; i++) {
    y[2 + i] = k.e[i];
    y[6 + i] = k.cof[i / 2][i % 2];
  }
  y[10] = k.cof_hoop;
  return true;
}

static void TestKinematicsDerivatives(void **state)
{
  Rng    r     = {101};
  double worst = 0.0;

  (void)state;
  for (int n = 0; n < 3000; n++) {
    const double      size = RngLog(&r, 1e-6, 0.5), tw = RngBetween(&r, -0.9, 0.9);
    KinematicsContext c;
    Kinematics        k;

    for (int i = 0; i < MOTION_COUNT; i++)
      c.g[i] = RngBetween(&r, -size, size);
    c.g[1] -= tw * (n % 2);
    c.g[2] += tw * (n % 2);
    if (!KinematicsEvaluate(c.g, &k) || k.J < 0.2)
      continue;
    for (c.which = 0; c.which < MOTION_COUNT; c.which++) {
      const bool hoop = c.which == MOTION_HOOP;
      double     dy[RIDDERS_ROWS], err[RIDDERS_ROWS], exact[11] = {hoop ? 0.0 : k.dtheta[0][c.which], k.dJ[c.which]};

      for (int i = 0; i < 4; i++) {
        exact[2 + i] = k.de[i][c.which];
        exact[6 + i] = k.dcof[i / 2][i % 2][c.which];
      }
      exact[10] = hoop ? 0.0 : k.dJ[c.which] / k.lambda;
      assert_true(Ridders(KinematicsRows, &c, c.g[c.which], 0.02, 11, dy, err));
      for (int i = 0; i < 11; i++)
        worst = fmax(worst, fabs(dy[i] - exact[i]));
    }
  }
  printf("kinematics: derivatives of theta, J, ln V, cof against differences: worst %.1e (all of order 1)\n", worst);
  assert_true(worst < 1e-9);
}

/* ln V against an eigen-decomposition done here, and F = V R. */
static void TestKinematicsValues(void **state)
{
  Rng    r     = {102};
  double worst = 0.0, uniaxial = 0.0, rigid = 0.0;

  (void)state;
  for (int n = 0; n < 20000; n++) {
    const double a = RngBetween(&r, -PI, PI), t = RngBetween(&r, -PI, PI), q = RngLog(&r, 1e-8, 0.7);
    const double s1 = q * RngBetween(&r, -1.0, 1.0), s2 = q * RngBetween(&r, -1.0, 1.0); /* logarithmic stretches */
    const double c = cos(a), s = sin(a), e1 = exp(s1), e2 = exp(s2);
    const double V[2][2] = {{c * c * e1 + s * s * e2, c * s * (e1 - e2)}, {c * s * (e1 - e2), s * s * e1 + c * c * e2}};
    const double R[2][2] = {{cos(t), -sin(t)}, {sin(t), cos(t)}};
    const double e[4]    = {c * c * s1 + s * s * s2, s * s * s1 + c * c * s2, 0.0, c * s * (s1 - s2)};
    double       g[MOTION_COUNT] = {0.0}, angle;
    Kinematics   k;

    for (int i = 0; i < 4; i++)
      g[i] = V[i / 2][0] * R[0][i % 2] + V[i / 2][1] * R[1][i % 2] - (i == 0 || i == 3);
    assert_true(KinematicsEvaluate(g, &k));
    angle = remainder(atan2(k.turn.s, k.turn.c) - t, 2.0 * PI);
    for (int i = 0; i < 4; i++)
      worst = fmax(worst, fabs(k.e[i] - e[i]));
    worst = fmax(fmax(worst, fabs(angle)), fabs(k.J - e1 * e2));

    const double u[MOTION_COUNT] = {e1 - 1.0};
    assert_true(KinematicsEvaluate(u, &k));
    uniaxial                     = fmax(fmax(uniaxial, fabs(k.e[0] - log(k.J))), fmax(fabs(k.e[YY]), fabs(k.e[XY])));
    const double w[MOTION_COUNT] = {R[0][0] - 1.0, R[0][1], R[1][0], R[1][1] - 1.0};
    assert_true(KinematicsEvaluate(w, &k));
    for (int i = 0; i < 4; i++)
      rigid = fmax(rigid, fabs(k.e[i]));
    for (int i = 0; i < 2; i++)
      rigid = fmax(rigid, fabs(k.stretch[i] - 1.0));
  }
  printf("kinematics: theta, J, ln V of F = V R: %.1e; uniaxial e - ln J: %.1e; rigid rotation, strain: %.1e\n", worst,
         uniaxial, rigid);
  assert_true(worst < 4e-15);
  assert_true(uniaxial < 5e-16);
  assert_true(rigid < 1e-15);
}

/* ---------------------------------------------------------------- tangent */
typedef struct {
  Particle q;
  double  *which; /* a member of q */
} TangentContext;

static bool OutputRows(void *ctx, double x, double y[RIDDERS_ROWS])
{
  TangentContext *c  = (TangentContext *)ctx;
  const double    x0 = *c->which;
  PointState      s;
  PointOutput     o;

  *c->which             = x;
  const ClStatus status = Evaluate(&c->q, false, &s, &o);
  *c->which             = x0;
  memcpy(y, o.out, sizeof(o.out));
  y[OUT_M] = s.m_h; /* without the constant m_s, in which small changes drown */
  return status == CL_OK;
}

/* A typical change of each input, in whose units columns of one row compare. */
static void InputScales(double scale[IN_COUNT])
{
  for (int k = 0; k < IN_COUNT; k++)
    scale[k] = k < IN_P    ? 1.0
               : k < IN_T  ? 1e6
               : k == IN_T ? 10.0
               : k < IN_GT ? 1e6
               : k < IN_J  ? 50.0
               : k < IN_U  ? 1e-5
                           : 1e-3;
}

typedef struct {
  double worst;
  int    row, column;
} Worst;

static void Note(Worst *w, double error, int row, int column)
{
  if (!(error <= w->worst))
    *w = (Worst){error, row, column};
}

/* The terms that make up an output: round-off is relative to them, and no difference can see a derivative below it. */
static void Magnitudes(const Particle *q, const PointState *s, const PointOutput *o, double size[OUT_COUNT])
{
  double       d;
  const double latent = fabs(LatentHeatEvaluate(&q->mat.latent, q->in[IN_T], &d)) / q->h.dt;

  for (int i = 0; i < OUT_COUNT; i++)
    size[i] = fabs(o->out[i]);
  size[OUT_M]    = s->m_h;
  size[OUT_ROOT] = size[OUT_ROOT + 1] = 10.0; /* where a fluid fills the pores slopes drown in the digits of 1 */
  size[OUT_DM] += s->m_w + s->m_h;
  size[OUT_DM + 1] += s->m_g + s->m_h;
  size[OUT_Q] += latent * (s->m_h + fabs(q->h.m_star[0]));
  if (q->h.compression)
    size[OUT_Q] += s->V * 1e6 / q->h.dt;
}

/* Long steps see round-off least, short ones stay off the kinks of the laws: the better of the two counts. */
static bool Differences(TangentContext *c, double x, double step, double D[OUT_COUNT][IN_COUNT], int column,
                        double dy[RIDDERS_ROWS])
{
  double near[RIDDERS_ROWS], err[RIDDERS_ROWS];

  if (!Ridders(OutputRows, c, x, step, OUT_COUNT, dy, err) ||
      !Ridders(OutputRows, c, x, step / 32.0, OUT_COUNT, near, err))
    return false;
  for (int i = 0; i < OUT_COUNT; i++) {
    if (fabs(near[i] - D[i][column]) < fabs(dy[i] - D[i][column]))
      dy[i] = near[i];
  }
  return true;
}

/* Errors relative to the largest scaled entry of the row, or to 1e-5 of its magnitude.  Steps stay well inside 0.1 % of
   p_e where that is near. */
static void CheckTangent(const Particle *q, double step, Worst *row)
{
  TangentContext c = {.q = *q};
  double         scale[IN_COUNT], dy[IN_COUNT][RIDDERS_ROWS], top[OUT_COUNT] = {0.0};
  double         size[OUT_COUNT];
  PointState     s;
  PointOutput    o;

  InputScales(scale);
  assert_int_equal(Evaluate(q, true, &s, &o), CL_OK);
  Magnitudes(q, &s, &o, size);
  for (int k = 0; k < IN_COUNT; k++) {
    c.which = &c.q.in[k];
    assert_true(Differences(&c, q->in[k], step * scale[k], o.D, k, dy[k]));
    for (int i = 0; i < OUT_COUNT; i++)
      top[i] = fmax(top[i], fmax(fabs(o.D[i][k]), fabs(dy[k][i])) * scale[k]);
  }
  for (int i = 0; i < OUT_COUNT; i++) {
    const double floor = fmax(top[i], 1e-5 * size[i]);

    for (int k = 0; k < IN_COUNT; k++) {
      const double error = fabs(o.D[i][k] - dy[k][i]) * scale[k];

      if (error > 0.0)
        Note(row, error / floor, i, k);
    }
  }
}

static void CheckWide(const Particle *q, Worst *worst)
{
  TangentContext c = {.q = *q};
  double         dy[RIDDERS_ROWS], err[RIDDERS_ROWS];
  PointState     s;
  PointOutput    o;

  assert_int_equal(Evaluate(q, true, &s, &o), CL_OK);
  for (int k = 0; k < 4; k++) {
    const int f = k / 2, j = k % 2;
    double    exact[OUT_COUNT] = {0.0};

    c.which = &c.q.h.proj[f][j];
    for (int i = 0; i < 2; i++)
      exact[OUT_FLUX + 2 * f + i] = o.wide[f][f][i][j];
    if (f == PHASE_W) /* (352) */
      for (int i = 0; i < 2; i++)
        exact[OUT_FLUX + 2 * PHASE_G + i] = o.wide[PHASE_G][PHASE_W][i][j];
    exact[OUT_Q] = o.wide_q[f][j];
    assert_true(Ridders(OutputRows, &c, *c.which, 1e5, OUT_COUNT, dy, err));
    for (int i = 0; i < OUT_COUNT; i++) {
      if (fabs(dy[i] - exact[i]) > 0.0)
        Note(worst, fabs(dy[i] - exact[i]) * 1e6 / (fabs(exact[i]) * 1e6 + fabs(o.out[i])), i, k);
    }
  }
}

/* 29 x 17 entries and the wide part at random states of every regime, all laws. */
static void TestTangent(void **state)
{
  Rng r = {103};

  (void)state;
  printf("tangent against differences, worst of 400 random states: 29 x 17 entries | wide part, relative to the row\n");
  for (int regime = 0; regime < REGIMES; regime++) {
    /* where there is no gas the digits of p_e - p_g tell more than the law's curvature */
    const double step = regime == JUST_ABOVE || regime == JUST_BELOW ? 2e-4 : regime == NO_GAS ? 2e-2 : 5e-3;
    Worst        row = {0.0, 0, 0}, wide = {0.0, 0, 0};

    for (int n = 0; n < 400; n++) {
      Particle q;

      RandomParticle(&r, (Regime)regime, &q);
      CheckTangent(&q, step, &row);
      CheckWide(&q, &wide);
    }
    printf("  %-13s %.1e (out %d, in %d) | %.1e (out %d)\n", regime_name[regime], row.worst, row.row, row.column,
           wide.worst, wide.row);
    assert_true(row.worst < 1e-6);
    assert_true(wide.worst < 1e-8);
  }
}

/* ---------------------------------------------------------------- objectivity */
/* A particle that reproduces its own history: nothing moves, nothing reacts, temperature and hydrate as at t_n. */
static void RestingParticle(Rng *r, Particle *q)
{
  PointState  s;
  PointOutput o;

  RandomParticle(r, NO_KINETICS, q);
  for (int i = 0; i < 4; i++) { /* a first stage */
    q->h.skeleton.from.sig[i]    = q->h.skeleton.sig[i];
    q->h.skeleton.from.strain[i] = 0.0;
  }
  q->h.T_n = q->in[IN_T];
  memset(&q->in[IN_GRADU], 0, MOTION_COUNT * sizeof(double));
  assert_int_equal(Evaluate(q, false, &s, &o), CL_OK);
  q->h.Sh_n = s.Sh;
}

static void RotateBy(Particle *q, double theta)
{
  q->in[IN_GRADU] = q->in[IN_GRADU + 3] = cos(theta) - 1.0;
  q->in[IN_GRADU + 1]                   = -sin(theta);
  q->in[IN_GRADU + 2]                   = sin(theta);
}

/* R s R^T as a 3x3 product. */
static void RotateTensor(const double s[6], double theta, double r[6])
{
  static const int at[3][3] = {{XX, XY, XZ}, {XY, YY, YZ}, {XZ, YZ, ZZ}};
  const double     R[3][3]  = {{cos(theta), -sin(theta), 0.0}, {sin(theta), cos(theta), 0.0}, {0.0, 0.0, 1.0}};

  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++) {
      r[at[i][j]] = 0.0;
      for (int k = 0; k < 3; k++) {
        for (int l = 0; l < 3; l++)
          r[at[i][j]] += R[i][k] * s[at[k][l]] * R[j][l];
      }
    }
  }
}

/* One rotation of any angle: stress, forces and fluxes turn with the body; scalars stay. */
static void TestRigidRotation(void **state)
{
  Rng    r      = {104};
  double stress = 0.0, force = 0.0, scalar = 0.0;

  (void)state;
  for (int n = 0; n < 5000; n++) {
    const double theta = n < 5 ? (n - 2) * PI / 2.0 : RngBetween(&r, -PI, PI), c = cos(theta), s = sin(theta);
    Particle     q;
    PointState   a, b;
    PointOutput  oa, ob;
    double       turned[6], dE;

    RestingParticle(&r, &q);
    assert_int_equal(Evaluate(&q, false, &a, &oa), CL_OK);
    RotateBy(&q, theta);
    assert_int_equal(Evaluate(&q, false, &b, &ob), CL_OK);
    const double E = ElasticityYoung(&q.mat.elasticity, q.h.Sh_n, &dE); /* 1 ulp in J is a strain, and so a stress */
    RotateTensor(q.h.skeleton.sig, theta, turned);
    for (int k = 0; k < 6; k++)
      stress = fmax(stress, fabs(b.skeleton.sig[k] - turned[k]) / (5e6 + 0.2 * E));
    for (int k = 0; k < 2; k++) { /* P' = R P: the force on a node turns with the body; its gradients G do not */
      const double x = oa.out[OUT_P + k], y = oa.out[OUT_P + 2 + k], size = q.h.V * (1e7 + 0.2 * E);

      force = fmax(force, fabs(ob.out[OUT_P + k] - (c * x - s * y)) / size);
      force = fmax(force, fabs(ob.out[OUT_P + 2 + k] - (s * x + c * y)) / size);
      force = fmax(force, fabs(ob.out[OUT_HEAT + k] - oa.out[OUT_HEAT + k]) / (q.h.V * 150.0));
    }
    for (int k = OUT_M; k <= OUT_C; k++) {
      const bool share = k == OUT_ROOT || k == OUT_ROOT + 1; /* of 1, and steep where it is small */

      if (k < OUT_DM || k == OUT_C)
        scalar = fmax(scalar, fabs(ob.out[k] - oa.out[k]) / (share ? 1.0 : oa.out[k]));
    }
  }
  printf("rigid rotation of a stressed body: stress %.1e, forces %.1e, masses and coefficients %.1e\n", stress, force,
         scalar);
  assert_true(stress < 1e-14);
  assert_true(force < 1e-14);
  assert_true(scalar < 1e-13);
}

/* The same state with the deformed configuration as its reference: F = 1, V = J V_n, gradients F^-T g. */
static void MoveReference(const Particle *from, const Kinematics *k, Particle *q)
{
  *q     = *from;
  q->h.V = k->J * from->h.V;
  for (int a = 0; a < MOTION_COUNT; a++)
    q->in[IN_GRADU + a] = 0.0;
  for (int i = 0; i < 2; i++) {
    const double *g = from->in, *co = k->cof[i];

    for (int f = 0; f < PHASE_COUNT; f++) {
      q->in[IN_GP + 2 * f + i] = (co[0] * g[IN_GP + 2 * f] + co[1] * g[IN_GP + 2 * f + 1]) / k->J;
      q->h.proj[f][i]          = (co[0] * from->h.proj[f][0] + co[1] * from->h.proj[f][1]) / k->J;
    }
    q->in[IN_GT + i] = (co[0] * g[IN_GT] + co[1] * g[IN_GT + 1]) / k->J;
  }
}

/* Which configuration gradients are taken on does not matter: fluxes become F^-1 times those of the deformed one
   (Piola), forces, masses and carried heat stay. */
static void TestReference(void **state)
{
  Rng    r    = {112};
  double flux = 0.0, force = 0.0, scalar = 0.0;
  int    seen = 0;

  (void)state;
  for (int n = 0; n < 20000; n++) {
    Particle    q, moved;
    PointState  a, b;
    PointOutput oa, ob;
    Kinematics  k;

    RandomParticle(&r, NO_KINETICS, &q);
    for (int i = 0; i < MOTION_COUNT; i++)
      q.in[IN_GRADU + i] *= 10.0;
    SetSolubility(&q.mat.gas, RngPick(&r, 2) ? 1.9e-5 : 0.0);
    q.h.compression = false;
    q.h.upwind[0] = q.h.upwind[1] = q.h.upwind[2] = 0.0; /* is of the configuration at t_n */
    assert_true(KinematicsEvaluate(&q.in[IN_GRADU], &k));
    MoveReference(&q, &k, &moved);
    if (Evaluate(&q, false, &a, &oa) != CL_OK)
      continue; /* no pores are left */
    assert_int_equal(Evaluate(&moved, false, &b, &ob), CL_OK);
    seen++;
    for (int row = OUT_FLUX; row <= OUT_HEAT; row += 2) {
      const double *x = &ob.out[row], size = hypot(x[0], x[1]);

      for (int i = 0; i < 2; i++) /* F^-1 = cof^T/J */
        flux = fmax(flux, fabs(oa.out[row + i] - (k.cof[0][i] * x[0] + k.cof[1][i] * x[1]) / k.J) / size);
    }
    for (int row = OUT_G; row < OUT_M; row += 2) {
      const double *x = &ob.out[row], *y = &oa.out[row];

      force = fmax(force, hypot(y[0] - x[0], y[1] - x[1]) / hypot(x[0], x[1]));
    }
    for (int row = OUT_M; row <= OUT_C; row++) {
      if (row < OUT_DM || row == OUT_C)
        scalar = fmax(scalar, fabs(oa.out[row] - ob.out[row]) / fabs(ob.out[row]));
    }
  }
  printf("another reference configuration: fluxes %.1e, forces %.1e, masses and coefficients %.1e\n", flux, force,
         scalar);
  assert_true(seen > 10000);
  assert_true(flux < 1e-12);
  assert_true(force < 1e-14);
  assert_true(scalar < 1e-13);
}

/* A thousand turns of 73 degrees: the stress drifts by round-off only. */
static void TestManyTurns(void **state)
{
  Rng         r = {105};
  Particle    q;
  PointState  s;
  PointOutput o;
  double      first[6], first0[6], turned[6], turned0[6], worst = 0.0;

  (void)state;
  RestingParticle(&r, &q);
  memcpy(first, q.h.skeleton.sig, sizeof(first));
  memcpy(first0, q.h.skeleton.sig0, sizeof(first0));
  for (int n = 1; n <= 1000; n++) {
    RotateBy(&q, 73.0 * PI / 180.0);
    assert_int_equal(Evaluate(&q, false, &s, &o), CL_OK);
    memcpy(q.h.skeleton.sig, s.skeleton.sig, sizeof(s.skeleton.sig));
    memcpy(q.h.skeleton.sig0, s.skeleton.sig0, sizeof(s.skeleton.sig0));
    memcpy(q.h.skeleton.from.sig, s.skeleton.sig, sizeof(q.h.skeleton.from.sig));
    memcpy(q.h.skeleton.from.own, s.skeleton.own, sizeof(s.skeleton.own));
    q.h.V = s.V;
  }
  RotateTensor(first, 1000.0 * 73.0 * PI / 180.0, turned);
  RotateTensor(first0, 1000.0 * 73.0 * PI / 180.0, turned0);
  for (int k = 0; k < 6; k++)
    worst = fmax(worst, fmax(fabs(s.skeleton.sig[k] - turned[k]), fabs(s.skeleton.sig0[k] - turned0[k])) / 5e6);
  printf("1000 turns of 73 degrees: stress %.1e of 5 MPa\n", worst);
  assert_true(worst < 1e-12);
}

/* Simple shear to gamma in n steps; the exact Jaumann solution is s_xy = G sin gamma, s_xx = -s_yy = G (1 - cos gamma).
 */
static double ShearError(double gamma, int n)
{
  Rng         r = {106};
  Particle    q;
  PointState  s;
  PointOutput o;

  RestingParticle(&r, &q);
  q.mat.elasticity.Eh = 0.0;
  memset(q.h.skeleton.sig, 0, sizeof(q.h.skeleton.sig));
  memset(q.h.skeleton.sig0, 0, sizeof(q.h.skeleton.sig0));
  q.in[IN_GRADU + 1] = gamma / n;
  for (int k = 0; k < n; k++) {
    assert_int_equal(Evaluate(&q, false, &s, &o), CL_OK);
    memcpy(q.h.skeleton.sig, s.skeleton.sig, sizeof(s.skeleton.sig));
  }
  const double G = q.mat.elasticity.E0 * ElasticityShearFactor(&q.mat.elasticity), normal = 1.0 - cos(gamma);

  return fmax(fabs(s.skeleton.sig[XY] / G - sin(gamma)),
              fmax(fabs(s.skeleton.sig[XX] / G - normal),
                   fmax(fabs(s.skeleton.sig[YY] / G + normal), fabs(s.skeleton.sig[ZZ] / G))));
}

static void TestSimpleShear(void **state)
{
  double old = NAN, order = NAN, error = NAN;

  (void)state;
  printf(
      "Jaumann simple shear to gamma = 2: largest error of s_xy = G sin(gamma), s_xx = G (1 - cos(gamma)), over G\n");
  for (int n = 10; n <= 10240; n *= 4) {
    error = ShearError(2.0, n);
    order = log(old / error) / log(4.0);
    printf("  %5d steps: %.3e, order %.3f\n", n, error, order);
    if (n > 10)
      assert_true(fabs(order - 2.0) < 0.02);
    old = error;
  }
  assert_true(error < 1e-7);
}

/* ---------------------------------------------------------------- hydrate */
/* For any length of the step: dissociation leaves 0 <= m_h <= m_h*, formation m_h* <= m_h below the full pore. */
static void TestHydrateBounds(void **state)
{
  Rng    r        = {107};
  double smallest = INFINITY, fullest = 0.0;

  (void)state;
  for (int n = 0; n < 30000; n++) {
    static const Regime regime[3] = {DISSOCIATING, FORMING, NO_HYDRATE};
    Particle            q;
    PointState          s;
    PointOutput         o;

    RandomParticle(&r, regime[n % 3], &q);
    memset(&q.in[IN_GRADU], 0, MOTION_COUNT * sizeof(double));
    q.h.m_star[0] = fmax(0.0, q.h.m_star[0]);
    q.h.dt        = RngLog(&r, 1e-3, 1e9);
    if (n % 2)
      q.mat.kinetics.K0 *= RngLog(&r, 1.0, 1e12);
    assert_int_equal(Evaluate(&q, true, &s, &o), CL_OK);
    if (n % 3 == 0)
      assert_true(s.m_h <= q.h.m_star[0]);
    if (n % 3 == 1)
      assert_true(s.m_h >= q.h.m_star[0]);
    for (int k = 0; k < OUT_COUNT * IN_COUNT; k++)
      assert_true(isfinite((&o.D[0][0])[k]));
    smallest = fmin(smallest, s.Sh);
    fullest  = fmax(fullest, s.Sh);
  }
  printf("steps of 1e-3 to 1e9 s, K_d up to 1e12 times: S_h from %.1e to 1 - %.1e\n", smallest, 1.0 - fullest);
  assert_true(smallest >= 0.0);
  assert_true(fullest < 1.0);
}

/* The integral of the rate: m_h satisfies (11)-(13), (371), checked against an independent bisection in S_h. */
/* What pores that hold S of hydrate lack of what the reaction leaves them, kg: (11)-(13), (371), (418). */
static double Lacks(const Particle *q, const PointState *s, double S, double rho, double pe, double rate)
{
  const double pc = q->in[IN_P + 1] - q->in[IN_P], sg = GasShareOf(&q->mat, pc, S), pore = s->phi * s->V * rho;
  const double pw = q->in[IN_P] + q->h.shift[0], pg = q->in[IN_P + 1] + q->h.shift[1]; /* of the nodal fields */
  const bool   holds = q->mat.gas.trace > 0.0;
  const double p = holds && pg < pw ? pg : (1.0 - sg) * pw + sg * pg, S0 = q->h.m_star[0] / pore;
  const double gas = fmax(pg - pw, 0.0) / RetentionTrapScale(&q->mat.retention);
  const double x = fmax(p - pe, 1e-12) / WET_OVER, whole = pow(fmax(1.0 - S0, 0.01), -3.0);
  const double more = 1.0 + (whole - 1.0) * -expm1(-x) / x;
  const double wet  = holds ? s->phi * S0 * more * pow(1.0 - S, 3.0) * exp(-gas) : 0.0;
  const double area = p <= pe ? s->phi * S : (1.0 - sg) * (sg * pow(1.0 - S, 3.0) + wet);

  return q->h.m_star[0] - rate * (pe - p) * area - pore * S;
}

static void TestHydrateEquation(void **state)
{
  Rng    r     = {108};
  double worst = 0.0;

  (void)state;
  for (int n = 0; n < 3000; n++) {
    static const Regime regime[4] = {DISSOCIATING, FORMING, JUST_ABOVE, LITTLE_GAS};
    Particle            q;
    PointState          s;
    PointOutput         o;
    double              d1, d2, lo = 0.0, hi = 1.0;

    RandomParticle(&r, regime[n % 4], &q);
    assert_int_equal(Evaluate(&q, false, &s, &o), CL_OK);
    const Kinetics *k = &q.mat.kinetics;
    const double    T = q.in[IN_T] + q.h.shift[2], pe = EquilibriumPressure(&k->equilibrium, T, &d1);
    const double    rho  = LiquidDensity(&q.mat.hydrate, 0.0, q.in[IN_T], &d1, &d2);
    const double    rate = q.h.dt * s.V * k->M_h * KineticsRateConstant(k, T, &d1) * k->A_geo;
    for (int it = 0; it < 200; it++) {
      const double S = 0.5 * (lo + hi);

      *(Lacks(&q, &s, S, rho, pe, rate) < 0.0 ? &hi : &lo) = S;
    }
    worst = fmax(worst, fabs(s.Sh - lo));
  }
  printf("hydrate equation (11)-(13), (371), (418) against bisection: S_h within %.1e\n", worst);
  assert_true(worst < 1e-13); /* p_e - p cancels to a thousandth: 1e-16/1e-3 */
}

/* Newton for p_w, p_g of a closed isothermal cell: OUT_DM = 0. */
static bool SolveClosedCell(Particle *q, PointState *s)
{
  PointOutput o, t;
  PointState  st;

  for (int it = 0; it < 200; it++) {
    double cut = 1.0, dx[2];

    assert_int_equal(Evaluate(q, true, s, &o), CL_OK);
    const double *a = &o.D[OUT_DM][IN_P], *b = &o.D[OUT_DM + 1][IN_P], f = o.out[OUT_DM], g = o.out[OUT_DM + 1];
    const double  det = a[0] * b[1] - a[1] * b[0];

    dx[0] = -(b[1] * f - a[1] * g) / det;
    dx[1] = -(a[0] * g - b[0] * f) / det;
    if (fabs(dx[0]) + fabs(dx[1]) < 4e-9) /* a few ulp */
      return true;
    const double size = fabs(f) / q->h.m_star[1] + fabs(g) / q->h.m_star[2], p[2] = {q->in[IN_P], q->in[IN_P + 1]};
    for (int halve = 0; halve < 60; halve++, cut *= 0.5) { /* monotone decrease */
      for (int k = 0; k < 2; k++)
        q->in[IN_P + k] = p[k] + cut * dx[k];
      const char *why;
      if (PointEvaluate(&(PointInput){AllFields(), &q->mat, &q->h, q->in}, false, &st, &t, &why) == CL_OK &&
          fabs(t.out[OUT_DM]) / q->h.m_star[1] + fabs(t.out[OUT_DM + 1]) / q->h.m_star[2] < size)
        break;
    }
  }
  return false;
}

/* K_d to infinity in a closed isothermal cell: p tends to p_e like 1/K_d, whether hydrate forms or dissociates; where
   gas is scarce it is p_g that does (371). */
static void ClosedCell(double p0, double pc, const char *what)
{
  Particle   q   = {.mat = SedimentMaterial(), .h = {.V = 1e-4, .dt = 10.0, .T_n = 4.0}};
  double     old = NAN, d;
  PointState s;

  q.mat.reacts           = true;
  q.mat.retention.p_trap = 1e6;
  q.in[IN_T]             = 4.0;
  if (pc < 0.0) {
    q.mat.gas.trace = GasTrace(&q.mat.gas);
    q.mat.water.K   = 1e7; /* where gas is scarce water's own gives the ulps of p_w */
  }
  SetPressures(&q, p0, pc, 0.1);
  InitialMasses(&q.mat, q.h.V, 0.3, 0.1, q.in[IN_P], q.in[IN_P + 1], 4.0, &q.h.m_s, &q.h.m_star[0], &q.h.m_star[1],
                &q.h.m_star[2]);
  q.h.Sh_n        = 0.1;
  const double pe = EquilibriumPressure(&q.mat.kinetics.equilibrium, 4.0, &d), K0 = q.mat.kinetics.K0;
  for (double f = 1.0; f <= 1e12; f *= 100.0) {
    q.mat.kinetics.K0 = f * K0;
    assert_true(SolveClosedCell(&q, &s));
    const double p = pc < 0.0 ? q.in[IN_P + 1] : s.p, gap = fabs(p - pe);
    printf("  %s, K_d x %.0e: p - p_e = %12.5e Pa, S_h = %.8f\n", what, f, p - pe, s.Sh);
    if ((pc < 0.0 ? old < 0.1 * WET_OVER : f > 1e3) && f < 1e9) /* (418) fades over WET_OVER */
      assert_true(fabs(gap * 100.0 / old - 1.0) < 0.05);
    assert_true(what[0] == 'f' ? s.Sh > 0.1 : s.Sh < 0.1);
    old = gap;
  }
  assert_true(old < 1e-3);
}

/* (323): without gas, methane flows from the higher p_g to the lower, also where both are below zero. */
static void TestFlowOfTrace(void **state)
{
  static const double pg[] = {3e6, 1e5, -1e5, -3e7, -5e10};
  const char         *why;

  (void)state;
  for (size_t k = 0; k < sizeof(pg) / sizeof(*pg); k++) {
    Particle    q = {.mat = SedimentMaterial(), .h = {.V = 1e-4, .dt = 1e7, .T_n = 4.0}};
    PointState  s;
    PointOutput o;

    q.mat.gas.trace     = GasTrace(&q.mat.gas);
    q.in[IN_T]          = 4.0;
    q.in[IN_P]          = 5e6;
    q.in[IN_P + 1]      = pg[k];
    q.in[IN_J + CL_DIM] = 1e-9; /* of the gas, along x */
    InitialMasses(&q.mat, q.h.V, 0.3, 0.1, q.in[IN_P], q.in[IN_P + 1], 4.0, &q.h.m_s, &q.h.m_star[0], &q.h.m_star[1],
                  &q.h.m_star[2]);
    q.h.Sh_n = 0.1;
    assert_int_equal(PointEvaluate(&(PointInput){AllFields(), &q.mat, &q.h, q.in}, true, &s, &o, &why), CL_OK);
    const double flux = o.out[VectorAt(OUT_FLUX, PHASE_G, 0)];
    printf("  p_g = %g Pa: flux of methane %g kg m/s, of which the gradient makes %g\n", pg[k], flux,
           o.D[VectorAt(OUT_FLUX, PHASE_G, 0)][VectorAt(IN_GP, PHASE_G, 0)]);
    assert_true(flux > 0.0 && s.rho[PHASE_G] > 3.0);
    assert_true(o.D[VectorAt(OUT_FLUX, PHASE_G, 0)][VectorAt(IN_GP, PHASE_G, 0)] < 0.0);
    assert_true(pg[k] > 0.0 || s.m_g < 0.0); /* the mass says what is missing */
  }
}

/* A reaction ten times as slow makes a tenth of the hydrate, to round-off of what it makes rather than of what there
   is: methane of pores without gas is far below that. */
static void TestSlowReaction(void **state)
{
  Rng    r        = {118};
  double worst[2] = {0.0, 0.0};
  int    seen[2]  = {0, 0};

  (void)state;
  for (int n = 0; n < 400; n++) {
    Particle    q;
    PointState  s;
    PointOutput o;
    double      heat[2];

    RandomParticle(&r, n % 2 ? NO_GAS : n % 4 ? FORMING : DISSOCIATING, &q);
    q.in[IN_GT] = q.in[IN_GT + 1] = 0.0;
    q.mat.kinetics.K0 *= 1e-15;
    q.h.compression = false;
    for (int k = 0; k < 2; k++, q.mat.kinetics.K0 *= 0.1) {
      assert_int_equal(Evaluate(&q, false, &s, &o), CL_OK);
      heat[k] = o.out[OUT_Q];
    }
    if (heat[0] == 0.0 && heat[1] == 0.0) /* nothing forms without gas */
      continue;
    seen[n % 2]++;
    worst[n % 2] = fmax(worst[n % 2], fabs(10.0 * heat[1] / heat[0] - 1.0));
  }
  printf("slow reaction: heat of a tenth of the rate off a tenth of the heat by %.1e with gas, %.1e without\n",
         worst[0], worst[1]);
  assert_true(seen[0] > 100 && seen[1] > 50 && worst[0] < 1e-9 && worst[1] < 1e-9);
}

static void TestStiffKinetics(void **state)
{
  (void)state;
  printf("closed isothermal cell at 4 degC, one step of 10 s:\n");
  ClosedCell(6e6, 5e4, "forming");
  ClosedCell(6e6, -1e5, "forming of scarce gas");
  ClosedCell(3.3e6, 5e4, "dissociating");
}

/* What the hydrate gives or takes is what OUT_DM says, in water, in methane and in all; totals by hand. */
static void TestReactionConserves(void **state)
{
  Rng    r     = {109};
  double worst = 0.0;

  (void)state;
  for (int n = 0; n < 20000; n++) {
    Particle    q;
    PointState  s;
    PointOutput o;

    RandomParticle(&r, (Regime)(n % REGIMES), &q);
    q.mat.reacts = n % REGIMES != NO_KINETICS;
    assert_int_equal(Evaluate(&q, false, &s, &o), CL_OK);
    const double h = q.mat.reacts ? s.m_h - q.h.m_star[0] : 0.0, w = 6.0 * 0.018 / 0.124, g = 0.016 / 0.124;
    const double water = s.m_w - q.h.m_star[1] + w * h, methane = s.m_g - q.h.m_star[2] + g * h;
    const double size = s.m_w + s.m_g + s.m_h;

    worst = fmax(worst, fabs(o.out[OUT_DM] - water) / size);
    worst = fmax(worst, fabs(o.out[OUT_DM + 1] - methane) / size);
    worst = fmax(worst,
                 fabs(o.out[OUT_DM] + o.out[OUT_DM + 1] - (s.m_w - q.h.m_star[1] + s.m_g - q.h.m_star[2] + h)) / size);
    worst = fmax(worst, fabs(o.out[OUT_M] - q.h.m_s - s.m_h) / (q.h.m_s + s.m_h));
    worst = fmax(worst, fabs(o.out[OUT_M + 1] - s.m_w) / s.m_w);
    worst = fmax(worst, fabs(o.out[OUT_M + 2] - s.m_g) / s.m_g);
    worst = fmax(worst, fabs(s.Sh + s.Sw + s.Sg - 1.0));
  }
  printf("masses of water, methane and all through the reaction: %.1e\n", worst);
  assert_true(worst < 1e-15);
}

/* Without a reaction heat is what the masses store, and what each fluid carries with its own heat capacity. */
static void TestHeatOfMasses(void **state)
{
  Rng    r     = {111};
  double worst = 0.0;

  (void)state;
  for (int n = 0; n < 20000; n++) {
    Particle    q;
    PointState  s;
    PointOutput o;

    RandomParticle(&r, NO_KINETICS, &q);
    SetSolubility(&q.mat.gas, RngPick(&r, 2) ? 1.9e-5 : 0.0);
    q.h.compression = false;
    assert_int_equal(Evaluate(&q, false, &s, &o), CL_OK);
    const double *water = &o.out[OUT_FLUX], *gas = &o.out[OUT_FLUX + 2], *g = &q.in[IN_GT];
    const double  stored  = q.h.m_s * q.mat.c_s + s.m_h * q.mat.c_h + s.m_w * q.mat.c_w + s.m_g * q.mat.c_g;
    double        carried = 0.0, size = 0.0;

    for (int i = 0; i < 2; i++) {
      carried += (q.mat.c_w * water[i] + q.mat.c_g * gas[i]) * g[i];
      size += fabs(q.mat.c_w * water[i] * g[i]) + fabs(q.mat.c_g * gas[i] * g[i]);
    }
    worst = fmax(worst, fabs(o.out[OUT_Q] - carried) / size);
    worst = fmax(worst, fabs(o.out[OUT_C] / stored - 1.0));
  }
  printf("heat of the masses, stored and carried: %.1e\n", worst);
  assert_true(worst < 1e-14);
}

/* ---------------------------------------------------------------- robustness */
/* 1e5 admissible states over a wide box: every number comes out finite. */
static void TestNeverNan(void **state)
{
  Rng r = {110};

  (void)state;
  for (int n = 0; n < 100000; n++) {
    Particle     q;
    PointState   s;
    PointOutput  o;
    const double phi = RngBetween(&r, 1e-3, 0.999), Sh = RngPick(&r, 4) ? RngUnit(&r) * 0.999 : 0.0;

    RandomParticle(&r, (Regime)(n % REGIMES), &q);
    q.in[IN_T] = RngBetween(&r, -40.0, 150.0);
    SetPressures(&q, RngLog(&r, 1e3, 1e9), (RngPick(&r, 2) ? -1.0 : 1.0) * RngLog(&r, 1e-3, 500.0), Sh);
    InitialMasses(&q.mat, q.h.V, phi, Sh, q.in[IN_P], q.in[IN_P + 1], q.in[IN_T], &q.h.m_s, &q.h.m_star[0],
                  &q.h.m_star[1], &q.h.m_star[2]);
    q.h.dt          = RngLog(&r, 1e-6, 1e9);
    const double up = RngLog(&r, 1.0, 3.0); /* widening keeps the pores open */
    RotateBy(&q, RngBetween(&r, -PI, PI));
    for (int k = 0; k < 4; k++)
      q.in[IN_GRADU + k] = up * (q.in[IN_GRADU + k] + (k == 0 || k == 3)) - (k == 0 || k == 3);
    q.in[IN_HOOP] = up - 1.0;
    assert_int_equal(Evaluate(&q, true, &s, &o), CL_OK);
    for (int k = 0; k < OUT_COUNT; k++)
      assert_true(isfinite(o.out[k]));
    for (int k = 0; k < OUT_COUNT * IN_COUNT; k++)
      assert_true(isfinite((&o.D[0][0])[k]));
    assert_true(s.phi > 0.0 && s.phi < 1.0 && s.Sh >= 0.0 && s.Sh < 1.0 && s.Sw >= 0.0 && s.Sg >= 0.0);
    assert_true(isfinite(s.skeleton.sig[XX] + s.skeleton.sig[YY] + s.skeleton.sig[ZZ] + s.skeleton.sig[XY] +
                         s.skeleton.sig[YZ] + s.skeleton.sig[XZ]));
    for (int f = 0; f < PHASE_COUNT; f++) {
      assert_true(s.rho[f] > 0.0 && s.tau[f] > 0.0 && isfinite(s.rho[f]) && isfinite(s.tau[f]));
      for (int k = 0; k < 4; k++)
        assert_true(isfinite(o.wide[f][f][k / 2][k % 2]) && isfinite(o.wide_q[f][k % 2]));
    }
  }
}

/* Every bad number in every input: refused with a reason, never CL_OK. */
static void TestInadmissible(void **state)
{
  static const double bad[4] = {NAN, INFINITY, -INFINITY, -1e300};
  Rng                 r      = {111};

  (void)state;
  for (int n = 0; n < 200; n++) {
    for (int k = 0; k < IN_COUNT; k++) {
      for (int b = 0; b < 4; b++) {
        Particle    q;
        PointState  s;
        PointOutput o;

        RandomParticle(&r, (Regime)(n % REGIMES), &q);
        q.in[k]               = bad[b];
        const ClStatus status = Evaluate(&q, n % 2, &s, &o);
        assert_true(status == CL_OK || status == CL_DOMAIN || status == CL_NONFINITE);
        if (status != CL_OK)
          continue;
        if (b < 3)
          printf("  input %d = %g was accepted\n", k, bad[b]);
        assert_false(b < 3); /* -1e300 may pass, if all that comes of it is finite */
        for (int i = 0; i < OUT_COUNT; i++)
          assert_true(isfinite(o.out[i]));
      }
    }
  }
}

static void Refused(const Particle *q, ClStatus expected, const char *what)
{
  PointState     s;
  PointOutput    o;
  const ClStatus status = Evaluate(q, true, &s, &o);

  if (status != expected)
    printf("  %s: status %d, expected %d\n", what, (int)status, (int)expected);
  assert_int_equal(status, expected);
}

static void TestRefusals(void **state)
{
  Rng      r = {112};
  Particle q, p;

  (void)state;
  RandomParticle(&r, FORMING, &q);
  memset(&q.in[IN_GRADU], 0, MOTION_COUNT * sizeof(double));
  p              = q;
  p.in[IN_GRADU] = -1.5;
  Refused(&p, CL_DOMAIN, "J below zero");
  p.in[IN_GRADU] = -1.0;
  Refused(&p, CL_DOMAIN, "J zero");
  p              = q;
  p.in[IN_GRADU] = -0.999;
  Refused(&p, CL_DOMAIN, "porosity below zero");
  p = q;
  p.h.m_star[0] *= 1e3;
  p.mat.reacts = false;
  Refused(&p, CL_DOMAIN, "hydrate fills the pores, no kinetics");
  p.mat.reacts = true;
  Refused(&p, CL_DOMAIN, "hydrate fills the pores, kinetics");
  p          = q;
  p.in[IN_T] = -CL_ZERO_CELSIUS - 10.0;
  Refused(&p, CL_DOMAIN, "below absolute zero");
  p          = q;
  p.in[IN_T] = NAN;
  Refused(&p, CL_NONFINITE, "temperature NaN");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(TestKinematicsDerivatives),
      cmocka_unit_test(TestKinematicsValues),
      cmocka_unit_test(TestTangent),
      cmocka_unit_test(TestRigidRotation),
      cmocka_unit_test(TestReference),
      cmocka_unit_test(TestManyTurns),
      cmocka_unit_test(TestSimpleShear),
      cmocka_unit_test(TestHydrateBounds),
      cmocka_unit_test(TestHydrateEquation),
      cmocka_unit_test(TestFlowOfTrace),
      cmocka_unit_test(TestSlowReaction),
      cmocka_unit_test(TestStiffKinetics),
      cmocka_unit_test(TestReactionConserves),
      cmocka_unit_test(TestHeatOfMasses),
      cmocka_unit_test(TestNeverNan),
      cmocka_unit_test(TestInadmissible),
      cmocka_unit_test(TestRefusals),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
