/* A well, a line along an axis or normal to the plane: which particles it draws from, how it draws so that the grid has
   Thiem's flow, and what it adds to the balances; docs/equations.md (366)-(370). */
#include "terms.h"
#include "clathra/point_flow.h"
#include "clathra/point_heat.h"
#include "clathra/point_state.h"
#include "clathra/shape.h"

#include <petscmat.h>

/* ---------------------------------------------------------------- its particles */
static double Tent(double t)
{
  return fmax(0.0, 1.0 - fabs(t));
}

/* Of place i along an axis: its middle, in cells. */
static double Middle(const Well *w, int d, double i)
{
  return w->first[d] + (i + 0.5) * w->width[d];
}

/* The first place that may be within a cell of the well. */
static double FirstPlace(const Well *w, int d)
{
  return floor((w->place[d] - 1.0 - w->first[d]) / w->width[d]) - 1.0;
}

/* Which way it goes, and what of that is open. */
static void TakeAxes(const Bc *b, Well *w)
{
  w->along = 2;
  for (int d = 0; d < CL_DIM; d++) {
    const double end = CL_DIM == 2 ? b->at[d] : b->end[d];

    w->at[d] = 0.5 * (b->at[d] + end);
    w->along = end != b->at[d] ? d : w->along;
  }
  w->across[0] = (w->along + 1) % 3;
  w->across[1] = (w->along + 2) % 3;
  w->lower = w->upper = 0.0;
#if CL_DIM == 3
  w->lower = fmin(b->at[w->along], b->end[w->along]);
  w->upper = fmax(b->at[w->along], b->end[w->along]);
#endif
}

/* Share of what is open that lies in a particle at x0 with half-lengths l. */
static double Open(const Well *w, const double x0[CL_DIM], const double l[CL_DIM])
{
  if (CL_DIM == 2)
    return 1.0;
  const double lower = fmax(w->lower, x0[w->along] - l[w->along]), upper = fmin(w->upper, x0[w->along] + l[w->along]);

  return fmax(0.0, upper - lower) / (w->upper - w->lower);
}

bool WellPlace(const Scene *c, const Bc *b, Well *w)
{
  Lattice lattice;

  TakeAxes(b, w);
  const PetscInt region = RegionAt(c, w->at);
  if (region < 0)
    return false;
  RegionLattice(c, region, &lattice);
  for (int d = 0; d < 2; d++) {
    const int        axis = w->across[d];
    const GridLines *line = &lattice.line[axis];

    w->line[d]  = *line;
    w->place[d] = LinesPlace(line, w->at[axis]);
    w->first[d] = line->x ? 0.0 : LinesPlace(line, lattice.from[axis]);
    w->width[d] = line->x ? lattice.spacing[axis] : lattice.spacing[axis] / line->h;
    w->sum[d]   = 0.0;
    for (double i = FirstPlace(w, d); Middle(w, d, i) < w->place[d] + 1.0; i++)
      w->sum[d] += w->width[d] * Tent(Middle(w, d, i) - w->place[d]);
  }
  return true;
}

double WellShare(const Well *w, const double x0[CL_DIM], const double l[CL_DIM])
{
  double share = Open(w, x0, l);

  for (int d = 0; d < 2; d++) {
    const int    axis = w->across[d];
    const double lo = LinesPlace(&w->line[d], x0[axis] - l[axis]), hi = LinesPlace(&w->line[d], x0[axis] + l[axis]);

    share *= (hi - lo) * Tent(0.5 * (lo + hi) - w->place[d]) / w->sum[d]; /* omega (366) */
  }
  return share;
}

/* ---------------------------------------------------------------- the discrete flow about it */
#define CELLS 9                  /* on each side of the well's own */
#define LINES (2 * CELLS + 2)    /* nodes along an axis */
#define RIM 2                    /* of them at each end hold the logarithm */
#define INSIDE (LINES - 2 * RIM) /* unknown */
#define SIZE (INSIDE * INSIDE)

/* Sums of one axis: V G G, V S S, V G S over its places, and the well's weights omega S. */
typedef struct {
  GridLines line; /* the nodes */
  double    place[LINES + 2 * LINES_PAD];
  PetscInt  guess;
  double    GG[LINES][LINES], SS[LINES][LINES], GS[LINES][LINES];
  int       n; /* places of the well */
  double    omega[LINES * 8], S[LINES * 8][LINES];
} Column;

#define PLACES ((int)(sizeof(((Column *)0)->omega) / sizeof(double)))

/* The nodes about the well, as far apart as the last known ones beyond the grid's ends. */
static void TakeNodes(const Well *w, int d, Column *k)
{
  const GridLines *line  = &w->line[d];
  const PetscInt   first = (PetscInt)floor(w->place[d]) - CELLS;

  k->line = (GridLines){.lower = LinesFrom(line, 0.0) + (double)first * line->h, .cells = LINES - 1, .h = line->h};
  if (line->x) {
    double x = LinesAt(line, PetscMax(first, 0)) - PetscMax(-first, 0) * LinesWidth(line, 0);

    k->line.nguess = 1;
    k->line.guess  = &k->guess;
    k->guess       = 0;
    k->line.x      = k->place + LINES_PAD;
    for (PetscInt i = 0; i <= LINES + LINES_PAD - 1; i++) {
      k->line.x[i] = x;
      x += LinesWidth(line, PetscMin(PetscMax(first + i, 0), line->cells - 1));
    }
    for (PetscInt i = 1; i <= LINES_PAD; i++)
      k->line.x[-i] = k->line.x[0] - (double)i * (k->line.x[1] - k->line.x[0]);
    k->line.lower = k->line.x[0];
  }
  k->line.upper = LinesAt(&k->line, LINES - 1);
}

static void AddPlace(BasisType basis, Column *k, double lo, double hi, double weight)
{
  const double a = LinesFrom(&k->line, lo), b = LinesFrom(&k->line, hi);
  Axis         s;

  BasisAxis(basis, 0.5 * (a + b), 0.5 * (b - a), &k->line, &s);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const PetscInt m = s.base + i, n = s.base + j;

      if (m < 0 || n < 0 || m >= LINES || n >= LINES)
        continue;
      k->GG[m][n] += (b - a) * s.dS[i] * s.dS[j];
      k->SS[m][n] += (b - a) * s.S[i] * s.S[j];
      k->GS[m][n] += (b - a) * s.dS[i] * s.S[j];
    }
  }
  if (weight <= 0.0 || k->n == PLACES)
    return;
  k->omega[k->n] = weight;
  for (int i = 0; i < 3; i++) {
    if (s.base + i >= 0 && s.base + i < LINES)
      k->S[k->n][s.base + i] += s.S[i];
  }
  k->n++;
}

/* Fills the nodes' cells with particles like the well's own. */
static void FillColumn(const Scene *c, const Well *w, int d, Column *k)
{
  const double first = floor(w->place[d]) - CELLS, s = w->width[d];

  TakeNodes(w, d, k);
  for (double i = ceil((first - w->first[d]) / s - BASIS_SNAP);
       Middle(w, d, i) + 0.5 * s < first + LINES - 1 + BASIS_SNAP; i++) {
    const double middle = Middle(w, d, i), weight = s * Tent(middle - w->place[d]) / w->sum[d];

    AddPlace(c->basis, k, middle - 0.5 * s - first, middle + 0.5 * s - first, weight);
  }
}

typedef struct {
  double A[3];                      /* (306) across the well: its axes, then both */
  double root, radius, skin, at[2]; /* sqrt(r); r_w'; s; the well, m */
  Column column[2];
  Mat    K, W;          /* without the well; sums of sqrt(r) omega S S over the well's particles */
  Vec    load, draw, P; /* without the well; sums of sqrt(r) omega S; the solution */
} Flow;

/* (368): P at a node, per flow of one. */
static double Thiem(const Flow *f, int i, int j)
{
  const double x = LinesAt(&f->column[0].line, i) - f->at[0], y = LinesAt(&f->column[1].line, j) - f->at[1];
  const double rho2 = (f->A[1] * x * x - 2.0 * f->A[2] * x * y + f->A[0] * y * y) / f->root; /* det A = r */

  return (0.5 * log(rho2) - log(f->radius) + f->skin) / (2.0 * M_PI * f->root);
}

static bool Unknown(int i, int j)
{
  return i >= RIM && j >= RIM && i < LINES - RIM && j < LINES - RIM;
}

static int Number(int i, int j)
{
  return (j - RIM) * INSIDE + i - RIM;
}

static double Entry(const Flow *f, int i, int j, int k, int l)
{
  const Column *x = &f->column[0], *y = &f->column[1];

  return f->A[0] * x->GG[i][k] * y->SS[j][l] + f->A[1] * x->SS[i][k] * y->GG[j][l] +
         f->A[2] * (x->GS[i][k] * y->GS[l][j] + x->GS[k][i] * y->GS[j][l]);
}

static PetscErrorCode Assemble(Flow *f)
{
  PetscFunctionBeginUser;
  for (int j = RIM; j < LINES - RIM; j++) {
    for (int i = RIM; i < LINES - RIM; i++) {
      for (int l = j - 2; l <= j + 2; l++) {
        for (int k = i - 2; k <= i + 2; k++) {
          const double a = Entry(f, i, j, k, l);

          if (Unknown(k, l))
            PetscCall(MatSetValue(f->K, Number(i, j), Number(k, l), a, ADD_VALUES));
          else
            PetscCall(VecSetValue(f->load, Number(i, j), -a * Thiem(f, k, l), ADD_VALUES));
        }
      }
    }
  }
  PetscCall(MatAssemblyBegin(f->K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(f->K, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AssembleWell(Flow *f)
{
  const Column *x = &f->column[0], *y = &f->column[1];

  PetscFunctionBeginUser;
  for (int b = 0; b < y->n; b++) {
    for (int a = 0; a < x->n; a++) {
      const double draws          = f->root * x->omega[a] * y->omega[b];
      PetscInt     node[CL_NODES] = {0}, n = 0;
      double       S[CL_NODES] = {0.0}, SS[CL_NODES * CL_NODES];

      for (int j = RIM; j < LINES - RIM; j++) {
        for (int i = RIM; i < LINES - RIM && y->S[b][j] != 0.0; i++) {
          if (x->S[a][i] != 0.0 && n < CL_NODES) {
            node[n] = Number(i, j);
            S[n++]  = x->S[a][i] * y->S[b][j];
          }
        }
      }
      for (PetscInt k = 0; k < n; k++) {
        PetscCall(VecSetValue(f->draw, node[k], draws * S[k], ADD_VALUES));
        for (PetscInt l = 0; l < n; l++)
          SS[k * n + l] = draws * S[k] * S[l];
      }
      PetscCall(MatSetValues(f->W, n, node, n, node, SS, ADD_VALUES));
    }
  }
  PetscCall(MatAssemblyBegin(f->W, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(f->W, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is left of 1/Q - 1 with 1/C. */
static PetscErrorCode Miss(Flow *f, double inverse, double *miss)
{
  Mat    L;
  double flow;

  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(f->K, MAT_COPY_VALUES, &L));
  PetscCall(MatAXPY(L, 1.0 / inverse, f->W, SAME_NONZERO_PATTERN));
  PetscCall(MatSetOption(L, MAT_SPD, PETSC_TRUE));
  PetscCall(MatCholeskyFactor(L, NULL, NULL));
  PetscCall(MatSolve(L, f->load, f->P));
  PetscCall(VecDot(f->draw, f->P, &flow));
  PetscCall(MatDestroy(&L));
  *miss = inverse / flow - 1.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define LEAST 1e-3 /* of 1/C */
#define SECANTS 30

/* (369): 1/Q is all but linear in 1/C. */
static PetscErrorCode Index(Flow *f, double *C)
{
  double a = LEAST, b = 0.1, at_a, at_b;

  PetscFunctionBeginUser;
  *C = 0.0;
  PetscCall(Miss(f, a, &at_a));
  PetscCall(Miss(f, b, &at_b));
  if (!(at_a < 0.0 && at_a > -1.0)) /* the cells alone resist more than the well may, or it sucks against its skin */
    PetscFunctionReturn(PETSC_SUCCESS);
  for (int n = 0; n < SECANTS && fabs(at_b) > 1e-12; n++) {
    const double next = fmax(b - at_b * (b - a) / (at_b - at_a), LEAST);

    a    = b;
    at_a = at_b;
    b    = next;
    PetscCall(Miss(f, b, &at_b));
  }
  *C = 1.0 / b;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (306) of a material across the well, as it lies at the start; returns det A. */
static double Across(const Well *w, const Permeability *law, double A[3])
{
  static const double one[CL_DIM][CL_DIM] = CL_IDENTITY;
  const Beds          beds                = BedsOf(law->ratio, law->dip * M_PI / 180.0, one);
  const int           i = w->across[0], j = w->across[1];

  A[0] = beds.A[cl_symmetric[i][i]];
  A[1] = beds.A[cl_symmetric[j][j]];
  A[2] = beds.A[cl_symmetric[i][j]];
  return A[0] * A[1] - A[2] * A[2];
}

double WellRatio(const Well *w, const Permeability *law)
{
  double A[3];

  return Across(w, law, A);
}

static PetscErrorCode FlowCreate(const Scene *c, const Bc *b, const Well *w, Flow *f)
{
  const PetscInt region = RegionAt(c, w->at); /* WellPlace has found one */

  PetscFunctionBeginUser;
  const double ratio  = Across(w, &c->material[c->region[region].material].permeability, f->A);
  const double fourth = pow(ratio, 0.25);
  f->root             = sqrt(ratio);
  f->radius           = 0.5 * b->radius * (fourth + 1.0 / fourth);
  f->skin             = b->skin;
  for (int d = 0; d < 2; d++) {
    f->at[d] = w->at[w->across[d]];
    FillColumn(c, w, d, &f->column[d]);
  }
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, SIZE, SIZE, NULL, &f->K));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, SIZE, SIZE, NULL, &f->W));
  PetscCall(MatCreateVecs(f->K, &f->load, &f->P));
  PetscCall(VecDuplicate(f->load, &f->draw));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FlowDestroy(Flow **f)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&(*f)->K));
  PetscCall(MatDestroy(&(*f)->W));
  PetscCall(VecDestroy(&(*f)->load));
  PetscCall(VecDestroy(&(*f)->draw));
  PetscCall(VecDestroy(&(*f)->P));
  PetscCall(PetscFree(*f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WellIndex(const Scene *c, const Bc *b, const Well *w, double *C)
{
  Flow *f;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, &f));
  PetscCall(FlowCreate(c, b, w, f));
  PetscCall(Assemble(f));
  PetscCall(AssembleWell(f));
  PetscCall(Index(f, C));
  PetscCall(FlowDestroy(&f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- what a particle of it yields */
void WellProperties(const PointProperties *q, Face *f)
{
  for (int k = 0; k < PHASE_COUNT; k++) {
    f->conducts[k] = q->resist[k] > 0.0 ? 1.0 / q->resist[k] : 0.0;
    f->kr[k]       = q->kr[k];
  }
}

/* A number with its slopes in p_w, p_g and T. */
typedef struct {
  double v, d[PHASE_COUNT + 1];
} Rate;

/* k_r of a fluid, at the particle's capillary pressure where it has one. */
static Rate Mobile(const FaceState *x, int phase)
{
  const Material *mat = x->mat;
  double          ds, dSh, slope;

  if (!(x->c->fields.has & HAS_GAS))
    return (Rate){.v = x->f->kr[phase]};
  const double pc      = x->in[IN_P + PHASE_G] - x->in[IN_P + PHASE_W],
               sg      = RetentionGasShare(&mat->retention, pc, x->Sh, &ds, &dSh);
  const bool       gas = phase == PHASE_G;
  const KrArgument at  = KrArgumentOf(mat->relperm.of_pores, gas ? sg : 1.0 - sg, x->Sh);
  const double     kr  = gas ? RelPermGas(&mat->relperm, at.v, &slope) : RelPermWater(&mat->relperm, at.v, &slope);
  const double     dpc = slope * at.share * (gas ? ds : -ds);

  return (Rate){kr, {-dpc, dpc, 0.0}};
}

/* p - p^ of (367) for a fluid. */
static Rate Head(const FaceState *x, PetscInt k, int phase)
{
  const double *p = &x->in[IN_P];
  Rate          r = {.d = {0.0}};
  double        ds, dSh;

  if (!(x->c->fields.has & HAS_GAS)) {
    r.v        = p[phase] - x->v->value[k];
    r.d[phase] = 1.0;
    return r;
  }
  const double       pc = p[PHASE_G] - p[PHASE_W], sg = RetentionGasShare(&x->mat->retention, pc, x->Sh, &ds, &dSh);
  const PorePressure mean = PorePressureOf(sg, p[PHASE_W], p[PHASE_G]);

  return (Rate){mean.v - x->v->value[k], {mean.pw - mean.sg * ds, mean.pg + mean.sg * ds, 0.0}};
}

/* Volume that leaves, m^3/s. */
static Rate Volume(const FaceState *x, int phase, const Rate *head)
{
  const Rate   kr = Mobile(x, phase);
  const double G  = x->f->draws * x->f->conducts[phase];
  Rate         q  = {.v = G * kr.v * head->v};

  for (int j = 0; j < PHASE_COUNT; j++)
    q.d[j] = G * (kr.d[j] * head->v + kr.v * head->d[j]);
  return q;
}

/* (367): mass of a fluid that leaves, kg/s. */
static Rate Mass(const FaceState *x, int phase, const Rate *head, const Rate *q)
{
  const bool   enters = head->v < 0.0;
  const double H      = enters || phase == PHASE_W ? 0.0 : x->mat->gas.trace;
  const int    sets   = GasFlowsByWater(H, x->in[IN_P], x->in[IN_P + PHASE_G]) ? PHASE_W : phase;
  const double part   = sets == phase ? 1.0 : CL_GAS_FLOWS; /* of a thin gas (323) */
  double       dp, dT;
  const double rho =
      FluidDensity(x->mat, phase, part * x->in[IN_P + sets] - (enters ? head->v : 0.0), x->in[IN_T], &dp, &dT);
  Rate m = {rho * q->v, {0.0, 0.0, dT * q->v}};

  for (int j = 0; j < PHASE_COUNT; j++)
    m.d[j] = rho * q->d[j] + dp * ((j == sets ? part : 0.0) - (enters ? head->d[j] : 0.0)) * q->v;
  return m;
}

/* A mass that leaves, to the balance of a fluid. */
static void Leave(const FaceState *x, int phase, const Rate *m, FaceOutput *o)
{
  o->out[F_PW + phase] += x->dt * m->v;
  o->outflow[phase] += m->v;
  for (int j = 0; j <= PHASE_COUNT; j++)
    o->D[F_PW + phase][j < PHASE_COUNT ? IN_P + j : IN_T] += x->dt * m->d[j];
}

/* (370): heat of what enters with a temperature of its own. */
static void Warm(const FaceState *x, PetscInt k, int phase, const Rate *m, FaceOutput *o)
{
  const double c_f = SpecificHeat(x->mat, phase), dT_in = x->v->shear[k] - x->T;

  if (!x->c->fields.heat || !x->c->bc[k].heated.n || m->v >= 0.0)
    return;
  o->heat_in -= c_f * m->v * dT_in;
  o->out[F_T] += c_f * m->v * dT_in;
  for (int j = 0; j <= PHASE_COUNT; j++)
    o->D[F_T][j < PHASE_COUNT ? IN_P + j : IN_T] += c_f * m->d[j] * dT_in;
  o->D[F_T][IN_T] -= c_f * m->v;
}

/* (352): the methane of the water that flows. */
static Rate Dissolved(const FaceState *x, const Rate *q)
{
  const double H = x->mat->gas.carried, c = DissolvedMethane(H, x->in[IN_P + PHASE_G]);
  Rate         m = {.v = c * q->v};

  for (int j = 0; j < PHASE_COUNT; j++)
    m.d[j] = c * q->d[j] + (j == PHASE_G ? H * q->v : 0.0);
  return m;
}

void FaceWell(const FaceState *x, PetscInt k, FaceOutput *o)
{
  const bool held = x->c->bc[k].value.n > 0;

  for (int phase = 0; phase < PHASE_COUNT; phase++) {
    if (!x->c->fields.phase[phase])
      continue;
    const Rate head = Head(x, k, phase), q = Volume(x, phase, &head);
    const Rate m = held ? Mass(x, phase, &head, &q) : (Rate){.v = -x->f->share * x->v->phase[phase][k]};

    Leave(x, phase, &m, o);
    Warm(x, k, phase, &m, o);
    if (held && phase == PHASE_W && (x->c->fields.has & HAS_GAS)) {
      const Rate methane = Dissolved(x, &q);

      Leave(x, PHASE_G, &methane, o);
    }
  }
}
