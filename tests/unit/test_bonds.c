/* Unit tests of hydrate that bears a stress of its own (docs/equations.md (93), (94)): a closed path, its order under
   the stages of SDIRK2, cycles of hydrate at constant load, turned bodies, shares of a plastic stress, blocks. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>
#include "clathra/point_reaction.h"
#include "clathra/skeleton.h"
#include "random.h"

#define E_BARE 100e6 /* Pa */
#define E_HYD 1e9    /* Pa per S_h */
#define NU 0.25
#define GAMMA (1.0 - 0.70710678118654752440)

static Material Bonded(int change)
{
  return (Material){.elasticity = {E_BARE, E_HYD, 1.0, 1.0, NU, change}};
}

/* A point on its way, and one stage of it: strain since t_n in the frame of then, turned by `angle`. */
typedef struct {
  Material        mat;
  SkeletonHistory h;
  double          Sh; /* at t_n */
} Walk;

static SkeletonState Stage(const Walk *w, const double e[4], double angle, double Sh_star, double Sh,
                           SkeletonStage *end)
{
  double        dE;
  const double  kept = Sh < Sh_star ? Sh / Sh_star : 1.0, e6[6] = {e[0], e[1], e[2], e[3], 0.0, 0.0};
  double        turned[6];
  SkeletonState s;
  const char   *why;

  Turn6(e6, cos(angle), sin(angle), turned);
  const SkeletonStep d = {.turn = {cos(angle), sin(angle)},
                          .e    = {turned[0], turned[1], turned[2], turned[3]},
                          .E_n  = ElasticityYoung(&w->mat.elasticity, w->Sh, &dE),
                          .E    = ElasticityYoung(&w->mat.elasticity, Sh, &dE),
                          .Sh   = Sh,
                          .kept = kept};
  assert_true(SkeletonUpdate(&w->mat, &w->h, &d, &s, NULL, &why));
  SkeletonEndStage(&w->h, &d, &s, 1.0, end);
  return s;
}

static void Commit(Walk *w, const SkeletonState *s, double Sh)
{
  for (int k = 0; k < 6; k++) {
    w->h.sig[k]  = s->sig[k];
    w->h.sig0[k] = s->sig0[k];
  }
  w->h.from = (SkeletonStage){.sig = {s->sig[0], s->sig[1], s->sig[2], s->sig[3]}};
  for (int k = 0; k < OWN_COUNT; k++)
    w->h.from.own[k] = s->own[k];
  w->Sh = Sh;
}

static double Hydrate(double t)
{
  return 0.4 * exp(-t);
}

static double Strain(double t)
{
  return -1e-3 * t * (2.0 - t);
}

/* Loss at a rate and a strain over one unit of time, in n steps: what hydrate bears is M_h(t) eps(t), since
   d(h/m) = M_h/m d eps. */
static double LossError(int n, bool second)
{
  Walk         w = {.mat = Bonded(STIFFNESS_BONDS), .Sh = Hydrate(0.0)};
  const double M = (1.0 - NU) / ((1.0 + NU) * (1.0 - 2.0 * NU)), dt = 1.0 / n, c = (1.0 - GAMMA) / GAMMA;

  for (int k = 0; k < n; k++) {
    const double        t0 = k * dt, t1 = second ? t0 + GAMMA * dt : t0 + dt, to = Hydrate(t0 + dt);
    const SkeletonStage y_n = w.h.from;
    SkeletonStage       y_1, unused;
    const double        e1[4] = {Strain(t1) - Strain(t0)}, e[4] = {Strain(t0 + dt) - Strain(t0)};

    SkeletonState s = Stage(&w, e1, 0.0, w.Sh, Hydrate(t1), &y_1);
    if (second) {
      SkeletonStar(&y_n, &y_1, c, &w.h.from);
      s = Stage(&w, e, 0.0, w.Sh + c * (Hydrate(t1) - w.Sh), to, &unused);
    }
    Commit(&w, &s, to);
  }
  const double bond = E_HYD * M * Hydrate(1.0) * Strain(1.0), all = bond + E_BARE * M * Strain(1.0);
  return fmax(fabs(w.h.from.own[OWN_P_BOND] / bond - 1.0), fabs(w.h.sig[XX] / all - 1.0));
}

static void TestLoss(void **state)
{
  (void)state;
  for (int second = 0; second < 2; second++) {
    const double e[3]  = {LossError(8, second), LossError(16, second), LossError(32, second)};
    const double order = log2(e[1] / e[2]);

    printf("loss while it is strained, %s: errors %.2e, %.2e, %.2e, order %.2f\n", second ? "sdirk2" : "euler", e[0],
           e[1], e[2], order);
    assert_true(fabs(order - 1.0 - second) < 0.1 && e[2] < (second ? 1e-3 : 4e-2));
  }
}

/* Strain xx at which the stress is q, sideways held: the stress is linear in it. */
static double Find(const Walk *w, double Sh, double q)
{
  const double  none[4] = {0.0}, some[4] = {1e-4};
  SkeletonStage end;
  const double  a = Stage(w, none, 0.0, w->Sh, Sh, &end).sig[XX], b = Stage(w, some, 0.0, w->Sh, Sh, &end).sig[XX];

  return 1e-4 * (q - a) / (b - a);
}

/* Five cycles of hydrate (0.4 -> least -> 0.4) at constant load of a body that was loaded when it had hydrate: where it
   is after each, from where the first found it without. */
static void Cycles(int change, double least, bool extra, double u[6])
{
  Walk         w  = {.mat = Bonded(change), .Sh = 0.4};
  const double q  = -1e6;
  double       at = 0.0;
  const int    n  = 20;

  for (int half = -1; half < 10; half++) {
    for (int k = 1; k <= n; k++) {
      const double  x    = half < 0 ? 0.0 : half % 2 ? 1.0 - (double)k / n : (double)k / n;
      const double  Sh   = 0.4 + (least - 0.4) * x;
      const double  load = half < 0 ? q * k / n : extra ? q * (1.0 + 0.5 * x) : q;
      const double  e[4] = {Find(&w, Sh, load)};
      SkeletonStage end;
      SkeletonState s = Stage(&w, e, 0.0, w.Sh, Sh, &end);

      at += e[0];
      Commit(&w, &s, Sh);
    }
    if (half % 2)
      u[(half + 1) / 2] = at;
  }
}

static void TestCycles(void **state)
{
  static const char *const name[] = {"both", "loss_only", "bonds"};
  const double             bare   = -1e6 * (1.0 + NU) * (1.0 - 2.0 * NU) / (1.0 - NU) / E_BARE;
  double                   u[3][6];

  (void)state;
  for (int change = 0; change < 3; change++) {
    Cycles(change, 1e-9, false, u[change]);
    printf("cycles of hydrate under constant load, %-9s: strain", name[change]);
    for (int k = 0; k < 6; k++)
      printf(" %.4e", u[change][k]);
    printf("\n");
  }
  for (int k = 2; k < 6; k++) {
    assert_true(fabs(u[STIFFNESS_BONDS][k] / bare - 1.0) < 1e-6);                        /* what the skeleton bears */
    assert_true(u[STIFFNESS_LOSS_ONLY][k] < u[STIFFNESS_LOSS_ONLY][k - 1] + 0.5 * bare); /* further and further */
  }
  assert_true(fabs(u[STIFFNESS_BOTH][5] / u[STIFFNESS_BOTH][0] - 1.0) < 1e-6); /* lifted to where it was loaded */
  Cycles(STIFFNESS_BONDS, 1e-9, true, u[0]);
  for (int k = 2; k < 6; k++) /* the load grows while hydrate goes, and falls while it forms */
    assert_true(fabs(u[0][k] - u[0][1]) < 1e-6 * fabs(bare));
  Cycles(STIFFNESS_BONDS, 0.2, false, u[0]); /* some stays: ever less of what it bears */
  printf("  half of it stays: strain");
  for (int k = 0; k < 6; k++)
    printf(" %.4e", u[0][k]);
  printf("\n");
  for (int k = 1; k < 5; k++)
    assert_true(fabs(u[0][k + 1] - u[0][k]) < 0.84 * fabs(u[0][k] - u[0][k - 1]) && u[0][k] >= bare);
}

/* The same path seen from a frame that turns: stress and the hydrate's part turn with it. */
static void TestTurning(void **state)
{
  Rng    r     = {501};
  Walk   still = {.mat = Bonded(STIFFNESS_BONDS), .Sh = 0.4}, turns = still;
  double angle = 0.0, worst = 0.0;

  (void)state;
  for (int k = 0; k < 200; k++) {
    const double  c = RngBetween(&r, -0.3, 0.3), Sh = fmax(0.01, still.Sh + RngBetween(&r, -0.05, 0.05));
    double        e[4], e6[6] = {0.0}, turned[6], back[6], part[6] = {0.0}, sig[6];
    SkeletonStage end;

    for (int i = 0; i < 4; i++)
      e6[i] = e[i] = RngBetween(&r, -1e-3, 1e-3);
    Turn6(e6, cos(angle), sin(angle), turned);
    const SkeletonState a = Stage(&still, e, 0.0, still.Sh, Sh, &end), b = Stage(&turns, turned, c, turns.Sh, Sh, &end);
    Commit(&still, &a, Sh);
    Commit(&turns, &b, Sh);
    angle += c;
    Turn6(a.sig, cos(angle), sin(angle), sig);
    for (int i = 0; i < 4; i++)
      part[i] = a.own[OWN_P_BOND + i];
    Turn6(part, cos(angle), sin(angle), back);
    for (int i = 0; i < 4; i++)
      worst = fmax(worst, fmax(fabs(sig[i] - b.sig[i]), fabs(back[i] - b.own[OWN_P_BOND + i])) / 1e6);
  }
  printf("a body that turns by %.1f rad in 200 steps: off by %.1e MPa\n", angle, worst);
  assert_true(worst < 1e-11);
}

/* (94): with hydrate that stays, from no stress, both parts flow alike and bear what their stiffness says. */
static void TestShares(void **state)
{
  Rng    r     = {502};
  double worst = 0.0;
  int    yield = 0;

  (void)state;
  for (int flow = 0; flow < 2; flow++) {
    Walk w = {.mat = Bonded(STIFFNESS_BONDS), .Sh = 0.3};

    w.mat.plasticity = (Plasticity){.type         = PLASTICITY_MOHR_COULOMB,
                                    .flow         = flow,
                                    .c_max        = 2e5,
                                    .c_min        = 2e5,
                                    .c_res        = 1e5,
                                    .phi_peak     = 25.0,
                                    .phi_res      = 20.0,
                                    .psi_max      = 8.0,
                                    .psi_min      = 8.0,
                                    .eta_s        = 5.0,
                                    .eccentricity = 0.1,
                                    .cutoff       = INFINITY};
    for (int k = 0; k < 200; k++) {
      const double  e[4] = {RngBetween(&r, -2e-4, 4e-4), RngBetween(&r, -6e-4, 1e-4), 0.0, RngBetween(&r, -4e-4, 4e-4)};
      SkeletonStage end;
      const SkeletonState s = Stage(&w, e, RngBetween(&r, -0.1, 0.1), w.Sh, w.Sh, &end);

      Commit(&w, &s, w.Sh);
      yield += s.region != RETURN_ELASTIC;
      for (int i = 0; i < 4; i++)
        worst = fmax(worst, fabs(s.own[OWN_P_BOND + i] - 0.3 * E_HYD / (E_BARE + 0.3 * E_HYD) * s.sig[i]) / 1e5);
    }
  }
  printf("share of the hydrate in a plastic stress: off by %.1e of c; %d steps yield\n", worst, yield);
  assert_true(worst < 1e-10 && yield > 200);
}

/* Blocks do what single particles do, elastic and plastic. */
#define N 32
static void TestBlock(void **state)
{
  Rng    r     = {503};
  double worst = 0.0;
  int    yield = 0;

  (void)state;
  for (int run = 0; run < 100; run++) {
    Material mat = Bonded(STIFFNESS_BONDS);
    Walk     w[N];
    double   in[11][N], held[17 + OWN_COUNT][N] = {{0.0}}, work[N];

    if (run % 2)
      mat.plasticity = (Plasticity){.type         = PLASTICITY_MOHR_COULOMB,
                                    .flow         = FLOW_MENETREY_WILLAM,
                                    .c_max        = 5e5,
                                    .c_min        = 5e5,
                                    .c_res        = 5e5,
                                    .phi_peak     = 25.0,
                                    .phi_res      = 25.0,
                                    .psi_max      = 5.0,
                                    .psi_min      = 5.0,
                                    .cell         = 1.0,
                                    .eccentricity = 0.1,
                                    .cutoff       = INFINITY,
                                    .factor       = run % 3 ? 1.0 : 1.8};
    if (run % 4 == 3) { /* softens, with its own plastic strain or that of its neighbours */
      mat.plasticity.c_res    = 1e5;
      mat.plasticity.phi_res  = 15.0;
      mat.plasticity.eta_s    = 5.0;
      mat.plasticity.nonlocal = run % 8 == 3 ? 0.5 : 0.0;
    }
    if (run % 6 == 5) { /* strength that grows with depth */
      mat.plasticity.gradient = 3e5;
      mat.plasticity.level    = 3.0;
      mat.plasticity.axis     = run % 4 == 1;
      mat.plasticity.up       = run % 12 == 5 ? 1 : -1;
    }
    SkeletonBlock b = {.n           = N,
                       .turn        = {in[0], in[1]},
                       .e           = {[XX] = in[2], [YY] = in[3], [ZZ] = in[10], [XY] = in[4]},
                       .thermal     = in[5],
                       .E_n         = in[6],
                       .E           = in[7],
                       .Sh          = in[8],
                       .kept        = in[9],
                       .work        = work,
                       .store.yield = held[12]};
    for (int i = 0; i < 6; i++) {
      b.store.sig[i]  = held[i];
      b.store.sig0[i] = held[6 + i];
    }
    for (int i = 0; i < OWN_COUNT; i++)
      b.store.own[i] = held[13 + i];
    b.store.nonlocal = held[13 + OWN_COUNT];
    b.store.place[0] = held[15 + OWN_COUNT];
    b.store.place[1] = held[16 + OWN_COUNT];
    b.store.rate     = held[14 + OWN_COUNT];
    SkeletonState s[N];
    for (int q = 0; q < N; q++) {
      const char        *why;
      double             dE;
      const double       Sh = RngBetween(&r, 0.1, 0.4), a = RngBetween(&r, -0.2, 0.2);
      const SkeletonStep d = {.turn    = {cos(a), sin(a)},
                              .thermal = RngBetween(&r, -1e-4, 1e-4),
                              .E_n     = 1e8,
                              .e       = {RngBetween(&r, -1e-3, 1e-3), RngBetween(&r, -1e-3, 1e-3),
                                          RngBetween(&r, -1e-3, 1e-3), RngBetween(&r, -1e-3, 1e-3)},
                              .E       = ElasticityYoung(&mat.elasticity, Sh, &dE),
                              .Sh      = Sh,
                              .kept    = RngBetween(&r, 0.0, 1.0)};
      const double row[11] = {d.turn.c, d.turn.s, d.e[0], d.e[1], d.e[3], d.thermal, d.E_n, d.E, d.Sh, d.kept, d.e[2]};

      w[q].h = (SkeletonHistory){0};
      for (int i = 0; i < 11; i++)
        in[i][q] = row[i];
      for (int i = 0; i < 6; i++)
        held[i][q] = w[q].h.sig[i] = i < 4 ? RngBetween(&r, -1e6, 3e5) : 0.0;
      for (int i = 0; i < 4; i++) {
        held[13 + OWN_P_BOND + i][q] = w[q].h.from.own[OWN_P_BOND + i] = RngBetween(&r, -5e5, 5e5);
        w[q].h.from.sig[i]                                             = w[q].h.sig[i];
      }
      held[13 + OWN_P_EPS][q] = w[q].h.from.own[OWN_P_EPS] = run % 4 == 3 && q % 2 ? RngBetween(&r, 0.0, 0.5) : 0.0;
      held[13 + OWN_COUNT][q] = w[q].h.nonlocal = RngBetween(&r, 0.0, 0.5);
      for (int i = 0; i < 2; i++)
        held[15 + OWN_COUNT + i][q] = w[q].h.place[i] = RngBetween(&r, 0.0, 6.0);
      assert_true(SkeletonUpdate(&mat, &w[q].h, &d, &s[q], NULL, &why));
      yield += s[q].region != RETURN_ELASTIC;
    }
    const char *why;
    assert_true(SkeletonUpdateBlock(&mat, &b, &why));
    for (int q = 0; q < N; q++) {
      for (int i = 0; i < 4; i++) {
        worst = fmax(worst, fabs(held[i][q] - s[q].sig[i]));
        worst = fmax(worst, fabs(held[13 + OWN_P_BOND + i][q] - s[q].own[OWN_P_BOND + i]));
      }
    }
  }
  printf("block against single form: worst %.1e Pa of 1e6; %d yield\n", worst, yield);
  assert_true(worst < 1e-8 && yield > 200);
}

/* Hydrate that melts by half and half again is none in the end, and what it bears keeps slopes that are numbers. */
static void HydrateComesToItsEnd(void **state)
{
  double m = 1.0;
  int    n = 0;

  for (; m > 0.0 && n < 2000; n++) {
    double       slope;
    const double gain = ReactionDissociated(m, 1.0, &slope);
    const Kept   k    = KeptHydrate(m, m + gain);

    assert_true(isfinite(slope) && isfinite(k.v) && isfinite(k.m) && k.v >= 0.0 && k.v <= 0.5);
    assert_true(m < 1e-99 || (slope == -0.25 * m && gain == -0.5 * m && k.m * m == 1.0));
    m += gain;
  }
  assert_true(m == 0.0 && n < 350);
  assert_true(isfinite(KeptHydrate(1e-311, 0.0).m)); /* of an older checkpoint */
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestLoss),    cmocka_unit_test(TestCycles),
                                     cmocka_unit_test(TestTurning), cmocka_unit_test(TestShares),
                                     cmocka_unit_test(TestBlock),   cmocka_unit_test(HydrateComesToItsEnd)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
