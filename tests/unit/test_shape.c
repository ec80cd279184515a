/* Tests of src/shape and of seeding such shapes: points in polygons, areas, surfaces, lines on them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>
#include "clathra/geometry.h"
#include "clathra/particles.h"
#include "clathra/shape.h"
#include "random.h"
#include "ranks.h"

#define Say(...) Call(PetscPrintf(PETSC_COMM_WORLD, __VA_ARGS__))

/* ---------------------------------------------------------------- points, segments, polygons */
/* A square cut by a bent line: every point, also on the line and its corners, lies on one side of it. */
static void TestPointInPolygon(void **state)
{
  const double lower[] = {0, 0, 4, 0, 4, 1, 2.5, 3, 1, 2, 0, 2}, upper[] = {0, 4, 0, 2, 1, 2, 2.5, 3, 4, 1, 4, 4};
  const double line[] = {0, 2, 1, 2, 2.5, 3, 4, 1};
  int          on     = 0;
  Rng          rng    = {11};

  (void)state;
  for (int j = 0; j < 64; j++) {
    for (int i = 0; i < 64; i++) { /* multiples of 1/16: exact, many on the line */
      const double x[2] = {i / 16.0, j / 16.0};

      Check(PolygonHolds(6, lower, x) != PolygonHolds(6, upper, x));
      Check(PolygonHolds(6, lower, x) == LineCovers(4, line, x));
      on += x[0] <= 1.0 ? x[1] == 2.0 : x[0] <= 2.5 ? 3.0 * (x[1] - 2.0) == 2.0 * (x[0] - 1.0) : false;
    }
  }
  Check(on >= 25);
  for (int k = 0; k < 10000; k++) {
    const double x[2] = {-1.0 + 6.0 * RngUnit(&rng), -1.0 + 6.0 * RngUnit(&rng)};
    const bool   in   = x[0] > 0.0 && x[0] < 4.0 && x[1] > 0.0 && x[1] < 4.0;

    Check((PolygonHolds(6, lower, x) || PolygonHolds(6, upper, x)) == in);
    Check(LineCovers(4, line, x) == (x[0] > 0.0 && x[0] < 4.0 && !PolygonHolds(6, upper, x) && x[1] < 4.0));
  }
}

static void TestCrossing(void **state)
{
  const struct {
    PetscInt n;
    double   x[16];
    bool     crosses;
  } polygon[] = {
      {3, {0, 0, 1, 0, 0, 1}, false},
      {4, {0, 0, 1, 0, 1, 1, 0, 1}, false},
      {5, {0, 0, 1, 0, 2, 0, 2, 2, 0, 2}, false},                /* a point within a side */
      {6, {0, 0, 2, 0, 2, 2, 1, 2, 1, 1, 0, 1}, false},          /* with a notch */
      {4, {0, 0, 1, 1, 1, 0, 0, 1}, true},                       /* a bow tie */
      {4, {0, 0, 2, 0, 1, 0, 1, 1}, true},                       /* runs back */
      {3, {0, 0, 1, 0, 2, 0}, true},                             /* flat */
      {5, {0, 0, 1, 0, 1, 1, 0, 1, 0, 0}, true},                 /* the first point again */
      {7, {0, 0, 2, 0, 2, 2, 1, 0, 0.5, 1, 0.2, 2, 0, 2}, true}, /* a corner touches a side */
      {7, {2, 2, 1, 0, 0.5, 1, 0.2, 2, 0, 2, 0, 0, 2, 0}, true}, /* the same, listed from there */
  };
  PetscInt pair[2];

  (void)state;
  for (size_t k = 0; k < sizeof polygon / sizeof *polygon; k++)
    Check(PolygonCrosses(polygon[k].n, polygon[k].x, pair) == polygon[k].crosses);
  Check(PolygonCrosses(polygon[4].n, polygon[4].x, pair) && pair[0] == 0 && pair[1] == 2);
}

static void TestSegments(void **state)
{
  const double a[] = {0, 0}, b[] = {2, 0}, c[] = {0.5, -1}, d[] = {0.5, 1}, e[] = {0.5, 0}, f[] = {3, 1};
  double       t;

  (void)state;
  Check(SegmentsMeet(a, b, c, d, &t) && fabs(t - 0.25) < 1e-15);
  Check(SegmentsMeet(a, b, e, d, &t) && SegmentsMeet(a, b, c, e, &t)); /* ends count */
  Check(!SegmentsMeet(a, b, d, f, &t) && !SegmentsMeet(a, b, e, b, &t) && !SegmentsMeet(e, f, c, a, &t));
}

/* ---------------------------------------------------------------- regions */
#define REGIONS 4
typedef struct {
  Scene    c;
  Material mat;
  Region   region[REGIONS];
  Grid     g;
} SmallScene;

/* `n` cells along each side of (-1.1, 1.3) x (-1.2, 1.4) m. */
static void SceneMake(SmallScene *s, PetscInt n, PetscInt nregion)
{
  memset(s, 0, sizeof *s);
  s->mat = (Material){.porosity = 0.3, .solid = {2600.0, INFINITY, 0.0, 0.0, 4.0}};
  s->c   = (Scene){.lower     = {-1.1, -1.2},
                   .upper     = {1.3, 1.4},
                   .cells     = {n, n},
                   .material  = &s->mat,
                   .region    = s->region,
                   .nmaterial = 1,
                   .nregion   = nregion};
  Check(FieldSetMake(HAS_SOLID, true, &s->c.fields));
  for (PetscInt k = 0; k < nregion; k++) {
    s->region[k] = (Region){.lower = {-INFINITY, -INFINITY}, .upper = {INFINITY, INFINITY}, .ppc = {2, 2}};
  }
}

static void SetCircle(SmallScene *s, PetscInt k, double x, double y, double radius)
{
  s->region[k].shape     = SHAPE_CIRCLE;
  s->region[k].circle[0] = x;
  s->region[k].circle[1] = y;
  s->region[k].circle[2] = radius;
  RegionBound(&s->c, &s->region[k]);
}

static void SetPoints(SmallScene *s, PetscInt k, ShapeKind shape, PetscInt n, double *x)
{
  s->region[k].shape                                                    = shape;
  *(shape == SHAPE_BELOW ? &s->region[k].below : &s->region[k].polygon) = (Points){n, x};
  RegionBound(&s->c, &s->region[k]);
}

/* Layers under a line, a polygon with a side on it (and a corner of its own there), a circle in both, a box beside:
   every point of the grid lies in exactly one, whatever the slopes; the corners of many cells lie on the lines. */
static void TestPartition(void **state)
{
  static PetscInt circle[] = {2};
  SmallScene      s;

  (void)state;
  for (int slope = -4; slope <= 4; slope++) {
    for (int dyadic = 0; dyadic < 2; dyadic++) {
      const double k      = dyadic ? slope / 4.0 : slope / 3.7;
      double       low[]  = {-1.1, 0.1 - 1.1 * k, 0.7, 0.1 + 0.7 * k};
      double       high[] = {-1.1, 1.4, -1.1, 0.1 - 1.1 * k, 0.1, 0.1 + 0.1 * k, 0.7, 0.1 + 0.7 * k, 0.7, 1.4};

      SceneMake(&s, 20, 4);
      SetCircle(&s, 2, 0.1, 0.1, 0.3);
      SetPoints(&s, 0, SHAPE_BELOW, 2, low);
      SetPoints(&s, 1, SHAPE_POLYGON, 5, high);
      s.region[3].lower[0] = 0.7;
      RegionBound(&s.c, &s.region[3]);
      s.region[0].minus = s.region[1].minus = (Names){1, circle};
      for (int j = 0; j <= 400; j++) {
        for (int i = 0; i <= 400; i++) {
          const double x[2] = {-1.1 + 2.4 * (i + 0.01) / 401.0, -1.2 + 2.6 * (j + 0.01) / 401.0};
          const double y[2] = {x[0], 0.1 + x[0] * k}; /* on the line */
          int          in = 0, on = 0;

          for (PetscInt r = 0; r < 4; r++) {
            in += RegionHolds(&s.c, r, x);
            on += RegionHolds(&s.c, r, y);
          }
          Check(in == 1 && (x[0] > 0.7 || on == 1));
        }
      }
    }
  }
}

/* Points of the boundary are reached, of any shape, and what is off it by more than the slack only from inside; the
   highest point along a direction. */
static void TestReach(void **state)
{
  static double wedge_line[] = {-0.8, -0.7, 0.9, -0.4, 1.1, 0.5}, triangle[] = {-0.8, -0.7, 0.9, -0.4, 0.2, 1.1};
  const double  slack[] = {1e-6, 1e-6}, up[] = {0.0, 1.0}, tilted[] = {0.6, 0.8};
  SmallScene    s;

  (void)state;
  SceneMake(&s, 24, 3);
  SetPoints(&s, 0, SHAPE_POLYGON, 3, triangle);
  SetPoints(&s, 1, SHAPE_BELOW, 3, wedge_line);
  SetCircle(&s, 2, 0.1, 0.2, 0.7);
  for (int k = 0; k < 3; k++) {
    const double *a = triangle + 2 * k, *b = triangle + 2 * ((k + 1) % 3), angle = 0.3 + k;

    for (int i = 0; i <= 10; i++) {
      const double t = i / 10.0, x[] = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
      const double out[] = {x[0] + 1e-3 * (b[1] - a[1]), x[1] - 1e-3 * (b[0] - a[0])};

      Check(RegionReaches(&s.c, 0, x, slack) && !RegionReaches(&s.c, 0, out, slack));
      Check(k || RegionReaches(&s.c, 1, x, slack)); /* the first side is also on the line */
    }
    const double on[]  = {0.1 + 0.7 * cos(angle), 0.2 + 0.7 * sin(angle)};
    const double off[] = {0.1 + 0.7001 * cos(angle), 0.2 + 0.7001 * sin(angle)};

    Check(RegionReaches(&s.c, 2, on, slack) && !RegionReaches(&s.c, 2, off, slack));
  }
  Check(fabs(RegionHighest(&s.region[0], up) - 1.1) < 1e-14 && fabs(RegionHighest(&s.region[0], tilted) - 1.0) < 1e-14);
  Check(fabs(RegionHighest(&s.region[1], up) - 0.5) < 1e-14 &&
        fabs(RegionHighest(&s.region[1], tilted) - 1.06) < 1e-14);
  Check(fabs(RegionHighest(&s.region[2], up) - 0.9) < 1e-14 &&
        fabs(RegionHighest(&s.region[2], tilted) - 0.92) < 1e-14);
  s.region[2].upper[1] = 0.5;
  Check(RegionHighest(&s.region[2], up) == 0.5);
}

typedef struct {
  double   volume, closed[CL_DIM], own, true_area;
  PetscInt n;
} Body;

/* Volume, vector sum and size of the surface of what is seeded, over all ranks. */
static void Measure(SmallScene *s, Body *body)
{
  double    sum[6] = {0}, n[CL_DIM];
  Particles P;

  Call(GridCreate(PETSC_COMM_WORLD, s->c.lower, s->c.upper, s->c.cells, &s->g));
  Call(ParticlesCreate(s->c.fields.has, &P));
  Call(ParticlesSeed(&s->c, &s->g, &P));
  for (PetscInt p = 0; p < P.n; p++) {
    sum[0] += P.f[P_V][p];
    for (int side = 0; side < SIDE_COUNT; side++) {
      const int    d = side / 2, sign = side % 2 ? 1 : -1;
      const double x[2] = {P.f[P_X][p], P.f[P_X + 1][p]}, radius = x[0] + (d == 0 ? sign * P.f[P_L][p] : 0.0);
      const double area = 2.0 * P.f[P_L + 1 - d][p] * (s->c.axisymmetric ? 2.0 * M_PI * radius : 1.0);

      if (!(P.i[PI_FACES][p] >> side & 1))
        continue;
      sum[1 + d] += sign * area;
      sum[3] += area;
      FaceNormal(&s->c, P.i[PI_REGION][p], x, side, n);
      Check(sign * n[d] > 0.0);
      sum[4] += area * hypot(n[0], n[1]);
    }
  }
  sum[5] = (double)P.n;
  Call(MPI_Allreduce(MPI_IN_PLACE, sum, 6, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  *body = (Body){sum[0], {sum[1], sum[2]}, sum[3], sum[4], (PetscInt)sum[5]};
  Call(ParticlesDestroy(&P));
  Call(GridDestroy(&s->g));
}

typedef void (*Build)(SmallScene *, PetscInt cells);

static void BuildCircle(SmallScene *s, PetscInt n)
{
  SceneMake(s, n, 1);
  SetCircle(s, 0, 0.06, 0.13, 0.9);
}
static void BuildRing(SmallScene *s, PetscInt n)
{
  static PetscInt hole[] = {1};

  SceneMake(s, n, 2);
  SetCircle(s, 0, 0.06, 0.13, 0.9);
  SetCircle(s, 1, 0.16, 0.03, 0.35);
  s->region[1].material = -1;
  s->region[0].minus    = (Names){1, hole};
}
static double wedge[] = {-0.8, -0.7, 0.9, -0.4, 1.1, 0.5, 0.2, 0.1, -0.3, 1.2};
static void   BuildPolygon(SmallScene *s, PetscInt n)
{
  SceneMake(s, n, 1);
  SetPoints(s, 0, SHAPE_POLYGON, 5, wedge);
}
/* Of two materials with particles of two sizes: no face between them. */
static void BuildLayers(SmallScene *s, PetscInt n)
{
  static double   low[] = {-1.0, -0.5, 0.2, -0.1, 1.2, 0.6}, high[] = {-1.0, 0.6, 1.2, 0.9};
  static PetscInt lower[] = {0};

  SceneMake(s, n, 2);
  s->region[0].lower[1] = s->region[1].lower[1] = -1.0;
  SetPoints(s, 0, SHAPE_BELOW, 3, low);
  SetPoints(s, 1, SHAPE_BELOW, 2, high);
  s->region[1].ppc[0] = s->region[1].ppc[1] = 3;
  s->region[1].minus                        = (Names){1, lower};
}
/* A ball: half a circle, cut at the axis. */
static void BuildBall(SmallScene *s, PetscInt n)
{
  SceneMake(s, n, 1);
  s->c.axisymmetric     = true;
  s->c.lower[0]         = 0.0;
  s->region[0].lower[0] = 0.0;
  SetCircle(s, 0, 0.0, 0.1, 1.0);
}

/* Volume and surface converge; the staircase is closed. */
static void TestMeasures(void **state)
{
  const double w[5] = {hypot(1.7, 0.3), hypot(0.2, 0.9), hypot(0.9, 0.4), hypot(0.5, 1.1), hypot(0.5, 1.9)};
  const struct {
    const char *name;
    Build       build;
    double      volume, surface;
  } body[] = {
      {"circle", BuildCircle, M_PI * 0.81, 2.0 * M_PI * 0.9},
      {"ring", BuildRing, M_PI * (0.81 - 0.35 * 0.35), 2.0 * M_PI * 1.25},
      {"polygon", BuildPolygon, 1.645, w[0] + w[1] + w[2] + w[3] + w[4]},
      {"layers", BuildLayers, 2.2 * 1.75, 2.2 + 1.6 + 1.9 + hypot(2.2, 0.3)},
      {"ball", BuildBall, 4.0 / 3.0 * M_PI, 4.0 * M_PI + 0.0},
  };
  const PetscInt cells[4] = {12, 24, 48, 96};

  (void)state;
  Say("body      cells  volume error  surface error (relative)  staircase/true\n");
  for (size_t k = 0; k < sizeof body / sizeof *body; k++) {
    double error[4][2];

    for (int level = 0; level < 4; level++) {
      SmallScene s;
      Body       b;

      body[k].build(&s, cells[level]);
      Measure(&s, &b);
      error[level][0] = b.volume / body[k].volume - 1.0;
      error[level][1] = b.true_area / body[k].surface - 1.0;
      Say("%-9s %5d  %12.2e  %13.2e  %28.4f\n", body[k].name, (int)cells[level], error[level][0], error[level][1],
          b.own / body[k].surface);
      Check(b.own > 1.02 * body[k].surface);          /* what FaceNormal is for */
      for (int d = s.c.axisymmetric; d < CL_DIM; d++) /* particles of two sizes do not tile where they meet */
        Check(fabs(b.closed[d]) < (s.region[1].ppc[0] == 3 ? 2.0 / (double)cells[level] : 1e-12 * b.own));
      for (int q = 0; q < 2; q++) /* of first order */
        Check(fabs(error[level][q]) < 0.8 / (double)cells[level]);
    }
  }
}

/* Every face of a body lies on one of the lines that bound it: on one, but for those at corners; a line a little off
   takes as much; one beside the body nothing. */
static void TestAlong(void **state)
{
  SmallScene s;
  Lattice    lattice;
  PetscInt   ij[CL_DIM], count = 0, twice = 0, off = 0;
  double     x[CL_DIM];

  (void)state;
  for (PetscInt n = 12; n <= 96; n *= 2) {
    BuildPolygon(&s, n);
    RegionLattice(&s.c, 0, &lattice);
    count = twice = off = 0;
    for (ij[1] = 0; ij[1] < lattice.n[1]; ij[1]++) {
      for (ij[0] = 0; ij[0] < lattice.n[0]; ij[0]++) {
        if (!RegionPlace(&s.c, 0, &lattice, ij, x))
          continue;
        for (int side = 0; side < SIDE_COUNT; side++) {
          int on = 0;

          for (int k = 0; k < 5; k++) {
            const double *a = wedge + 2 * k, *b = wedge + 2 * ((k + 1) % 5), nudge = 0.05 * lattice.spacing[0];
            double        line[2][4] = {{a[0], a[1], b[0], b[1]}, {a[0] + nudge, a[1], b[0] + nudge, b[1]}};
            const Meter   m[2]       = {{.side = SIDE_COUNT, .region = -1, .along = {2, line[0]}},
                                        {.side = SIDE_COUNT, .region = -1, .along = {2, line[1]}}};

            on += FaceNamed(&s.c, &m[0], 0, x, side);
            off += (RegionFaces(&s.c, 0, &lattice, ij) >> side & 1) && !FaceNamed(&s.c, &m[1], 0, x, side) &&
                   FaceNamed(&s.c, &m[0], 0, x, side);
          }
          if (!(RegionFaces(&s.c, 0, &lattice, ij) >> side & 1))
            continue;
          Check(on >= 1);
          count++;
          twice += on > 1;
        }
      }
    }
    Say("%3d cells: %4d faces, %2d on two lines, %2d not on a line that is shifted by 0.05 spacings\n", (int)n,
        (int)count, (int)twice, (int)off);
    Check(twice <= 5 && off <= 5);
  }
}

/* A line along a box's top takes the top, no side; side, from and to as ever. */
static void TestBoxFaces(void **state)
{
  double      top[] = {-0.5, 0.75, 0.5, 0.75};
  const Meter line  = {.side = SIDE_COUNT, .region = 0, .along = {2, top}};
  const Meter part  = {.side = SIDE_YMAX, .region = -1, .from = 0.0, .to = INFINITY};
  SmallScene  s;
  Lattice     lattice;
  PetscInt    ij[CL_DIM], taken[SIDE_COUNT] = {0}, right = 0, faces = 0;
  double      x[CL_DIM], n[CL_DIM];

  (void)state;
  SceneMake(&s, 24, 1);
  for (int d = 0; d < CL_DIM; d++) {
    s.region[0].lower[d] = d ? -0.5 : -0.5;
    s.region[0].upper[d] = d ? 0.75 : 0.5;
  }
  RegionLattice(&s.c, 0, &lattice);
  for (ij[1] = 0; ij[1] < lattice.n[1]; ij[1]++) {
    for (ij[0] = 0; ij[0] < lattice.n[0]; ij[0]++) {
      Check(RegionPlace(&s.c, 0, &lattice, ij, x));
      for (int side = 0; side < SIDE_COUNT; side++) {
        if (!(RegionFaces(&s.c, 0, &lattice, ij) >> side & 1))
          continue;
        FaceNormal(&s.c, 0, x, side, n);
        Check(n[side / 2] == (side % 2 ? 1.0 : -1.0) && n[1 - side / 2] == 0.0);
        taken[side] += FaceNamed(&s.c, &line, 0, x, side);
        right += FaceNamed(&s.c, &part, 0, x, side);
        faces++;
      }
    }
  }
  Check(faces == 2 * (lattice.n[0] + lattice.n[1]) && taken[SIDE_YMAX] == lattice.n[0]);
  Check(!taken[SIDE_XMIN] && !taken[SIDE_XMAX] && !taken[SIDE_YMIN] && right == lattice.n[0] / 2);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(TestPointInPolygon), cmocka_unit_test(TestCrossing), cmocka_unit_test(TestSegments),
      cmocka_unit_test(TestPartition),      cmocka_unit_test(TestMeasures), cmocka_unit_test(TestAlong),
      cmocka_unit_test(TestBoxFaces),       cmocka_unit_test(TestReach),
  };

  return RunTests(argc, argv, tests, NULL, NULL);
}
