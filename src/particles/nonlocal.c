/* Plastic strain averaged over neighbours, for materials with a nonlocal_length; docs/equations.md (85), (86).
   Once a step (hybrid: once a burst), so pairs of particles are gone through and no list is kept.  Neighbours on other
   ranks and behind planes of symmetry come as copies of what the average needs. */
#include "clathra/particles.h"
#include <string.h>

#define REACH 3.0            /* lengths beyond which weights are below 1e-3 of the largest */
#define IMAGES (1 << CL_DIM) /* of a place: itself and what perpendicular planes mirror */

/* What a neighbour tells. */
enum { N_X = 0, N_VOLUME = CL_DIM, N_GROWTH, N_MATERIAL, N_COUNT };
typedef struct {
  double v[N_COUNT];
} Neighbour;

/* Neighbours in squares of the size of one length. */
typedef struct {
  double     lower[CL_DIM], size;
  PetscInt   cells[CL_DIM], n, *first; /* those of cell k: from first[k] up to first[k + 1] */
  char      *grows;                    /* is there new plastic strain in the cell? */
  Neighbour *of;
} Cells;

static PetscInt MaterialOf(const Scene *c, const Particles *P, PetscInt p)
{
  return c->region[P->i[PI_REGION][p]].material;
}

static double LengthOf(const Scene *c, PetscInt material)
{
  return c->material[material].plasticity.nonlocal;
}

static double LargestLength(const Scene *c)
{
  double l = 0.0;

  for (PetscInt k = 0; k < c->nmaterial; k++)
    l = fmax(l, LengthOf(c, k));
  return l;
}

/* A place and its mirror images behind planes of symmetry (rollers) within reach. */
static int Images(const Scene *c, const double x[CL_DIM], double reach, double image[IMAGES][CL_DIM])
{
  int n = 1;

  memcpy(image[0], x, sizeof(image[0]));
  for (PetscInt k = 0; k < c->nbc; k++) {
    const Bc *b = &c->bc[k];

    if (b->type != BC_ROLLER || fabs(x[b->axis] - b->position) >= reach)
      continue;
    for (int i = 0, had = n; i < had && n < IMAGES; i++, n++) {
      memcpy(image[n], image[i], sizeof(image[n]));
      image[n][b->axis] = 2.0 * b->position - image[i][b->axis];
    }
  }
  return n;
}

/* Is x within reach of the cells of rank r? */
static bool Reaches(const Grid *g, PetscMPIInt r, const double x[CL_DIM], double reach)
{
  static const PetscInt first[CL_DIM] = {0};
  PetscInt              at[CL_DIM];
  double                d2 = 0.0;

  BoxAt(first, g->nproc, r, at);
  for (int d = 0; d < CL_DIM; d++) {
    const double lo = GridNode(g, d, g->start[d][at[d]]), hi = GridNode(g, d, g->start[d][at[d] + 1]);

    d2 += PetscSqr(fmax(0.0, fmax(lo - x[d], x[d] - hi)));
  }
  return d2 < reach * reach;
}

/* What this rank's particles tell rank r; to == NULL: how many those are. */
static PetscInt Tell(const Scene *c, const Grid *g, const Particles *P, PetscMPIInt r, Neighbour *to)
{
  PetscInt n = 0;

  for (PetscInt p = 0; p < P->n; p++) {
    const PetscInt material = MaterialOf(c, P, p);
    const double   reach    = REACH * LengthOf(c, material);
    double         x[CL_DIM], image[IMAGES][CL_DIM];

    ParticlePlace(P, p, x);
    for (int i = 0, images = reach > 0.0 ? Images(c, x, reach, image) : 0; i < images; i++) {
      if (!Reaches(g, r, image[i], reach))
        continue;
      if (to) {
        memcpy(to[n].v, image[i], sizeof(image[i]));
        to[n].v[N_VOLUME]   = P->f[P_V][p];
        to[n].v[N_GROWTH]   = P->f[P_EPS][p] - P->f[P_AVERAGED][p];
        to[n].v[N_MATERIAL] = (double)material;
      }
      n++;
    }
  }
  return n;
}

/* All neighbours of this rank's particles, in an order that their places on the ranks decide.  Collective. */
static PetscErrorCode Exchange(const Scene *c, const Grid *g, const Particles *P, PetscInt *n, Neighbour **all)
{
  PetscMPIInt *count, *to, *got, *from;
  Neighbour   *out;
  PetscInt     total = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(g->size, &count, g->size, &to, g->size, &got, g->size, &from));
  for (PetscMPIInt r = 0; r < g->size; r++) {
    to[r]    = (PetscMPIInt)(N_COUNT * total);
    count[r] = (PetscMPIInt)(N_COUNT * Tell(c, g, P, r, NULL));
    total += count[r] / N_COUNT;
  }
  PetscCall(PetscMalloc1(total, &out));
  for (PetscMPIInt r = 0; r < g->size; r++)
    Tell(c, g, P, r, &out[to[r] / N_COUNT]);
  PetscCallMPI(MPI_Alltoall(count, 1, MPI_INT, got, 1, MPI_INT, g->comm));
  *n = 0;
  for (PetscMPIInt r = 0; r < g->size; r++) {
    from[r] = (PetscMPIInt)(N_COUNT * *n);
    *n += got[r] / N_COUNT;
  }
  PetscCall(PetscMalloc1(*n, all));
  PetscCallMPI(MPI_Alltoallv(out, count, to, MPIU_REAL, *all, got, from, MPIU_REAL, g->comm));
  PetscCall(PetscFree(out));
  PetscCall(PetscFree4(count, to, got, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt CellOf(const Cells *k, int d, double x)
{
  return (PetscInt)PetscMin(PetscMax((x - k->lower[d]) / k->size, 0.0), (double)(k->cells[d] - 1));
}

static const PetscInt origin[CL_DIM] = {0};

static PetscInt CellAt(const Cells *k, const double x[CL_DIM])
{
  PetscInt at[CL_DIM];

  for (int d = 0; d < CL_DIM; d++)
    at[d] = CellOf(k, d, x[d]);
  return BoxPlace(origin, k->cells, at);
}

/* Sorts n neighbours into cells; takes them over. */
static PetscErrorCode CellsCreate(double size, PetscInt n, Neighbour *all, Cells *k)
{
  double    upper[CL_DIM];
  PetscInt *at, cells;

  PetscFunctionBeginUser;
  *k = (Cells){.size = size, .n = n};
  for (int d = 0; d < CL_DIM; d++) {
    k->lower[d] = PETSC_MAX_REAL;
    upper[d]    = PETSC_MIN_REAL;
    for (PetscInt q = 0; q < n; q++) {
      k->lower[d] = fmin(k->lower[d], all[q].v[N_X + d]);
      upper[d]    = fmax(upper[d], all[q].v[N_X + d]);
    }
    k->cells[d] = n ? 1 + (PetscInt)((upper[d] - k->lower[d]) / size) : 1;
  }
  cells = BoxSize(k->cells);
  PetscCall(PetscCalloc2(cells + 2, &k->first, cells, &k->grows));
  PetscCall(PetscMalloc1(n, &k->of));
  at = k->first + 1; /* counts, then where the next one goes: in the end first[k + 1] */
  for (int pass = 0; pass < 2; pass++) {
    for (PetscInt q = 0; q < n; q++) {
      const PetscInt cell = CellAt(k, &all[q].v[N_X]);

      if (pass == 0)
        at[cell + 1]++;
      else
        k->of[at[cell]++] = all[q];
      k->grows[cell] |= all[q].v[N_GROWTH] != 0.0;
    }
    for (PetscInt q = 0; pass == 0 && q < cells; q++)
      at[q + 1] += at[q];
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CellsDestroy(Cells *k)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(k->first, k->grows));
  PetscCall(PetscFree(k->of));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Place of the first cell of the j-th row along x of a box of cells. */
static PetscInt Row(const Cells *k, const PetscInt lo[CL_DIM], const PetscInt rows[CL_DIM], PetscInt j)
{
  PetscInt at[CL_DIM];

  BoxAt(lo, rows, j, at);
  at[0] = 0;
  return BoxPlace(origin, k->cells, at);
}

/* (85) at x for a material; own is the particle's growth, which counts where it has no neighbours. */
static double Average(const Cells *k, const double x[CL_DIM], double material, double length, double own)
{
  const double reach = REACH * length;
  double       sum = 0.0, weights = 0.0;
  bool         grows = false;
  PetscInt     lo[CL_DIM], hi[CL_DIM], rows[CL_DIM] = {1};

  for (int d = 0; d < CL_DIM; d++) {
    lo[d] = CellOf(k, d, x[d] - reach);
    hi[d] = CellOf(k, d, x[d] + reach);
  }
  for (int d = 1; d < CL_DIM; d++)
    rows[d] = hi[d] - lo[d] + 1;
  for (PetscInt j = 0; j < BoxSize(rows) && !grows; j++) {
    const PetscInt row = Row(k, lo, rows, j);

    for (PetscInt i = lo[0]; i <= hi[0]; i++)
      grows = grows || k->grows[row + i];
  }
  if (!grows)
    return 0.0;
  for (PetscInt j = 0; j < BoxSize(rows); j++) {
    const PetscInt row = Row(k, lo, rows, j);

    for (PetscInt q = k->first[row + lo[0]]; q < k->first[row + hi[0] + 1]; q++) {
      const double *v  = k->of[q].v;
      double        r2 = 0.0;

      for (int d = 0; d < CL_DIM; d++)
        r2 += PetscSqr(v[N_X + d] - x[d]);
      if (r2 >= reach * reach || v[N_MATERIAL] != material)
        continue;
      const double r = sqrt(r2) / length, w = v[N_VOLUME] * r * exp(-r * r);
      sum += w * v[N_GROWTH];
      weights += w;
    }
  }
  return weights > 0.0 ? sum / weights : own;
}

PetscErrorCode ParticlesNonlocal(const Scene *c, const Grid *g, double time, Particles *P)
{
  double *const *f = P->f;
  Neighbour     *all;
  PetscInt       n;
  Cells          k;

  PetscFunctionBeginUser;
  if (!f[P_NONLOCAL])
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Exchange(c, g, P, &n, &all));
  PetscCall(CellsCreate(LargestLength(c), n, all, &k));
  for (PetscInt p = 0; p < P->n; p++) {
    const double   own      = f[P_EPS][p] - f[P_AVERAGED][p];
    const PetscInt material = MaterialOf(c, P, p);
    const double   length   = LengthOf(c, material);
    double         x[CL_DIM];

    ParticlePlace(P, p, x);
    const double grown = length > 0.0 ? Average(&k, x, (double)material, length, own) : own;

    f[P_NONLOCAL][p] += grown;
    f[P_NONLOCAL_RATE][p] = time > 0.0 ? grown / time : 0.0;
    f[P_AVERAGED][p]      = f[P_EPS][p];
  }
  PetscCall(CellsDestroy(&k));
  PetscFunctionReturn(PETSC_SUCCESS);
}
