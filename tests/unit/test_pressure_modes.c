/* The storage (417) of changes of pressure that particles do not see: where it is and where not, what it must not
   change, and what it is for: nodes beside a single row of particles stay where these are. */
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

#define SIZE (N + 1)

/* ---------------------------------------------------------------- where it is */
typedef double Ties[CL_DIM][SIZE][SIZE];

/* Of every pair of neighbours, W[axis][y][x] of the lower one: the tie over g_s h^2 rho s. */
static void TiesOf(int ppc, const double lower[2], const double upper[2], Ties W)
{
  SmallScene  *s = TiedScene(HAS_WATER, false, BASIS_CPGIMP, ppc, lower, upper);
  const Model *m = &s->m;

  StageStart(s, 1.0);
  memset(W, 0, sizeof(Ties));
  for (PetscInt k = 0; k < m->added->nghost; k++) {
    const GhostLine *g  = &m->added->ghost[k];
    const PetscInt  *ij = m->map.ij[g->node[0]], *to = m->map.ij[g->node[1]];

    if (g->node[1] == g->node[2])
      W[to[0] == ij[0]][ij[1]][ij[0]] +=
          g->store[PHASE_W] / (STORAGE_SHARE * H * H * 0.5 * (StoredAt(m, g->node[0], 0) + StoredAt(m, g->node[1], 0)));
  }
  Call(MPI_Allreduce(MPI_IN_PLACE, W, CL_DIM * SIZE * SIZE, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  TiedFree(s);
}

static double Most(Ties W, int d)
{
  double most = 0.0;

  for (int k = 0; k < SIZE * SIZE; k++)
    most = fmax(most, W[d][k / SIZE][k % SIZE]);
  return most;
}

/* A row of particles through all cells along x (or y), its middle a share `at` of a cell above a line. Inside the grid
   a node sees four of them, of a quarter of a cell, with S = 1/4, 3/4, 3/4, 1/4 along the row. */
static void TestRow(void **state)
{
  static Ties W;

  (void)state;
  for (int k = 0; k < 6; k++) {
    const double at = 0.25 + 0.1 * (k % 3), middle = (2.0 + at) * H, l = 0.25 * H;
    const int    up       = k / 3;
    const double lower[2] = {up ? middle - l : 0.0, up ? 0.0 : middle - l},
                 upper[2] = {up ? middle + l : N * H, up ? N * H : middle + l};
    const double along = 0.25 * (2.0 * 0.0625 + 2.0 * 0.5625), A = along * PetscSqr(1.0 - at), B = along * PetscSqr(at);
    double       off = 0.0;

    TiesOf(2, lower, upper, W);
    for (int i = 0; i < N + 1; i++) {
      const double wall = i == 0 || i == N ? 0.5 : 1.0, want = wall * A * B / (A + B);

      for (int j = 0; j < N; j++)
        off = fmax(off, fabs((up ? W[0][i][j] : W[1][j][i]) - (j == 2 ? want : 0.0)));
    }
    Say("a row of particles along %c, %.2f of a cell above a line: ties across it off by %.1e of %.1e, along it %.1e\n",
        up ? 'y' : 'x', at, off, A * B / (A + B), Most(W, up));
    Check(off < 1e-13 && Most(W, up) == 0.0);
  }
}

/* Bodies that fill cells, wherever lines and surfaces are, with two and three particles a cell: nothing. */
static void TestFilled(void **state)
{
  static Ties W;
  double      most = 0.0;

  (void)state;
  for (int ppc = 2; ppc <= 3; ppc++) {
    for (int k = 0; k < 40; k++) {
      const double by = k / 40.0 * H, lower[2] = {0.3 * H + by, 0.7 * H + 0.6 * by},
                   upper[2] = {3.4 * H + 1.7 * by, 4.1 * H + 0.8 * by};

      TiesOf(ppc, lower, upper, W);
      most = fmax(most, fmax(Most(W, 0), Most(W, 1)));
    }
  }
  Say("filled cells, 40 places, 2 and 3 particles across: largest tie %.1e\n", most);
  Check(most == 0.0);
}

/* Ties between the two nodes of the middle column of a body of two rows, the upper one moved to `apart` of a cell above
   the lower one. */
static double TieOfTwo(double apart)
{
  const double     lower[2] = {0.0, 2.05 * H}, upper[2] = {N * H, 3.05 * H};
  SmallScene      *s   = TiedScene(HAS_WATER, false, BASIS_CPGIMP, 2, lower, upper);
  const Particles *P   = &s->m.P;
  double           tie = 0.0;

  for (PetscInt p = 0; p < P->n; p++) {
    if (P->f[P_X + 1][p] > 2.55 * H)
      P->f[P_X + 1][p] += (apart - 0.5) * H;
  }
  StageStart(s, 1.0);
  for (PetscInt k = 0; k < s->m.added->nghost; k++) {
    const GhostLine *g  = &s->m.added->ghost[k];
    const PetscInt  *ij = s->m.map.ij[g->node[0]];

    if (g->node[1] == g->node[2] && ij[0] == 3 && ij[1] == 2)
      tie += g->store[PHASE_W];
  }
  TiedFree(s);
  return Sum(tie);
}

/* Two rows that part: the tie fades without a jump. */
static void TestFades(void **state)
{
  const double first = TieOfTwo(0.0), last = TieOfTwo(0.5);
  double       jump[2] = {0.0, 0.0};

  (void)state;
  for (int fine = 0; fine < 2; fine++) {
    const int parts = fine ? 200 : 50;

    for (int k = 1; k <= parts; k++)
      jump[fine] = fmax(jump[fine], fabs(TieOfTwo(0.5 * k / parts) - TieOfTwo(0.5 * (k - 1) / parts)) / first);
  }
  Say("two rows that part: the tie ends at %.1e of the first, in 50 parts by up to %.2f, in 200 %.3f\n", last / first,
      jump[0], jump[1]);
  Check(first > 0.0 && last == 0.0 && jump[1] < 0.3 * jump[0]);
}

/* ---------------------------------------------------------------- what it must not change */
static const double row[2][2] = {{0.117, 0.234}, {0.408, 0.284}};

static void TestRows(void **state)
{
  SmallScene *s = TiedScene(HAS_ALL, false, BASIS_CPGIMP, 2, row[0], row[1]);
  double      constant, sum;

  (void)state;
  RandomHistory(s, 0.2);
  RandomStage(s, 20.0);
  s->m.added->ncell = 0; /* (23) */
  const double none = TiedRows(s, CONSTANT, &constant), any = TiedRows(s, RANDOM, &sum);
  Say("rows of the tie: of a constant change %.1e, of any their sum %.1e\n", none / any, fabs(sum));
  Check(any > 0.0 && none < 1e-9 * any && fabs(sum) < 1e-14);
  TiedFree(s);
}

/* ---------------------------------------------------------------- what it is for */
/* A sealed row of particles at unlike heights: what is stored in them grows by what makes 0.1 MPa, and Newton's method
   starts from nodes that are up to 1 MPa off. Largest change of a node's pressure over 0.1 MPa; apart: of a particle's,
   from 1. */
static double Sealed(bool held, double *apart)
{
  SmallScene  *s = TiedScene(HAS_WATER, false, BASIS_CPGIMP, 2, row[0], row[1]);
  Model       *m = &s->m;
  const int    n = m->c->fields.n, at = PlaceP(&m->c->fields, PHASE_W);
  const double made = 1e5;
  double      *x, most = 0.0;
  PetscInt     newton;
  ClStatus     status;

  for (PetscInt p = 0; p < m->P.n; p++)
    m->P.f[P_X + 1][p] += 0.03 * H * Noise(4, m->P.i[PI_ID][p], 0);
  StageStart(s, 1.0);
  for (PetscInt p = 0; p < m->P.n; p++)
    s->stage.m_star[3 * p + 1] *= 1.0 + made / s->mat.water.K;
  if (!held)
    m->added->nghost = 0;
  Call(ModelBeginStage(m, &s->stage));
  Call(PetscMalloc1(m->map.n_local * n, &x));
  Call(PetscArraycpy(x, m->x_n, m->map.n_local * n));
  for (PetscInt I = 0; I < m->map.n_local; I++)
    x[I * n + at] += 1e6 * Noise(5, m->map.ij[I][0] + 100 * m->map.ij[I][1], 0);
  Call(ModelSolve(m, x, &newton, &status));
  for (PetscInt I = 0; I < m->map.n_owned; I++)
    most = fmax(most, status == CL_OK ? fabs(x[I * n + at] - m->x_n[I * n + at]) / made : INFINITY);
  *apart = 0.0;
  for (PetscInt p = 0; p < m->P.n; p++) {
    Reach  r;
    double dp = 0.0;

    ReachExpand(m, p, &r);
    for (int a = 0; a < r.n; a++)
      dp += r.S[a] * (x[r.node[a] * n + at] - m->x_n[r.node[a] * n + at]) / made;
    *apart = fmax(*apart, fabs(dp - 1.0));
  }
  *apart = Largest(*apart);
  Call(PetscFree(x));
  TiedFree(s);
  return Largest(most);
}

/* LU of the whole leaves what no particle sees as it finds it; that of the reduced matrix happens to take it away. */
static void TestSealed(void **state)
{
  static const char *const matrix[] = {"whole", "reduced"};

  (void)state;
  for (int k = 0; k < 2; k++) {
    double bare_apart, apart;

    Call(PetscOptionsSetValue(NULL, "-newton_preconditioner", matrix[k]));
    const double bare = Sealed(false, &bare_apart), tied = Sealed(true, &apart);

    Say("a sealed row, LU of the %s matrix: nodes change by %.3g without and %.3f with the tie of what particles do, "
        "particles off by %.1e and %.1e\n",
        matrix[k], bare, tied, bare_apart, apart);
    Check((bare > 3.0 || k == 1) && tied < 1.1 && apart < 0.01);
  }
  Call(PetscOptionsClearValue(NULL, "-newton_preconditioner"));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestRow), cmocka_unit_test(TestFilled),
                                     cmocka_unit_test(TestFades), cmocka_unit_test(TestRows),
                                     cmocka_unit_test(TestSealed)};

  return RunTests(argc, argv, tests, SolveWell, NULL);
}
