/* wells: keys of a well that must agree with each other, with the grid and with the body. */
#include "case_private.h"
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

/* The smallest cell about the well, m. */
static double Cell(const Well *w)
{
  return fmin(LinesLeastAt(&w->line[0], w->at[w->across[0]]), LinesLeastAt(&w->line[1], w->at[w->across[1]]));
}

bool WellFits(const Bc *b, const Well *w)
{
  return b->radius <= 0.5 * Cell(w) * (1.0 + WHOLE);
}

static void CheckPlace(Reader *r, const Scene *c, const Bc *b)
{
  Well w;

  if (!WellPlace(c, b, &w)) {
    FAIL(b, "at", "lies outside the body: no region has particles at %s", PlaceWords(w.at).s);
    return;
  }
  const double sum = Shares(c, &w);
  if (fabs(sum - 1.0) > WHOLE) {
    FAIL(b, "at",
         "%s: a well draws from the particles within a cell of it, and those of the body have %.6g of its "
         "weights: the body ends nearer than that, or regions that differ in particles_per_cell meet there",
         PlaceWords(b->at).s, sum);
  } else if (b->value.n && !WellFits(b, &w)) {
    FAIL(b, "radius",
         "%g m is more than half a cell (%g m): cut such a well out of the body and give its wall a pressure",
         b->radius, Cell(&w));
  } else if (b->value.n && !(b->index > 0.0)) {
    FAIL(b, "skin", "%g with radius %g m is more than the cells about the well can yield (%g m wide)", b->skin,
         b->radius, Cell(&w));
  }
}

bool WellRuns(const Scene *c, const Bc *b)
{
  int differ = 0;

  for (int d = 0; d < CL_DIM; d++)
    differ += b->at[d] != b->end[d];
  return CL_DIM == 3 ? differ == 1 : !c->axisymmetric;
}

void CheckWell(Reader *r, const Case *c, const Bc *b)
{
  const bool rate = b->rate[PHASE_W].n || b->rate[PHASE_G].n;

  CheckField(r, &c->scene, b, "gas_flow", HAS_GAS, b->rate[PHASE_G].n);
  CheckField(r, &c->scene, b, "inflow_temperature", HAS_HEAT, b->heated.n);
  if (c->scene.axisymmetric)
    FAIL(b, "type", "well is a line normal to the plane; about an axis a well is a pressure on side: left");
  else if (!WellRuns(&c->scene, b))
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
