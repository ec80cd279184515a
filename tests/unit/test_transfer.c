/* Velocities carried to nodes (451) and what nodes do not see (452) on a body that is turned, sheared and shifted
 * against its grid. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <math.h>
#include <cmocka.h>
#include "small_scene.h"
#include "clathra/transfer.h"

static const double middle[2] = {0.3, 0.16}, turn = 0.3; /* rad */

/* Velocity of a phase at a place, m/s. */
typedef double Motion(const double x[CL_DIM], PetscInt id, int phase, int d);

static double Uniform(const double x[CL_DIM], PetscInt id, int phase, int d)
{
  (void)x;
  (void)id;
  return 2.0 + phase - 3.0 * d;
}

static double Linear(const double x[CL_DIM], PetscInt id, int phase, int d)
{
  (void)id;
  return (1.0 + phase) * (3.0 * x[0] - 5.0 * x[1] + 2.0 * x[CL_DIM - 1] + d);
}

static double Uneven(const double x[CL_DIM], PetscInt id, int phase, int d)
{
  (void)x;
  return Noise(3 + d, id, phase);
}

/* With the body as it lies, turned and sheared by a fifth or not. */
static SmallScene *Make(bool turned, bool axisymmetric, BasisType basis)
{
  const double lower[2] = {0.11, 0.08}, upper[2] = {0.47, 0.24};
  SmallScene  *s = malloc(sizeof(*s));
  ClStatus     status;

  SceneInit(s, HAS_ALL, true, axisymmetric, basis, 0.0, lower, upper);
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
  for (PetscInt p = 0; turned && p < s->m.P.n; p++) {
    double *const *f = s->m.P.f;
    const double   X = 0.5 * (f[P_X][p] - middle[0] + 0.2 * (f[P_X + 1][p] - middle[1])),
                 Y   = 0.5 * (f[P_X + 1][p] - middle[1]);

    f[P_X][p]     = middle[0] + cos(turn) * X - sin(turn) * Y;
    f[P_X + 1][p] = middle[1] + sin(turn) * X + cos(turn) * Y;
  }
  Call(ModelBeginStep(&s->m, &status));
  Check(status == CL_OK);
  return s;
}

static Transfer Of(SmallScene *s)
{
  return (Transfer){.grid = &s->m.grid, .map = &s->m.map, .n = s->m.P.n, .stencil = s->m.stencil};
}

static double Mass(const SmallScene *s, PetscInt p, int phase)
{
  double *const *f = s->m.P.f;

  return phase ? f[P_MS + 1 + phase][p] : f[P_MS][p] + f[P_MH][p];
}

static void Give(SmallScene *s, Motion *v)
{
  for (PetscInt p = 0; p < s->m.P.n; p++) {
    double x[CL_DIM];

    ParticleCentroid(&s->m.grid, &s->m.P, p, &s->m.stencil[p], x);
    for (int phase = 0; phase <= PHASE_COUNT; phase++) {
      for (int d = 0; d < CL_DIM; d++)
        s->m.P.f[VectorAt(P_VS, phase, d)][p] = v(x, s->m.P.i[PI_ID][p], phase, d);
    }
  }
}

/* Momentum along each axis, twice the kinetic energy. */
static void Sums(SmallScene *s, double sum[CL_DIM + 1])
{
  for (int k = 0; k <= CL_DIM; k++)
    sum[k] = 0.0;
  for (PetscInt p = 0; p < s->m.P.n; p++) {
    for (int phase = 0; phase <= PHASE_COUNT; phase++) {
      for (int d = 0; d < CL_DIM; d++) {
        const double v = s->m.P.f[VectorAt(P_VS, phase, d)][p];

        sum[d] += Mass(s, p, phase) * v;
        sum[CL_DIM] += Mass(s, p, phase) * v * v;
      }
    }
  }
  for (int k = 0; k <= CL_DIM; k++)
    sum[k] = Sum(sum[k]);
}

/* Largest change of any velocity of phase 0, and of any phase against it, by (452) in full. */
static void Change(SmallScene *s, double share, double change[2])
{
  const PetscInt n = s->m.P.n;
  const Transfer t = Of(s);
  double        *before;

  Call(PetscMalloc1(P_COUNT * n, &before));
  for (int k = P_VS; k < P_VS + 3 * CL_DIM; k++)
    memcpy(&before[k * n], s->m.P.f[k], (size_t)n * sizeof(double));
  Call(TransferUnseen(&t, &s->c.scene.fields, share, &s->m.P));
  change[0] = change[1] = 0.0;
  for (PetscInt p = 0; p < n; p++) {
    for (int d = 0; d < CL_DIM; d++) {
      const double own = s->m.P.f[P_VS + d][p] - before[(P_VS + d) * n + p];

      change[0] = fmax(change[0], fabs(own));
      for (int phase = 1; phase <= PHASE_COUNT; phase++) {
        const int k = VectorAt(P_VS, phase, d);

        change[1] = fmax(change[1], fabs(s->m.P.f[k][p] - before[k * n + p] - own));
      }
    }
  }
  change[0] = Largest(change[0]);
  change[1] = Largest(change[1]);
  Call(PetscFree(before));
}

static void TestUnseen(void **state)
{
  (void)state;
  for (int k = 0; k < 6; k++) {
    SmallScene *s = Make(k % 2, CL_DIM == 2 && k / 2 == 1, k / 2 == 2 ? BASIS_UGIMP : BASIS_CPGIMP);
    double      before[CL_DIM + 1], after[CL_DIM + 1], again[CL_DIM + 1], change[2], momentum = 0.0;

    Give(s, Uniform);
    Change(s, 1.0, change);
    assert_true(change[0] < 1e-13 && change[1] < 1e-13);
    Give(s, Linear);
    Change(s, 1.0, change);
    const double linear = change[0];
    Give(s, Uneven);
    Sums(s, before);
    Change(s, 0.5, change);
    Sums(s, after);
    Change(s, 1.0, change);
    Sums(s, again);
    for (int d = 0; d < CL_DIM; d++)
      momentum = fmax(momentum, fabs(again[d] - before[d]));
    momentum /= before[CL_DIM]; /* speeds of about 1 m/s */
    Say("unseen motion, %s%s: linear motion changes by %.1e; of noise the energy is %.3f after half of it is taken, "
        "%.3f after all, momentum is off by %.1e\n",
        basis_name[s->c.scene.basis], k % 2 ? ", turned" : "", linear, after[CL_DIM] / before[CL_DIM],
        again[CL_DIM] / before[CL_DIM], momentum);
    assert_true(change[1] < 1e-13 && change[0] > 0.1 && momentum < 1e-12 && linear < 1e-3);
    assert_true(again[CL_DIM] < after[CL_DIM] && after[CL_DIM] < before[CL_DIM]);
    SceneDestroy(s);
    free(s);
  }
}

/* Nodes have the velocity of a motion that is linear, to the body's rim and at walls, and what fills it without a
   gradient has its mean there (451). */
static void TestCarried(void **state)
{
  (void)state;
  for (int k = 0; k < 6; k++) {
    SmallScene     *s     = Make(k % 2, CL_DIM == 2 && k / 2 == 1, k / 2 == 2 ? BASIS_UGIMP : BASIS_CPGIMP);
    const Model    *m     = &s->m;
    const FieldSet *fs    = &s->c.scene.fields;
    double          worst = 0.0, momentum[CL_DIM + 1], seen[CL_DIM] = {0.0};
    ClStatus        status;

    Give(s, Linear);
    for (PetscInt p = 0; p < m->P.n; p++) {
      for (int i = 0; i < CL_DIM; i++) {
        for (int phase = 1; phase <= PHASE_COUNT; phase++)
          m->P.f[VectorAt(P_VS, phase, i)][p] = m->P.f[P_VS + i][p];
        m->P.f[VectorAt(P_GV, i, 0)][p] = 3.0;
        m->P.f[VectorAt(P_GV, i, 1)][p] = -5.0;
        m->P.f[VectorAt(P_GV, i, CL_DIM - 1)][p] += 2.0;
      }
    }
    Call(ModelBeginStep(&s->m, &status));
    Check(status == CL_OK);
    for (PetscInt I = 0; I < m->map.n_local; I++) {
      double x[CL_DIM];

      for (int d = 0; d < CL_DIM; d++)
        x[d] = GridNode(&m->grid, d, m->map.ij[I][d]);
      for (int q = 0; q < 3 * CL_DIM; q++)
        worst = fmax(worst, fabs(ModelStart(m)[I * fs->n + fs->at[F_VS + q]] - Linear(x, 0, 0, q % CL_DIM)));
    }
    worst = Largest(worst);
    Sums(s, momentum);
    for (PetscInt p = 0; p < m->P.n; p++) {
      Reach r;

      ReachExpand(m, p, &r);
      for (int a = 0; a < r.n; a++) {
        for (int q = 0; q < 3 * CL_DIM; q++)
          seen[q % CL_DIM] += Mass(s, p, q / CL_DIM) * r.S[a] * ModelStart(m)[r.node[a] * fs->n + fs->at[F_VS + q]];
      }
    }
    for (int d = 0; d < CL_DIM; d++)
      worst = fmax(worst, fabs(Sum(seen[d]) - momentum[d]) / fabs(momentum[CL_DIM]));
    Say("linear motion, %s%s: off at any node, and in momentum, by %.1e\n", basis_name[s->c.scene.basis],
        k % 2 ? ", turned" : "", worst);
    assert_true(worst < 1e-12);
    SceneDestroy(s);
    free(s);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestUnseen), cmocka_unit_test(TestCarried)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
