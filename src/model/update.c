/* What Newton's update may change at once, node by node. */
#include "gather.h"
#include "solver.h"

/* Limits of one update, so that no law is evaluated far outside its range. */
#define LIMIT_T 5.0 /* K */
#define LIMIT_P 0.5 /* of the pressure of a gas that is there (349) or appears */

#define REACH 25.0         /* of p_0 below p_w: where no gas is left */
#define LARGEST_SHARE 0.05 /* of the open pores: what gas gains or loses in one update */
#define CURVED 0.5         /* of the linear change of methane: what the law may differ from it */
#define STRAIGHT 0.002     /* of p_0: change of p_c over which any law is straight */

#define HALVINGS 6   /* at most; what leaves the least is tried then: a kink may lie in the way */
#define DESCENT 1e-4 /* of the residual, for a whole update (Armijo) */

/* (104): where the law bends, p_g to where a node holds as much methane as the linear update d of both pressures says,
   but no more of it than that; p_w keeps a share of the pressure there is, for gas that appears holds it.  False where
   the law is nearly straight. */
static bool FollowMethane(const Material *mat, double Sh, const double p[PHASE_COUNT], double d[PHASE_COUNT], double T)
{
  double       slope[PHASE_COUNT], none[PHASE_COUNT];
  const double there = fmax(p[PHASE_W], p[PHASE_G]), pw = fmax(p[PHASE_W] + d[PHASE_W], (1.0 - LIMIT_P) * there),
               pg = p[PHASE_G] + d[PHASE_G], most = LARGEST_SHARE * GasDensity(&mat->gas, there, T, &none[0], &none[1]);
  const double from   = PointMethane(mat, Sh, p[PHASE_W], p[PHASE_G], T, slope),
               linear = slope[PHASE_W] * d[PHASE_W] + slope[PHASE_G] * d[PHASE_G];
  const double want   = from + fmax(-most, fmin(linear, most));
  const double least = fmin(pg, pw - REACH * mat->retention.p0), largest = fmax(pg, p[PHASE_G]);

  if (fabs(d[PHASE_G] - d[PHASE_W]) <= STRAIGHT * mat->retention.p0 ||
      fabs(PointMethane(mat, Sh, pw, pg, T, none) - want) <= CURVED * fabs(linear))
    return false;
  const double found = PointGasPressure(mat, want, Sh, pw, T, least, largest);
  if (found == largest)
    return false;
  d[PHASE_W] = pw - p[PHASE_W];
  d[PHASE_G] = found - p[PHASE_G];
  return true;
}

/* Does it to a node's update; false where nothing changes. */
static bool Follow(const Model *m, PetscInt I, const double *x, double *y)
{
  const FieldSet *fs = &m->c->fields;
  const double   *s = &m->col_scale[I * fs->n], T = fs->heat ? x[PlaceT(fs)] * s[PlaceT(fs)] : 0.0;
  double          p[PHASE_COUNT], d[PHASE_COUNT]; /* SNES takes the update off */

  for (int k = 0; k < PHASE_COUNT; k++) {
    p[k] = x[PlaceP(fs, k)] * s[PlaceP(fs, k)];
    d[k] = -y[PlaceP(fs, k)] * s[PlaceP(fs, k)];
  }
  if (NodeMaterial(m, I)->gas.trace == 0.0 || !FollowMethane(NodeMaterial(m, I), m->hydrate[I], p, d, T))
    return false;
  for (int k = 0; k < PHASE_COUNT; k++)
    y[PlaceP(fs, k)] = -d[k] / s[PlaceP(fs, k)];
  return true;
}

/* Is there a gas phase before and after the update? */
static bool HoldsGas(const Model *m, PetscInt I, const double *x, const double *y)
{
  const FieldSet *fs = &m->c->fields;
  const int       w = PlaceP(fs, PHASE_W), g = PlaceP(fs, PHASE_G);
  const double    pc = x[g] - x[w];

  return NodeMaterial(m, I)->gas.trace == 0.0 || (pc > 0.0 && pc - (y[g] - y[w]) > 0.0);
}

/* Share of a node's update that stays in the trusted range. */
static double NodeLimit(const Model *m, PetscInt I, const double *x, const double *y)
{
  const FieldSet *fs  = &m->c->fields;
  const double   *s   = &m->col_scale[I * fs->n];
  double          cut = 1.0;

  if (fs->heat) {
    const double dT = fabs(y[PlaceT(fs)] * s[PlaceT(fs)]);

    if (dT > LIMIT_T)
      cut = fmin(cut, LIMIT_T / dT);
  }
  if (fs->phase[PHASE_G] && HoldsGas(m, I, x, y)) {
    const int    g   = PlaceP(fs, PHASE_G); /* a step of p_g goes no farther than half of it (349) */
    const double dpg = fabs(y[g]), pg = fmax(fabs(x[g]), m->coef[I * NC_COUNT + NC_P + PHASE_G] / s[g]);

    if (dpg > LIMIT_P * pg)
      cut = fmin(cut, LIMIT_P * pg / dpg);
  }
  for (int d = 0; fs->solid && d < CL_DIM; d++) {
    const double du = fabs(y[PlaceVs(fs) + d] * s[PlaceVs(fs) + d]) * m->stage.dt;
    const double h  = LinesLess(&m->grid.line[d], m->map.ij[I][d]);

    if (du > CL_LIMIT_J * h)
      cut = fmin(cut, CL_LIMIT_J * h / du);
  }
  return cut;
}

/* Y with the updates of (104); false, and no vector, where no rank has any. */
static PetscErrorCode FollowAll(const Model *m, Vec X, Vec Y, Vec *followed)
{
  const PetscInt n = m->c->fields.n;
  const double  *x;
  double        *y;
  int            any = 0;

  PetscFunctionBeginUser;
  *followed = NULL;
  if (!(m->c->fields.has & HAS_GAS))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(Y, followed));
  PetscCall(VecCopy(Y, *followed));
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(VecGetArray(*followed, &y));
  for (PetscInt I = 0; I < m->map.n_owned; I++)
    any |= Follow(m, I, &x[I * n], &y[I * n]);
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscCall(VecRestoreArray(*followed, &y));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, m->grid.comm));
  if (!any)
    PetscCall(VecDestroy(followed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All of Y by the least share that a node's may be. */
static PetscErrorCode Shorten(const Model *m, Vec X, Vec Y, bool *shorter)
{
  const PetscInt n = m->c->fields.n;
  const double  *x, *y;
  double         cut = 1.0;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(VecGetArrayRead(Y, &y));
  for (PetscInt I = 0; I < m->map.n_owned; I++)
    cut = fmin(cut, NodeLimit(m, I, &x[I * n], &y[I * n]));
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscCall(VecRestoreArrayRead(Y, &y));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &cut, 1, MPI_DOUBLE, MPI_MIN, m->grid.comm));
  *shorter = cut < 1.0;
  if (*shorter)
    PetscCall(VecScale(Y, cut));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Are updates shortened until the residual falls? */
static bool Searches(const Model *m)
{
  return ModelVelocitiesFollow(m) || m->solver->searches; /* updates halved from one first guess (426) */
}

/* Norm of the scaled residual that a share of Y leaves, fluid velocities with the pressures. */
static PetscErrorCode Leaves(SNES snes, Model *m, Vec X, double share, Vec Y, const Vec work[2], double *norm)
{
  PetscFunctionBeginUser;
  PetscCall(VecWAXPY(work[0], -share, Y, X));
  PetscCall(ModelVelocitiesOfPressures(m, work[0]));
  PetscCall(SNESComputeFunction(snes, work[0], work[1]));
  PetscCall(VecNorm(work[1], NORM_2, norm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (415): which of the updates, the first of them being Newton's, and what share of it. */
static PetscErrorCode Choose(SNES snes, Model *m, Vec X, const Vec update[2], int *chosen, double *share)
{
  const int halvings = Searches(m) ? HALVINGS : 0;
  double    from, norm, least = INFINITY, trial = 1.0;
  Vec       work[2];

  PetscFunctionBeginUser;
  *chosen = 0;
  *share  = 1.0;
  PetscCall(VecDuplicate(X, &work[0]));
  PetscCall(VecDuplicate(X, &work[1]));
  PetscCall(SNESGetFunctionNorm(snes, &from));
  for (int k = 0; k <= halvings && !(least <= (1.0 - DESCENT * trial) * from); k++) {
    trial = ldexp(1.0, -k);
    for (int of = 0; of < 2 && update[of]; of++) {
      PetscCall(Leaves(snes, m, X, trial, update[of], work, &norm));
      if (norm < least) { /* not so where it is no number */
        least   = norm;
        *chosen = of;
        *share  = trial;
      }
    }
  }
  PetscCall(
      PetscInfo(snes, "update%s: share %g leaves %.3e of %.3e\n", *chosen ? " of methane" : "", *share, least, from));
  PetscCall(VecDestroy(&work[0]));
  PetscCall(VecDestroy(&work[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelLimitUpdate(SNESLineSearch ls, Vec X, Vec Y, PetscBool *changed, void *model)
{
  Model *m         = (Model *)model;
  Vec    update[2] = {Y};
  bool   shorter;
  SNES   snes;
  double share;
  int    chosen;

  PetscFunctionBeginUser;
  PetscCall(FollowAll(m, X, Y, &update[1]));
  PetscCall(Shorten(m, X, Y, &shorter));
  *changed = shorter;
  if (!update[1] && !Searches(m))
    PetscFunctionReturn(PETSC_SUCCESS);
  if (update[1])
    PetscCall(Shorten(m, X, update[1], &shorter));
  PetscCall(SNESLineSearchGetSNES(ls, &snes));
  PetscCall(Choose(snes, m, X, update, &chosen, &share));
  if (chosen)
    PetscCall(VecCopy(update[1], Y));
  PetscCall(VecScale(Y, share));
  *changed |= chosen || share < 1.0;
  PetscCall(VecDestroy(&update[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
