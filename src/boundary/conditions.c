/* The table of conditions; what a face adds to its nodes; Dirichlet values of nodes. */
#include "terms.h"
#include "clathra/point_heat.h"
#include "clathra/shape.h"

#if CL_DIM == 2
const char *const cl_side[] = {"left", "right", "bottom", "top", "none", NULL};
#else
const char *const cl_side[] = {"left", "right", "bottom", "top", "back", "front", "none", NULL};
#endif

/* ---------------------------------------------------------------- faces */
/* An area vector goes with the motion: a = cof(F) n. */
static void Carry(const Kinematics *k, const double n[CL_DIM], double a[CL_DIM], double da[CL_DIM][MOTION_COUNT])
{
  for (int i = 0; i < CL_DIM; i++) {
    a[i] = VectorDot(k->cof[i], n);
    for (int q = 0; q < MOTION_COUNT; q++) {
      da[i][q] = k->dcof[i][0][q] * n[0];
      for (int j = 1; j < CL_DIM; j++)
        da[i][q] += k->dcof[i][j][q] * n[j];
    }
  }
}

/* Area over which fluxes per area act, of the true surface (70), and its slopes. */
static void Area(FaceState *x)
{
  x->area = VectorLength(x->s);
  for (int k = 0; k < MOTION_COUNT; k++)
    x->darea[k] = AlongSlope(x->s, x->ds, k) / x->area;
}

/* (364): of the temperature at the face, whichever way the fluids flow. */
static double CarriedOut(const FaceState *x, const double outflow[PHASE_COUNT])
{
  double sum = 0.0;

  for (int phase = 0; x->c->fields.heat && phase < PHASE_COUNT; phase++)
    sum += SpecificHeat(x->mat, phase) * outflow[phase];
  return sum * x->T;
}

bool FaceActs(const Scene *c, const Face *f)
{
  bool acts = c->ambient_drag > 0.0 && c->fields.solid;

  for (PetscInt k = 0; k < c->nmeter; k++)
    acts = acts || (f->meters >> k & 1);
  for (int kind = BC_NONE + 1; kind < BC_FACES; kind++)
    acts = acts || f->bc[kind] >= 0;
  return acts;
}

/* Sum of the sizes of all that has been added. */
static double Amount(const FaceOutput *o)
{
  double sum = fabs(o->heat_in);

  for (int q = 0; q < F_COUNT; q++)
    sum += fabs(o->out[q]);
  for (int phase = 0; phase < PHASE_COUNT; phase++)
    sum += fabs(o->outflow[phase]);
  return sum;
}

/* What the conditions on a face add, and the enthalpy of what they let out. */
static void Act(const FaceState *x, FaceOutput *o)
{
  for (int kind = BC_NONE + 1; kind < BC_FACES; kind++) {
    const PetscInt k = x->f->bc[kind];

    if (k >= 0 && cl_condition[kind].face && (x->c->fields.has & cl_condition[kind].has)) {
      const double before = Amount(o);

      cl_condition[kind].face(x, k, o);
      o->acts[kind] = Amount(o) != before;
    }
  }
  o->enthalpy = CarriedOut(x, o->outflow);
}

void FaceEvaluate(const FaceInput *g, FaceOutput *o)
{
  const Face   *f  = g->f;
  const double *in = g->in;
  FaceState     x  = {.c     = g->c,
                      .f     = f,
                      .v     = g->v,
                      .mat   = g->mat,
                      .p0    = g->p0,
                      .in    = in,
                      .Sh    = g->Sh,
                      .kappa = g->kappa,
                      .dt    = g->dt,
                      .T     = in[IN_T]};

  for (int d = 0; d < CL_DIM; d++) {
    x.T += in[IN_GT + d] * f->r[d];
    x.a[d] = f->n[d];
    x.s[d] = f->s[d];
  }
  *o = (FaceOutput){0};
  if (f->share > 0.0) {
    Act(&x, o);
    return;
  }
  if (VectorDot(f->n, f->n) == 0.0)
    return; /* on the axis */
  if (g->c->fields.solid) {
    Kinematics k;

    if (!KinematicsEvaluate(&in[IN_GRADU], &k))
      return; /* the particle itself reports it */
    Carry(&k, f->n, x.a, x.da);
    Carry(&k, f->s, x.s, x.ds);
    FaceDrag(&x, g->velocity, o);
  }
  Area(&x);
  Act(&x, o);
}

/* ---------------------------------------------------------------- nodes */
/* Of the node at x (m). */
static bool OnPlane(const Grid *g, const Bc *b, const double x[CL_DIM])
{
  return fabs(x[b->axis] - b->position) < 1e-6 * g->line[b->axis].h;
}

/* Does the node lie in the initial shape of the condition's region? */
static bool InRegion(const Scene *c, const Grid *g, const Bc *b, const double x[CL_DIM])
{
  double slack[CL_DIM];

  for (int d = 0; d < CL_DIM; d++)
    slack[d] = 1e-6 * g->line[d].h;
  for (PetscInt k = 0; k < c->nregion; k++) {
    if ((b->region < 0 || b->region == k) && RegionReaches(c, k, x, slack))
      return true;
  }
  return false;
}

/* Prescribes the velocities along axis d: of the skeleton, and of the fluids unless they are free to cross. */
static void Hold(const FieldSet *fs, int d, double velocity, bool drained, unsigned *mask, double *value)
{
  static const int first[3] = {F_VS, F_VW, F_VG};

  for (int i = 0; i < (drained ? 1 : 3); i++) {
    const int k = fs->at[first[i] + d];

    if (k < 0)
      continue;
    *mask |= 1u << k;
    value[k] = velocity;
  }
}

static void NodeRoller(const FieldSet *fs, const Bc *b, double at, unsigned *mask, double *value)
{
  Hold(fs, (int)b->axis, at, b->drained, mask, value);
}

static void NodeFixed(const FieldSet *fs, const Bc *b, double at, unsigned *mask, double *value)
{
  for (int d = 0; d < CL_DIM; d++)
    Hold(fs, d, at, b->drained, mask, value);
}

static void NodeTemperature(const FieldSet *fs, const Bc *b, double at, unsigned *mask, double *value)
{
  (void)b;
  *mask |= 1u << PlaceT(fs);
  value[PlaceT(fs)] = at;
}

bool NodePrescribed(const Scene *c, const Grid *g, const Bc *b, const double x[CL_DIM])
{
  const Condition *kind = &cl_condition[b->type];

  return kind->node && (kind->where == IN_REGION ? InRegion(c, g, b, x) : OnPlane(g, b, x));
}

void PlaneConditions(const Scene *c, const Grid *g, const BcValues *v, const PetscInt ij[CL_DIM], bool at_axis,
                     unsigned *mask, double *value)
{
  const FieldSet *fs = &c->fields;
  double          x[CL_DIM], gradient[CL_DIM];

  for (int d = 0; d < CL_DIM; d++)
    x[d] = GridNode(g, d, ij[d]);
  if (at_axis && x[0] < 1e-6 * g->line[0].h)
    Hold(fs, 0, 0.0, false, mask, value); /* nothing crosses the axis */
  for (PetscInt k = 0; k < c->nbc; k++) {
    const Bc *b = &c->bc[k];

    if (NodePrescribed(c, g, b, x))
      cl_condition[b->type].node(fs, b, BcValueAt(c, b, v->value[k], x, gradient), mask, value);
  }
}

/* ---------------------------------------------------------------- the table */
#define FACE(kind, word_, has_, by_, term, doc)                                                                        \
  [BC_##kind] = {.word = word_, .has = (has_), .where = ON_FACES, .face = term},
#define NODE(kind, word_, has_, by_, term, where_, doc)                                                                \
  [BC_##kind] = {.word = word_, .has = (has_), .where = where_, .node = term},
#define FORM(kind, word_, has_, by_, term, where_, form) NODE(kind, word_ " " form, has_, by_, term, where_, form)
const Condition cl_condition[BC_COUNT] = {CL_FACE_CONDITIONS(FACE) CL_NODE_CONDITIONS(NODE) CL_NODE_FORMS(FORM)};
