/* Initial particles: regular inside each cell of a region's box, with faces on the box's sides. */
#include "clathra/particles.h"
#include "clathra/point.h"

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

/* Mean pore pressure, with the weight of the water above for a hydrostatic region. */
static double InitialPressure(const Case *c, const Region *r, const Material *mat, const double x[])
{
  double p = r->pressure;

  if (r->hydrostatic) {
    for (int d = 0; d < CL_DIM; d++) {
      if (c->gravity[d] != 0.0)
        p += mat->water.rho0 * c->gravity[d] * (x[d] - r->datum);
    }
  }
  return p;
}

static void Set(Particles *P, PetscInt p, int component, double value)
{
  if (P->f[component])
    P->f[component][p] = value;
}

/* Pressures of the phases from their mean (10). */
static PetscErrorCode InitialPressures(const Case *c, const Region *r, const Material *mat, const double x[],
                                       double *pw, double *pg, double *sg)
{
  const double pm = InitialPressure(c, r, mat, x);
  double       pc = 0.0, ds;

  PetscFunctionBeginUser;
  *sg = r->Sg / (1.0 - r->Sh);
  if (c->fields.has & HAS_GAS_PRESSURE)
    PetscCheck(RetentionInvert(&mat->retention, *sg, &pc), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "region %s: the retention law never reaches the initial gas share %g", r->name, *sg);
  *pw = pm - *sg * pc;
  *pg = *pw + pc;
  if (c->fields.has & HAS_GAS_PRESSURE) /* to the last digit what the law makes of these pressures */
    *sg = RetentionGasShare(&mat->retention, *pg - *pw, &ds);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode InitialState(const Case *c, PetscInt region, Particles *P, PetscInt p, const double x[],
                                   const double l[])
{
  const Region   *r   = &c->region[region];
  const Material *mat = &c->material[r->material];
  const double    V   = 4.0 * l[0] * l[1] * (c->axisymmetric ? 2.0 * M_PI * x[0] : 1.0);
  double          pw = 0.0, pg = 0.0, sg = 0.0, m[4];

  PetscFunctionBeginUser;
  if (c->fields.fluid)
    PetscCall(InitialPressures(c, r, mat, x, &pw, &pg, &sg));
  PointInitialMasses(&c->fields, mat, V, mat->porosity, r->Sh, sg, pw, pg, r->temperature, &m[0], &m[1], &m[2], &m[3]);
  for (int k = 0; k < P_COUNT; k++)
    Set(P, p, k, 0.0);
  for (int d = 0; d < CL_DIM; d++) {
    P->f[P_X + d][p] = x[d];
    P->f[P_L + d][p] = l[d];
    if (r->hydrostatic) {
      Set(P, p, P_GW + d, mat->water.rho0 * c->gravity[d]);
      Set(P, p, P_GG + d, mat->water.rho0 * c->gravity[d]);
    }
  }
  Set(P, p, P_F, 1.0);
  Set(P, p, P_F + 3, 1.0);
  P->f[P_V][p]   = V;
  P->f[P_PHI][p] = mat->porosity;
  P->f[P_SH][p]  = r->Sh;
  Set(P, p, P_SW, r->Sw);
  Set(P, p, P_T, r->temperature);
  for (int k = 0; k < 2; k++) {
    Set(P, p, k ? P_PW0 : P_PW, pw);
    Set(P, p, k ? P_PG0 : P_PG, pg);
    for (int s = 0; s < 6; s++)
      Set(P, p, (k ? P_SIG0 : P_SIG) + s, r->stress[s]);
  }
  for (int k = 0; k < 4; k++)
    Set(P, p, P_MS + k, m[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
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

static PetscErrorCode SeedRegion(const Case *c, const Grid *g, PetscInt region, PetscInt *id, Particles *P)
{
  const Fill     fx = FillAxis(g, &c->region[region], 0), fy = FillAxis(g, &c->region[region], 1);
  const PetscInt n[CL_DIM] = {fx.n, fy.n};
  double         l[CL_DIM];

  PetscFunctionBeginUser;
  ParticlesInitialHalfLength(c, g, region, l);
  for (PetscInt j = 0; j < n[1]; j++) {
    for (PetscInt i = 0; i < n[0]; i++, (*id)++) {
      const PetscInt ij[CL_DIM] = {i, j};
      const double   x[CL_DIM]  = {fx.from + ((double)i + 0.5) * fx.spacing, fy.from + ((double)j + 0.5) * fy.spacing};
      PetscInt       cell[CL_DIM];

      PetscCheck(GridCell(g, x, cell), g->comm, PETSC_ERR_ARG_OUTOFRANGE, "region %s leaves the grid",
                 c->region[region].name);
      if (GridCellOwner(g, cell) != g->rank)
        continue;
      const PetscInt p = P->n;
      PetscCall(ParticlesResize(P, p + 1));
      PetscCall(InitialState(c, region, P, p, x, l));
      P->i[PI_ID][p]     = *id;
      P->i[PI_REGION][p] = region;
      P->i[PI_FACES][p]  = FaceBits(c, region, ij, n, x, l);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ParticlesSeed(const Case *c, const Grid *g, Particles *P)
{
  PetscInt id = 0;

  PetscFunctionBeginUser;
  PetscCall(ParticlesResize(P, 0));
  for (PetscInt r = 0; r < c->nregion; r++)
    PetscCall(SeedRegion(c, g, r, &id, P));
  PetscFunctionReturn(PETSC_SUCCESS);
}
