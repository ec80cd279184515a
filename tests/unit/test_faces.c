/* Unit tests of the surface faces: what each condition adds to the rows, and its tangent against differences. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <math.h>
#include <string.h>
#include <cmocka.h>
#include "clathra/boundary.h"
#include "random.h"
#include "sediment.h"

#define STATES 40
#define DT 30.0
#define KAPPA 2.0

typedef struct {
  Scene    c;
  Bc       bc[3];
  Material mat;
  Face     face;
  BcValues v;
  double   value[3], shear[3], phase[PHASE_COUNT][3];
  double   p0[PHASE_COUNT], Sh;
  Schedule given; /* stands for any function of time: its value is in v */
} SmallScene;

static double one[1];

static void SceneInit(SmallScene *s, Rng *r)
{
  memset(s, 0, sizeof(*s));
  s->mat                   = SedimentMaterial();
  s->mat.gas.carried       = 3e-7;
  s->mat.retention.hydrate = 1.5;
  s->Sh                    = 0.3;
  s->given                 = (Schedule){.n = 1, .t = one, .y = one};
  assert_true(FieldSetMake(HAS_ALL, true, &s->c.fields));
  s->c.bc             = s->bc;
  s->c.nbc            = 3;
  s->v.value          = s->value;
  s->v.shear          = s->shear;
  s->v.phase[PHASE_W] = s->phase[PHASE_W];
  s->v.phase[PHASE_G] = s->phase[PHASE_G];
  s->p0[PHASE_W]      = 3e6;
  s->p0[PHASE_G]      = 3e6 + RngBetween(r, 1e4, 2e5);
  s->face = (Face){.side = SIDE_XMAX, .n = {2.0, 0.3}, .s = {1.4, 0.6}, .x = {1.0, 2.0}, .r = {0.01, 0.002}};
  for (int kind = 0; kind < BC_FACES; kind++)
    s->face.bc[kind] = -1;
  s->face.K        = 1e9;
  s->face.moved[0] = 3e-3;
  s->face.moved[1] = -2e-3;
  s->face.ring[1]  = 0.1;
}

/* Inputs of a particle: a motion of some percent, pressures, gradients, fluxes. */
static void Inputs(Rng *r, double in[IN_COUNT])
{
  for (int k = 0; k < MOTION_COUNT; k++)
    in[IN_GRADU + k] = RngBetween(r, -0.05, 0.05);
  in[IN_P]     = RngBetween(r, 2e6, 4e6);
  in[IN_P + 1] = in[IN_P] + RngBetween(r, 1e4, 2e5);
  in[IN_T]     = RngBetween(r, 1.0, 20.0);
  for (int k = 0; k < 4; k++) {
    in[IN_GP + k] = RngBetween(r, -1e6, 1e6);
    in[IN_J + k]  = RngBetween(r, -1e-5, 1e-5);
  }
  for (int k = 0; k < 2; k++)
    in[IN_GT + k] = RngBetween(r, -10.0, 10.0);
  for (int k = 0; k < 2; k++)
    in[IN_U + k] = RngBetween(r, -1e-3, 1e-3);
}

typedef struct {
  const SmallScene *s;
  double            in[IN_COUNT];
  int               column;
} Line;

static void Evaluate(const SmallScene *s, const double in[IN_COUNT], FaceOutput *o)
{
  const double velocity[CL_DIM] = {0.02 + in[IN_U] / DT, -0.01 + in[IN_U + 1] / DT};

  FaceEvaluate(&(FaceInput){&s->c, &s->face, &s->v, &s->mat, s->p0, in, velocity, s->Sh, KAPPA, DT}, o);
  if (s->face.bc[BC_PLATE] >= 0)
    PlateEvaluate(&s->bc[s->face.bc[BC_PLATE]], &s->face, s->value[s->face.bc[BC_PLATE]], in, o);
}

static bool Rows(void *ctx, double x, double y[RIDDERS_ROWS])
{
  Line      *p = (Line *)ctx;
  FaceOutput o;

  p->in[p->column] = x;
  Evaluate(p->s, p->in, &o);
  for (int k = 0; k < F_COUNT; k++)
    y[k] = o.out[k];
  return true;
}

/* Every entry of the tangent against differences; relative to the largest entry of its row times the column's scale. */
static double WorstTangent(const SmallScene *s, const double in[IN_COUNT])
{
  static const double step[IN_COUNT] = {1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e4,  1e4,  1e-1, 1e4,  1e4,
                                        1e4,  1e4,  1e-1, 1e-1, 1e-6, 1e-6, 1e-6, 1e-6, 1e-4, 1e-4};
  double              fd[IN_COUNT][RIDDERS_ROWS], err[RIDDERS_ROWS], worst = 0.0;
  FaceOutput          o;

  Evaluate(s, in, &o);
  for (int q = 0; q < IN_COUNT; q++) {
    Line p = {.s = s, .column = q};

    memcpy(p.in, in, sizeof(p.in));
    assert_true(Ridders(Rows, &p, in[q], step[q], F_COUNT, fd[q], err));
  }
  for (int k = 0; k < F_COUNT; k++) {
    double scale = 0.0;

    for (int q = 0; q < IN_COUNT; q++)
      scale = fmax(scale, fabs(o.D[k][q]) * step[q]);
    for (int q = 0; q < IN_COUNT; q++) {
      const double off = fabs(fd[q][k] - o.D[k][q]) * step[q];

      if (scale == 0.0)
        assert_true(off == 0.0);
      else
        worst = fmax(worst, off / scale);
    }
  }
  return worst;
}

/* ---------------------------------------------------------------- the conditions */
static void Closed(SmallScene *s, Rng *r)
{
}

static void Prescribe(SmallScene *s, Rng *r, bool natural, OpenPhases open)
{
  s->face.bc[BC_PRESSURE] = 0;
  s->bc[0].type           = BC_PRESSURE;
  s->bc[0].value          = s->given;
  s->value[0]             = RngBetween(r, 2e6, 4e6);
  s->bc[0].natural        = natural;
  s->bc[0].open           = open;
}

static void Held(SmallScene *s, Rng *r)
{
  Prescribe(s, r, false, OPEN_BOTH);
}

static void Free(SmallScene *s, Rng *r)
{
  Prescribe(s, r, true, OPEN_BOTH);
}

/* What stands around the body: 1 GPa/m, so that differences see it. */
static void AmbientFluid(SmallScene *s, Rng *r, bool natural)
{
  Prescribe(s, r, natural, OPEN_BOTH);
  s->value[0] = INFINITY;
  s->v.ambient =
      (Ambient){.on = true, .pressure = 2e6, .weight = {3e8, -1e9}, .head = -1.7e9 - RngBetween(r, 5e6, 1e7)};
}

static void AmbientHeld(SmallScene *s, Rng *r)
{
  AmbientFluid(s, r, false);
}

static void AmbientFree(SmallScene *s, Rng *r)
{
  AmbientFluid(s, r, true);
}

static void HeatFlux(SmallScene *s, Rng *r)
{
  s->face.bc[BC_HEAT_FLUX] = 0;
  s->value[0]              = RngBetween(r, -50.0, 50.0);
}

static void WaterOnly(SmallScene *s, Rng *r)
{
  Prescribe(s, r, true, OPEN_WATER);
}

static void GasOnly(SmallScene *s, Rng *r)
{
  Prescribe(s, r, true, OPEN_GAS);
}

static void Separate(SmallScene *s, Rng *r)
{
  Prescribe(s, r, false, OPEN_BOTH);
  for (int ph = 0; ph < PHASE_COUNT; ph++) {
    s->bc[0].phase[ph] = s->given;
    s->phase[ph][0]    = RngBetween(r, 2e6, 4e6);
  }
}

static void Inflow(SmallScene *s, Rng *r)
{
  s->face.bc[BC_INFLOW] = 1;
  s->bc[1].type         = BC_INFLOW;
  s->phase[0][1]        = RngBetween(r, -1e-5, 1e-5);
  s->phase[1][1]        = RngBetween(r, -1e-5, 1e-5);
}

static void WarmInflow(SmallScene *s, Rng *r)
{
  Inflow(s, r);
  s->bc[1].value = s->given;
  s->value[1]    = RngBetween(r, 1.0, 60.0);
}

static void Plate(SmallScene *s, Rng *r)
{
  s->face.bc[BC_PLATE] = 0;
  s->face.side         = RngBetween(r, 0.0, 1.0) < 0.5 ? SIDE_YMIN : SIDE_XMAX;
  s->bc[0].type        = BC_PLATE;
  s->value[0]          = RngBetween(r, -1e-2, 1e-2);
}

static void RoughPlate(SmallScene *s, Rng *r)
{
  Plate(s, r);
  s->bc[0].rough = true;
}

static void LoosePlate(SmallScene *s, Rng *r)
{
  Plate(s, r);
  s->bc[0].separates = true;
}

/* A particle of a well. */
static void Drives(SmallScene *s, Rng *r)
{
  s->face.bc[BC_WELL]       = 0;
  s->face.share             = 0.3;
  s->face.draws             = 0.9;
  s->face.conducts[PHASE_W] = 1e-9;
  s->face.conducts[PHASE_G] = 1e-7;
  s->face.r[0] = s->face.r[1] = 0.0;
  s->bc[0].type               = BC_WELL;
}

static void WellDraws(SmallScene *s, Rng *r)
{
  Drives(s, r);
  s->bc[0].value = s->given;
  s->value[0]    = RngBetween(r, 1e6, 1.9e6);
}

static void WellFills(SmallScene *s, Rng *r)
{
  Drives(s, r);
  s->bc[0].value  = s->given;
  s->bc[0].heated = s->given;
  s->value[0]     = RngBetween(r, 4.5e6, 6e6);
  s->shear[0]     = RngBetween(r, 1.0, 60.0);
}

static void WellRates(SmallScene *s, Rng *r)
{
  Drives(s, r);
  for (int ph = 0; ph < PHASE_COUNT; ph++) {
    s->bc[0].rate[ph] = s->given;
    s->phase[ph][0]   = RngBetween(r, -1e-3, 1e-3);
  }
  s->bc[0].heated = s->given;
  s->shear[0]     = RngBetween(r, 1.0, 60.0);
}

static void Drag(SmallScene *s, Rng *r)
{
  s->c.ambient_density = RngBetween(r, 900.0, 1100.0);
  s->c.ambient_drag    = RngBetween(r, 0.5, 2.0);
}

/* (425): temperatures that grow with depth. */
static void Depth(SmallScene *s, Rng *r)
{
  s->c.gravity[0]           = 1.7;
  s->c.gravity[1]           = -9.66;
  s->face.bc[BC_CONVECTION] = s->face.bc[BC_FACE_TEMPERATURE] = 2;
  s->bc[2].alpha                                              = 15.0;
  s->value[2]                                                 = 12.0;
  s->bc[2].with_depth                                         = RngBetween(r, 0.5, 2.0);
}

static void Everything(SmallScene *s, Rng *r)
{
  Drag(s, r);
  Free(s, r);
  WarmInflow(s, r);
  s->face.bc[BC_TRACTION] = s->face.bc[BC_CONVECTION] = s->face.bc[BC_FACE_TEMPERATURE] = 2;
  s->bc[2].alpha                                                                        = 15.0;
  s->value[2]                                                                           = 12.0;
  s->shear[2]                                                                           = 1e5;
}

static const struct {
  const char *name;
  void (*set)(SmallScene *, Rng *);
} condition[] = {{"closed", Closed},
                 {"pressure, held", Held},
                 {"pressure, free", Free},
                 {"pressure, water", WaterOnly},
                 {"pressure, gas", GasOnly},
                 {"p_w and p_g", Separate},
                 {"inflow", Inflow},
                 {"warm inflow", WarmInflow},
                 {"pressure, ambient", AmbientHeld},
                 {"ambient, free", AmbientFree},
                 {"heat flux", HeatFlux},
                 {"drag", Drag},
                 {"T with depth", Depth},
                 {"all at once", Everything},
                 {"well, out", WellDraws},
                 {"well, in", WellFills},
                 {"well, rates", WellRates},
                 {"plate", Plate},
                 {"plate, rough", RoughPlate},
                 {"plate, separates", LoosePlate}};

static void Tangents(void **state)
{
  Rng r = {.s = 20240501};

  for (size_t k = 0; k < sizeof(condition) / sizeof(*condition); k++) {
    double worst = 0.0;

    for (int n = 0; n < STATES; n++) {
      SmallScene s;
      double     in[IN_COUNT];

      SceneInit(&s, &r);
      condition[k].set(&s, &r);
      s.face.leaves[PHASE_W] = n & 1;
      s.face.leaves[PHASE_G] = n >> 1 & 1;
      s.face.pore            = n & 1 ? INFINITY : 0.0;
      Inputs(&r, in);
      if (n % 4 == 3) { /* no gas (323) */
        s.mat.gas.trace = 3e-7;
        in[IN_P + 1] -= 8e6;
      }
      worst = fmax(worst, WorstTangent(&s, in));
    }
    printf("%-18s largest relative difference %.2e\n", condition[k].name, worst);
    assert_true(worst < 1e-8);
  }
}

/* A face that is passed over gives nothing, and changes nothing; each condition, and the drag, makes it count. */
static void IdleFaces(void **state)
{
  static const FaceOutput nothing = {0};
  Rng                     r       = {.s = 15};

  for (size_t k = 0; k < sizeof(condition) / sizeof(*condition); k++) {
    SmallScene s;
    FaceOutput o;
    double     in[IN_COUNT];

    SceneInit(&s, &r);
    condition[k].set(&s, &r);
    Inputs(&r, in);
    Evaluate(&s, in, &o);
    assert_int_equal(FaceActs(&s.c, &s.face), condition[k].set != Closed);
    assert_true(FaceActs(&s.c, &s.face) || memcmp(&o, &nothing, sizeof(o)) == 0);
    s.face.meters = 1;
    s.c.nmeter    = 1;
    assert_true(FaceActs(&s.c, &s.face));
  }
}

/* (199): at the prescribed temperature a face conducts as the body does, through all of a step; off it, it gives heat,
   over the area that the step stands for. */
static void FaceTemperature(void **state)
{
  Rng        r = {.s = 19};
  SmallScene s;
  FaceOutput o;
  double     in[IN_COUNT] = {0.0};

  SceneInit(&s, &r);
  s.face.bc[BC_FACE_TEMPERATURE] = 2;
  s.face.ring[1]                 = 0.0;
  in[IN_GT]                      = -7.0;
  in[IN_GT + 1]                  = 3.0;
  s.value[2]                     = 10.0;
  in[IN_T]                       = 10.0 - in[IN_GT] * s.face.r[0] - in[IN_GT + 1] * s.face.r[1];
  Evaluate(&s, in, &o);
  assert_true(fabs(o.heat_in - KAPPA * (in[IN_GT] * s.face.n[0] + in[IN_GT + 1] * s.face.n[1])) < 1e-12);
  in[IN_T] -= 1.0;
  const double before = o.heat_in, given = FACE_PENALTY * KAPPA / hypot(s.face.r[0], s.face.r[1]);
  Evaluate(&s, in, &o);
  assert_true(fabs((o.heat_in - before) / (given * hypot(s.face.s[0], s.face.s[1])) - 1.0) < 1e-12);
}

/* (425): a face that is moved down sees as much more as the depth that it gained; one that is moved along a level sees
   what it saw. */
static void WithDepth(void **state)
{
  Rng        r = {.s = 425};
  SmallScene s;
  FaceOutput o, down, level;
  double     in[IN_COUNT] = {[IN_T] = 8.0};

  SceneInit(&s, &r);
  Depth(&s, &r);
  s.face.bc[BC_FACE_TEMPERATURE] = -1;
  Evaluate(&s, in, &o);
  const double g     = hypot(s.c.gravity[0], s.c.gravity[1]);
  const double depth = (s.face.x[0] * s.c.gravity[0] + s.face.x[1] * s.c.gravity[1]) / g;
  const double alpha = 15.0 * hypot(s.face.s[0], s.face.s[1]);
  assert_true(fabs(o.heat_in / (alpha * (12.0 + s.bc[2].with_depth * depth - 8.0)) - 1.0) < 1e-14);
  for (int d = 0; d < CL_DIM; d++)
    in[IN_U + d] = 3.0 * s.c.gravity[d] / g;
  Evaluate(&s, in, &down);
  assert_true(fabs((down.heat_in - o.heat_in) / (alpha * 3.0 * s.bc[2].with_depth) - 1.0) < 1e-13);
  in[IN_U]     = 3.0 * s.c.gravity[1] / g;
  in[IN_U + 1] = -3.0 * s.c.gravity[0] / g;
  Evaluate(&s, in, &level);
  assert_true(fabs(level.heat_in / o.heat_in - 1.0) < 1e-14);
}

/* A face exchanges heat by its own temperature, not by that of its particle. */
static void Convection(void **state)
{
  Rng        r = {.s = 31};
  SmallScene s;
  FaceOutput o;
  double     in[IN_COUNT] = {[IN_T] = 8.0, [IN_GT] = -7.0, [IN_GT + 1] = 3.0};

  SceneInit(&s, &r);
  s.face.bc[BC_CONVECTION] = 2;
  s.bc[2].alpha            = 15.0;
  s.value[2]               = 12.0;
  Evaluate(&s, in, &o);
  const double T = in[IN_T] + in[IN_GT] * s.face.r[0] + in[IN_GT + 1] * s.face.r[1];
  assert_true(fabs(o.heat_in / (15.0 * (12.0 - T) * hypot(s.face.s[0], s.face.s[1])) - 1.0) < 1e-14);
}

/* (365): what is taken to leave has the body's own density at the face, else that of the pressure outside, both at the
   particle's temperature; water takes along the methane that it holds (352).  Without gas (323) is its density. */
static void DensityOfOutflow(void **state)
{
  Rng        r = {.s = 32};
  SmallScene s;
  FaceOutput o;
  double     in[IN_COUNT] =
      {[IN_T] = 8.0, [IN_P] = 3e6, [IN_P + 1] = 3.1e6, [IN_J] = 2e-6, [IN_J + 1] = -1e-6, [IN_J + 2] = 5e-6},
         d, e;

  SceneInit(&s, &r);
  Separate(&s, &r);
  for (int k = 0; k < 3; k++) {
    const bool out = k > 0, none = k == 2;

    in[IN_P + 1]           = none ? -3e6 : 3.1e6;
    s.mat.gas.trace        = none ? 3e-7 : 0.0;
    s.face.leaves[PHASE_W] = s.face.leaves[PHASE_G] = out;
    Evaluate(&s, in, &o);
    const double pw     = out ? FacePressure(&s.face, PHASE_W, in) : s.phase[PHASE_W][0],
                 pg     = none  ? 0.1 * pw
                          : out ? FacePressure(&s.face, PHASE_G, in)
                                : s.phase[PHASE_G][0];
    const double  water = LiquidDensity(&s.mat.water, pw, 8.0, &d, &e), gas = GasDensity(&s.mat.gas, pg, 8.0, &d, &e);
    const double *n    = s.face.n;
    const double  Ja_w = in[IN_J] * n[0] + in[IN_J + 1] * n[1], Ja_g = in[IN_J + 2] * n[0] + in[IN_J + 3] * n[1];
    assert_true(fabs(o.outflow[PHASE_W] / (water * Ja_w) - 1.0) < 1e-14);
    assert_true(fabs(o.outflow[PHASE_G] / (gas * Ja_g + 3e-7 * in[IN_P + 1] * Ja_w) - 1.0) < 1e-14);
  }
}

/* (358): the sea lets gas out of a body whose pore pressure is above its own, and none into it; water crosses either
   way.  A reservoir, of a given pressure or a saturation that is held, does not ask. */
static void NoGasFromTheSea(void **state)
{
  Rng r = {.s = 358};

  for (int n = 0; n < STATES; n++) {
    for (int natural = 0; natural < 2; natural++) {
      SmallScene s;
      FaceOutput o[2];
      double     in[IN_COUNT], d[CL_DIM];

      SceneInit(&s, &r);
      AmbientFluid(&s, &r, natural);
      Inputs(&r, in);
      for (int k = 0; k < 2; k++) {
        s.face.pore = AmbientPressure(&s.v.ambient, s.face.x, d) + (k ? 1.0 : -1.0);
        Evaluate(&s, in, &o[k]);
        assert_true(o[k].out[F_PW] != 0.0 && o[k].out[F_PW] == o[0].out[F_PW] && o[k].out[F_VW] == o[0].out[F_VW]);
      }
      assert_true((o[0].out[F_VG] == 0.0 && o[0].out[F_VG + 1] == 0.0) == natural && o[1].out[F_VG] != 0.0);
      assert_true((o[1].out[F_PG] != o[0].out[F_PG]) == natural);
      s.value[0]  = 3e6;
      s.face.pore = 0.0;
      Evaluate(&s, in, &o[0]);
      assert_true(o[0].out[F_VG] != 0.0);
    }
  }
}

/* (152): dynamic pressure on a face that moves into the fluid, none on one that leaves it. */
static void DragOfTheSea(void **state)
{
  Rng        r = {.s = 152};
  SmallScene s;
  FaceOutput o;
  double     in[IN_COUNT] = {0.0};

  SceneInit(&s, &r);
  Drag(&s, &r);
  s.face.n[0] = 0.0; /* Evaluate moves the face by (0.02, -0.01) m/s */
  s.face.n[1] = -3.0;
  Evaluate(&s, in, &o);
  assert_true(o.out[F_VS] == 0.0);
  assert_true(fabs(o.out[F_VS + 1] / (0.5 * s.c.ambient_density * s.c.ambient_drag * 1e-4 * -3.0) - 1.0) < 1e-14);
  s.face.n[1] = 3.0;
  Evaluate(&s, in, &o);
  assert_true(o.out[F_VS] == 0.0 && o.out[F_VS + 1] == 0.0);
}

/* (31): whatever p_c is, the mean outside is the prescribed one; free takes the particle's p_c, held the initial one.
 */
static void MeanPressure(void **state)
{
  Rng r = {.s = 7};

  for (int n = 0; n < STATES; n++) {
    for (int natural = 0; natural < 2; natural++) {
      SmallScene s;
      FaceOutput o;
      double     in[IN_COUNT], p[PHASE_COUNT];
      SceneInit(&s, &r);
      Prescribe(&s, &r, natural, OPEN_BOTH);
      Inputs(&r, in);
      memset(in, 0, MOTION_COUNT * sizeof(*in)); /* a = n */
      Evaluate(&s, in, &o);
      for (int ph = 0; ph < PHASE_COUNT; ph++)
        p[ph] = o.out[F_VW + 2 * ph] / s.face.n[0] + in[IN_P + ph] + in[IN_GP + 2 * ph] * s.face.r[0] +
                in[IN_GP + 2 * ph + 1] * s.face.r[1]; /* the row has what it differs from the body's own */
      const double pc = natural ? in[IN_P + 1] - in[IN_P] : s.p0[1] - s.p0[0];
      const double sg = GasShareOf(&s.mat, pc, s.Sh);

      assert_true(fabs(p[1] - p[0] - pc) < 1e-12 * p[1]);
      assert_true(fabs((1.0 - sg) * p[0] + sg * p[1] - s.value[0]) < 1e-12 * s.value[0]);
    }
  }
}

/* Mass rows are what the meters count, with the other sign of time; closed phases let nothing through. */
static void MassRows(void **state)
{
  Rng r = {.s = 11};

  for (size_t k = 0; k < sizeof(condition) / sizeof(*condition); k++) {
    for (int n = 0; n < STATES; n++) {
      SmallScene s;
      FaceOutput o;
      double     in[IN_COUNT];

      SceneInit(&s, &r);
      condition[k].set(&s, &r);
      s.mat.gas.carried = n % 2 ? 3e-7 : 0.0;
      Inputs(&r, in);
      Evaluate(&s, in, &o);
      for (int ph = 0; ph < PHASE_COUNT; ph++) {
        const double terms =
            fabs(o.out[F_PW + ph]) + (ph == PHASE_G ? fabs(o.out[F_PW]) : 0.0); /* (352) goes with water */

        assert_true(fabs(o.out[F_PW + ph] - DT * o.outflow[ph]) <= 1e-14 * terms);
      }
      assert_true(fabs(o.out[F_T] + o.heat_in) <= 1e-14 * fabs(o.heat_in));
      for (int q = 0; condition[k].set == Closed && q < F_COUNT; q++)
        assert_true(o.out[q] == 0.0);
      if (condition[k].set == Closed || condition[k].set == GasOnly)
        assert_true(o.outflow[PHASE_W] == 0.0);
      if (condition[k].set == Closed || (condition[k].set == WaterOnly && s.mat.gas.carried == 0.0))
        assert_true(o.outflow[PHASE_G] == 0.0);
    }
  }
}

/* (72): the spring's force and where it acts; none where a plate that separates has lifted off; area under it. */
static void PlateForces(void **state)
{
  Rng r      = {.s = 13};
  int lifted = 0;

  for (int n = 0; n < STATES; n++) {
    for (int kind = 0; kind < 3; kind++) {
      SmallScene s;
      FaceOutput o;
      double     in[IN_COUNT];

      SceneInit(&s, &r);
      (kind == 0 ? Plate : kind == 1 ? RoughPlate : LoosePlate)(&s, &r);
      Inputs(&r, in);
      Evaluate(&s, in, &o);
      const int    d = s.face.side == SIDE_XMAX ? 0 : 1;
      const double along =
          s.face.K * (s.face.moved[d] + in[IN_U + d] - s.value[0]); /* outwards is + at xmax, - at ymin */
      const double gap  = d == 0 ? along : -along;
      const bool   off  = kind == 2 && gap <= 0.0;
      const double a[2] = {s.face.n[0], s.face.n[1]};
      const double cof  = d == 0 ? (1.0 + in[IN_GRADU + 3]) * a[0] - in[IN_GRADU + 2] * a[1]
                                 : (1.0 + in[IN_GRADU]) * a[1] - in[IN_GRADU + 1] * a[0];

      lifted += off;
      assert_true(fabs(o.plate[PLATE_FORCE] - (off ? 0.0 : gap)) <= 1e-6);
      assert_true(fabs(o.out[F_VS + d] - (off ? 0.0 : along)) <= 1e-6);
      assert_true(fabs(o.out[F_VS + 1 - d] - (kind == 1 ? s.face.K * (s.face.moved[1 - d] + in[IN_U + 1 - d]) : 0.0)) <=
                  1e-6);
      assert_true(o.plate[PLATE_SHEAR] == -o.out[F_VS + 1 - d]);
      assert_true(fabs(o.plate[PLATE_AREA] - (off ? 0.0 : (d == 0 ? 1.0 : -1.0) * (1.0 + in[IN_GRADU + 4]) * cof)) <=
                  1e-12);
    }
  }
  assert_true(lifted > 5 && lifted < STATES - 5);
}

/* The true area goes with the motion: |cof(F) s|. */
static void TrueArea(void **state)
{
  Rng r = {.s = 17};

  for (int n = 0; n < STATES; n++) {
    SmallScene s;
    FaceOutput o;
    double     in[IN_COUNT];

    SceneInit(&s, &r);
    s.face.bc[BC_HEAT_FLUX] = 2;
    s.value[2]              = 50.0;
    Inputs(&r, in);
    Evaluate(&s, in, &o);

    const double F[2][2] = {{1.0 + in[IN_GRADU], in[IN_GRADU + 1]}, {in[IN_GRADU + 2], 1.0 + in[IN_GRADU + 3]}};
    const double hoop    = 1.0 + in[IN_GRADU + 4];
    const double area =
        hypot(F[1][1] * s.face.s[0] - F[1][0] * s.face.s[1], F[0][0] * s.face.s[1] - F[0][1] * s.face.s[0]);

    assert_true(fabs(o.heat_in - 50.0 * area * hoop) < 1e-12 * o.heat_in);
  }
}

/* What is given per area goes with the area that a step of a staircase stands for; vectors go with its own. */
static void Share(void **state)
{
  Rng r = {.s = 13};

  for (int n = 0; n < STATES; n++) {
    SmallScene s;
    FaceOutput whole, part;
    double     in[IN_COUNT];

    SceneInit(&s, &r);
    WarmInflow(&s, &r);
    s.face.bc[BC_TRACTION] = s.face.bc[BC_CONVECTION] = s.face.bc[BC_FACE_TEMPERATURE] = s.face.bc[BC_HEAT_FLUX] = 2;
    s.bc[2].alpha                                                                                                = 15.0;
    s.value[2]                                                                                                   = 12.0;
    Inputs(&r, in);
    in[IN_GT] = in[IN_GT + 1] = 0.0; /* what is conducted to a given temperature goes through the whole step */
    Evaluate(&s, in, &whole);
    for (int d = 0; d < CL_DIM; d++)
      s.face.s[d] *= 0.7;
    Evaluate(&s, in, &part);
    for (int ph = 0; ph < PHASE_COUNT; ph++)
      assert_true(fabs(part.outflow[ph] - 0.7 * whole.outflow[ph]) <= 1e-14 * fabs(whole.outflow[ph]));
    assert_true(fabs(part.heat_in - 0.7 * whole.heat_in) <= 1e-14 * fabs(whole.heat_in));
    assert_true(part.out[F_VS] == whole.out[F_VS] && part.out[F_VS + 1] == whole.out[F_VS + 1] &&
                whole.out[F_VS] != 0.0);
  }
}

/* (367): both fluids leave as the mean pressure drives them, each by its own mobility and density, water with its
   methane; what enters has the density of the pressure in the well.  (370): shares of a rate. */
static void WellFlows(void **state)
{
  Rng r = {.s = 367};

  for (int n = 0; n < STATES; n++) {
    SmallScene s;
    FaceOutput o;
    double     in[IN_COUNT], d, e;

    SceneInit(&s, &r);
    (n % 2 ? WellFills : WellDraws)(&s, &r);
    Inputs(&r, in);
    Evaluate(&s, in, &o);
    const double pc = in[IN_P + 1] - in[IN_P], sg = GasShareOf(&s.mat, pc, s.Sh),
                 head = in[IN_P] + sg * pc - s.value[0], less = n % 2 ? head : 0.0; /* below the body's own */
    const double w = 0.9 * 1e-9 *
                     RelPermWater(&s.mat.relperm, s.mat.relperm.of_pores ? (1.0 - s.Sh) * (1.0 - sg) : 1.0 - sg, &d) *
                     head,
                 g = 0.9 * 1e-7 * RelPermGas(&s.mat.relperm, s.mat.relperm.of_pores ? (1.0 - s.Sh) * sg : sg, &d) *
                     head;
    const double rho_w = LiquidDensity(&s.mat.water, in[IN_P] - less, in[IN_T], &d, &e),
                 rho_g = GasDensity(&s.mat.gas, in[IN_P + 1] - less, in[IN_T], &d, &e);

    assert_true(fabs(o.outflow[PHASE_W] - rho_w * w) <= 1e-13 * fabs(rho_w * w) && w != 0.0);
    assert_true(fabs(o.outflow[PHASE_G] - rho_g * g - 3e-7 * in[IN_P + 1] * w) <= 1e-13 * (fabs(rho_g * g) + fabs(w)));
    assert_true((o.outflow[PHASE_W] > 0.0) == (n % 2 == 0));
    WellRates(&s, &r);
    s.bc[0].value = (Schedule){.n = 0};
    Evaluate(&s, in, &o);
    for (int ph = 0; ph < PHASE_COUNT; ph++)
      assert_true(o.outflow[ph] == -0.3 * s.phase[ph][0]);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(Tangents),         cmocka_unit_test(MeanPressure),    cmocka_unit_test(FaceTemperature),
      cmocka_unit_test(WithDepth),        cmocka_unit_test(DragOfTheSea),    cmocka_unit_test(PlateForces),
      cmocka_unit_test(MassRows),         cmocka_unit_test(TrueArea),        cmocka_unit_test(Convection),
      cmocka_unit_test(DensityOfOutflow), cmocka_unit_test(NoGasFromTheSea), cmocka_unit_test(Share),
      cmocka_unit_test(WellFlows),        cmocka_unit_test(IdleFaces)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
