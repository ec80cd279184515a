/* What the nodes do not see of the particles' pressures evens out within the cells; docs/equations.md, section 7. */
#include "gather.h"

#define PASSES 6

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
  const Exchange *e         = &m->added->exchange[p];
  const double    l[CL_DIM] = {m->P.f[P_L][p], m->P.f[P_L + 1][p]};
  double          apart     = 0.0;
  Reach           r;

  ReachExpand(m, p, &r);
  for (int f = 0; f < PHASE_COUNT; f++)
    apart += e->share[f] != 0.0 ? e->share[f] * Shift(m, p, &r, F_PW + f) : 0.0;
  return ExchangeShare(e->mobility, e->storage, l, m->stage.ahead) * apart;
}

/* (354): takes away what the nodes see of it. */
static PetscErrorCode Hide(Model *m, double *sum)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(sum, m->map.n_local));
  for (PetscInt p = 0; p < m->P.n; p++) {
    Reach r;

    ReachExpand(m, p, &r);
    for (int a = 0; a < r.n; a++)
      sum[r.node[a]] += m->P.f[P_V][p] * r.S[a] * m->added->exchange[p].change;
  }
  PetscCall(NodeMapSum(&m->map, sum, 1));
  for (PetscInt p = 0; p < m->P.n; p++) {
    Reach r;

    ReachExpand(m, p, &r);
    for (int a = 0; a < r.n; a++)
      m->added->exchange[p].change -= r.S[a] * sum[r.node[a]] / m->V[r.node[a]];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ExchangeBuild(Model *m)
{
  double *sum;

  PetscFunctionBeginUser;
  if (!SceneExchanges(m->c)) /* a rank without particles has no list, but is asked for sums */
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt p = 0; p < m->P.n; p++)
    m->added->exchange[p].change = Exchanged(m, p);
  PetscCall(PetscMalloc1(m->map.n_local, &sum));
  for (int k = 0; k < PASSES; k++)
    PetscCall(Hide(m, sum));
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}
