/* Borders between ranks that follow the particles. */
#include "clathra/particles.h"

#define UNEVEN 1.1 /* most particles of a rank over the mean from which on borders move */
#define GAIN 0.05  /* of the mean, that has to be gained by it */

/* Ways to share, and what is known of the best. */
typedef struct {
  const Grid      *g;
  const Particles *P;
  PetscInt        *load[CL_DIM]; /* particles in the columns of cells along an axis, of all ranks */
  double           mean;         /* particles of a rank */
  PetscInt         nproc[CL_DIM], *start[CL_DIM];
  double           most, seam; /* of the best: particles of the fullest rank over the mean, nodes along the seams */
} Search;

static bool CellOf(const Search *s, PetscInt p, PetscInt cell[CL_DIM])
{
  double x[CL_DIM];

  ParticleGridPlace(s->P, p, x);

  return GridCell(s->g, x, cell);
}

static PetscErrorCode Columns(Search *s)
{
  PetscFunctionBeginUser;
  for (int d = 0; d < CL_DIM; d++)
    PetscCall(PetscCalloc1(s->g->cells[d], &s->load[d]));
  for (PetscInt p = 0; p < s->P->n; p++) {
    PetscInt cell[CL_DIM];

    for (int d = 0; CellOf(s, p, cell) && d < CL_DIM; d++)
      s->load[d][cell[d]]++;
  }
  for (int d = 0; d < CL_DIM; d++)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->load[d], (PetscMPIInt)s->g->cells[d], MPIU_INT, MPI_SUM, s->g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Particles of the fullest rank over the mean. */
static PetscErrorCode Fullest(const Search *s, const PetscInt nproc[], PetscInt *const start[], double *most)
{
  PetscInt *count, cell[CL_DIM], largest = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->g->size, &count));
  for (PetscInt p = 0; p < s->P->n; p++) {
    if (CellOf(s, p, cell))
      count[GridBoxOwner(nproc, start, cell)]++;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, s->g->size, MPIU_INT, MPI_SUM, s->g->comm));
  for (PetscMPIInt r = 0; r < s->g->size; r++)
    largest = PetscMax(largest, count[r]);
  *most = (double)largest / s->mean;
  PetscCall(PetscFree(count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Even enough and with shorter seams, or more even. */
static bool Better(const Search *s, double most, double seam)
{
  return s->most <= UNEVEN && most <= UNEVEN ? seam < s->seam : most < s->most;
}

static PetscErrorCode Take(const PetscInt nproc[], double seam, void *ctx)
{
  Search   *s = (Search *)ctx;
  PetscInt *start[CL_DIM];
  double    most;

  PetscFunctionBeginUser;
  for (int d = 0; d < CL_DIM; d++) {
    PetscCall(PetscMalloc1(nproc[d] + 1, &start[d]));
    GridEvenBorders(s->g->cells[d], s->load[d], nproc[d], start[d]);
  }
  PetscCall(Fullest(s, nproc, start, &most));
  const bool better = Better(s, most, seam);
  for (int d = 0; d < CL_DIM; d++) {
    if (better) {
      PetscInt *const before = s->start[d];

      s->nproc[d] = nproc[d];
      s->start[d] = start[d];
      start[d]    = before;
    }
    PetscCall(PetscFree(start[d]));
  }
  if (better) {
    s->most = most;
    s->seam = seam;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ParticlesFullest(const Grid *g, const Particles *P, double *mean, double *most)
{
  PetscInt largest = P->n, all = P->n;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPIU_INT, MPI_MAX, g->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPIU_INT, MPI_SUM, g->comm));
  *mean = (double)PetscMax(all, 1) / (double)g->size;
  *most = (double)largest / *mean;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ParticlesBalance(Grid *g, Particles *P, bool *moved)
{
  Search   s = {.g = g, .P = P, .most = INFINITY, .seam = INFINITY};
  PetscInt left;
  double   now;

  PetscFunctionBeginUser;
  *moved = false;
  if (g->size == 1)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ParticlesFullest(g, P, &s.mean, &now));
  if (now <= UNEVEN)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Columns(&s));
  PetscCall(GridShares(g->size, g->cells, Take, &s));
  *moved = s.most <= now - GAIN;
  if (*moved) {
    PetscCall(GridShare(g, s.nproc, s.start));
    PetscCall(ParticlesMigrate(g, P, &left));
  }
  for (int d = 0; d < CL_DIM; d++) {
    PetscCall(PetscFree(s.load[d]));
    PetscCall(PetscFree(s.start[d]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
