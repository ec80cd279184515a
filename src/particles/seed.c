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
  Lattice  lattice;
  PetscInt ij[CL_DIM];
  double   x[CL_DIM], l[CL_DIM];

  PetscFunctionBeginUser;
  if (RegionEmpty(&c->region[region]))
    PetscFunctionReturn(PETSC_SUCCESS);
  RegionLattice(c, region, &lattice);
  for (ij[1] = 0; ij[1] < lattice.n[1]; ij[1]++) {
    for (ij[0] = 0; ij[0] < lattice.n[0]; ij[0]++) {
      if (!RegionPlace(c, region, &lattice, ij, x))
        continue;
      for (int d = 0; d < CL_DIM; d++)
        l[d] = 0.5 * LatticeWidth(&lattice, d, x[d]);
      const Site site = {.id     = (*id)++,
                         .region = region,
                         .faces  = RegionFaces(c, region, &lattice, ij),
                         .x      = {x[0], x[1]},
                         .l      = {l[0], l[1]}};

      PetscCall(visit(c, g, &site, ctx));
    }
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
