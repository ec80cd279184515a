/* What the nodes do not see of the particles' pressures evens out within the cells; docs/equations.md, section 7. */
#include "gather.h"

#define HIDDEN 1e-8 /* of the moments of y, what (354) may leave, in the norm of r . r/(diagonal) */
#define MOST_ITERATIONS 2000

void ExchangeSet(const Model *m, PetscInt p, const PointProperties *q)
{
  Exchange *e = &m->added->exchange[p];

  e->mobility = 0.0;
  e->storage  = q->compressibility + (m->c->fields.solid ? 1.0 / q->M : 0.0);
  for (int f = 0; f < PHASE_COUNT; f++) {
    e->share[f] = m->c->fields.phase[f] ? q->s[f] : 0.0;
    e->mobility += m->c->fields.phase[f] ? q->kr[f] / q->resist[f] : 0.0;
  }
}

/* (353) as if nodes saw none of it. */
static double Exchanged(const Model *m, PetscInt p)
{
  const Exchange *e     = &m->added->exchange[p];
  double          apart = 0.0, l[CL_DIM];
  Reach           r;

  for (int d = 0; d < CL_DIM; d++)
    l[d] = m->P.f[P_L + d][p];
  ReachExpand(m, p, &r);
  for (int f = 0; f < PHASE_COUNT; f++)
    apart += e->share[f] != 0.0 ? e->share[f] * Shift(m, p, &r, F_PW + f) : 0.0;
  return ExchangeShare(e->mobility, e->storage, l, m->stage.ahead) * apart;
}

static double Seen(const Reach *r, const double *x)
{
  double v = 0.0;

  for (int a = 0; a < r->n; a++)
    v += r->S[a] * x[r->node[a]];
  return v;
}

/* v_p of sum_p V S_I v_p: a particle's y, sum_J S_J x_J of a nodal field x, or S_I itself. */
typedef enum { OF_CHANGE, OF_FIELD, OF_WEIGHT } Moment;

/* sum_p V S_I v_p over all ranks, as a vector over the owned nodes; x is [n_local]. */
static PetscErrorCode Moments(Model *m, Moment of, const double *x, Vec M)
{
  double *sum, *owned;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->map.n_local, &sum));
  for (PetscInt p = 0; p < m->P.n; p++) {
    const double V = m->P.f[P_V][p];
    Reach        r;

    ReachExpand(m, p, &r);
    const double v = of == OF_FIELD ? Seen(&r, x) : m->added->exchange[p].change;
    for (int a = 0; a < r.n; a++)
      sum[r.node[a]] += r.S[a] * V * (of == OF_WEIGHT ? r.S[a] : v);
  }
  PetscCall(NodeMapReduce(&m->map, sum, 1));
  PetscCall(VecGetArrayWrite(M, &owned));
  PetscCall(PetscArraycpy(owned, sum, m->map.n_owned));
  PetscCall(VecRestoreArrayWrite(M, &owned));
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* [n_local] of a vector over the owned nodes, ghosts included. */
static PetscErrorCode Nodal(Model *m, Vec X, double *x)
{
  const double *owned;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(X, &owned));
  PetscCall(PetscArraycpy(x, owned, m->map.n_owned));
  PetscCall(VecRestoreArrayRead(X, &owned));
  PetscCall(NodeMapBroadcast(&m->map, x, 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MassMult(Mat A, Vec X, Vec Y)
{
  Model  *m;
  double *x;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &m));
  PetscCall(PetscMalloc1(m->map.n_local, &x));
  PetscCall(Nodal(m, X, x));
  PetscCall(Moments(m, OF_FIELD, x, Y));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sum_p V S_I^2.  A node that sees next to nothing of its particles has S_I of its lumped mass left on the diagonal:
   scaled by that mass conjugate gradients do not converge. */
static PetscErrorCode MassDiagonal(Mat A, Vec D)
{
  Model *m;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &m));
  PetscCall(Moments(m, OF_WEIGHT, NULL, D));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nodal field of (354), [n_local]; *found is false where that has not converged.  Its solver takes options
   -exchange_ksp_. */
static PetscErrorCode Project(Model *m, double *x, bool *found)
{
  const PetscInt     n = m->map.n_owned, N = m->map.n_global;
  Mat                A;
  Vec                X, B;
  KSP                ksp;
  PC                 pc;
  KSPConvergedReason why;

  PetscFunctionBeginUser;
  PetscCall(MatCreateShell(m->grid.comm, n, n, N, N, m, &A));
  PetscCall(MatShellSetOperation(A, MATOP_MULT, (void (*)(void))MassMult));
  PetscCall(MatShellSetOperation(A, MATOP_GET_DIAGONAL, (void (*)(void))MassDiagonal));
  PetscCall(MatSetOption(A, MAT_SPD, PETSC_TRUE));
  PetscCall(MatCreateVecs(A, &X, &B));
  PetscCall(Moments(m, OF_CHANGE, NULL, B));
  PetscCall(KSPCreate(m->grid.comm, &ksp));
  PetscCall(KSPSetType(ksp, KSPCG));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCJACOBI));
  PetscCall(KSPSetNormType(ksp, KSP_NORM_NATURAL));
  PetscCall(KSPSetTolerances(ksp, HIDDEN, PETSC_DEFAULT, PETSC_DEFAULT, MOST_ITERATIONS));
  PetscCall(KSPSetOptionsPrefix(ksp, "exchange_"));
  PetscCall(KSPSetFromOptions(ksp));
  PetscCall(KSPSolve(ksp, B, X));
  PetscCall(KSPGetConvergedReason(ksp, &why));
  *found = why > 0;
  PetscCall(Nodal(m, X, x));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(VecDestroy(&X));
  PetscCall(VecDestroy(&B));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ExchangeBuild(Model *m)
{
  double *x;
  bool    found = false;

  PetscFunctionBeginUser;
  m->uneven = false;
  if (!SceneExchanges(m->c)) /* a rank without particles has no list, but is asked for sums */
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt p = 0; p < m->P.n; p++)
    m->added->exchange[p].change = Exchanged(m, p);
  PetscCall(PetscMalloc1(m->map.n_local, &x));
  PetscCall(Project(m, x, &found));
  m->uneven = !found;
  for (PetscInt p = 0; p < m->P.n; p++) {
    Reach r;

    ReachExpand(m, p, &r);
    m->added->exchange[p].change = found ? m->added->exchange[p].change - Seen(&r, x) : 0.0;
  }
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
