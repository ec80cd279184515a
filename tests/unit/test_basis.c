/* Tests of src/basis, src/grid and src/particles: basis functions, node numbering, seeding and migration over ranks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>
#include "clathra/basis.h"
#include "clathra/particles.h"
#include "clathra/point.h"
#include "random.h"
#include "ranks.h"

#define Say(...) Call(PetscPrintf(PETSC_COMM_WORLD, __VA_ARGS__))

/* ---------------------------------------------------------------- one axis */
static const char *const basis_name[3] = {"cpgimp", "ugimp", "linear"};

/* Sum of the weights; of the gradients; error of x; gradient of x. */
typedef struct {
  double one, zero, x, dx;
} Moments;

static Moments MomentsOf(const Axis *a, double lower, double h, double x)
{
  Moments m = {-1.0, 0.0, -x, -1.0};

  for (int k = 0; k < 3; k++) {
    const double node = lower + (double)(a->base + k) * h;

    m.one += a->S[k];
    m.zero += a->dS[k];
    m.x += a->S[k] * node;
    m.dx += a->dS[k] * node;
  }
  return m;
}

/* A position whose domain edges are anywhere, on a grid line, or within 1e-12 cells of one. */
static void RandomDomain(Rng *r, double lower, double h, int cells, double *x, double *l)
{
  const int    kind = RngPick(r, 4);
  const double off = kind == 2 ? RngBetween(r, -1e-12, 1e-12) : 0.0, line = 1.0 + RngPick(r, cells - 2);

  *l = RngPick(r, 8) ? RngLog(r, 1e-3, 0.5) * h : 0.5 * h;
  if (kind == 0)
    *x = RngBetween(r, lower + *l, lower + cells * h - *l);
  else if (kind < 3)
    *x = lower + (line + off) * h + (RngPick(r, 2) ? *l : -*l);
  else
    *x = lower + (line + RngPick(r, 3) * 0.5) * h;
}

static void TestAxis(void **state)
{
  const double    lower = -0.37, h = 0.13;
  const int       cells = 9;
  const GridLines line  = LinesEqual(lower, lower + cells * h, cells);

  (void)state;
  for (int basis = 0; basis < 3; basis++) {
    Rng     r = {201};
    Moments w = {0};

    for (int n = 0; n < 100000; n++) {
      double x, l;
      Axis   a;

      RandomDomain(&r, lower, h, cells, &x, &l);
      BasisAxis((BasisType)basis, x, l, &line, &a);
      const Moments m = MomentsOf(&a, lower, h, x);
      w.one           = fmax(w.one, fabs(m.one) * l / h); /* (3) divides by 2 l: so does its round-off */
      w.zero          = fmax(w.zero, fabs(m.zero) * l);
      w.x             = fmax(w.x, fabs(m.x) / h);
      w.dx            = fmax(w.dx, fabs(m.dx) * l / h);
      for (int k = 0; k < 3; k++) {
        Check(a.S[k] >= 0.0 && a.S[k] <= 1.0 + 1e-15);
        if (a.S[k] != 0.0 || a.dS[k] != 0.0)
          Check(a.base + k >= 0 && a.base + k <= cells);
      }
    }
    Say("%-6s: (sum of weights - 1) x l/h: %.1e, of gradients x l: %.1e, linear field: %.1e h, its gradient x l/h: "
        "%.1e\n",
        basis_name[basis], w.one, w.zero, w.x, w.dx);
    /* an edge moved by the snap (1e-12 here) moves the mean by as much */
    Check(w.one < 5e-16 && w.zero < 5e-16 && w.x < 2e-12 && w.dx < 2e-12);
  }
}

/* Weights by fine quadrature of the hat functions, gradients by differences of the weights. */
static void TestAgainstDefinition(void **state)
{
  const double    lower = 0.2, h = 0.5;
  const GridLines line = LinesEqual(lower, lower + 8.0 * h, 8);

  (void)state;
  for (int basis = 0; basis < 3; basis++) {
    Rng    r      = {202};
    double weight = 0.0, slope = 0.0;

    for (int n = 0; n < 20000; n++) {
      const double l = RngBetween(&r, 0.02, 0.5) * h, x = RngBetween(&r, lower + h, lower + 7.0 * h), t = 1e-5 * h;
      Axis         a, up, down;

      BasisAxis((BasisType)basis, x, l, &line, &a);
      BasisAxis((BasisType)basis, x + t, l, &line, &up);
      BasisAxis((BasisType)basis, x - t, l, &line, &down);
      for (int k = 0; k < 3; k++) {
        const double node = lower + (double)(a.base + k) * h, half = basis == BASIS_CPGIMP ? fmax(l, h / 20.0) : l,
                     lo = x - half, hi = x + half;
        const double cut[5] = {lo, fmin(fmax(node - h, lo), hi), fmin(fmax(node, lo), hi), fmin(fmax(node + h, lo), hi),
                               hi};
        double       S      = basis == BASIS_LINEAR ? fmax(0.0, 1.0 - fabs(x - node) / h) : 0.0;

        for (int q = 0; q < 4 && basis != BASIS_LINEAR; q++) /* exact on each straight piece */
          S += (cut[q + 1] - cut[q]) * fmax(0.0, 1.0 - fabs(0.5 * (cut[q] + cut[q + 1]) - node) / h) / (2.0 * half);
        weight = fmax(weight, fabs(a.S[k] - S) * l / h);
        if (up.base == a.base && down.base == a.base) /* no kink between */
          slope = fmax(slope, fabs((up.S[k] - down.S[k]) / (2.0 * t) - a.dS[k]) * l);
      }
    }
    Say("%-6s: weights against the integral, x l/h: %.1e, gradients against differences of weights %.1e\n",
        basis_name[basis], weight, slope);
    Check(weight < 1e-15 && slope < (basis == BASIS_LINEAR ? 1e-10 : 2e-5)); /* kinks of S' within a step: t/h */
  }
}

/* Domains over the edge of the grid keep to it: sums still hold, no node outside. */
static void TestClipping(void **state)
{
  const GridLines line = LinesEqual(0.0, 4.0, 4);
  Rng             r    = {203};

  (void)state;
  for (int n = 0; n < 20000; n++) {
    const double l = RngBetween(&r, 0.05, 0.5), x = RngBetween(&r, 0.0, 1.0) * l;
    Axis         a, b;
    double       Sa = -1.0, Sb = -1.0, Ga = 0.0, Gb = 0.0;

    BasisAxis(BASIS_UGIMP, x, l, &line, &a);
    BasisAxis(BASIS_UGIMP, 4.0 - x, l, &line, &b);
    for (int k = 0; k < 3; k++) {
      Check(a.base >= 0 && ((a.S[k] == 0.0 && a.dS[k] == 0.0) || a.base + k <= 4));
      Check(b.base >= 0 && ((b.S[k] == 0.0 && b.dS[k] == 0.0) || b.base + k <= 4));
      Sa += a.S[k], Sb += b.S[k], Ga += a.dS[k], Gb += b.dS[k];
    }
    Check(fabs(Sa) < 4e-15 && fabs(Sb) < 4e-15 && fabs(Ga) < 1e-13 && fabs(Gb) < 1e-13);
    for (int k = 0; k < 3; k++) { /* mirror images */
      const PetscInt i = 4 - (a.base + k) - b.base;
      Check(i < 0 || i > 2 || (fabs(a.S[k] - b.S[i]) < 4e-15 && fabs(a.dS[k] + b.dS[i]) < 1e-12));
    }
  }
}

/* ---------------------------------------------------------------- nodes */
#define CELLS_X 11
#define CELLS_Y 7

static void MakeGrid(Grid *g)
{
  const double   lower[2] = {-0.2, 0.1}, upper[2] = {0.9, 0.8};
  const PetscInt cells[2] = {CELLS_X, CELLS_Y};

  Call(GridCreate(PETSC_COMM_WORLD, lower, upper, cells, g));
}

static bool Active(PetscInt i, PetscInt j) /* an arbitrary set with holes */
{
  return i >= 0 && j >= 0 && i <= CELLS_X && j <= CELLS_Y && (i * 7 + j * 5) % 4 != 0;
}

/* Each rank flags only the nodes that its own cells see; the map must hold their union. */
static void MakeMap(const Grid *g, NodeMap *map)
{
  unsigned char *flag;
  bool           changed;

  Call(PetscCalloc1(g->gm[0] * g->gm[1], &flag));
  for (PetscInt j = g->xs[1]; j < g->xs[1] + g->xm[1]; j++) {
    for (PetscInt i = g->xs[0]; i < g->xs[0] + g->xm[0]; i++)
      flag[GridPadded(g, (PetscInt[]){i, j})] = Active(i, j);
  }
  memset(map, 0, sizeof(*map));
  Call(NodeMapUpdate(g, flag, map, &changed));
  Check(changed);
  Call(NodeMapUpdate(g, flag, map, &changed));
  Check(!changed);
  Call(PetscFree(flag));
}

static void TestNodeMap(void **state)
{
  Grid     g;
  NodeMap  map;
  PetscInt count = 0, seen[(CELLS_X + 1) * (CELLS_Y + 1)] = {0};

  (void)state;
  MakeGrid(&g);
  MakeMap(&g, &map);
  for (PetscInt j = 0; j <= CELLS_Y; j++) {
    for (PetscInt i = 0; i <= CELLS_X; i++)
      count += Active(i, j);
  }
  Check(map.n_global == count);
  for (PetscInt k = 0; k < map.n_local; k++) {
    const PetscInt *ij = map.ij[k];

    Check(Active(ij[0], ij[1]) && map.index[GridPadded(&g, ij)] == k);
    Check(map.global[k] >= 0 && map.global[k] < count);
    Check((GridCellOwner(&g, ij) == g.rank) == (k < map.n_owned));
    if (k < map.n_owned) {
      Check(map.global[k] == map.first + k);
      seen[map.global[k]] = 1 + ij[0] + 100 * ij[1];
    }
  }
  Call(MPI_Allreduce(MPI_IN_PLACE, seen, count, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  for (PetscInt k = 0; k < map.n_local; k++) /* ghosts carry their owners' numbers */
    Check(seen[map.global[k]] == 1 + map.ij[k][0] + 100 * map.ij[k][1]);
  for (PetscInt j = g.gs[1]; j < g.gs[1] + g.gm[1]; j++) { /* every active node in reach has a number, no other */
    for (PetscInt i = g.gs[0]; i < g.gs[0] + g.gm[0]; i++)
      Check((map.index[GridPadded(&g, (PetscInt[]){i, j})] >= 0) == Active(i, j));
  }
  Call(NodeMapDestroy(&map));
  Call(GridDestroy(&g));
}

/* Ranks that see a node, found through a sum of ones; then sums and broadcasts of blocks of every width. */
static void TestNodeSums(void **state)
{
  Grid    g;
  NodeMap map;

  (void)state;
  MakeGrid(&g);
  MakeMap(&g, &map);
  for (PetscInt nc = 1; nc < 17; nc++) {
    double *a, *ones;

    Call(PetscMalloc2(map.n_local * nc, &a, map.n_local, &ones));
    for (PetscInt k = 0; k < map.n_local; k++) {
      ones[k] = 1.0;
      for (PetscInt c = 0; c < nc; c++)
        a[k * nc + c] = (double)(map.ij[k][0] + 100 * map.ij[k][1] + 10000 * c);
    }
    Call(NodeMapSum(&map, ones, 1));
    Call(NodeMapSum(&map, a, nc));
    for (PetscInt k = 0; k < map.n_local; k++) {
      Check(ones[k] >= 1.0 && ones[k] <= (double)g.size);
      Check(g.size == 1 || k < map.n_owned || ones[k] >= 2.0);
      for (PetscInt c = 0; c < nc; c++)
        Check(a[k * nc + c] == ones[k] * (double)(map.ij[k][0] + 100 * map.ij[k][1] + 10000 * c));
    }
    for (PetscInt k = 0; k < map.n_local * nc; k++)
      a[k] = k < map.n_owned * nc ? (double)(map.global[k / nc] * 17 + k % nc) : -1.0;
    Call(NodeMapBroadcast(&map, a, nc));
    for (PetscInt k = 0; k < map.n_local * nc; k++)
      Check(a[k] == (double)(map.global[k / nc] * 17 + k % nc));
    Call(PetscFree2(a, ones));
  }
  Call(NodeMapDestroy(&map));
  Call(GridDestroy(&g));
}

/* The tensor product by hand. */
static void TestStencilExpand(void **state)
{
  Grid    g;
  NodeMap map;
  Rng     r = {204};

  (void)state;
  MakeGrid(&g);
  memset(&map, 0, sizeof(map));
  unsigned char *flag;
  bool           changed;
  Call(PetscMalloc1(g.gm[0] * g.gm[1], &flag));
  memset(flag, 1, (size_t)(g.gm[0] * g.gm[1]));
  Call(NodeMapUpdate(&g, flag, &map, &changed));
  for (int n = 0; n < 20000; n++) {
    Stencil  s = {.r = 0.0};
    PetscInt node[CL_NODES], cell[2];
    double   S[CL_NODES], G[CL_NODES][CL_DIM], H[CL_NODES], x[2], l[2];

    for (int d = 0; d < 2; d++) {
      RandomDomain(&r, g.lower[d], g.line[d].h, (int)g.cells[d], &x[d], &l[d]);
      BasisAxis((BasisType)(n % 3), x[d], l[d], &g.line[d], &s.axis[d]);
    }
    Check(GridCell(&g, x, cell));
    if (GridCellOwner(&g, cell) != g.rank)
      continue;
    const int count = StencilExpand(&s, &g, &map, node, S, G, H);
    double    sum   = 0.0;
    for (int a = 0; a < count; a++) {
      Check(node[a] >= 0 && node[a] < map.n_local);
      const PetscInt i = map.ij[node[a]][0] - s.axis[0].base, j = map.ij[node[a]][1] - s.axis[1].base;

      Check(i >= 0 && i < 3 && j >= 0 && j < 3);
      Check(S[a] == s.axis[0].S[i] * s.axis[1].S[j]);
      Check(G[a][0] == s.axis[0].dS[i] * s.axis[1].S[j] && G[a][1] == s.axis[0].S[i] * s.axis[1].dS[j]);
      for (int b = 0; b < a; b++)
        Check(node[b] != node[a]);
      sum += S[a];
    }
    Check(fabs(sum - 1.0) < 1e-15 * (g.line[0].h / l[0] + g.line[1].h / l[1]));
  }
  Call(PetscFree(flag));
  Call(NodeMapDestroy(&map));
  Call(GridDestroy(&g));
}

/* Sum over Gauss's points (three an axis: exact) of the part of [lo, hi] x [lo, hi] in a cell from `at` on with widths
   h: of the gradients of its corners' functions, of N/r, and of 1, all weighted with r about an axis. */
static double GaussPart(bool ring, const double lo[2], const double hi[2], const double at[2], const double h[2],
                        double G[4][2], double hoop[4])
{
  static const double place[3]  = {-0.7745966692414834, 0.0, 0.7745966692414834},
                      weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  double from[2], to[2], all = 0.0;

  for (int d = 0; d < 2; d++) {
    from[d] = fmax(lo[d], at[d]);
    to[d]   = fmin(hi[d], at[d] + h[d]);
    if (!(to[d] > from[d]))
      return 0.0;
  }
  for (int q = 0; q < 9; q++) {
    const int k[2] = {q % 3, q / 3};
    double    xi[2], dA = 1.0, r = 1.0;

    for (int d = 0; d < 2; d++) {
      const double x = 0.5 * (from[d] + to[d]) + 0.5 * place[k[d]] * (to[d] - from[d]);

      xi[d] = (x - at[d]) / h[d];
      dA *= weight[k[d]] * (to[d] - from[d]);
      r = ring && d == 0 ? x : r;
    }
    for (int i = 0; i < 4; i++) {
      const double N[2] = {i & 1 ? xi[0] : 1.0 - xi[0], i & 2 ? xi[1] : 1.0 - xi[1]};

      G[i][0] += dA * r * (i & 1 ? 1.0 : -1.0) / h[0] * N[1];
      G[i][1] += dA * r * (i & 2 ? 1.0 : -1.0) / h[1] * N[0];
      hoop[i] += dA * N[0] * N[1];
    }
    all += dA * r;
  }
  return all;
}

/* (88): means over what domains of random places and sizes hold of the middle one of nine cells, equal ones and others,
   in the plane and about an axis. */
static void TestCellMean(void **state)
{
  static const double place[2][4] = {{0.0, 0.3, 0.6, 0.9}, {0.0, 0.2, 0.6, 0.9}};
  double              worst       = 0.0;
  const NodeMap       none        = {.n_local = 0};
  Rng                 r           = {88};

  (void)state;
  for (int n = 0; n < 400; n++) {
    const bool    ring = n % 2;
    const double *x_of = place[n / 2 % 2];
    Grid          g    = {.rank = 0};

    for (int d = 0; d < 2; d++) {
      if (n / 2 % 2)
        Call(LinesCreate(3, x_of, &g.line[d]));
      else
        g.line[d] = LinesEqual(0.0, 0.9, 3);
    }
    double       moment[CELL_MOMENTS] = {0.0}, G[4][2] = {{0.0}}, hoop[4] = {0.0}, all = 0.0;
    const double at[2] = {x_of[1], x_of[1]}, h[2] = {x_of[2] - x_of[1], x_of[2] - x_of[1]};
    CellMean     mean;

    for (int p = 0; p < 3; p++) {
      Stencil   s = {.r = 0.0};
      AxisParts part[2], over[2];
      PetscInt  cell[CL_CORNERS];
      double    share[CL_CORNERS];
      double    lo[2], hi[2], V;

      for (int d = 0; d < 2; d++) {
        const double l = RngBetween(&r, 0.03, 0.09), x = RngBetween(&r, 0.21, 0.69);

        if (ring && d == 0)
          BasisRadius(BASIS_UGIMP, x, l, &g.line[d], &s.axis[d], s.hoop, &s.r);
        else
          BasisAxis(BASIS_UGIMP, x, l, &g.line[d], &s.axis[d]);
        lo[d] = x - l;
        hi[d] = x + l;
      }
      V = (hi[0] - lo[0]) * (hi[1] - lo[1]) * (ring ? s.r : 1.0);
      StencilCells(&s, &g, &none, part, cell, share); /* of a grid without padding: no cell is on this rank */
      memcpy(over, part, sizeof(part));
      if (ring)
        over[0] = StencilRing(&s, &g, &part[0]);
      for (int c = 0; c < 4; c++) {
        if (s.axis[0].base + (c & 1) != 1 || s.axis[1].base + (c >> 1) != 1)
          continue;
        for (int k = 0; k < 4; k++) {
          moment[k] += V * PartMoment(part, c, k);
          moment[4 + k] += ring ? V * PartMoment(over, c, k) : 0.0;
        }
      }
      all += GaussPart(ring, lo, hi, at, h, G, hoop);
    }
    for (int d = 0; d < 2; d++)
      Call(LinesDestroy(&g.line[d]));
    if (!(all > 0.0))
      continue;
    CellMeanOf(moment, h, ring, &mean);
    worst = fmax(worst, fabs(moment[0] / all - 1.0));
    for (int i = 0; i < 4; i++) {
      worst = fmax(worst, fabs(mean.hoop[i] - (ring ? hoop[i] / all : 0.0)) * h[0]);
      for (int d = 0; d < 2; d++)
        worst = fmax(worst, fabs(mean.Q[i][d] - G[i][d] / all) * h[d]);
    }
  }
  Say("means over cells: worst %.1e\n", worst);
  Check(worst < 1e-11);
  Check(BasisCell(3.2, 3.0, 8.0) == 0 && BasisCell(4.2, 3.0, 8.0) == 1 && BasisCell(3.2, 2.0, 8.0) == 1);
  Check(BasisCell(8.0, 7.0, 8.0) == 0 && BasisCell(4.0 - 1e-9, 3.0, 8.0) == 1 && BasisCell(7.6, 7.0, 8.0) == 0);
}

/* ---------------------------------------------------------------- particles */
static void MakeCase(Scene *c, Material *mat, Region *region)
{
  *mat = (Material){.porosity  = 0.3,
                    .solid     = {2600.0, INFINITY, 0.0, 0.0, 4.0},
                    .hydrate   = {900.0, INFINITY, 0.0, 0.0, 4.0},
                    .water     = {1000.0, 2.2e9, 0.0, 3.25e6, 4.0},
                    .gas       = {.M = 0.016},
                    .retention = {.p0 = 5e4, .m = 0.3, .lambda = 1.5, .Swr = 0.2, .Sgr = 0.1}};
  Check(RetentionSetType(&mat->retention, "van_genuchten"));
  region[0] = (Region){.name        = "a",
                       .lower       = {-0.1, 0.2},
                       .upper       = {0.83, 0.47},
                       .ppc         = {2, 3},
                       .pressure    = 3e6,
                       .temperature = 4.0,
                       .Sh          = 0.2,
                       .Sw          = 0.4,
                       .Sg          = 0.4};
  region[1] = (Region){.name        = "b",
                       .lower       = {-0.1, 0.47},
                       .upper       = {0.4, 0.7},
                       .ppc         = {1, 2},
                       .pressure    = 3e6,
                       .temperature = 4.0,
                       .Sw          = 0.6,
                       .Sg          = 0.4};
  *c        = (Scene){.lower     = {-0.2, 0.1},
                      .upper     = {0.9, 0.8},
                      .cells     = {CELLS_X, CELLS_Y},
                      .material  = mat,
                      .region    = region,
                      .nmaterial = 1,
                      .nregion   = 2};
  Check(FieldSetMake(HAS_ALL, true, &c->fields));
}

/* Ids 0..n-1 once each, on the right ranks, at places that the id alone decides; volumes and masses of the boxes. */
static void TestSeed(void **state)
{
  Grid           g;
  Particles      P;
  Scene          c;
  Material       mat;
  Region         region[2];
  const PetscInt nx[2] = {19, 5}, ny[2] = {9, 5}, total = 19 * 9 + 5 * 5; /* ceil(9.3 x 2) x ceil(2.7 x 3), ... */
  PetscInt       seen[19 * 9 + 5 * 5] = {0}, faces[SIDE_COUNT] = {0};
  double         V = 0.0, solid = 0.0;

  (void)state;
  MakeGrid(&g);
  MakeCase(&c, &mat, region);
  Call(ParticlesCreate(~0u, &P));
  Call(ParticlesSeed(&c, &g, &P));
  for (PetscInt p = 0; p < P.n; p++) {
    const PetscInt id = P.i[PI_ID][p], r = id >= 19 * 9, k = r ? id - 19 * 9 : id, i = k % nx[r], j = k / nx[r];
    const double   x[2] = {P.f[P_X][p], P.f[P_X + 1][p]};
    PetscInt       cell[2];

    Check(id >= 0 && id < total && P.i[PI_REGION][p] == r);
    seen[id]++;
    for (int d = 0; d < 2; d++) {
      const double dx = (region[r].upper[d] - region[r].lower[d]) / (double)(d ? ny[r] : nx[r]);

      Check(fabs(x[d] - region[r].lower[d] - dx * ((double)(d ? j : i) + 0.5)) < 1e-14);
      Check(fabs(P.f[P_L + d][p] - 0.5 * dx) < 1e-15);
    }
    Check(GridCell(&g, x, cell) && GridCellOwner(&g, cell) == g.rank);
    V += P.f[P_V][p];
    solid += P.f[P_MS][p];
    for (int s = 0; s < SIDE_COUNT; s++)
      faces[s] += (P.i[PI_FACES][p] >> s) & 1;
  }
  Call(MPI_Allreduce(MPI_IN_PLACE, seen, total, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  Call(MPI_Allreduce(MPI_IN_PLACE, faces, SIDE_COUNT, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  Call(MPI_Allreduce(MPI_IN_PLACE, &V, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  Call(MPI_Allreduce(MPI_IN_PLACE, &solid, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  for (PetscInt k = 0; k < total; k++)
    Check(seen[k] == 1);
  const double area = 0.93 * 0.27 + 0.5 * 0.23;
  Check(fabs(V - area) < 1e-14 && fabs(solid - 0.7 * 2600.0 * area) < 1e-11);
  Check(faces[SIDE_XMIN] == 9 + 5 && faces[SIDE_XMAX] == 9 + 5 && faces[SIDE_YMIN] == 19);
  Check(faces[SIDE_YMAX] == 5 + 9); /* of the lower box only what the upper one does not cover: columns 10 to 18 */
  Call(ParticlesDestroy(&P));
  Call(GridDestroy(&g));
}

/* Every variable of a particle is a function of its id, so that a mix-up shows. */
static double Stamp(PetscInt id, int k)
{
  return (double)id * 1000.0 + (double)k + 0.25;
}

static void Fill(const Grid *g, Particles *P, PetscInt n)
{
  Call(ParticlesCreate(~0u, P));
  Call(ParticlesResize(P, n));
  for (PetscInt p = 0; p < n; p++) {
    const PetscInt id = p * g->size + g->rank;

    for (int k = 0; k < P_COUNT; k++)
      P->f[k][p] = Stamp(id, k);
    P->i[PI_ID][p]     = id;
    P->i[PI_REGION][p] = id % 3;
    P->i[PI_FACES][p]  = id % 16;
  }
}

/* A position that belongs to (id, round): anywhere, on the seams between ranks to the last bit, or next to them. */
static void Place(const Grid *g, PetscInt id, int round, double x[2])
{
  Rng r = {0x9E3779B97F4A7C15ULL * (uint64_t)(id + 1) + (uint64_t)(round + 1) * 77777ULL};

  for (int d = 0; d < 2; d++) {
    const double width = (double)g->cells[d] * g->line[d].h;

    (void)RngUnit(&r);
    x[d] = g->lower[d] + width * RngUnit(&r);
    if (g->nproc[d] > 1 && RngPick(&r, 2)) {
      x[d] = g->lower[d] + (double)g->start[d][1] * g->line[d].h;
      if (RngPick(&r, 3))
        x[d] = nextafter(x[d], RngPick(&r, 2) ? INFINITY : -INFINITY);
    }
  }
  if (id == 5) {
    x[0] = g->lower[0] + (double)g->cells[0] * g->line[0].h; /* the far corner belongs to the last cell */
    x[1] = g->lower[1];
  }
}

static void CheckArrived(const Grid *g, const Particles *P, PetscInt total, int round)
{
  PetscInt *seen;

  Call(PetscCalloc1(total, &seen));
  for (PetscInt p = 0; p < P->n; p++) {
    const PetscInt id = P->i[PI_ID][p];
    double         x[2];
    PetscInt       cell[2];

    Check(id >= 0 && id < total);
    seen[id]++;
    Place(g, id, round, x);
    Check(P->f[P_X][p] == x[0] && P->f[P_X + 1][p] == x[1]);
    Check(GridCell(g, x, cell) && GridCellOwner(g, cell) == g->rank);
    Check(P->i[PI_REGION][p] == id % 3 && P->i[PI_FACES][p] == id % 16);
    for (int k = P_X + 2; k < P_COUNT; k++)
      Check(P->f[k][p] == Stamp(id, k));
  }
  Call(MPI_Allreduce(MPI_IN_PLACE, seen, total, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  for (PetscInt k = 0; k < total; k++)
    Check(seen[k] == 1);
  Call(PetscFree(seen));
}

static void TestMigrate(void **state)
{
  const PetscInt n = 500;
  Grid           g;
  Particles      P;
  PetscInt       left, *before, moved = 0;

  (void)state;
  MakeGrid(&g);
  Fill(&g, &P, n);
  for (int round = 0; round < 20; round++) {
    for (PetscInt p = 0; p < P.n; p++) {
      double x[2];

      Place(&g, P.i[PI_ID][p], round, x);
      P.f[P_X][p]     = x[0];
      P.f[P_X + 1][p] = x[1];
    }
    const PetscInt was = P.n;
    Call(PetscMalloc1(was, &before));
    Call(PetscArraycpy(before, P.i[PI_ID], was));
    Call(ParticlesMigrate(&g, &P, &left));
    Check(left == 0);
    CheckArrived(&g, &P, n * g.size, round);
    PetscInt k = 0; /* those that stayed come first, in their old order */
    for (PetscInt q = 0; q < was; q++) {
      if (k < P.n && before[q] == P.i[PI_ID][k])
        k++;
    }
    for (PetscInt q = 0; q < was; q++) {
      for (PetscInt p = k; p < P.n; p++)
        Check(P.i[PI_ID][p] != before[q]);
    }
    moved += P.n - k;
    Call(PetscFree(before));
  }
  Call(MPI_Allreduce(MPI_IN_PLACE, &moved, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  Say("migration: %" PetscInt_FMT " moves between ranks, none lost or doubled\n", moved);
  Check(g.size == 1 || moved > 1000);
  Call(ParticlesDestroy(&P));
  Call(GridDestroy(&g));
}

/* Particles outside, or nowhere: counted on all ranks, nothing moves. */
static void TestLeaving(void **state)
{
  static const double outside[4] = {-0.2000001, 0.9000001, NAN, INFINITY};
  Grid                g;
  Particles           P;
  PetscInt            left;

  (void)state;
  MakeGrid(&g);
  Fill(&g, &P, 50);
  for (PetscInt p = 0; p < P.n; p++) {
    P.f[P_X][p]     = 0.3;
    P.f[P_X + 1][p] = 0.3;
  }
  if (g.rank == g.size - 1) {
    for (int k = 0; k < 4; k++)
      P.f[P_X][10 * k] = outside[k];
  }
  Call(ParticlesMigrate(&g, &P, &left));
  Check(left == 4 && P.n == 50);
  for (PetscInt p = 0; p < P.n; p++)
    Check(P.i[PI_ID][p] == p * g.size + g.rank);
  Call(ParticlesDestroy(&P));
  Call(GridDestroy(&g));
}

/* ---------------------------------------------------------------- borders between ranks */
/* Each rank's load is the mean but for a column; columns without load are nobody's burden. */
static void TestEvenBorders(void **state)
{
  enum { CELLS = 60 };
  Rng rng = {11};

  (void)state;
  for (int trial = 0; trial < 200; trial++) {
    PetscInt       load[CELLS], start[7], total = 0, most = 0;
    const PetscInt nproc = 1 + RngPick(&rng, 6), empty = RngPick(&rng, 20);

    for (PetscInt k = 0; k < CELLS; k++) {
      load[k] = k < empty ? 0 : 1 + RngPick(&rng, 9);
      total += load[k];
      most = PetscMax(most, load[k]);
    }
    GridEvenBorders(CELLS, load, nproc, start);
    Check(start[0] == 0 && start[nproc] == CELLS + 1);
    for (PetscInt r = 0; r < nproc; r++) {
      PetscInt share = 0;

      for (PetscInt k = start[r]; k < PetscMin(start[r + 1], CELLS); k++)
        share += load[k];
      Check(start[r + 1] - start[r] >= 3);
      Check(fabs((double)share - (double)total / (double)nproc) <= (double)most);
    }
  }
}

/* All load in one column: whoever has it, the others keep their three nodes. */
static void TestLonelyColumn(void **state)
{
  PetscInt load[12] = {0}, start[5];

  (void)state;
  for (int k = 0; k < 12; k++) {
    load[k] = 1000;
    GridEvenBorders(12, load, 4, start);
    for (int r = 0; r < 4; r++)
      Check(start[r + 1] - start[r] >= 3);
    Check(start[0] == 0 && start[4] == 13);
    load[k] = 0;
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(TestAxis),        cmocka_unit_test(TestAgainstDefinition),
      cmocka_unit_test(TestClipping),    cmocka_unit_test(TestNodeMap),
      cmocka_unit_test(TestNodeSums),    cmocka_unit_test(TestStencilExpand),
      cmocka_unit_test(TestCellMean),    cmocka_unit_test(TestSeed),
      cmocka_unit_test(TestMigrate),     cmocka_unit_test(TestLeaving),
      cmocka_unit_test(TestEvenBorders), cmocka_unit_test(TestLonelyColumn),
  };

  return RunTests(argc, argv, tests, NULL, NULL);
}
