/* Lines of a grid whose cells differ: look-up, weights in the plane and about an axis, places of particles, stencils.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>
#include "clathra/basis.h"
#include "clathra/particles.h"
#include "clathra/shape.h"
#include "random.h"
#include "ranks.h"

#define Say(...) Call(PetscPrintf(PETSC_COMM_WORLD, __VA_ARGS__))

#define CELLS 9

static const char *const basis_name[] = {"cpgimp", "ugimp", "linear"};

/* Cells of random widths, each at most twice as wide as the next; the first at `lower`. */
static GridLines RandomLines(Rng *r, double lower)
{
  double    place[CELLS + 1] = {lower}, h = RngBetween(r, 0.05, 0.3);
  GridLines line;

  for (int i = 1; i <= CELLS; i++) {
    place[i] = place[i - 1] + h;
    h *= pow(2.0, RngBetween(r, -1.0, 1.0));
  }
  Call(LinesCreate(CELLS, place, &line));
  return line;
}

static double Hat(const GridLines *line, PetscInt node, double x)
{
  const double at = LinesAt(line, node), h = LinesWidth(line, x < at ? node - 1 : node);

  return fmax(0.0, 1.0 - fabs(x - at) / h);
}

/* ---------------------------------------------------------------- look-up */
static void TestLookUp(void **state)
{
  Rng    r     = {301};
  double worst = 0.0;

  (void)state;
  for (int n = 0; n < 300; n++) {
    GridLines    line   = RandomLines(&r, RngBetween(&r, -3.0, 3.0));
    const double length = line.upper - line.lower;

    for (int k = 0; k < 50; k++) {
      const bool     on   = k % 3 == 0;
      const PetscInt at   = (PetscInt)RngBetween(&r, 0.0, CELLS);
      const double   x    = on ? line.x[at] : line.lower + length * RngUnit(&r);
      PetscInt       cell = 0;

      while (cell + 1 < CELLS && x >= line.x[cell + 1])
        cell++;
      Check(LinesFind(&line, x) == cell);
      Check(LinesWidthAt(&line, x) == line.x[cell + 1] - line.x[cell]);
      worst = fmax(worst, fabs(LinesFrom(&line, LinesPlace(&line, x)) - x) / length);
    }
    Check(LinesFind(&line, line.lower - 0.5 * LinesWidth(&line, 0)) == -1 && LinesFind(&line, line.upper) == CELLS);
    Check(LinesFind(&line, line.lower - 1e6) == -LINES_PAD && LinesFind(&line, 1e6) == CELLS + LINES_PAD - 1);
    Check(fabs(LinesLeastAt(&line, line.lower) / fmin(LinesWidth(&line, 0), LinesWidth(&line, 1)) - 1.0) < 1e-12);
    Call(LinesDestroy(&line));
  }
  Say("a place to cells and back: %.1e of the axis\n", worst);
  Check(worst < 4e-16);
}

/* ---------------------------------------------------------------- weights (301), (302) */
typedef struct {
  double one, zero, linear, slope, weight, centroid;
} Worst;

/* Sums over the nodes, and the weights by the trapezoidal rule between the places where the hat has a kink. */
static void Look(const GridLines *line, BasisType basis, double x, double l, Worst *w)
{
  Axis a;

  BasisAxis(basis, x, l, line, &a);
  const double reach = basis == BASIS_LINEAR ? 0.0 : BasisReach(basis, line, x, l), h = LinesWidthAt(line, x);
  const double lo = fmax(x - reach, line->lower), hi = fmin(x + reach, line->upper), mid = 0.5 * (lo + hi);
  double       one = -1.0, zero = 0.0, linear = -mid, slope = -1.0;

  Check(reach <= 0.75 * h);
  for (int k = 0; k < 3; k++) {
    const double node = LinesAt(line, a.base + k), S = a.S[k];

    one += S;
    zero += a.dS[k];
    linear += S * node;
    slope += a.dS[k] * node;
    Check(S >= 0.0 && S <= 1.0 + 1e-15);
    Check((S == 0.0 && a.dS[k] == 0.0) || (a.base + k >= 0 && a.base + k <= CELLS));
  }
  w->one      = fmax(w->one, fabs(one) * l / h);
  w->zero     = fmax(w->zero, fabs(zero) * l);
  w->linear   = fmax(w->linear, fabs(linear) / h);
  w->slope    = fmax(w->slope, fabs(slope) * l / h);
  w->centroid = fmax(w->centroid, fabs(AxisCentroid(&a, line) - mid) / h);
  for (PetscInt node = 0; node <= CELLS; node++) { /* all nodes: none beyond the three is reached */
    const PetscInt k = node - a.base;
    double         S = basis == BASIS_LINEAR ? Hat(line, node, x) : 0.0;

    for (PetscInt i = 0; i < CELLS && reach > 0.0; i++) {
      const double p = fmax(lo, line->x[i]), q = fmin(hi, line->x[i + 1]);

      if (q > p)
        S += 0.5 * (q - p) * (Hat(line, node, p) + Hat(line, node, q)) / (hi - lo);
    }
    w->weight = fmax(w->weight, fabs(S - (k >= 0 && k < 3 ? a.S[k] : 0.0)) * l / h);
  }
}

static void TestWeights(void **state)
{
  (void)state;
  for (int basis = 0; basis < 3; basis++) {
    Rng   r = {302};
    Worst w = {0};

    for (int n = 0; n < 400; n++) {
      GridLines line = RandomLines(&r, RngBetween(&r, -3.0, 3.0));

      for (int k = 0; k < 50; k++) { /* also domains longer than their cell, and over the grid's edge */
        const double l = RngBetween(&r, 0.01, 0.3), s = RngBetween(&r, 1e-3, 0.999);

        Look(&line, (BasisType)basis, line.lower + (line.upper - line.lower) * s, l, &w);
      }
      Call(LinesDestroy(&line));
    }
    Say("%-6s: sum of weights - 1, x l/h: %.0e, of gradients x l: %.0e, linear field: %.0e h, its gradient x l/h: "
        "%.0e, "
        "weights against the integral: %.0e, centroid %.0e h\n",
        basis_name[basis], w.one, w.zero, w.linear, w.slope, w.weight, w.centroid);
    Check(w.one < 1e-13 && w.zero < 1e-13 && w.linear < 1e-11 && w.slope < 1e-11 && w.weight < 1e-11 &&
          w.centroid < 1e-11);
  }
}

/* Equal cells written as unequal ones. */
static void TestEqual(void **state)
{
  const GridLines equal = LinesEqual(0.3, 0.3 + 0.2 * CELLS, CELLS);
  GridLines       line;
  Rng             r = {303};
  double          place[CELLS + 1], worst = 0.0;

  (void)state;
  for (int i = 0; i <= CELLS; i++)
    place[i] = LinesAt(&equal, i);
  Call(LinesCreate(CELLS, place, &line));
  for (int n = 0; n < 20000; n++) {
    const double l = RngBetween(&r, 0.02, 0.15), x = RngBetween(&r, 0.3 + l, equal.upper - l);
    double       H[2][3], radius[2];
    Axis         a, b, c, d;

    BasisAxis((BasisType)(n % 3), x, l, &equal, &a);
    BasisAxis((BasisType)(n % 3), x, l, &line, &b);
    BasisRadius((BasisType)(n % 3), x, l, &equal, &c, H[0], &radius[0]);
    BasisRadius((BasisType)(n % 3), x, l, &line, &d, H[1], &radius[1]);
    Check(a.base == b.base && c.base == d.base);
    for (int k = 0; k < 3; k++) {
      worst = fmax(worst, fmax(fabs(a.S[k] - b.S[k]), fabs(c.S[k] - d.S[k])));
      worst = fmax(worst, l * fmax(fabs(a.dS[k] - b.dS[k]), fabs(c.dS[k] - d.dS[k])));
      worst = fmax(worst, 0.2 * fabs(H[0][k] - H[1][k]));
    }
  }
  Say("equal cells as unequal ones: %.1e\n", worst);
  Check(worst < 1e-13);
  Call(LinesDestroy(&line));
}

/* The half-length that acts does not jump as a domain crosses cells, and its edges move with it. */
static void TestReach(void **state)
{
  Rng    r    = {304};
  double jump = 0.0;

  (void)state;
  for (int n = 0; n < 100; n++) {
    GridLines    line = RandomLines(&r, 0.0);
    const double step = 1e-4 * line.h;

    for (double x = line.lower; x + step < line.upper; x += 97.3 * step) {
      const double a = BasisReach(BASIS_UGIMP, &line, x, 1e9), b = BasisReach(BASIS_UGIMP, &line, x + step, 1e9);

      jump = fmax(jump, fabs(b - a) / step);
    }
    for (PetscInt i = 0; i < CELLS; i++)
      Check(fabs(BasisReach(BASIS_UGIMP, &line, 0.5 * (line.x[i] + line.x[i + 1]), 1e9) - 0.5 * LinesWidth(&line, i)) <
            1e-14);
    Call(LinesDestroy(&line));
  }
  Say("slope of the half-length that acts: %.3g, below 1\n", jump);
  Check(jump < 0.5 + 1e-6);
}

/* (29): sums and moments of the weights about an axis against Simpson's rule, which is exact for r N. */
static void TestRadius(void **state)
{
  Rng    r     = {305};
  double worst = 0.0, hoop = 0.0, slope = 0.0;

  (void)state;
  for (int n = 0; n < 5000; n++) {
    GridLines    line = RandomLines(&r, n % 2 ? 0.0 : RngBetween(&r, 0.1, 3.0));
    const double l = RngBetween(&r, 0.01, 0.1), x = line.lower + l + (line.upper - line.lower - 2.0 * l) * RngUnit(&r);
    const double reach = BasisReach(BASIS_CPGIMP, &line, x, l), lo = x - reach, hi = x + reach;
    double       H[3], radius, sum = 0.0, u = 0.0, gradient = 0.0;
    Axis         a;

    BasisRadius(BASIS_CPGIMP, x, l, &line, &a, H, &radius);
    for (int k = 0; k < 3; k++) {
      double S = 0.0, N = 0.0;

      for (PetscInt i = -1; i <= CELLS; i++) {
        const double p = fmax(lo, line.x[i]), q = fmin(hi, line.x[i + 1]), mid = 0.5 * (p + q);

        if (!(q > p))
          continue;
        const double at[3] = {p, mid, q}, weight[3] = {1.0, 4.0, 1.0};
        for (int g = 0; g < 3; g++) {
          const double value = weight[g] * (q - p) / 6.0 * Hat(&line, a.base + k, at[g]);

          S += value * at[g];
          N += value;
        }
      }
      worst = fmax(worst, fabs(a.S[k] - S / (2.0 * reach * x)));
      hoop  = fmax(hoop, fabs(H[k] - N / (2.0 * reach * x)) * x);
      sum += a.S[k];
      u += H[k] * LinesAt(&line, a.base + k);
      gradient += a.dS[k] * LinesAt(&line, a.base + k);
    }
    slope = fmax(slope, fmax(fabs(u - 1.0), fmax(fabs(sum - 1.0), fabs(gradient - 1.0) * l / LinesWidthAt(&line, x))));
    Call(LinesDestroy(&line));
  }
  Say("about an axis: weights against the integral %.1e, hoop strain %.1e, of u_r = r %.1e\n", worst, hoop, slope);
  Check(worst < 1e-11 && hoop < 1e-11 && slope < 1e-11);
}

/* ---------------------------------------------------------------- places of particles */
/* They fill a region's box without overlap, end on lines inside it, and each knows its own width. */
static void TestPlaces(void **state)
{
  Rng    r    = {306};
  double fill = 0.0;

  (void)state;
  for (int n = 0; n < 500; n++) {
    Scene   c      = {.cells = {CELLS, 2}, .lower = {0.0, 0.0}, .upper = {0.0, 1.0}};
    Region  region = {.shape = SHAPE_BOX, .ppc = {1 + n % 3, 2}, .material = 0};
    Lattice lattice;
    double  end;

    c.line[0]       = RandomLines(&r, 0.0);
    c.upper[0]      = c.line[0].upper;
    c.nregion       = 1;
    c.region        = &region;
    region.lower[0] = n % 4 ? RngBetween(&r, 0.0, 0.4) * c.upper[0] : c.line[0].x[1];
    region.upper[0] = n % 4 ? RngBetween(&r, 0.6, 1.0) * c.upper[0] : c.line[0].x[6];
    region.upper[1] = 1.0;
    end             = region.lower[0];
    RegionLattice(&c, 0, &lattice);
    for (PetscInt i = 0; i < lattice.n[0]; i++) {
      const PetscInt ij[CL_DIM] = {i, 0};
      double         x[CL_DIM], l[CL_DIM];

      Check(RegionPlace(&c, 0, &lattice, ij, x));
      ParticlesInitialHalfLength(&c, 0, x, l);
      fill = fmax(fill, fabs(x[0] - l[0] - end) / c.upper[0]);
      end  = x[0] + l[0];
      Check(BasisReach(BASIS_UGIMP, &c.line[0], x[0], l[0]) >
            (i == 0 || i + 1 == lattice.n[0] ? 0.9 : 1.0 - 1e-12) * l[0]);
      Check((RegionFaces(&c, 0, &lattice, ij) & 3) == ((i == 0) | (i + 1 == lattice.n[0]) << 1));
    }
    fill = fmax(fill, fabs(end - region.upper[0]) / c.upper[0]);
    if (n % 4 == 0)
      Check(lattice.n[0] == 5 * region.ppc[0]);
    Call(LinesDestroy(&c.line[0]));
  }
  Say("gaps and overlaps of the particles of a box: %.1e of the axis\n", fill);
  Check(fill < 1e-15);
}

/* ---------------------------------------------------------------- the grid */
/* Cells and owners on all ranks; a linear field at the nodes. */
static void TestGrid(void **state)
{
  Rng       r = {307};
  GridLines line[CL_DIM];
  Grid      g;
  double    worst = 0.0;

  (void)state;
  for (int d = 0; d < CL_DIM; d++)
    line[d] = RandomLines(&r, d ? -1.0 : 2.0);
  Call(GridCreateOn(PETSC_COMM_WORLD, line, &g));
  for (int n = 0; n < 5000; n++) {
    double   x[CL_DIM], l[CL_DIM], value = 0.0;
    PetscInt cell[CL_DIM];
    Axis     a[CL_DIM];

    for (int d = 0; d < CL_DIM; d++) {
      l[d] = RngBetween(&r, 0.1, 0.25) * line[d].h;
      x[d] = line[d].lower + l[d] + (line[d].upper - line[d].lower - 2.0 * l[d]) * RngUnit(&r);
      BasisAxis(BASIS_CPGIMP, x[d], l[d], &g.line[d], &a[d]);
    }
    Check(GridCell(&g, x, cell));
    for (int d = 0; d < CL_DIM; d++)
      Check(x[d] >= GridNode(&g, d, cell[d]) && x[d] <= GridNode(&g, d, cell[d] + 1));
    for (int i = 0; i < 9; i++)
      value += a[0].S[i % 3] * a[1].S[i / 3] *
               (1.0 + 2.0 * GridNode(&g, 0, a[0].base + i % 3) - 3.0 * GridNode(&g, 1, a[1].base + i / 3));
    worst = fmax(worst, fabs(value - (1.0 + 2.0 * x[0] - 3.0 * x[1])));
    Check(GridHighest2At(&g, x) <= GridHighest2(&g) * (1.0 + 1e-14));
  }
  Say("a linear field at particles: %.1e\n", worst);
  Check(worst < 1e-11);
  Call(GridDestroy(&g));
  for (int d = 0; d < CL_DIM; d++)
    Call(LinesDestroy(&line[d]));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestLookUp), cmocka_unit_test(TestWeights),
                                     cmocka_unit_test(TestEqual),  cmocka_unit_test(TestReach),
                                     cmocka_unit_test(TestRadius), cmocka_unit_test(TestPlaces),
                                     cmocka_unit_test(TestGrid)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
