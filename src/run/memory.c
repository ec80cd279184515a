/* memory: what a run will need, against what the machine has. */
#include "run_private.h"
#include "clathra/shape.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* Fitted to the largest resident sizes of 56 runs: 0.77 to 1.18 of what these and six others, up to 3 GB, took;
   tests/integration/control.py measures eight. */
#define PROCESS 54e6    /* bytes of a rank without a body */
#define ADDRESSES 430e6 /* bytes of addresses, beyond what it uses, that a rank reserves: a limit counts them, too */
#define COPIES 5.1      /* of what a particle holds */
#define NODE 168.0      /* doubles at a node in hybrid */
#define UNKNOWN 64.0    /* doubles at a node for each of its unknowns in implicit steps */
#define GRID 32.0       /* bytes a node of the grid, with particles or without */
#define MULTIGRID 10.0  /* bytes an entry of the reduced matrix (170), multigrid included */
#define LU 14.0         /* ... without its factors */
#define LU_WHOLE 49.0   /* ... of the whole matrix */
#define FACTORS_2D 9.4  /* entries of the factors for one of a node's block, times log2 of the cells across */
#define FACTORS_3D 19.0 /* ... times the root of the cells of a layer */
#define SHOWN 0.25      /* of the machine's memory: a run that needs more says how much */
#define GIGABYTE 1e9    /* bytes */

/* The body as memory counts it. */
typedef struct {
  double particles, nodes, cells; /* nodes: those that particles reach */
  double longest;                 /* cells along its longest axis */
} Body;

/* Adds region r: all of the places of its lattice, or those that have a particle. */
static void AddRegion(const Scene *c, PetscInt r, bool all, Body *body)
{
  static const PetscInt first[CL_DIM] = {0};
  Lattice               lattice;
  PetscInt              ij[CL_DIM];
  double                x[CL_DIM], size = 1.0, ppc = 1.0, edge = 1.0, n = 0.0;

  RegionLattice(c, r, &lattice);
  for (int d = 0; d < CL_DIM; d++) {
    const double cells = (double)lattice.n[d] / (double)c->region[r].ppc[d];

    size *= (double)lattice.n[d];
    ppc *= (double)c->region[r].ppc[d];
    edge *= 1.0 + 2.0 / cells;
    body->longest = fmax(body->longest, cells);
  }
  if (size == 0.0)
    return;
  all = all || size > PETSC_MAX_INT;
  for (PetscInt k = 0; !all && k < BoxSize(lattice.n); k++) {
    BoxAt(first, lattice.n, k, ij);
    n += RegionPlace(c, r, &lattice, ij, x);
  }
  n = all ? size : n;
  body->particles += n;
  body->cells += n / ppc;
  body->nodes += n / ppc * edge;
}

static double GridNodes(const Scene *c)
{
  double nodes = 1.0;

  for (int d = 0; d < CL_DIM; d++)
    nodes *= (double)c->cells[d] + 1.0;
  return nodes;
}

static Body BodyOf(const Scene *c, bool all)
{
  Body body = {.longest = 1.0};

  for (PetscInt r = 0; r < c->nregion; r++) {
    if (!RegionEmpty(&c->region[r]))
      AddRegion(c, r, all, &body);
  }
  body.nodes = fmin(body.nodes, GridNodes(c));
  return body;
}

/* Bytes that a particle holds. */
static double Held(const Scene *c)
{
  const Particles held = {.has = c->fields.has};
  double          one  = 0.0;

  for (const ParticleVariable *v = cl_particle_variable; v->name; v++)
    one += ParticlesHold(&held, v) ? (double)sizeof(double) * v->nc : 0.0;
  return one;
}

static bool TakesImplicitSteps(const Case *c)
{
  bool takes = false;

  for (PetscInt k = 0; k < PetscMax(c->nstage, 1); k++)
    takes = takes || (IntegratorKinds(CaseInStage(c, k)->integrator) & BY_IMPLICIT);
  return takes;
}

/* Bytes a node of the system of implicit steps; factored: unknowns a node of the matrix of which LU is made, 0:
   multigrid. */
static double System(const FieldSet *fs, const Body *body, int factored)
{
  const double across = body->cells / body->longest, row = pow(5.0, CL_DIM); /* blocks */
  double       left = 0.0;

  for (int k = 0; k < fs->n; k++)
    left += fs->field[k] < F_VW || fs->field[k] >= F_PW;
  const double block = factored ? PetscSqr((double)factored) : PetscSqr(left);
  const double fill  = CL_DIM == 3 ? FACTORS_3D * sqrt(across) : FACTORS_2D * log2(1.0 + across);
  if (!factored)
    return block * MULTIGRID * row;
  return block * ((factored > left ? LU_WHOLE : LU) * row + sizeof(double) * fill);
}

/* Bytes of all ranks. */
static double Need(const Case *c, const Body *body, PetscMPIInt size, int factored)
{
  const FieldSet *fs   = &c->scene.fields;
  double          node = NODE * sizeof(double);

  if (TakesImplicitSteps(c))
    node = UNKNOWN * sizeof(double) * fs->n + System(fs, body, factored);
  return PROCESS * size + COPIES * Held(&c->scene) * body->particles + node * body->nodes + GRID * GridNodes(&c->scene);
}

/* The limit that a file of control groups sets, bytes; INFINITY where it sets none. */
static double LimitIn(const char *folder, const char *group, const char *name)
{
  char   path[2 * PATH_MAX];
  double limit = INFINITY;
  FILE  *f;

  snprintf(path, sizeof(path), "/sys/fs/cgroup%s%s/%s", folder, group, name);
  f = fopen(path, "r");
  if (f && fscanf(f, "%lf", &limit) != 1)
    limit = INFINITY;
  if (f)
    fclose(f);
  return limit;
}

/* ... of a group and all above it; what is left of `group` is "". */
static double LimitUpwards(const char *folder, char *group, const char *name)
{
  double limit = LimitIn(folder, group, name);

  for (char *end = strrchr(group, '/'); end; end = strrchr(group, '/')) {
    *end  = '\0';
    limit = fmin(limit, LimitIn(folder, group, name));
  }
  return limit;
}

/* The limit of this process's container or job, bytes, of either version of control groups. */
static double Container(void)
{
  double limit = INFINITY;
  FILE  *f     = fopen("/proc/self/cgroup", "r");
  char   line[PATH_MAX], group[PATH_MAX];

  while (f && fgets(line, sizeof(line), f)) {
    if (sscanf(line, "0::%4095s", group) == 1)
      limit = fmin(limit, LimitUpwards("", group, "memory.max"));
    else if (sscanf(line, "%*d:memory:%4095s", group) == 1)
      limit = fmin(limit, LimitUpwards("/memory", group, "memory.limit_in_bytes"));
  }
  if (f)
    fclose(f);
  return limit;
}

/* The share of the need that falls on a machine, or on one process where that has a limit, and what there is: memory,
   or the limit of its container. */
static PetscErrorCode Shares(MPI_Comm comm, double *share, double *there)
{
  MPI_Comm      machine;
  PetscMPIInt   size, here;
  struct rlimit own;
  double        limit;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine));
  PetscCallMPI(MPI_Comm_size(machine, &here));
  PetscCallMPI(MPI_Comm_free(&machine));
  *share = (double)here / size;
  *there = fmin((double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE), Container());
  limit  = getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur != RLIM_INFINITY ? (double)own.rlim_cur : INFINITY;
  *there = fmin(*there, fmax(limit - ADDRESSES, 0.0) * here);
  PetscFunctionReturn(PETSC_SUCCESS);
}

Place CellsWords(const Scene *c, const char *between)
{
  Place words = {""};
  int   n     = 0;

  for (int d = 0; d < CL_DIM; d++)
    n += snprintf(words.s + n, sizeof(words.s) - (size_t)n, "%s%" PetscInt_FMT, d ? between : "", c->cells[d]);
  return words;
}

PetscErrorCode MemoryLook(MPI_Comm comm, const Case *c, const Model *m, bool *ok)
{
  const int   factored = m ? ModelFactored(m) : 0;
  Body        body     = BodyOf(&c->scene, true);
  double      share = 1.0, there = 0.0, worst, need;
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(Shares(comm, &share, &there));
  worst = there / share; /* what all may need before the tightest machine is full */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE, MPI_MIN, comm));
  if (Need(c, &body, size, factored) > SHOWN * worst) /* not every place of a shape's bounds has a particle */
    body = BodyOf(&c->scene, false);
  need = Need(c, &body, size, factored);
  *ok  = need <= worst;
  if (!*ok)
    PetscCall(
        PetscFPrintf(comm, stderr,
                     "clathra: %s: grid_cells = %s: %.3g particles and %s need about %.3g GB of memory, and there "
                     "are %.3g GB: fewer cells, fewer particles a cell (region_..._particles_per_cell), or ranks "
                     "on more machines\n",
                     c->file, CellsWords(&c->scene, ", ").s, body.particles,
                     factored ? "the factors of LU" : "their nodes", need / GIGABYTE, worst / GIGABYTE));
  else if (m && need > SHOWN * worst)
    PetscCall(PetscPrintf(comm, "  memory: about %.3g GB of the %.3g GB that there are\n", need / GIGABYTE,
                          worst / GIGABYTE));
  PetscFunctionReturn(PETSC_SUCCESS);
}
