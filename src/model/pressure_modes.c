/* Modes of the pressures in the null space of the map from nodes to particles (417).
   Two neighbouring nodes whose weights are nearly parallel over all particles have one pressure as far as particles can
   tell: no storage sees the difference between them.  It is given a share of that of the volume both have in common. */
#include "gather.h"

#define PARALLEL                                                                                                       \
  0.95 /* square of the normalised inner product of two nodes' weights above which they count as parallel */

/* Gram matrix of the weights: of a node with itself, and along each axis with the next node, m^3. */
enum { GRAM_OWN = 0, GRAM_NEXT, GRAM_COUNT = GRAM_NEXT + CL_DIM };

/* The axis along which node b comes after node a; -1 where it does not. */
static int AxisBetween(const PetscInt a[CL_DIM], const PetscInt b[CL_DIM])
{
  int along = -1;

  for (int d = 0; d < CL_DIM; d++) {
    if (b[d] == a[d])
      continue;
    if (b[d] != a[d] + 1 || along >= 0)
      return -1;
    along = d;
  }
  return along;
}

static void AddParticle(const Model *m, PetscInt p, double *gram)
{
  const double V = m->P.f[P_V][p];
  Reach        r;

  ReachExpand(m, p, &r);
  for (int a = 0; a < r.n; a++) {
    double *at = &gram[GRAM_COUNT * r.node[a]];

    at[GRAM_OWN] += V * r.S[a] * r.S[a];
    for (int b = 0; b < r.n; b++) {
      const int d = AxisBetween(m->map.ij[r.node[a]], m->map.ij[r.node[b]]);

      if (d >= 0)
        at[GRAM_NEXT + d] += V * r.S[a] * r.S[b];
    }
  }
}

/* w V_ab (417), m^3, of node a and the next one along an axis, b. */
static double CouplingVolume(const double *gram, PetscInt a, PetscInt b, int axis)
{
  const double A = gram[GRAM_COUNT * a + GRAM_OWN], B = gram[GRAM_COUNT * b + GRAM_OWN],
               both = gram[GRAM_COUNT * a + GRAM_NEXT + axis], alike = A * B > 0.0 ? both * both / (A * B) : 0.0;

  return alike > PARALLEL ? (alike - PARALLEL) / (1.0 - PARALLEL) * A * B / (A + B) : 0.0;
}

/* The difference of two nodes is a line whose third node does not count. */
static GhostLine Difference(const Model *m, PetscInt a, PetscInt b, double volume)
{
  GhostLine line = {.node = {a, b, b}, .second = {1.0, -1.0, 0.0}, .carried = CarriedAt(m, a)};

  for (int f = 0; f < PHASE_COUNT; f++)
    line.store[f] = 0.5 * STORAGE_SHARE * volume * (StoredAt(m, a, f) + StoredAt(m, b, f));
  return line;
}

PetscErrorCode PressureModesBuild(Model *m)
{
  double  *gram; /* [n_local][GRAM_COUNT] */
  PetscInt n = m->added->nghost;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(GRAM_COUNT * m->map.n_local, &gram));
  for (PetscInt p = 0; p < m->P.n; p++)
    AddParticle(m, p, gram);
  PetscCall(NodeMapSum(&m->map, gram, GRAM_COUNT));
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int d = 0, step = 1; d < CL_DIM; d++, step *= WIDTH) {
      const PetscInt K      = ModelNeighbour(m, I, NEIGHBOURS / 2 + step);
      const double   volume = K >= 0 ? CouplingVolume(gram, I, K, d) : 0.0;

      if (volume > 0.0)
        m->added->ghost[n++] = Difference(m, I, K, volume);
    }
  }
  m->added->nghost = n;
  PetscCall(PetscFree(gram));
  PetscFunctionReturn(PETSC_SUCCESS);
}
