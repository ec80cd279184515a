/* memory: what a run needs at least, against what the machine has. */
#include "run_private.h"
#include "clathra/shape.h"

#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#define COPIES 2.0   /* of the particles at least: hybrid keeps one of a burst, a Jacobian takes more */
#define NODE 32.0    /* bytes a node of the grid at least: flags, and what snapshots hold of it */
#define SHOWN 0.25   /* of the machine's memory: a run that needs more says how much */
#define GIGABYTE 1e9 /* bytes */

/* Places of the regions' lattices, of which each has a particle or none; all: no place is looked at. */
static double Places(const Scene *c, bool all)
{
  static const PetscInt first[CL_DIM] = {0};
  double                n             = 0.0;

  for (PetscInt r = 0; r < c->nregion; r++) {
    Lattice  lattice;
    PetscInt ij[CL_DIM];
    double   x[CL_DIM], size = 1.0;

    if (RegionEmpty(&c->region[r]))
      continue;
    RegionLattice(c, r, &lattice);
    for (int d = 0; d < CL_DIM; d++)
      size *= (double)lattice.n[d];
    n += all || size > PETSC_MAX_INT ? size : 0.0;
    for (PetscInt k = 0; !all && size <= PETSC_MAX_INT && k < BoxSize(lattice.n); k++) {
      BoxAt(first, lattice.n, k, ij);
      n += RegionPlace(c, r, &lattice, ij, x);
    }
  }
  return n;
}

/* Bytes of so many particles and the grid. */
static double Need(const Scene *c, double particles)
{
  double          nodes = 1.0, one = sizeof(PetscInt) * PI_COUNT;
  const Particles held = {.has = c->fields.has};

  for (const ParticleVariable *v = cl_particle_variable; v->name; v++)
    one += ParticlesHold(&held, v) ? (double)sizeof(double) * v->nc : 0.0;
  for (int d = 0; d < CL_DIM; d++)
    nodes *= (double)c->cells[d] + 1.0;
  return COPIES * one * particles + NODE * nodes;
}

/* What this process and the others on its machine may have in all, bytes: memory, or the limit of a container. */
static double Machine(void)
{
  double memory = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE), limit;
  FILE  *f      = fopen("/sys/fs/cgroup/memory.max", "r");

  if (f && fscanf(f, "%lf", &limit) == 1)
    memory = fmin(memory, limit);
  if (f)
    fclose(f);
  return memory;
}

/* The share of the need that falls on a machine, or on one process where that has a limit, and what there is. */
static PetscErrorCode Shares(MPI_Comm comm, double *share, double *there)
{
  MPI_Comm      machine;
  PetscMPIInt   size, here;
  struct rlimit own;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine));
  PetscCallMPI(MPI_Comm_size(machine, &here));
  PetscCallMPI(MPI_Comm_free(&machine));
  *share = (double)here / size;
  *there = Machine();
  if (getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur != RLIM_INFINITY && (double)own.rlim_cur * here < *there)
    *there = (double)own.rlim_cur * here;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MemoryLook(MPI_Comm comm, const Case *c, bool *ok)
{
  const Scene *scene     = &c->scene;
  double       particles = Places(scene, true), share = 1.0, there = 0.0, worst;

  PetscFunctionBeginUser;
  PetscCall(Shares(comm, &share, &there));
  worst = there / share; /* what all may need before the tightest machine is full */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE, MPI_MIN, comm));
  if (Need(scene, particles) > SHOWN * worst) /* not every place of a shape's bounds has a particle */
    particles = Places(scene, false);
  *ok = Need(scene, particles) <= worst;
  if (!*ok)
    PetscCall(
        PetscFPrintf(comm, stderr,
                     "clathra: %s: %.3g particles and the grid need at least %.3g GB of memory, and there are %.3g "
                     "GB: fewer cells (grid_cells), fewer particles a cell (region_..._particles_per_cell), or "
                     "ranks on more machines\n",
                     c->file, particles, Need(scene, particles) / GIGABYTE, worst / GIGABYTE));
  else if (Need(scene, particles) > SHOWN * worst)
    PetscCall(PetscPrintf(comm, "  memory: at least %.3g GB of the %.3g GB that there are\n",
                          Need(scene, particles) / GIGABYTE, worst / GIGABYTE));
  PetscFunctionReturn(PETSC_SUCCESS);
}
