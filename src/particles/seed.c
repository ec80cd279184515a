/* Initial particles: regular inside each cell of a region's box, with faces on the box's sides. */
#include "clathra/particles.h"

/* Particles along one axis of a box, which they fill exactly. */
typedef struct {
  PetscInt n;
  double   from, spacing; /* m */
} Fill;

/* The box is cut into whole spacings: ppc per cell where the box follows the grid, the nearest number elsewhere. */
static Fill FillAxis(const Grid *g, const Region *r, int d)
{
  Fill         f;
  const double length = r->upper[d] - r->lower[d];

  f.n       = PetscMax((PetscInt)ceil(length / g->h[d] * (double)r->ppc[d] - 1e-6), 1);
  f.from    = r->lower[d];
  f.spacing = length / (double)f.n;
  return f;
}

/* Sides of the box that no other region touches are surfaces. */
static bool Touched(const Case *c, PetscInt region, const double x[])
{
  for (PetscInt k = 0; k < c->nregion; k++) {
    const Region *r = &c->region[k];

    if (k != region && x[0] >= r->lower[0] && x[0] <= r->upper[0] && x[1] >= r->lower[1] && x[1] <= r->upper[1])
      return true;
  }
  return false;
}

static PetscInt FaceBits(const Case *c, PetscInt region, const PetscInt ij[], const PetscInt n[], const double x[],
                         const double l[])
{
  PetscInt bits = 0;

  for (int d = 0; d < CL_DIM; d++) {
    for (int upper = 0; upper < 2; upper++) {
      double outside[CL_DIM] = {x[0], x[1]};

      if (ij[d] != (upper ? n[d] - 1 : 0))
        continue;
      outside[d] += (upper ? 1.0 : -1.0) * 1.001 * l[d];
      if (!Touched(c, region, outside))
        bits |= 1 << (2 * d + upper);
    }
  }
  return bits;
}

void ParticlesInitialHalfLength(const Case *c, const Grid *g, PetscInt region, double l[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    l[d] = 0.5 * FillAxis(g, &c->region[region], d).spacing;
}

static PetscErrorCode VisitRegion(const Case *c, const Grid *g, PetscInt region, PetscInt *id, SiteVisit visit,
                                  void *ctx)
{
  const Fill     fx = FillAxis(g, &c->region[region], 0), fy = FillAxis(g, &c->region[region], 1);
  const PetscInt n[CL_DIM] = {fx.n, fy.n};
  double         l[CL_DIM];

  PetscFunctionBeginUser;
  ParticlesInitialHalfLength(c, g, region, l);
  for (PetscInt j = 0; j < n[1]; j++) {
    for (PetscInt i = 0; i < n[0]; i++) {
      const PetscInt ij[CL_DIM] = {i, j};
      const double   x[CL_DIM]  = {fx.from + ((double)i + 0.5) * fx.spacing, fy.from + ((double)j + 0.5) * fy.spacing};
      const Site     site       = {.id     = (*id)++,
                                   .region = region,
                                   .faces  = FaceBits(c, region, ij, n, x, l),
                                   .x      = {x[0], x[1]},
                                   .l      = {l[0], l[1]}};

      PetscCall(visit(c, g, &site, ctx));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SitesVisit(const Case *c, const Grid *g, SiteVisit visit, void *ctx)
{
  PetscInt id = 0;

  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < c->nregion; r++)
    PetscCall(VisitRegion(c, g, r, &id, visit, ctx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A particle where the cell is this rank's. */
static PetscErrorCode Seed(const Case *c, const Grid *g, const Site *s, void *particles)
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

PetscErrorCode ParticlesSeed(const Case *c, const Grid *g, Particles *P)
{
  PetscFunctionBeginUser;
  PetscCall(ParticlesResize(P, 0));
  PetscCall(SitesVisit(c, g, Seed, P));
  PetscFunctionReturn(PETSC_SUCCESS);
}
