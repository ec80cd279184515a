/* What drives fluids where a border of layers cuts cells: (306), and of one fluid what it becomes there (447). */
#include "clathra/boundary.h"

/* Sums over particles at a node, then at a cell by its lowest node. */
enum { NODE_V, NODE_LN, NODE_SUMS };
enum { CELL_V, CELL_OVER_K, CELL_SUMS };

#define LEAST_RATIO 1e-10 /* of less the round-off of A has no inverse (448) */
#define ALIKE 1e-12       /* of ln k_p over the width of a domain: layers of a node that differ by less are one */

typedef struct {
  const Scene     *c;
  const Grid      *g;
  NodeMap         *map;
  const Particles *P;
  double          *k;    /* [n] k_p of (350) */
  double          *node; /* [n_local][NODE_SUMS] */
  double          *T;    /* [n_local][CL_SYMMETRIC] */
  double          *cell; /* [n_local][CELL_SUMS] */
} Borders;

/* A particle's nodes. */
typedef struct {
  int      n;
  PetscInt at[CL_NODES];
  double   S[CL_NODES], G[CL_NODES][CL_DIM];
} Nodes;

static void NodesOf(const Borders *b, PetscInt p, Nodes *to)
{
  Stencil s;
  double  H[CL_NODES];

  ParticleStencil(b->c, b->g, b->P, p, &s);
  to->n = StencilExpand(&s, b->g, b->map, to->at, to->S, to->G, H);
}

/* Weighted means of ln k_p at the nodes. */
static PetscErrorCode Means(Borders *b)
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < b->P->n; p++) {
    const Material *mat = &b->c->material[b->c->region[b->P->i[PI_REGION][p]].material];
    const double    V   = b->P->f[P_V][p];
    Nodes           to;

    b->k[p]         = SceneConductance(b->c, mat, b->P->f[P_SH][p]);
    const double ln = log(b->k[p]);
    NodesOf(b, p, &to);
    for (int a = 0; a < to.n; a++) {
      b->node[NODE_SUMS * to.at[a] + NODE_V] += to.S[a] * V;
      b->node[NODE_SUMS * to.at[a] + NODE_LN] += to.S[a] * V * ln;
    }
  }
  PetscCall(NodeMapSum(b->map, b->node, NODE_SUMS));
  for (PetscInt I = 0; I < b->map->n_local; I++)
    b->node[NODE_SUMS * I + NODE_LN] /= b->node[NODE_SUMS * I + NODE_V];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gradient of ln k_p at particle p at t_n, 1/m; false where all is one layer. */
static bool Normal(const Borders *b, PetscInt p, const Nodes *to, double n[CL_DIM])
{
  const double own       = log(b->k[p]);
  double       g[CL_DIM] = {0.0}, A[CL_DIM][CL_DIM], terms = 0.0;

  for (int a = 0; a < to->n; a++) {
    const double more = b->node[NODE_SUMS * to->at[a] + NODE_LN] - own;

    for (int d = 0; d < CL_DIM; d++)
      g[d] += to->G[a][d] * more;
    terms += VectorLength(to->G[a]);
  }
  for (int d = 0; d < CL_DIM; d++)
    n[d] = g[d];
  if (b->P->total) {
    ParticleInverse(b->P, p, A);
    for (int d = 0; d < CL_DIM; d++)
      n[d] = VectorDot(A[d], g);
  }
  return VectorLength(g) > ALIKE * terms;
}

/* N of the nodes: means of n (x) n. */
static PetscErrorCode Normals(Borders *b)
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < b->P->n; p++) {
    const double V = b->P->f[P_V][p];
    double       n[CL_DIM];
    Nodes        to;

    NodesOf(b, p, &to);
    if (!Normal(b, p, &to, n))
      continue;
    for (int a = 0; a < to.n; a++) {
      double *T = &b->T[CL_SYMMETRIC * to.at[a]];

      for (int i = 0; i < CL_DIM; i++) {
        for (int j = i; j < CL_DIM; j++)
          T[cl_symmetric[i][j]] += to.S[a] * V * n[i] * n[j];
      }
    }
  }
  PetscCall(NodeMapSum(b->map, b->T, CL_SYMMETRIC));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* N of particle p, of trace 1; false where there is no border. */
static bool Across(const Borders *b, PetscInt p, double N[CL_SYMMETRIC])
{
  double trace = 0.0;
  Nodes  to;

  NodesOf(b, p, &to);
  for (int k = 0; k < CL_SYMMETRIC; k++) {
    N[k] = 0.0;
    for (int a = 0; a < to.n; a++)
      N[k] += to.S[a] * b->T[CL_SYMMETRIC * to.at[a] + k] / b->node[NODE_SUMS * to.at[a] + NODE_V];
    trace += k < CL_DIM ? N[k] : 0.0;
  }
  for (int k = 0; k < CL_SYMMETRIC && trace > 0.0; k++)
    N[k] /= trace;
  return trace > 0.0;
}

/* Gas may be let free in what hangs into the cell beyond a border, and would have no way out: two fluids flow as the
   particles' beds alone say. */
PetscErrorCode ParticlesDrive(const Scene *c, const Grid *g, NodeMap *map, const Particles *P, Beds *A)
{
  Borders b = {.c = c, .g = g, .map = map, .P = P};
  double(*N)[CL_SYMMETRIC];
  bool *beside;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < P->n; p++)
    A[p] = ParticleBeds(c, P, p);
  if (c->fields.phase[PHASE_G])
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc4(P->n, &b.k, NODE_SUMS * map->n_local, &b.node, CL_SYMMETRIC * map->n_local, &b.T,
                         CELL_SUMS * map->n_local, &b.cell));
  PetscCall(PetscMalloc2(P->n, &N, P->n, &beside));
  PetscCall(Means(&b));
  PetscCall(Normals(&b));
  for (PetscInt p = 0; p < P->n; p++) {
    Stencil   s;
    AxisParts part[CL_DIM];
    PetscInt  cell[CL_CORNERS];
    double    share[CL_CORNERS];

    beside[p]         = Across(&b, p, N[p]);
    const double over = 1.0 / (b.k[p] * (beside[p] ? BedsAcross(&A[p], N[p]) : 1.0));
    ParticleStencil(c, g, P, p, &s);
    StencilCells(&s, g, map, part, cell, share);
    for (int k = 0; k < CL_CORNERS; k++) {
      if (cell[k] < 0)
        continue;
      b.cell[CELL_SUMS * cell[k] + CELL_V] += share[k] * P->f[P_V][p];
      b.cell[CELL_SUMS * cell[k] + CELL_OVER_K] += share[k] * P->f[P_V][p] * over;
    }
  }
  PetscCall(NodeMapSum(map, b.cell, CELL_SUMS));
  for (PetscInt p = 0; p < P->n; p++) {
    Stencil   s;
    AxisParts part[CL_DIM];
    PetscInt  cell[CL_CORNERS];
    double    share[CL_CORNERS], over = 0.0;

    if (!beside[p])
      continue;
    ParticleStencil(c, g, P, p, &s);
    StencilCells(&s, g, map, part, cell, share);
    for (int k = 0; k < CL_CORNERS; k++) {
      const double *sum = &b.cell[CELL_SUMS * cell[k]];

      over += cell[k] < 0 ? 0.0 : share[k] * sum[CELL_OVER_K] / sum[CELL_V];
    }
    const double ratio = 1.0 / (over * b.k[p] * BedsAcross(&A[p], N[p]));
    if (ratio < 1.0)
      BedsLessen(&A[p], N[p], fmax(ratio, LEAST_RATIO));
  }
  PetscCall(PetscFree2(N, beside));
  PetscCall(PetscFree4(b.k, b.node, b.T, b.cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}
