/* A body on a grid of 6 x 6 cells of 0.1 m, undrained, for the storage that changes of pressure are given where cells
   are slivers (351) and where particles do not see them (417): no ghost penalty acts. */
#pragma once

#include "small_scene.h"

#define H 0.1 /* m, cells */
#define N 6   /* cells along an axis */

static inline SmallScene *TiedScene(unsigned has, bool axisymmetric, BasisType basis, int ppc, const double lower[2],
                                    const double upper[2])
{
  SmallScene *s = malloc(sizeof(*s));

  SceneInit(s, has, false, axisymmetric, basis, 0.0, lower, upper);
  s->c.scene.upper[1]                    = N * H;
  s->c.scene.cells[1]                    = N;
  s->c.scene.stabilisation.ghost_penalty = 0.0;
  s->region.ppc[0] = s->region.ppc[1] = ppc;
  s->mat.reacts                       = false;
  s->mat.permeability.k0              = 1e-30; /* m^2: undrained */
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
  return s;
}

static inline void TiedFree(SmallScene *s)
{
  SceneDestroy(s);
  free(s);
}

/* Sum of the rows of both fluids over that of their sizes, and the largest row; of a change of the given kind. */
enum { CONSTANT = 0, LINEAR, RANDOM };
static inline double TiedRows(SmallScene *s, int kind, double *sum)
{
  Model          *m  = &s->m;
  const FieldSet *fs = &m->c->fields;
  double         *x, *f, worst = 0.0, size = 0.0;

  Call(PetscMalloc1(m->map.n_local * fs->n, &x));
  Call(PetscCalloc1(m->map.n_local * fs->n, &f));
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    const PetscInt *ij = m->map.ij[I];

    for (int k = 0; k < fs->n; k++) {
      const double by = kind == CONSTANT ? 1.0
                        : kind == LINEAR ? 0.3 * (double)ij[0] - 0.2 * (double)ij[1]
                                         : Noise(3, ij[0] + 100 * ij[1], k);

      x[I * fs->n + k] = m->stage.x_star[I * fs->n + k] + 1e5 * by;
    }
  }
  StabilisationResidual(m, x, false, f);
  Call(NodeMapReduce(&m->map, f, fs->n));
  *sum = 0.0;
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int q = 0; q < PHASE_COUNT; q++) {
      const double a = f[I * fs->n + PlaceP(fs, q)];

      *sum += a;
      size += fabs(a);
      worst = fmax(worst, fabs(a));
    }
  }
  *sum = Sum(*sum) / fmax(Sum(size), 1e-300);
  Call(PetscFree(x));
  Call(PetscFree(f));
  return Largest(worst);
}
