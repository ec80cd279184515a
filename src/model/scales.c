/* What rows and unknowns are measured in: scales of a stage, node by node. */
#include "gather.h"

#define ROUND_OFF_P 1e-3 /* of 1 MPa, times Newton's tolerance: round-off of a pressure, with a margin */

/* Mass that a change of 1 MPa stores, moves or turns into hydrate, but no more than there is, unless that is below the
   round-off of what moves or reacts. */
static double MassScale(const FieldSet *fs, const double c[NC_COUNT], int phase, double w, double dt, double h)
{
  const double squeezed = fs->solid ? w / c[NC_M] : 0.0;
  const double moved    = 1e6 * (c[NC_RHO + phase] * (c[NC_STORAGE + phase] + squeezed) +
                              dt * c[NC_LAMBDA + phase] / (h * h) + dt * c[NC_REACTION]);

  return fmax(fmin(moved, c[NC_RHO + phase] * w), ROUND_OFF_P * moved);
}

/* The least p_0 of the scene where gas may vanish, else infinity. */
static double LeastEntry(const Scene *c)
{
  double least = INFINITY;

  for (PetscInt k = 0; k < c->nmaterial; k++) {
    if (c->material[k].gas.trace > 0.0)
      least = fmin(least, c->material[k].retention.p0);
  }
  return least;
}

/* Over Newton's tolerance of masses: round-off of p_c, 4e-9 Pa at 10 MPa, times the steepest p_0 ds_g/dp_c, 0.3, with a
   margin. */
#define ROUND_OFF_PC 50.0 /* Pa */

/* Gas that may come within the step is known to the round-off of p_c over p_0, of all that the pores hold. */
static double ComingGas(const Model *m, PetscInt I)
{
  const double pores = m->w[PHASE_COUNT * I + PHASE_W] + m->w[PHASE_COUNT * I + PHASE_G];

  return ROUND_OFF_PC / LeastEntry(m->c) * m->coef[I * NC_COUNT + NC_RHO + PHASE_G] * pores;
}

#define SLIVER 0.05 /* of a cell: emptier nodes are held by the ghost penalty, whose rows do not shrink with them */

#define ROUND_OFF 1e-5 /* of the terms of a fluid's momentum, times Newton's tolerance, with a margin */

/* Row of a fluid's momentum per volume: 1 MPa over a cell, unless that is below the round-off of its terms: of the drag
   of the skeleton's own velocity where permeability is low; of pressures on a node that sees but a sliver, where
   forces shrink with its depth and the volume with the square of that. */
static double FluidScale(const Model *m, PetscInt I, int phase, double h)
{
  const FieldSet *fs = &m->c->fields;
  const double   *c = &m->coef[I * NC_COUNT], dt = m->stage.dt, P = 1e6;
  const double    sliver = sqrt(2.0 * NodeVolume(m, I) / m->V[I]);
  const double    kr     = c[NC_KR + phase];
  double          row    = kr / h * fmax(P, ROUND_OFF * sliver * fmax(P, fabs(c[NC_P + phase]))), v;

  if (!fs->solid)
    return row;
  v = P / h / ((fs->inertia ? c[NC_RHO + phase] / dt : 0.0) + c[NC_M] * dt / (h * h)); /* what 1 MPa brings about */
  for (int d = 0; d < CL_DIM; d++)
    v = fmax(v, fabs(m->stage.x_star[I * fs->n + PlaceVs(fs) + d]));
  return fmax(row, ROUND_OFF * c[NC_DRAG + phase] * m->w[PHASE_COUNT * I + phase] * v);
}

/* Columns: 1 MPa, 1 K, and the velocities that belong to 1 MPa over a cell.  Rows: what such a change makes of each
   balance, so that scaled residuals and updates compare across fields. */
static void NodeScales(const Model *m, PetscInt I, double h, double *row, double *col)
{
  const FieldSet *fs = &m->c->fields;
  const double   *c = &m->coef[I * NC_COUNT], dt = m->stage.dt, P = 1e6, V = m->V[I];
  const double    V_row = fmax(V, SLIVER * NodeVolume(m, I));

  for (int d = 0; d < CL_DIM; d++) {
    if (fs->solid) {
      col[PlaceVs(fs) + d] = P * h / (c[NC_M] * dt);
      row[PlaceVs(fs) + d] = V_row * P / h;
    }
    for (int k = 0; k < PHASE_COUNT; k++) {
      if (!fs->phase[k])
        continue;
      const double kr = c[NC_KR + k], inertia = fs->inertia ? kr * c[NC_RHO + k] / dt : 0.0;

      col[PlaceV(fs, k) + d] = kr * P / h / (inertia + c[NC_DRAG + k] * m->w[PHASE_COUNT * I + k]);
      row[PlaceV(fs, k) + d] = V * FluidScale(m, I, k, h);
    }
  }
  for (int k = 0; k < PHASE_COUNT; k++) {
    if (!fs->phase[k])
      continue;
    double mass = MassScale(fs, c, k, m->w[PHASE_COUNT * I + k], dt, h);
    if (k == PHASE_G)
      mass = fmax(mass, ComingGas(m, I));
    mass *= V_row;
    col[PlaceP(fs, k)] = P;
    row[PlaceP(fs, k)] = mass;
  }
  if (fs->heat) {
    col[PlaceT(fs)] = 1.0;
    row[PlaceT(fs)] = V_row * fmax(c[NC_CAPACITY] / dt + c[NC_KAPPA] / (h * h), ROUND_OFF_P * P * c[NC_REACTION_HEAT]);
  }
}

void ScalesBuild(Model *m)
{
  const int n = m->c->fields.n;

  for (PetscInt I = 0; I < m->map.n_local; I++)
    NodeScales(m, I, NodeWidth(m, I), &m->row_scale[I * n], &m->col_scale[I * n]);
}
