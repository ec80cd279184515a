/* What the conditions add to the balances, and Dirichlet values on grid planes. */
#include "clathra/boundary.h"
#include "clathra/shape.h"

Ambient AmbientOf(const Case *c, double t, const double gravity[CL_DIM])
{
  Ambient a = {.pressure = ScheduleValue(&c->ambient_pressure, t)};

  for (int d = 0; d < CL_DIM; d++)
    a.weight[d] = c->ambient_density * gravity[d];
  a.head = -hypot(a.weight[0], a.weight[1]) * ScheduleValue(&c->ambient_level, t);
  a.on   = a.pressure != 0.0 || c->ambient_density > 0.0;
  return a;
}

void BcValuesEvaluate(const Case *c, double t, BcValues *v)
{
  for (PetscInt k = 0; k < c->nbc; k++) {
    const double at = t - c->bc[k].zero;

    v->value[k] = ScheduleValue(&c->bc[k].value, at);
    v->shear[k] = ScheduleValue(&c->bc[k].shear, at);
    if (c->bc[k].type == BC_PLATE)
      v->value[k] = PlatePosition(&c->bc[k], t);
    for (int ph = 0; ph < PHASE_COUNT; ph++)
      v->phase[ph][k] = ScheduleValue(&c->bc[k].phase[ph], at);
  }
  for (int d = 0; d < CL_DIM; d++) {
    const double ramp = c->gravity_ramp, from = c->gravity_before[d], at = t - c->t_begin;

    v->gravity[d] = at < ramp ? from + (c->gravity[d] - from) * at / ramp : c->gravity[d];
  }
  v->ambient = AmbientOf(c, t, v->gravity);
}

/* First kink of the condition after t, which round-off may have left short of one. */
static double NextKink(const Bc *b, double t)
{
  const double at   = t - b->zero + 4.0 * PETSC_MACHINE_EPSILON * fabs(t);
  double       next = fmin(ScheduleNextKink(&b->value, at), ScheduleNextKink(&b->shear, at));

  next = fmin(next, fmin(ScheduleNextKink(&b->displacement, at), ScheduleNextKink(&b->force, at)));
  for (int ph = 0; ph < PHASE_COUNT; ph++)
    next = fmin(next, ScheduleNextKink(&b->phase[ph], at));
  return b->zero + next;
}

double BcNextMark(const Case *c, double t)
{
  double next = fmin(ScheduleNextMark(&c->ambient_pressure, t), ScheduleNextMark(&c->ambient_level, t));

  for (PetscInt k = 0; k < c->nbc; k++) {
    const Bc       *b     = &c->bc[k];
    const double    at    = t - b->zero + 4.0 * PETSC_MACHINE_EPSILON * fabs(t);
    const Schedule *own[] = {&b->value, &b->shear, &b->displacement, &b->force, &b->phase[0], &b->phase[1]};

    for (size_t i = 0; i < sizeof(own) / sizeof(*own); i++)
      next = fmin(next, b->zero + ScheduleNextMark(own[i], at));
  }
  return next;
}

double BcNextKink(const Case *c, double t)
{
  const double ramped = c->t_begin + c->gravity_ramp;
  double       next   = t < ramped - CaseTimeSlack(c, ramped) ? ramped : INFINITY;

  next = fmin(next, fmin(ScheduleNextKink(&c->ambient_pressure, t), ScheduleNextKink(&c->ambient_level, t)));
  for (PetscInt k = 0; k < c->nbc; k++)
    next = fmin(next, NextKink(&c->bc[k], t));
  return next;
}

/* Total traction: -q a + s a_perp; row v_s loses it. */
static void Traction(double q, double s, const double a[2], const double da[2][MOTION_COUNT], FaceOutput *o)
{
  o->out[F_VSX] = q * a[0] + s * a[1];
  o->out[F_VSY] = q * a[1] - s * a[0];
  for (int k = 0; k < MOTION_COUNT; k++) {
    o->D[F_VSX][k] = q * da[0][k] + s * da[1][k];
    o->D[F_VSY][k] = q * da[1][k] - s * da[0][k];
  }
}

/* (152): dynamic pressure of the fluid around the body on a face that moves into it. */
static void Drag(const Case *c, const double velocity[CL_DIM], const double a[2], const double da[2][MOTION_COUNT],
                 double dt, FaceOutput *o)
{
  const double area2 = a[0] * a[0] + a[1] * a[1], w = velocity[0] * a[0] + velocity[1] * a[1];
  const double C = 0.5 * c->ambient_density * c->ambient_drag / area2, q = C * w * w;

  if (w <= 0.0 || C == 0.0)
    return;
  for (int i = 0; i < 2; i++) {
    double *row = o->D[F_VSX + i];

    o->out[F_VSX + i] += q * a[i];
    for (int d = 0; d < CL_DIM; d++)
      row[IN_U + d] += 2.0 * C * w * a[d] / dt * a[i];
    for (int k = 0; k < MOTION_COUNT; k++) {
      const double dw     = velocity[0] * da[0][k] + velocity[1] * da[1][k],
                   darea2 = 2.0 * (a[0] * da[0][k] + a[1] * da[1][k]);

      row[k] += (2.0 * C * w * dw - q * darea2 / area2) * a[i] + q * da[i][k];
    }
  }
}

static double Density(const Material *mat, int phase, double p, double T, double *dp, double *dT)
{
  return phase == PHASE_W ? LiquidDensity(&mat->water, p, T, dp, dT) : GasDensity(&mat->gas, p, T, dp, dT);
}

/* Pressures outside, and their derivatives with respect to the particle's capillary pressure and to the displacement of
   the face (the same for both fluids). */
typedef struct {
  double p[PHASE_COUNT], dpc[PHASE_COUNT], du[CL_DIM];
} Outside;

/* Open face: outflow rho J . a, and in the fluid's momentum what the pressure outside differs from the fluid's own
   there, which is extrapolated from the particle.  A closed face adds nothing. */
static void Open(const Material *mat, const Face *f, int phase, const Outside *outside, const double a[2],
                 const double da[2][MOTION_COUNT], const double in[IN_COUNT], double dt, FaceOutput *o)
{
  double        dp, dT;
  const double *J = &in[IN_J + 2 * phase], Ja = J[0] * a[0] + J[1] * a[1], skin = f->skin[phase];
  const double  p = outside->p[phase], jump = p + skin * Ja - FacePressure(f, phase, in),
               rho = Density(mat, phase, p, in[IN_T], &dp, &dT);
  double *D        = o->D[F_PW + phase];

  o->out[F_PW + phase] = dt * rho * Ja;
  o->outflow[phase]    = rho * Ja;
  D[IN_T]              = dt * dT * Ja;
  for (int j = 0; j < 2; j++)
    D[IN_J + 2 * phase + j] = dt * rho * a[j];
  for (int k = 0; k < MOTION_COUNT; k++)
    D[k] = dt * rho * (J[0] * da[0][k] + J[1] * da[1][k]);
  for (int d = 0; d < CL_DIM; d++)
    D[IN_U + d] = dt * dp * outside->du[d] * Ja;
  for (int i = 0; i < 2; i++) {
    double *row = o->D[F_VWX + 2 * phase + i];

    o->out[F_VWX + 2 * phase + i] = jump * a[i];
    row[IN_P + phase]             = -a[i];
    for (int d = 0; d < CL_DIM; d++)
      row[IN_U + d] = outside->du[d] * a[i];
    for (int j = 0; j < 2; j++)
      row[IN_GP + 2 * phase + j] = -a[i] * f->r[j];
    for (int j = 0; j < 2; j++)
      row[IN_J + 2 * phase + j] = skin * a[j] * a[i];
    for (int k = 0; k < MOTION_COUNT; k++)
      row[k] = jump * da[i][k] + skin * (J[0] * da[0][k] + J[1] * da[1][k]) * a[i];
  }
  for (int k = 0; k < PHASE_COUNT; k++) { /* through p_c = p_g - p_w */
    const double dpk = (k == PHASE_G ? 1.0 : -1.0) * outside->dpc[phase];

    D[IN_P + k] = dt * dp * dpk * Ja;
    for (int i = 0; i < 2; i++)
      o->D[F_VWX + 2 * phase + i][IN_P + k] += dpk * a[i];
  }
}

/* Area over which fluxes per area act, of the true surface (70) (vector s), and its derivatives. */
static double Area(const double s[2], const double ds[2][MOTION_COUNT], double darea[MOTION_COUNT])
{
  const double area = hypot(s[0], s[1]);

  for (int k = 0; k < MOTION_COUNT; k++)
    darea[k] = (s[0] * ds[0][k] + s[1] * ds[1][k]) / area;
  return area;
}

/* Heat that a face lets in: a flux, exchange with what is outside, and a prescribed temperature (199). */
static void Heat(const Case *c, const Face *f, const BcValues *v, const double s[2], const double ds[2][MOTION_COUNT],
                 const double in[IN_COUNT], double kappa, FaceOutput *o)
{
  const double *g = &in[IN_GT], T = in[IN_T] + g[0] * f->r[0] + g[1] * f->r[1];
  double        flux = f->heat >= 0 ? v->value[f->heat] : 0.0, alpha = 0.0, conducts = 0.0, darea[MOTION_COUNT];
  const double  area = Area(s, ds, darea);

  if (f->convection >= 0) {
    alpha = c->bc[f->convection].alpha;
    flux += alpha * (v->value[f->convection] - T);
  }
  if (f->temperature >= 0) {
    const double strong = FACE_PENALTY / hypot(f->r[0], f->r[1]);

    conducts = kappa / (1.0 + strong * f->ring[1] * f->x[0]);
    alpha += strong * conducts;
    flux += strong * conducts * (v->value[f->temperature] - T);
  }
  o->heat_in      = flux * area + conducts * (g[0] * s[0] + g[1] * s[1]);
  o->out[F_T]     = -o->heat_in;
  o->D[F_T][IN_T] = alpha * area;
  for (int j = 0; j < 2; j++)
    o->D[F_T][IN_GT + j] = alpha * area * f->r[j] - conducts * s[j];
  for (int k = 0; k < MOTION_COUNT; k++)
    o->D[F_T][k] = -flux * darea[k] - conducts * (g[0] * ds[0][k] + g[1] * ds[1][k]);
}

/* Prescribed mean pressure of a face; that of the ambient fluid depends on where the face is. */
static double MeanOutside(const Face *f, const BcValues *v, const double in[IN_COUNT], double du[CL_DIM])
{
  const double value = v->value[f->pressure], x[CL_DIM] = {f->x[0] + in[IN_U], f->x[1] + in[IN_U + 1]};

  return isinf(value) ? AmbientPressure(&v->ambient, x, du) : value;
}

/* (31): p_w and p_g as prescribed, the face's initial ones, or from the mean with a capillary pressure: that of the
   face's initial state, or the particle's own (natural outflow). */
static void OutsidePressures(const Case *c, const Face *f, const BcValues *v, const Material *mat,
                             const double p0[PHASE_COUNT], const double in[IN_COUNT], Outside *o)
{
  const Bc *b = &c->bc[f->pressure];
  double    ds;

  *o = (Outside){.p = {p0[PHASE_W], p0[PHASE_G]}};
  for (int ph = 0; ph < PHASE_COUNT; ph++) {
    if (b->phase[ph].n)
      o->p[ph] = v->phase[ph][f->pressure];
  }
  if (b->phase[PHASE_W].n || b->phase[PHASE_G].n || (b->initial && !b->natural))
    return;
  if (!(c->fields.has & HAS_GAS_PRESSURE)) {
    o->p[PHASE_W] = o->p[PHASE_G] = b->initial ? p0[PHASE_W] : MeanOutside(f, v, in, o->du);
    return;
  }
  const double sg0   = RetentionGasShare(&mat->retention, p0[PHASE_G] - p0[PHASE_W], &ds);
  const double mean0 = (1.0 - sg0) * p0[PHASE_W] + sg0 * p0[PHASE_G];
  const double mean  = b->initial ? mean0 : MeanOutside(f, v, in, o->du);

  if (b->natural) {
    const double pc = in[IN_P + PHASE_G] - in[IN_P + PHASE_W], sg = RetentionGasShare(&mat->retention, pc, &ds);

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

/* Rows of the fluids, where a pressure is prescribed. */
static void Fluids(const Case *c, const Face *f, const BcValues *v, const Material *mat, const double p0[PHASE_COUNT],
                   const double a[2], const double da[2][MOTION_COUNT], const double in[IN_COUNT], double dt,
                   FaceOutput *o)
{
  Outside outside;

  if (f->pressure < 0)
    return;
  OutsidePressures(c, f, v, mat, p0, in, &outside);
  for (int phase = 0; phase < PHASE_COUNT; phase++) {
    if (c->fields.phase[phase] && Opens(&c->bc[f->pressure], phase))
      Open(mat, f, phase, &outside, a, da, in, dt, o);
  }
}

/* (106): gas that enters where there is none has the pressure of the water before it. */
static int InflowPressure(const Case *c, const Face *f, int phase, const double in[IN_COUNT])
{
  const bool two = c->fields.has & HAS_GAS_PRESSURE;

  return two && phase == PHASE_G && FacePressure(f, PHASE_W, in) > FacePressure(f, PHASE_G, in) ? PHASE_W : phase;
}

/* (32): mass and, where it comes with a temperature of its own, heat of what is let in.  Its density is the body's own
   at the face. */
static void Inflow(const Case *c, const Face *f, const BcValues *v, const Material *mat, int phase, const double s[2],
                   const double ds[2][MOTION_COUNT], const double in[IN_COUNT], double dt, FaceOutput *o)
{
  const int    own = InflowPressure(c, f, phase, in);
  const double p   = FacePressure(f, own, in);
  const double T   = in[IN_T] + in[IN_GT] * f->r[0] + in[IN_GT + 1] * f->r[1];
  double       darea[MOTION_COUNT];
  const double q = v->phase[phase][f->inflow], area = Area(s, ds, darea);
  const bool   heats = c->fields.heat && c->bc[f->inflow].value.n && q > 0.0;
  const double c_f = phase == PHASE_W ? mat->c_w : mat->c_g, dT_in = heats ? v->value[f->inflow] - T : 0.0;
  double       dp, dT, drate[IN_COUNT] = {0.0};
  const double rho = Density(mat, phase, p, T, &dp, &dT), rate = rho * q * area;

  drate[IN_P + own] = dp * q * area;
  drate[IN_T]       = dT * q * area;
  for (int j = 0; j < 2; j++) {
    drate[IN_GP + 2 * own + j] = dp * q * area * f->r[j];
    drate[IN_GT + j]           = dT * q * area * f->r[j];
  }
  for (int k = 0; k < MOTION_COUNT; k++)
    drate[k] = rho * q * darea[k];
  o->out[F_PW + phase] -= dt * rate;
  o->outflow[phase] -= rate;
  o->out[F_T] -= c_f * rate * dT_in;
  o->heat_in += c_f * rate * dT_in;
  for (int k = 0; k < IN_COUNT; k++) {
    o->D[F_PW + phase][k] -= dt * drate[k];
    o->D[F_T][k] -= c_f * drate[k] * dT_in;
  }
  if (!heats)
    return;
  o->D[F_T][IN_T] += c_f * rate;
  for (int j = 0; j < 2; j++)
    o->D[F_T][IN_GT + j] += c_f * rate * f->r[j];
}

/* An area vector goes with the motion: a = cof(F) n. */
static void Carry(const Kinematics *k, const double n[2], double a[2], double da[2][MOTION_COUNT])
{
  for (int i = 0; i < 2; i++) {
    a[i] = k->cof[i][0] * n[0] + k->cof[i][1] * n[1];
    for (int q = 0; q < MOTION_COUNT; q++)
      da[i][q] = k->dcof[i][0][q] * n[0] + k->dcof[i][1][q] * n[1];
  }
}

void FaceEvaluate(const Case *c, const Face *f, const BcValues *v, const Material *mat, const double p0[PHASE_COUNT],
                  const double in[IN_COUNT], const double velocity[CL_DIM], double kappa, double dt, FaceOutput *o)
{
  double     a[2] = {f->n[0], f->n[1]}, da[2][MOTION_COUNT] = {{0.0}};
  double     s[2] = {f->s[0], f->s[1]}, ds[2][MOTION_COUNT] = {{0.0}};
  Kinematics k;

  *o = (FaceOutput){0};
  if (a[0] == 0.0 && a[1] == 0.0)
    return; /* on the axis */
  if (c->fields.solid) {
    if (!KinematicsEvaluate(&in[IN_GRADU], &k))
      return; /* the particle itself reports it */
    Carry(&k, f->n, a, da);
    Carry(&k, f->s, s, ds);
    if (f->traction >= 0)
      Traction(v->value[f->traction], v->shear[f->traction], a, da, o);
    Drag(c, velocity, a, da, dt, o);
  }
  Fluids(c, f, v, mat, p0, a, da, in, dt, o);
  if (c->fields.heat)
    Heat(c, f, v, s, ds, in, kappa, o);
  for (int phase = 0; f->inflow >= 0 && phase < PHASE_COUNT; phase++) {
    if (c->fields.phase[phase])
      Inflow(c, f, v, mat, phase, s, ds, in, dt, o);
  }
}

static bool OnPlane(const Grid *g, const Bc *b, const PetscInt ij[CL_DIM])
{
  const double x = g->lower[b->axis] + (double)ij[b->axis] * g->h[b->axis];

  return fabs(x - b->position) < 1e-6 * g->h[b->axis];
}

/* Does the node lie in the initial shape of the condition's region? */
static bool InRegion(const Case *c, const Grid *g, const Bc *b, const PetscInt ij[CL_DIM])
{
  const double slack[CL_DIM] = {1e-6 * g->h[0], 1e-6 * g->h[1]};
  const double x[CL_DIM]     = {g->lower[0] + (double)ij[0] * g->h[0], g->lower[1] + (double)ij[1] * g->h[1]};

  for (PetscInt k = 0; k < c->nregion; k++) {
    if ((b->region < 0 || b->region == k) && RegionReaches(c, k, x, slack))
      return true;
  }
  return false;
}

/* Prescribes the velocities along axis d: of the skeleton, and of the fluids unless they are free to cross. */
static void Hold(const FieldSet *fs, int d, double velocity, bool drained, unsigned *mask, double *value)
{
  static const int first[3] = {F_VSX, F_VWX, F_VGX};

  for (int i = 0; i < (drained ? 1 : 3); i++) {
    const int k = fs->at[first[i] + d];

    if (k < 0)
      continue;
    *mask |= 1u << k;
    value[k] = velocity;
  }
}

void PlaneConditions(const Case *c, const Grid *g, const BcValues *v, const PetscInt ij[CL_DIM], bool at_axis,
                     unsigned *mask, double *value)
{
  const FieldSet *fs = &c->fields;

  if (at_axis && g->lower[0] + (double)ij[0] * g->h[0] < 1e-6 * g->h[0])
    Hold(fs, 0, 0.0, false, mask, value); /* nothing crosses the axis */
  for (PetscInt k = 0; k < c->nbc; k++) {
    const Bc *b = &c->bc[k];

    if (b->type < BC_ROLLER || !(b->type == BC_REGION_TEMPERATURE ? InRegion(c, g, b, ij) : OnPlane(g, b, ij)))
      continue;
    if (b->type == BC_TEMPERATURE || b->type == BC_REGION_TEMPERATURE) {
      *mask |= 1u << PlaceT(fs);
      value[PlaceT(fs)] = v->value[k];
      continue;
    }
    for (int d = 0; d < CL_DIM; d++) {
      if (b->type == BC_FIXED || d == b->axis)
        Hold(fs, d, b->type == BC_PLATE_LINE ? v->value[k] : 0.0, b->drained, mask, value);
    }
  }
}
