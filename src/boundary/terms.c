/* What each condition on a face adds to the balances, with the tangent. */
#include "terms.h"
#include "clathra/point_heat.h"
#include "clathra/point_state.h"

/* Total traction: -q a + s a_perp; row v_s loses it.  Shear is the plane's: a_perp is a turned about z. */
void FaceTraction(const FaceState *x, PetscInt k, FaceOutput *o)
{
  const double q = x->v->value[k], s = x->v->shear[k], perp[2] = {s, -s};

  for (int i = 0; i < CL_DIM; i++) {
    const double along = i < 2 ? perp[i] : 0.0;
    const int    other = i < 2 ? 1 - i : i;

    o->out[F_VS + i] += q * x->a[i] + along * x->a[other];
    for (int j = 0; j < MOTION_COUNT; j++)
      o->D[F_VS + i][j] += q * x->da[i][j] + along * x->da[other][j];
  }
}

/* (152): dynamic pressure of the fluid around the body on a face that moves into it. */
void FaceDrag(const FaceState *x, const double velocity[CL_DIM], FaceOutput *o)
{
  const double *a     = x->a;
  const double  area2 = VectorDot(a, a), w = VectorDot(velocity, a);
  const double  C = 0.5 * x->c->ambient_density * x->c->ambient_drag / area2, q = C * w * w;

  if (w <= 0.0 || C == 0.0)
    return;
  for (int i = 0; i < CL_DIM; i++) {
    double *row = o->D[F_VS + i];

    o->out[F_VS + i] += q * a[i];
    for (int d = 0; d < CL_DIM; d++)
      row[IN_U + d] += 2.0 * C * w * a[d] / x->dt * a[i];
    for (int k = 0; k < MOTION_COUNT; k++) {
      const double dw = AlongSlope(velocity, x->da, k), darea2 = 2.0 * AlongSlope(a, x->da, k);

      row[k] += (2.0 * C * w * dw - q * darea2 / area2) * a[i] + q * x->da[i][k];
    }
  }
}

/* ---------------------------------------------------------------- fluids */
/* Pressures outside, and their derivatives with respect to the particle's capillary pressure and to the displacement of
   the face (the same for both fluids). */
typedef struct {
  double p[PHASE_COUNT], dpc[PHASE_COUNT], du[CL_DIM];
} Outside;

/* Which pressure sets the density of what leaves, and which part of it (323). */
static int SetsDensity(const FaceState *x, int phase, double *part)
{
  const double H = x->mat->gas.trace;
  const bool   water =
      phase == PHASE_G && GasFlowsByWater(H, FacePressure(x->f, PHASE_W, x->in), FacePressure(x->f, PHASE_G, x->in));

  *part = water ? CL_GAS_FLOWS : 1.0;
  return water ? PHASE_W : phase;
}

/* Open face: rho J . a with the density outside or, where (365) has it leave, the body's own, and in the fluid's
   momentum what the pressure outside differs from the fluid's own there, which is extrapolated from the particle.  A
   closed face adds nothing. */
static void Open(const FaceState *x, int phase, const Outside *outside, FaceOutput *o)
{
  double        dp, dT, part;
  const Face   *f  = x->f;
  const double *in = x->in, *a = x->a, dt = x->dt;
  const double *J = &in[VectorAt(IN_J, phase, 0)], Ja = VectorDot(J, a);
  const double  p = outside->p[phase], jump = p - FacePressure(f, phase, in);
  const bool    leaves = f->leaves[phase];
  const int     sets   = SetsDensity(x, phase, &part);
  const double  rho    = FluidDensity(x->mat, phase, leaves ? part * FacePressure(f, sets, in) : p, in[IN_T], &dp, &dT);
  const double  inside = leaves ? part * dp : 0.0, beyond = leaves ? 0.0 : dp; /* slopes by p of either side */
  double       *D = o->D[F_PW + phase];

  o->out[F_PW + phase] += dt * rho * Ja;
  o->outflow[phase] += rho * Ja;
  D[IN_P + sets] += dt * inside * Ja;
  for (int j = 0; j < CL_DIM; j++)
    D[VectorAt(IN_GP, sets, j)] += dt * inside * f->r[j] * Ja;
  D[IN_T] += dt * dT * Ja;
  for (int j = 0; j < CL_DIM; j++)
    D[VectorAt(IN_J, phase, j)] += dt * rho * a[j];
  for (int k = 0; k < MOTION_COUNT; k++)
    D[k] += dt * rho * AlongSlope(J, x->da, k);
  for (int d = 0; d < CL_DIM; d++)
    D[IN_U + d] += dt * beyond * outside->du[d] * Ja;
  for (int i = 0; i < CL_DIM; i++) {
    double *row = o->D[VectorAt(F_VW, phase, i)];

    o->out[VectorAt(F_VW, phase, i)] += jump * a[i];
    row[IN_P + phase] -= a[i];
    for (int d = 0; d < CL_DIM; d++)
      row[IN_U + d] += outside->du[d] * a[i];
    for (int j = 0; j < CL_DIM; j++)
      row[VectorAt(IN_GP, phase, j)] -= a[i] * f->r[j];
    for (int k = 0; k < MOTION_COUNT; k++)
      row[k] += jump * x->da[i][k];
  }
  for (int k = 0; k < PHASE_COUNT; k++) { /* through p_c = p_g - p_w */
    const double dpk = (k == PHASE_G ? 1.0 : -1.0) * outside->dpc[phase];

    D[IN_P + k] += dt * beyond * dpk * Ja;
    for (int i = 0; i < CL_DIM; i++)
      o->D[VectorAt(F_VW, phase, i)][IN_P + k] += dpk * a[i];
  }
}

/* (352): the methane of the water that flows through an open face.  The fluid around the body holds none. */
static void Dissolved(const FaceState *x, bool ambient, FaceOutput *o)
{
  const double H = x->mat->gas.carried, dt = x->dt, *a = x->a, *J = &x->in[IN_J], Ja = VectorDot(J, a),
               c = DissolvedMethane(H, FacePressure(x->f, PHASE_G, x->in));
  double *D      = o->D[F_PG];

  if (H == 0.0 || (ambient && Ja < 0.0))
    return;
  o->out[F_PG] += dt * c * Ja;
  o->outflow[PHASE_G] += c * Ja;
  D[IN_P + PHASE_G] += dt * H * Ja;
  for (int j = 0; j < CL_DIM; j++) {
    D[VectorAt(IN_GP, PHASE_G, j)] += dt * H * Ja * x->f->r[j];
    D[IN_J + j] += dt * c * a[j];
  }
  for (int k = 0; k < MOTION_COUNT; k++)
    D[k] += dt * c * AlongSlope(J, x->da, k);
}

/* Where the face is at the end of the step, m. */
static void PlaceOfFace(const FaceState *s, double x[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    x[d] = s->f->x[d] + s->in[IN_U + d];
}

/* Prescribed mean pressure of a face; that of the ambient fluid depends on where the face is. */
static double MeanOutside(const FaceState *s, PetscInt k, double du[CL_DIM])
{
  const double value = s->v->value[k];
  double       x[CL_DIM];

  PlaceOfFace(s, x);
  return isinf(value) ? AmbientPressure(&s->v->ambient, x, du) : value;
}

/* (31): p_w and p_g as prescribed, the face's initial ones, or from the mean with a capillary pressure: that of the
   face's initial state, or the particle's own (natural outflow). */
static void OutsidePressures(const FaceState *x, PetscInt k, Outside *o)
{
  const Retention *retention = &x->mat->retention;
  const Bc        *b         = &x->c->bc[k];
  const double    *p0 = x->p0, *in = x->in;
  double           ds, dSh;

  *o = (Outside){.p = {p0[PHASE_W], p0[PHASE_G]}};
  for (int ph = 0; ph < PHASE_COUNT; ph++) {
    if (b->phase[ph].n)
      o->p[ph] = x->v->phase[ph][k];
  }
  if (b->phase[PHASE_W].n || b->phase[PHASE_G].n || (b->initial && !b->natural))
    return;
  if (!(x->c->fields.has & HAS_GAS)) {
    o->p[PHASE_W] = o->p[PHASE_G] = b->initial ? p0[PHASE_W] : MeanOutside(x, k, o->du);
    return;
  }
  const double sg0   = RetentionGasShare(retention, p0[PHASE_G] - p0[PHASE_W], x->Sh, &ds, &dSh);
  const double mean0 = PorePressureOf(sg0, p0[PHASE_W], p0[PHASE_G]).v;
  const double mean  = b->initial ? mean0 : MeanOutside(x, k, o->du);

  if (b->natural) {
    const double pc = in[IN_P + PHASE_G] - in[IN_P + PHASE_W], sg = RetentionGasShare(retention, pc, x->Sh, &ds, &dSh);

    o->p[PHASE_W]   = mean - sg * pc;
    o->p[PHASE_G]   = o->p[PHASE_W] + pc;
    o->dpc[PHASE_W] = -sg - ds * pc;
    o->dpc[PHASE_G] = 1.0 + o->dpc[PHASE_W];
    return;
  }
  for (int ph = 0; ph < PHASE_COUNT; ph++)
    o->p[ph] = p0[ph] + mean - mean0;
}

static bool Opens(const Bc *b, int phase)
{
  return b->open == OPEN_BOTH || (b->open == OPEN_WATER) == (phase == PHASE_W);
}

/* (358): the fluid around the body is water; gas leaves into it freely, but none comes back. */
static bool Gives(const FaceState *x, PetscInt k, int phase)
{
  double gradient[CL_DIM];

  return phase == PHASE_W || !isinf(x->v->value[k]) || !x->c->bc[k].natural ||
         x->f->pore > AmbientPressure(&x->v->ambient, x->f->x, gradient);
}

void FacePressures(const FaceState *x, PetscInt k, FaceOutput *o)
{
  Outside outside;

  OutsidePressures(x, k, &outside);
  for (int phase = 0; phase < PHASE_COUNT; phase++) {
    if (x->c->fields.phase[phase] && Opens(&x->c->bc[k], phase) && Gives(x, k, phase))
      Open(x, phase, &outside, o);
  }
  if ((x->c->fields.has & HAS_GAS) && Opens(&x->c->bc[k], PHASE_W))
    Dissolved(x, isinf(x->v->value[k]), o);
}

/* (106): gas that enters where there is none has the pressure of the water before it. */
static int InflowPressure(const FaceState *x, int phase)
{
  const bool two = x->c->fields.has & HAS_GAS;

  return two && phase == PHASE_G && FacePressure(x->f, PHASE_W, x->in) > FacePressure(x->f, PHASE_G, x->in) ? PHASE_W
                                                                                                            : phase;
}

/* (32): mass and, where it comes with a temperature of its own, heat of what is let in.  Its density is the body's own
   at the face. */
static void Inflow(const FaceState *x, PetscInt k, int phase, FaceOutput *o)
{
  const Face  *f   = x->f;
  const int    own = InflowPressure(x, phase);
  const double p = FacePressure(f, own, x->in), area = x->area, dt = x->dt, q = x->v->phase[phase][k];
  const bool   heats = x->c->fields.heat && x->c->bc[k].value.n && q > 0.0;
  const double c_f = SpecificHeat(x->mat, phase), dT_in = heats ? x->v->value[k] - x->T : 0.0;
  double       dp, dT, drate[IN_COUNT] = {0.0};
  const double rho = FluidDensity(x->mat, phase, p, x->T, &dp, &dT), rate = rho * q * area;

  drate[IN_P + own] = dp * q * area;
  drate[IN_T]       = dT * q * area;
  for (int j = 0; j < CL_DIM; j++) {
    drate[VectorAt(IN_GP, own, j)] = dp * q * area * f->r[j];
    drate[IN_GT + j]               = dT * q * area * f->r[j];
  }
  for (int j = 0; j < MOTION_COUNT; j++)
    drate[j] = rho * q * x->darea[j];
  o->out[F_PW + phase] -= dt * rate;
  o->outflow[phase] -= rate;
  o->out[F_T] -= c_f * rate * dT_in;
  o->heat_in += c_f * rate * dT_in;
  for (int j = 0; j < IN_COUNT; j++) {
    o->D[F_PW + phase][j] -= dt * drate[j];
    o->D[F_T][j] -= c_f * drate[j] * dT_in;
  }
  if (!heats)
    return;
  o->D[F_T][IN_T] += c_f * rate;
  for (int j = 0; j < CL_DIM; j++)
    o->D[F_T][IN_GT + j] += c_f * rate * f->r[j];
}

void FaceInflows(const FaceState *x, PetscInt k, FaceOutput *o)
{
  for (int phase = 0; phase < PHASE_COUNT; phase++) {
    if (x->c->fields.phase[phase])
      Inflow(x, k, phase, o);
  }
}

/* ---------------------------------------------------------------- heat */
/* A flux into the body (W/m^2) that falls by alpha with every kelvin of the face. */
static void LetIn(const FaceState *x, double flux, double alpha, FaceOutput *o)
{
  o->heat_in += flux * x->area;
  o->out[F_T] -= flux * x->area;
  o->D[F_T][IN_T] += alpha * x->area;
  for (int j = 0; j < CL_DIM; j++)
    o->D[F_T][IN_GT + j] += alpha * x->area * x->f->r[j];
  for (int j = 0; j < MOTION_COUNT; j++)
    o->D[F_T][j] -= flux * x->darea[j];
}

void FaceHeatFlux(const FaceState *x, PetscInt k, FaceOutput *o)
{
  LetIn(x, x->v->value[k], 0.0, o);
}

/* (443), of a particle inside. */
void FaceHeatSource(const FaceState *x, PetscInt k, FaceOutput *o)
{
  const double heat = x->f->share * x->v->value[k];

  o->heat_in += heat;
  o->out[F_T] -= heat;
}

/* alpha (T^ - T) into the body, T^ as (425) has it where the face is. */
static void Draw(const FaceState *x, PetscInt k, double alpha, FaceOutput *o)
{
  double at[CL_DIM], gradient[CL_DIM];

  PlaceOfFace(x, at);
  LetIn(x, alpha * (BcValueAt(x->c, &x->c->bc[k], x->v->value[k], at, gradient) - x->T), alpha, o);
  for (int d = 0; d < CL_DIM; d++)
    o->D[F_T][IN_U + d] -= alpha * gradient[d] * x->area;
}

void FaceConvection(const FaceState *x, PetscInt k, FaceOutput *o)
{
  Draw(x, k, x->c->bc[k].alpha, o);
}

/* (199): what the body conducts to the face, through its steps, and a penalty over the true surface. */
void FaceTemperature(const FaceState *x, PetscInt k, FaceOutput *o)
{
  const double *g = &x->in[IN_GT], strong = FACE_PENALTY / VectorLength(x->f->r);
  const double  conducts = x->kappa / (1.0 + strong * x->f->ring[1] * x->f->x[0]);
  const double  arrives  = conducts * VectorDot(g, x->a);

  Draw(x, k, strong * conducts, o);
  o->heat_in += arrives;
  o->out[F_T] -= arrives;
  for (int j = 0; j < CL_DIM; j++)
    o->D[F_T][IN_GT + j] -= conducts * x->a[j];
  for (int j = 0; j < MOTION_COUNT; j++)
    o->D[F_T][j] -= conducts * AlongSlope(g, x->da, j);
}
