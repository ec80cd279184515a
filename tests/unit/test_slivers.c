/* The storage (351) of changes of pressure at surfaces that cut cells: its weight, what it must not change, and what it
   is for: a sliver's pressure stays bounded, and a jump of pressure inside is not continued beside sediment that fills
   its cells. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <math.h>
#include <cmocka.h>
#include "tied_scene.h"
#include "model/additions.h"
#include "model/gather.h"

#define NODES ((N + 1) * (N + 1))

/* ---------------------------------------------------------------- the weight */
/* Weight of every line, W[axis][y][x] of its middle node, over that of a full cell: g_s = 1 ties like V_I rho s. */
static void Weights(SmallScene *s, double W[CL_DIM][N + 1][N + 1])
{
  const Model *m = &s->m;

  memset(W, 0, CL_DIM * NODES * sizeof(double));
  for (PetscInt k = 0; k < m->added->nghost; k++) {
    const GhostLine *g = &m->added->ghost[k];
    const PetscInt   I = g->node[1], *lo = m->map.ij[g->node[0]], *ij = m->map.ij[I];
    const double    *c = &m->coef[I * NC_COUNT];

    W[ij[0] == lo[0]][ij[1]][ij[0]] += g->store[PHASE_W] / (NodeVolume(m, I) * c[NC_RHO] * c[NC_STORAGE]);
  }
  Call(MPI_Allreduce(MPI_IN_PLACE, W, CL_DIM * NODES, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
}

static void WeightsOf(const double lower[2], const double upper[2], double W[CL_DIM][N + 1][N + 1])
{
  SmallScene *s = TiedScene(HAS_WATER, false, BASIS_CPGIMP, 2, lower, upper);

  StageStart(s, 1.0);
  Weights(s, W);
  TiedFree(s);
}

/* From wall to wall, the last of three rows filled to f: nodes f^2/2, 1/2 + f - f^2/2 and 1, half of that at the walls.
   One line of each column is tied, along the normal. */
static void TestFilled(void **state)
{
  static const double f[5] = {0.05, 0.3, 0.6, 0.95, 1.0}, lower[2] = {0.0, 0.0};
  static double       W[CL_DIM][N + 1][N + 1];

  (void)state;
  for (int k = 0; k < 10; k++) {
    const int    up   = k < 5;
    const double fill = f[k % 5], side = (2.0 + fill) * H;
    const double upper[2] = {up ? N * H : side, up ? side : N * H};
    double       off = 0.0, tied = 0.0;

    WeightsOf(lower, upper, W);
    for (int i = 0; i <= N; i++) {
      for (int j = 0; j <= N; j++) {
        const double wall = i == 0 || i == N ? 0.5 : 1.0,
                     want =
                         j == 2 ? STORAGE_SHARE * wall * 0.5 * fill * fill * fmax(1.0 - 2.0 * fill * fill, 0.0) : 0.0;

        off = fmax(off, fabs((up ? W[1][j][i] : W[0][i][j]) - want));
        off = fmax(off, fabs(up ? W[0][j][i] : W[1][i][j])); /* along the surface */
        tied += want;
      }
    }
    Say("cells filled to %.2f along %c: weights off by %.1e of a sum of %.1e\n", fill, up ? 'y' : 'x', off, tied);
    Check(off < 1e-13 && (tied > 0.0) == (fill < 0.7));
  }
}

static double Apart(double A[CL_DIM][N + 1][N + 1], double B[CL_DIM][N + 1][N + 1], bool swapped, bool mirrored)
{
  double off = 0.0;

  for (int d = 0; d < CL_DIM; d++) {
    for (int j = 0; j <= N; j++) {
      for (int i = 0; i <= N; i++) {
        const int to = mirrored ? N - i : i;

        off = fmax(off, fabs(A[d][j][i] - (swapped ? B[1 - d][to][j] : B[d][j][to])));
      }
    }
  }
  return off;
}

static const double block[2][2] = {{0.117, 0.134}, {0.408, 0.356}};

/* Largest change of a weight from one to the next of so many places of the block, up to 1.1 cells along x, 0.8 along y;
 * most: the largest weight. */
static double LargestJump(int parts, double *most)
{
  static double A[CL_DIM][N + 1][N + 1], B[CL_DIM][N + 1][N + 1];
  double        jump = 0.0;

  *most = 0.0;
  for (int k = 0; k <= parts; k++) {
    const double by[2]    = {1.1 * k / parts * H, 0.8 * k / parts * H},
                 lower[2] = {block[0][0] + by[0], block[0][1] + by[1]},
                 upper[2] = {block[1][0] + by[0], block[1][1] + by[1]};

    WeightsOf(lower, upper, B);
    for (int i = 0; i < CL_DIM * NODES; i++)
      *most = fmax(*most, (&B[0][0][0])[i]);
    jump = fmax(jump, k ? Apart(A, B, false, false) : 0.0);
    memcpy(A, B, sizeof(A));
  }
  return jump;
}

/* A block between the lines of the grid: mirrored, with axes swapped, moved by a cell the weights are the same; as it
   moves they change without jumps, also where cells and nodes come and go. */
static void TestPlace(void **state)
{
  const double *lo = block[0], *hi = block[1], swap[2][2] = {{lo[1], lo[0]}, {hi[1], hi[0]}},
               mirror[2][2] = {{N * H - hi[0], lo[1]}, {N * H - lo[0], hi[1]}},
               shift[2][2]  = {{lo[0] + H, lo[1] + H}, {hi[0] + H, hi[1] + H}};
  static double A[CL_DIM][N + 1][N + 1], B[CL_DIM][N + 1][N + 1];
  double        moved = 0.0, most;

  (void)state;
  WeightsOf(lo, hi, A);
  WeightsOf(mirror[0], mirror[1], B);
  const double mirrored = Apart(A, B, false, true);
  WeightsOf(swap[0], swap[1], B);
  const double swapped = Apart(A, B, true, false);
  WeightsOf(shift[0], shift[1], B);
  for (int k = 0; k < CL_DIM * N * N; k++)
    moved = fmax(moved, fabs(A[k / N / N][k / N % N][k % N] - B[k / N / N][k / N % N + 1][k % N + 1]));
  const double coarse = LargestJump(100, &most), fine = LargestJump(400, &most);
  Say("weights: mirrored %.1e, axes swapped %.1e, a cell on %.1e; moved in 100 parts by up to %.1e of %.1e, in 400 "
      "%.1e\n",
      mirrored, swapped, moved, coarse, most, fine);
  Check(mirrored < 1e-13 && swapped < 1e-13 && moved < 1e-13);
  Check(most > 0.01 * STORAGE_SHARE && fine < 0.3 * coarse);
}

/* ---------------------------------------------------------------- what it must not change */
static void TestRows(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    SmallScene *s = TiedScene(HAS_ALL, k, BASIS_CPGIMP, 2, block[0], block[1]);
    double      constant, linear, random;

    RandomHistory(s, 0.2);
    RandomStage(s, 20.0);
    s->m.added->ncell = 0; /* (23) */
    const double none = TiedRows(s, CONSTANT, &constant), bent = TiedRows(s, LINEAR, &linear),
                 any = TiedRows(s, RANDOM, &random);
    Say("rows of the tie, %s: of a constant change %.1e, of a linear one %.1e, of any their sum %.1e\n",
        k ? "about an axis" : "plane", none / any, bent / any, fabs(random));
    Check(any > 0.0 && none < 1e-9 * any && bent < 1e-9 * any && fabs(random) < 1e-14);
    TiedFree(s);
  }
}

/* ---------------------------------------------------------------- what it is for */
/* Sealed columns of water of three full rows of cells and one filled to f: what is stored in the outermost particles,
   or in those of the two lowest rows, grows by what makes 0.1 MPa there.  Largest changes of pressure over 0.1 MPa: of
   nodes, of particles up and down. */
typedef struct {
  double node, up, down;
} Change;

static Change Sealed(double f, bool outermost, bool held)
{
  const double lower[2] = {0.0, 0.0}, upper[2] = {N * H, (3.0 + f) * H}, made = 1e5;
  SmallScene  *s = TiedScene(HAS_WATER, false, BASIS_CPGIMP, 2, lower, upper);
  Model       *m = &s->m;
  Change       c = {0.0, 0.0, 0.0};
  double      *x;
  PetscInt     newton;
  ClStatus     status;

  StageStart(s, 1.0);
  for (PetscInt p = 0; p < m->P.n; p++) {
    const double y = m->P.f[P_X + 1][p], edge = y + m->P.f[P_L + 1][p];

    if (outermost ? edge > upper[1] - 1e-9 : edge < 2.0 * H + 1e-9)
      s->stage.m_star[3 * p + 1] *= 1.0 + made / s->mat.water.K;
  }
  if (!held)
    m->added->nghost = 0;
  Call(ModelBeginStage(m, &s->stage));
  Call(PetscMalloc1(m->map.n_local * m->c->fields.n, &x));
  Call(PetscArraycpy(x, m->x_n, m->map.n_local * m->c->fields.n));
  Call(ModelSolve(m, x, &newton, &status));
  Check(status == CL_OK);
  const int n = m->c->fields.n, at = PlaceP(&m->c->fields, PHASE_W);
  for (PetscInt I = 0; I < m->map.n_local; I++)
    c.node = fmax(c.node, fabs(x[I * n + at] - m->x_n[I * n + at]) / made);
  for (PetscInt p = 0; p < m->P.n; p++) {
    Reach  r;
    double dp = 0.0;

    ReachExpand(m, p, &r);
    for (int a = 0; a < r.n; a++)
      dp += r.S[a] * (x[r.node[a] * n + at] - m->x_n[r.node[a] * n + at]) / made;
    c.up   = fmax(c.up, dp);
    c.down = fmin(c.down, dp);
  }
  Call(PetscFree(x));
  TiedFree(s);
  return (Change){Largest(c.node), Largest(c.up), -Largest(-c.down)};
}

static void TestSealed(void **state)
{
  static const double filled[6] = {0.02, 0.1, 0.3, 0.6, 0.9, 1.0};

  (void)state;
  Say("sealed columns, the last row of cells filled to f: made in the outermost particles, the largest change at a "
      "node "
      "without and with the tie;\nmade up to a full row below: particles up and down without and with it\n");
  for (int k = 0; k < 6; k++) {
    const double f    = filled[k];
    const Change bare = Sealed(f, true, false), tied = Sealed(f, true, true), before = Sealed(f, false, false),
                 after = Sealed(f, false, true);

    Say("  %.2f: %.2f %.2f; %.3f %.3f, %.3f %.3f\n", f, bare.node, tied.node, before.up, before.down, after.up,
        after.down);
    Check(f < 0.7 ? tied.node < 1.0 / STORAGE_SHARE
                  : tied.node == bare.node && after.down == before.down && after.up == before.up);
    Check(f > 0.35 || bare.node > 3.0 * tied.node); /* without it 2/f */
    Check(after.down > before.down - 0.02);         /* 0.1 V_I rho s whatever the cells hold: by 0.09 */
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestFilled), cmocka_unit_test(TestPlace),
                                     cmocka_unit_test(TestRows), cmocka_unit_test(TestSealed)};

  return RunTests(argc, argv, tests, SolveWell, NULL);
}
