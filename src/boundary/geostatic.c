/* Stress from the weight above, in balance with gravity to round-off where layers lie across an axis;
   docs/equations.md, section 13. */
#include "clathra/boundary.h"
#include "clathra/tensor.h"
#include <stdlib.h>

#define SINGULAR 1e-9 /* pivot over diagonal: a cell whose particles are ruled by its neighbour */

enum { ACROSS = CL_DIM - 1 }; /* axes across the vertical one */

/* One site of the body; its weights along the vertical axis, per unit of area across it. */
typedef struct {
  Site     site;
  double   at[ACROSS], half[ACROSS]; /* its place and half-lengths across, m */
  double   height;                   /* m */
  double   weight[CL_DIM];           /* of itself along each axis, Pa; positive: compresses, shears as (83) */
  double   load;                     /* of what acts on its top face, Pa */
  double   p, ambient;               /* mean pore pressure, ambient pressure, Pa */
  double   S[3], force[3];           /* nodes base ... base + 2: shares of the weight, forces of a unit of stress */
  double   N[3];                     /* ... of the load */
  PetscInt base, hat;
  double   total[CL_DIM]; /* stress of the mixture beyond the ambient, across the vertical axis, Pa */
} Cell;

typedef struct {
  int      vertical, up;             /* axis; +1 where gravity points down along it, else -1 */
  double   from[ACROSS], to[ACROSS]; /* m, across: where this rank has particles */
  PetscInt n, cap;
  Cell    *cell, **order; /* in the order of numbers; by stripes: across, region, from the top down */
} Sites;

/* Nodal sums of one column, along the vertical axis. */
typedef struct {
  PetscInt n, nodes;
  Cell   **cell;                    /* from the top down */
  double  *row, *diag, *off, *load; /* [nodes] */
  bool    *seen;                    /* [regions] */
} Column;

/* The k-th axis across the vertical one. */
static int AcrossAxis(int vertical, int k)
{
  return k < vertical ? k : k + 1;
}

static PetscErrorCode FillCell(const Scene *c, const Grid *g, const Site *site, Sites *s, Cell *a)
{
  const Region  *r = &c->region[site->region];
  const int      v = s->vertical, side = 2 * v + (s->up > 0);
  const double   l = site->l[v];
  InitialScalars q;
  Axis           axis, hat;
  const Ambient  around = AmbientOf(c, 0.0, c->gravity);
  double         gradient[CL_DIM];

  PetscFunctionBeginUser;
  PetscCall(InitialScalarsAt(c, r, site->x, &q));
  BasisAxis(c->basis, site->x[v], l, &g->line[v], &axis);
  BasisHat(site->x[v] + s->up * l, &g->line[v], &hat);
  *a         = (Cell){.site = *site, .height = s->up * site->x[v], .p = q.p, .base = axis.base, .hat = hat.base};
  a->ambient = AmbientPressure(&around, site->x, gradient);
  for (int d = 0; d < CL_DIM; d++)
    a->weight[d] = -s->up * 2.0 * l * (q.density * c->gravity[d] - (d == v ? gradient[d] : q.grad_p[d]));
  if ((site->faces >> side) & 1)
    a->load = FaceLoad(c, (Side)side, site->region, site->x, 0.0);
  for (int k = 0; k < ACROSS; k++) {
    a->at[k]   = site->x[AcrossAxis(v, k)];
    a->half[k] = site->l[AcrossAxis(v, k)];
  }
  for (int k = 0; k < 3; k++) {
    a->S[k]     = axis.S[k];
    a->force[k] = 2.0 * l * axis.dS[k];
    a->N[k]     = hat.S[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Collect(const Scene *c, const Grid *g, const Site *site, void *sites)
{
  Sites *s = (Sites *)sites;

  PetscFunctionBeginUser;
  for (int k = 0; k < ACROSS; k++) {
    const double x = site->x[AcrossAxis(s->vertical, k)], l = site->l[AcrossAxis(s->vertical, k)];

    if (x + l < s->from[k] || x - l > s->to[k])
      PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (s->n == s->cap) {
    s->cap = 2 * s->cap + 64;
    PetscCall(PetscRealloc((size_t)s->cap * sizeof(*s->cell), &s->cell));
  }
  PetscCall(FillCell(c, g, site, s, &s->cell[s->n++]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int Order(double a, double b)
{
  return (a > b) - (a < b);
}

/* By their place across: 0 on one line along the vertical axis. */
static int Beside(const Cell *a, const Cell *b)
{
  int order = 0;

  for (int k = 0; k < ACROSS && !order; k++)
    order = Order(a->at[k], b->at[k]);
  return order;
}

static int FromTop(const void *a, const void *b)
{
  return Order((*(Cell *const *)b)->height, (*(Cell *const *)a)->height);
}

static int ByStripe(const void *p, const void *q)
{
  const Cell *a = *(Cell *const *)p, *b = *(Cell *const *)q;
  const int   x = Beside(a, b), region = (int)(a->site.region - b->site.region);

  return x ? x : region ? region : FromTop(p, q);
}

/* End of the stripe that begins at `first`. */
static PetscInt StripeEnd(const Sites *s, PetscInt first)
{
  const Cell *a   = s->order[first];
  PetscInt    end = first + 1;

  while (end < s->n && s->order[end]->site.region == a->site.region && !Beside(s->order[end], a))
    end++;
  return end;
}

/* Does the stripe of `a` hold what lies over and under `x`? */
static bool Holds(const Cell *a, const Cell *x)
{
  bool holds = true;

  for (int k = 0; k < ACROSS; k++)
    holds = holds && fabs(x->at[k] - a->at[k]) <= a->half[k] * (1.0 + 1e-9);
  return holds;
}

/* Everything above and below a cell: of each region the stripe that holds it. */
static void Gather(const Scene *c, const Sites *s, const Cell *x, Column *col)
{
  col->n = 0;
  for (PetscInt r = 0; r < c->nregion; r++)
    col->seen[r] = false;
  for (PetscInt first = 0, end; first < s->n; first = end) {
    const Cell *a = s->order[first];

    end = StripeEnd(s, first);
    if (col->seen[a->site.region] || !Holds(a, x))
      continue;
    col->seen[a->site.region] = true;
    for (PetscInt k = first; k < end; k++)
      col->cell[col->n++] = s->order[k];
  }
  qsort(col->cell, (size_t)col->n, sizeof(*col->cell), FromTop);
}

/* What a unit of stress in the particle is in the grid's cells base and base + 1: the force on all nodes above. */
static void Shares(const Cell *a, int up, double b[2])
{
  b[0] = up > 0 ? a->force[1] + a->force[2] : a->force[0];
  b[1] = up > 0 ? a->force[2] : a->force[0] + a->force[1];
}

/* (83) of the stress along axis d: by particles, each with the weight above its centre; then the rows of (84) for what
   the grid misses of it. */
static void FirstGuess(const Sites *s, int d, Column *col)
{
  double above = 0.0;

  for (PetscInt J = 0; J < col->nodes; J++)
    col->row[J] = col->diag[J] = col->off[J] = col->load[J] = 0.0;
  for (PetscInt k = 0; k < col->n; k++) {
    Cell        *a    = col->cell[k];
    const double load = d == s->vertical ? a->load : 0.0;
    double       b[2];

    a->total[d] = -(above + load + 0.5 * a->weight[d]);
    above += load + a->weight[d];
    Shares(a, s->up, b);
    for (int i = 0; i < 3; i++) {
      col->load[a->base + i] -= s->up * a->weight[d] * a->S[i];
      col->load[a->hat + i] -= s->up * load * a->N[i];
    }
    for (int i = 0; i < 2; i++) {
      col->row[a->base + i] -= b[i] * a->total[d];
      col->diag[a->base + i] += b[i] * b[i];
    }
    col->off[a->base] += b[0] * b[1];
  }
}

/* Forces on the nodes above each cell: sums of `load` from the top. */
static void AddLoads(const Sites *s, Column *col)
{
  double above = 0.0;

  for (PetscInt k = 0; k + 1 < col->nodes; k++) {
    const PetscInt cell = s->up > 0 ? col->nodes - 2 - k : k;

    above += col->load[s->up > 0 ? cell + 1 : cell];
    col->row[cell] += above;
  }
}

/* Smallest change of the particles' stresses that puts every cell in balance (84): tridiagonal normal equations. */
static void Balance(const Sites *s, int d, Column *col)
{
  const PetscInt n = col->nodes;

  for (PetscInt c = 0; c < n; c++) {
    const double own = col->diag[c], before = c ? col->off[c - 1] : 0.0;

    if (c && col->diag[c - 1] > 0.0) {
      col->diag[c] -= before * before / col->diag[c - 1];
      col->row[c] -= before / col->diag[c - 1] * col->row[c - 1];
    }
    if (col->diag[c] <= SINGULAR * own)
      col->diag[c] = 0.0;
  }
  for (PetscInt c = n - 1; c >= 0; c--) {
    const double after = c + 1 < n ? col->off[c] * col->row[c + 1] : 0.0;

    col->row[c] = col->diag[c] > 0.0 ? (col->row[c] - after) / col->diag[c] : 0.0;
  }
  for (PetscInt k = 0; k < col->n; k++) {
    Cell  *a = col->cell[k];
    double b[2];

    Shares(a, s->up, b);
    a->total[d] += b[0] * col->row[a->base] + b[1] * col->row[a->base + 1];
  }
}

/* Stresses of all along the axes that gravity acts along. */
static PetscErrorCode SolveColumns(const Scene *c, const Grid *g, Sites *s)
{
  Column col = {.nodes = g->cells[s->vertical] + 3};
  double(*total)[CL_DIM];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc6(s->n, &col.cell, col.nodes, &col.row, col.nodes, &col.diag, col.nodes, &col.off, col.nodes,
                         &col.load, c->nregion, &col.seen));
  PetscCall(PetscMalloc1(s->n, &total));
  for (PetscInt first = 0, end; first < s->n; first = end) {
    end = StripeEnd(s, first);
    Gather(c, s, s->order[first], &col);
    for (int d = 0; d < CL_DIM; d++) {
      if (c->gravity[d] == 0.0)
        continue;
      FirstGuess(s, d, &col);
      if (c->basis != BASIS_LINEAR) { /* particles beside a cell's edge are not shared: what they miss is no stress */
        AddLoads(s, &col);
        Balance(s, d, &col);
      }
    }
    for (PetscInt k = first; k < end; k++) /* the column's other stripes have columns of their own */
      memcpy(total[k], s->order[k]->total, sizeof(*total));
  }
  for (PetscInt k = 0; k < s->n; k++)
    memcpy(s->order[k]->total, total[k], sizeof(*total));
  PetscCall(PetscFree(total));
  PetscCall(PetscFree6(col.cell, col.row, col.diag, col.off, col.load, col.seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Effective stresses of the local particles of geostatic regions; both lists ascend in number. */
static PetscErrorCode Assign(const Scene *c, const Sites *s, Particles *P)
{
  PetscInt k = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < P->n; p++) {
    const Region *r = &c->region[P->i[PI_REGION][p]];

    while (k < s->n && s->cell[k].site.id < P->i[PI_ID][p])
      k++;
    PetscCheck(k < s->n && s->cell[k].site.id == P->i[PI_ID][p], PETSC_COMM_SELF, PETSC_ERR_PLIB,
               "particle %" PetscInt_FMT " has no column", P->i[PI_ID][p]);
    if (!RegionGeostatic(r))
      continue;
    const Cell  *a        = &s->cell[k];
    const double vertical = a->total[s->vertical] - a->ambient + a->p, across = RegionK0(c, r) * vertical;

    for (int i = XX; i <= ZZ; i++)
      P->f[P_SIG + i][p] = P->f[P_SIG0 + i][p] = i == s->vertical ? vertical : across;
    for (int d = 0; d < CL_DIM; d++) {
      const int i = voigt[s->vertical][d];

      if (d != s->vertical)
        P->f[P_SIG + i][p] = P->f[P_SIG0 + i][p] = a->total[d];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GeostaticStress(const Scene *c, const Grid *g, Particles *P)
{
  const int v      = SceneVertical(c);
  bool      wanted = false;

  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < c->nregion; r++)
    wanted = wanted || RegionGeostatic(&c->region[r]);
  if (!wanted || !c->fields.solid || !P->n)
    PetscFunctionReturn(PETSC_SUCCESS);
  Sites s = {.vertical = v, .up = c->gravity[v] < 0.0 ? 1 : -1};

  for (int k = 0; k < ACROSS; k++) {
    const int    d     = AcrossAxis(v, k);
    const double slack = 1e-6 * g->line[d].h, lower = GridNode(g, d, g->xs[d]);

    s.from[k] = lower - slack;
    s.to[k]   = (g->line[d].x ? GridNode(g, d, g->xs[d] + g->xm[d]) : lower + (double)g->xm[d] * g->line[d].h) + slack;
  }
  PetscCall(SitesVisit(c, g, Collect, &s));
  PetscCall(PetscMalloc1(s.n, &s.order));
  for (PetscInt k = 0; k < s.n; k++)
    s.order[k] = &s.cell[k];
  qsort(s.order, (size_t)s.n, sizeof(*s.order), ByStripe);
  PetscCall(SolveColumns(c, g, &s));
  PetscCall(Assign(c, &s, P));
  PetscCall(PetscFree(s.order));
  PetscCall(PetscFree(s.cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}
