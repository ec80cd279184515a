/* Tangents of particles: only slopes that can differ from zero are kept, and products run over several particles at a
   time. */
#include "tangents.h"
#include <stddef.h>

typedef float Floats __attribute__((vector_size(LANES * sizeof(float)), may_alias, aligned(sizeof(float))));

static bool InPhase(int k, int first, int phase)
{
  return k >= VectorAt(first, phase, 0) && k < VectorAt(first, phase + 1, 0);
}

static bool Carries(const Scene *c)
{
  for (PetscInt k = 0; k < c->nmaterial; k++) {
    if (c->material[k].gas.carried > 0.0)
      return true;
  }
  return false;
}

/* Does the flux of a phase go with what drives another: itself, or gas with the water (352)? */
static bool Follows(const Scene *c, int phase, int other)
{
  return other == phase || (other == PHASE_W && Carries(c));
}

/* Phase of an output of one fluid; -1: of none. */
static int PhaseOf(int out)
{
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (InPhase(out, OUT_FLUX, f) || InPhase(out, OUT_G, f) || out == OUT_M + 1 + f || out == OUT_MI + f ||
        out == OUT_D + f || out == OUT_ROOT + f || out == OUT_DM + f)
      return f;
  }
  return -1;
}

static bool IsScalar(int out)
{
  return out >= OUT_M && out <= OUT_C;
}

/* Do the scene's rows read it? */
static bool Reads(const Model *m, int out)
{
  const FieldSet *fs    = &m->c->fields;
  const int       phase = PhaseOf(out);

  if (phase >= 0)
    return fs->phase[phase] && (out != OUT_ROOT + phase || m->fluid) && (out != OUT_M + 1 + phase || fs->solid);
  if (out >= OUT_A)
    return m->bc.ambient.on && fs->solid;
  if (out == OUT_HOOP)
    return SceneStrainsAcross(m->c) && fs->solid;
  if (out == OUT_C || out == OUT_Q || (out >= OUT_HEAT && out < OUT_HEAT + CL_DIM))
    return fs->heat;
  return fs->solid; /* OUT_P, OUT_M */
}

/* Can the slope of an output with an input differ from zero? */
static bool Depends(const Model *m, int out, int in)
{
  const FieldSet *fs    = &m->c->fields;
  const int       phase = PhaseOf(out), other = in < IN_J ? (in - IN_GP) / CL_DIM : (in - IN_J) / CL_DIM;
  const bool      flux = out >= OUT_FLUX && out < OUT_HEAT, force = out >= OUT_G && out < OUT_M;

  if (in < IN_P)
    return fs->solid && !IsScalar(out) && (in < IN_HOOP || SceneStrainsAcross(m->c));
  if (in == IN_VOLUME)
    return fs->solid && IsScalar(out);
  if (in >= IN_PROJ) {
    const int of = (in - IN_PROJ) / CL_DIM;

    return fs->phase[of] && (out == OUT_Q || (flux && Follows(m->c, phase, of)));
  }
  if (in < IN_T)
    return fs->phase[in - IN_P] && !force;
  if (in == IN_T)
    return fs->heat && !force;
  if (in < IN_GT)
    return fs->phase[other] &&
           (out == OUT_Q || (force && other == phase) || (flux && (Follows(m->c, phase, other) || m->added->spread)));
  if (in < IN_J)
    return fs->heat && (out == OUT_Q || (out >= OUT_HEAT && out < OUT_HEAT + CL_DIM));
  if (in < IN_U)
    return fs->phase[other] && (out == OUT_Q || (flux && Follows(m->c, phase, other)));
  return fs->solid && m->bc.ambient.on && (out < OUT_FLUX || out == OUT_HOOP);
}

/* Storage keeps all digits: its slopes with both pressures nearly cancel where these rise together.  Then the rest,
   last the rows (16) of the fluids. */
static int Kind(int out)
{
  if (out >= OUT_DM && out < OUT_C)
    return 0;
  return (out >= OUT_G && out < OUT_M) || (out >= OUT_MI && out < OUT_DM) ? 2 : 1;
}

static int PlaceOf(int out, int in)
{
  const size_t row = (size_t)out, k = (size_t)in, of = k - IN_PROJ;
  size_t       at;

  if (in < IN_PROJ || in == IN_VOLUME)
    at = offsetof(PointOutput, D[0][0]) / sizeof(double) + row * IN_COUNT + (in == IN_VOLUME ? (size_t)IN_GRADU : k);
  else if (out == OUT_Q)
    at = offsetof(PointOutput, wide_q[0][0]) / sizeof(double) + of;
  else
    at = offsetof(PointOutput, wide[(row - OUT_FLUX) / CL_DIM][of / CL_DIM][(row - OUT_FLUX) % CL_DIM][of % CL_DIM]) /
         sizeof(double);
  return (int)at;
}

static void Pattern(const Model *m, Tangents *t)
{
  int n = 0;

  t->rows = t->volumes = 0;
  for (int kind = 0; kind < 3; kind++) {
    if (kind > 0)
      *(kind == 1 ? &t->storage : &t->momentum) = t->rows;
    for (int out = 0; out < OUT_COUNT; out++) {
      if (Kind(out) != kind || !Reads(m, out))
        continue;
      t->first[t->rows] = n;
      t->row[t->rows++] = out;
      for (int in = 0; in < IN_ALL; in++) {
        if (!Depends(m, out, in))
          continue;
        if (in == IN_VOLUME)
          t->volume[t->volumes++] = n;
        t->at[n]   = PlaceOf(out, in);
        t->in[n++] = in;
      }
    }
  }
  t->first[t->rows] = n;
  t->width          = n - t->first[t->storage];
  t->store          = t->first[t->storage] + MOTION_COUNT;
}

PetscErrorCode TangentsBegin(const Model *m, Tangents *t)
{
  const int      was    = t->width;
  const PetscInt groups = (m->P.n + LANES - 1) / LANES;

  PetscFunctionBeginUser;
  Pattern(m, t); /* a stage may bring another ambient pressure */
  if (groups <= t->cap && t->width <= was)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2(t->value, t->stored));
  t->cap = groups;
  /* zeros: the last group may have fewer particles */
  PetscCall(PetscCalloc2((size_t)t->cap * (size_t)t->width * LANES, &t->value,
                         (size_t)t->cap * (size_t)t->store * LANES, &t->stored));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TangentsEnd(Tangents *t)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(t->value, t->stored));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static float *Values(const Tangents *t, PetscInt group)
{
  return &t->value[(size_t)group * (size_t)t->width * LANES];
}

static double *Stored(const Tangents *t, PetscInt group)
{
  return &t->stored[(size_t)group * (size_t)t->store * LANES];
}

/* The number of the motion that changes the volume most. */
static int MostVolume(const double dJ[MOTION_COUNT])
{
  int q = 0;

  for (int k = 1; k < MOTION_COUNT; k++)
    q = fabs(dJ[k]) > fabs(dJ[q]) ? k : q;
  return q;
}

void TangentsKeep(Tangents *t, PetscInt q, const PointOutput *o)
{
  const int     motion = MostVolume(o->dJ);
  const double *from   = (const double *)o;
  const int     n = t->first[t->storage], all = t->first[t->rows];
  float        *v = Values(t, q / LANES) + q % LANES;
  double       *d = Stored(t, q / LANES) + q % LANES;

  for (int j = 0; j < n; j++)
    d[j * LANES] = from[t->at[j]];
  for (int j = n; j < all; j++)
    v[(j - n) * LANES] = (float)from[t->at[j]];
  for (int k = 0; k < t->volumes; k++) {
    const int    j     = t->volume[k];
    const double slope = from[t->at[j] + motion] / o->dJ[motion];

    if (j < n)
      d[j * LANES] = slope;
    else
      v[(j - n) * LANES] = (float)slope;
  }
  for (int k = 0; k < MOTION_COUNT; k++)
    d[(n + k) * LANES] = o->dJ[k];
}

void TangentsApply(const Tangents *t, PetscInt group, bool momentum, Lanes in[IN_ALL], Lanes out[OUT_COUNT])
{
  const int     n = t->first[t->storage];
  const Floats *v = (const Floats *)Values(t, group) - n;
  const Lanes  *d = (const Lanes *)Stored(t, group), none = {0.0};

  in[IN_VOLUME] = none;
  for (int k = 0; k < MOTION_COUNT; k++)
    in[IN_VOLUME] += d[n + k] * in[IN_GRADU + k];
  for (int k = 0; k < t->storage && !momentum; k++) {
    Lanes sum = none;

    for (int j = t->first[k]; j < t->first[k + 1]; j++)
      sum += d[j] * in[t->in[j]];
    out[t->row[k]] = sum;
  }
  for (int k = momentum ? t->momentum : t->storage; k < t->rows; k++) {
    Lanes sum = none;

    for (int j = t->first[k]; j < t->first[k + 1]; j++)
      sum += __builtin_convertvector(v[j], Lanes) * in[t->in[j]];
    out[t->row[k]] = sum;
  }
}
