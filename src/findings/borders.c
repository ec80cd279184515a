/* What a run with gas says of borders of layers that have settled off the grid's lines (docs/limits.md): the cell of
   the tight layer beside such a border drains as the other layer does, and no tolerance shows it. */
#include "findings_private.h"
#include "clathra/shape.h"
#include "clathra/words.h"

#define CONTRAST 1000.0 /* of k_0: with 100 the clays of settling_layers.yaml consolidate alike with and without it */
#define ON_LINE 1e-3    /* of a cell: the border lay on a line */
#define OFF_LINE 0.01   /* of a cell: it has left it */

typedef struct {
  double   off; /* how far from its line, cells */
  PetscInt tight, open;
  double   at[CL_DIM];
} Border;

static double OffLine(const GridLines *line, double x)
{
  const double place = LinesPlace(line, x);

  return fabs(place - round(place));
}

/* Where particle p, at x0 with half-lengths l at the start, lies beside a border along axis d that has gone farther off
   than `most`. */
static void Look(const Model *m, PetscInt p, const double x0[CL_DIM], const double l[CL_DIM], int d, double side,
                 Border *most)
{
  const GridLines *line = &m->grid.line[d];
  const double     edge = x0[d] + side * l[d], off = OffLine(line, edge + m->P.f[P_X + d][p] - x0[d]);
  const PetscInt   own = m->c->region[m->P.i[PI_REGION][p]].material;
  double           beyond[CL_DIM];

  if (off <= most->off || OffLine(line, edge) > ON_LINE)
    return;
  for (int i = 0; i < CL_DIM; i++)
    beyond[i] = i == d ? x0[i] + 1.01 * side * l[i] : x0[i];
  const PetscInt region = RegionAt(m->c, beyond);

  if (region < 0)
    return;
  const PetscInt other = m->c->region[region].material;
  const double   k[2]  = {m->c->material[own].permeability.k0, m->c->material[other].permeability.k0};
  const bool     tight = k[0] < k[1];

  if (fmax(k[0], k[1]) < CONTRAST * fmin(k[0], k[1]))
    return;
  *most = (Border){.off = off, .tight = tight ? own : other, .open = tight ? other : own};
  for (int i = 0; i < CL_DIM; i++)
    most->at[i] = m->P.f[P_X + i][p];
}

/* The border that is farthest off, of all ranks. */
static PetscErrorCode Farthest(const Model *m, Border *most)
{
  PetscFunctionBeginUser;
  *most = (Border){.off = OFF_LINE};
  for (PetscInt p = 0; p < m->P.n; p++) {
    double x0[CL_DIM], l[CL_DIM];

    ParticleInitialPlace(&m->P, p, x0);
    ParticlesInitialHalfLength(m->c, m->P.i[PI_REGION][p], x0, l);
    for (int d = 0; d < CL_DIM; d++) {
      Look(m, p, x0, l, d, -1.0, most);
      Look(m, p, x0, l, d, 1.0, most);
    }
  }
  PetscCall(GridShareLargest(m->grid.comm, most, sizeof(*most)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FindingsFindBorder(Findings *f, FindingId id)
{
  const Model *m = f->s->model;
  const Scene *c = m->c;
  char         what[256];
  Border       b;

  PetscFunctionBeginUser;
  if (!c->fields.solid || !c->fields.phase[PHASE_G] || c->basis == BASIS_TOTAL)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Farthest(m, &b));
  if (!(b.off > OFF_LINE))
    PetscFunctionReturn(PETSC_SUCCESS);
  snprintf(what, sizeof(what), "%sthinner cells on the side of %s",
           f->s->explicit ? "" : "basis: total, where the ground does not flow; ", c->material[b.tight].name);
  PetscCall(FindingSayOf(f->comm, id, NULL, what,
                         "the border between %s and %s lay on a line of the grid and is %.2g of a cell off it, near "
                         "%s: the cell of %s beside it drains as %s does, and no tolerance shows it (docs/limits.md)",
                         c->material[b.tight].name, c->material[b.open].name, b.off, PlaceWords(b.at).s,
                         c->material[b.tight].name, c->material[b.open].name));
  PetscFunctionReturn(PETSC_SUCCESS);
}
