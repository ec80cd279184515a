/* wells: keys of a well that must agree with each other, with the grid and with the body. */
#include "case_private.h"
#include "clathra/boundary.h"
#include "clathra/shape.h"
#include "clathra/words.h"

#define FAIL(b, key, ...) FAIL_AT(GROUP_BC, (b)->name, key, __VA_ARGS__)
#define WHOLE 1e-6 /* of the sum of the weights (366), which is 1 inside a body */

/* Sum of (366) over the particles of a body at the start. */
static double Shares(const Scene *c, const Well *w)
{
  double sum = 0.0;

  for (PetscInt k = 0; k < c->nregion; k++) {
    Lattice  lattice;
    PetscInt none[CL_DIM] = {0};

    if (RegionEmpty(&c->region[k]))
      continue;
    RegionLattice(c, k, &lattice);
    for (PetscInt at = 0; at < BoxSize(lattice.n); at++) {
      PetscInt ij[CL_DIM];
      double   x[CL_DIM], l[CL_DIM];

      BoxAt(none, lattice.n, at, ij);
      if (!RegionPlace(c, k, &lattice, ij, x))
        continue;
      for (int d = 0; d < CL_DIM; d++)
        l[d] = 0.5 * LatticeWidth(&lattice, d, x[d]);
      sum += WellShare(w, x, l);
    }
  }
  return sum;
}

static void CheckPlace(Reader *r, const Scene *c, Bc *b)
{
  Well   w;
  double h = INFINITY;

  if (!WellPlace(c, b, &w)) {
    FAIL(b, "at", "lies outside the body: no region has particles at %s", PlaceWords(w.at).s);
    return;
  }
  for (int d = 0; d < 2; d++)
    h = fmin(h, LinesLeastAt(&w.line[d], w.at[w.across[d]]));
  const double sum = Shares(c, &w);
  if (fabs(sum - 1.0) > WHOLE) {
    FAIL(b, "at",
         "%s: a well draws from the particles within a cell of it, and those of the body have %.6g of its "
         "weights: the body ends nearer than that, or regions that differ in particles_per_cell meet there",
         PlaceWords(b->at).s, sum);
  } else if (b->value.n && b->radius > 0.5 * h * (1.0 + WHOLE)) {
    FAIL(b, "radius",
         "%g m is more than half a cell (%g m): cut such a well out of the body and give its wall a pressure",
         b->radius, h);
  } else if (b->value.n) {
    PetscCallVoid(WellIndex(c, b, &w, &b->index));
    if (!(b->index > 0.0))
      FAIL(b, "skin", "%g with radius %g m is more than the cells about the well can yield (%g m wide)", b->skin,
           b->radius, h);
  }
}

/* In space it runs along an axis. */
static bool Runs(const Bc *b)
{
  int differ = 0;

  for (int d = 0; d < CL_DIM; d++)
    differ += b->at[d] != b->end[d];
  return differ == 1;
}

void CheckWell(Reader *r, const Case *c, Bc *b)
{
  const bool rate = b->rate[PHASE_W].n || b->rate[PHASE_G].n;

  CheckField(r, &c->scene, b, "gas_flow", HAS_GAS, b->rate[PHASE_G].n);
  CheckField(r, &c->scene, b, "inflow_temperature", HAS_HEAT, b->heated.n);
  if (c->scene.axisymmetric)
    FAIL(b, "type", "well is a line normal to the plane; about an axis a well is a pressure on side: left");
  else if (c->pressures == PRESSURES_PARTICLES)
    FAIL(b, "type", "well is not known with stepper_pressures: particles");
  else if (CL_DIM == 3 && !Runs(b))
    FAIL(b, "end", "must differ from at, %s, along one axis: a well runs along it, open between the two",
         PlaceWords(b->at).s);
  else if (rate && b->value.n)
    FAIL(b, b->rate[PHASE_W].n ? "water_flow" : "gas_flow",
         "and bottom_pressure are two ways to drive a well: give one");
  else if (!rate && !b->value.n)
    FAIL(b, "bottom_pressure", "is missing, or else water_flow or gas_flow");
  else if (!r->bad[GROUP_CASE] && !r->bad[GROUP_REGION] && !r->bad[GROUP_MATERIAL])
    CheckPlace(r, &c->scene, b);
}
