/* Initial particles: one at every place of a region's shape. */
#include "clathra/particles.h"
#include "clathra/shape.h"

void ParticlesInitialHalfLength(const Scene *c, PetscInt region, const double x[CL_DIM], double l[CL_DIM])
{
  Lattice lattice;

  RegionLattice(c, region, &lattice);
  for (int d = 0; d < CL_DIM; d++)
    l[d] = 0.5 * LatticeWidth(&lattice, d, x[d]);
}

static PetscErrorCode VisitRegion(const Scene *c, const Grid *g, PetscInt region, PetscInt *id, SiteVisit visit,
                                  void *ctx)
{
  static const PetscInt first[CL_DIM] = {0};
  Lattice               lattice;
  PetscInt              ij[CL_DIM];
  Site                  site = {.region = region};

  PetscFunctionBeginUser;
  if (RegionEmpty(&c->region[region]))
    PetscFunctionReturn(PETSC_SUCCESS);
  RegionLattice(c, region, &lattice);
  for (PetscInt k = 0; k < BoxSize(lattice.n); k++) {
    BoxAt(first, lattice.n, k, ij);
    if (!RegionPlace(c, region, &lattice, ij, site.x))
      continue;
    for (int d = 0; d < CL_DIM; d++)
      site.l[d] = 0.5 * LatticeWidth(&lattice, d, site.x[d]);
    site.id    = (*id)++;
    site.faces = RegionFaces(c, region, &lattice, ij);
    PetscCall(visit(c, g, &site, ctx));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SitesVisit(const Scene *c, const Grid *g, SiteVisit visit, void *ctx)
{
  PetscInt id = 0;

  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < c->nregion; r++)
    PetscCall(VisitRegion(c, g, r, &id, visit, ctx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A particle where the cell is this rank's. */
static PetscErrorCode Seed(const Scene *c, const Grid *g, const Site *s, void *particles)
{
  Particles *P = (Particles *)particles;
  PetscInt   cell[CL_DIM];

  PetscFunctionBeginUser;
  PetscCheck(GridCell(g, s->x, cell), g->comm, PETSC_ERR_ARG_OUTOFRANGE, "region %s leaves the grid",
             c->region[s->region].name);
  if (GridCellOwner(g, cell) != g->rank)
    PetscFunctionReturn(PETSC_SUCCESS);
  const PetscInt p = P->n;
  PetscCall(ParticlesResize(P, p + 1));
  PetscCall(ParticleInitialState(c, s->region, P, p, s->x, s->l));
  P->i[PI_ID][p]     = s->id;
  P->i[PI_REGION][p] = s->region;
  P->i[PI_FACES][p]  = s->faces;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ParticlesSeed(const Scene *c, const Grid *g, Particles *P)
{
  PetscFunctionBeginUser;
  PetscCall(ParticlesResize(P, 0));
  PetscCall(SitesVisit(c, g, Seed, P));
  PetscFunctionReturn(PETSC_SUCCESS);
}
