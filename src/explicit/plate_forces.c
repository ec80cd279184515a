/* Forces of the plates at the end of a step, and what they bear (75); docs/equations.md, section 12. */
#include "nodes.h"

/* Velocity of node I along d without plates, and what its springs and those of its followers add to it when pulled by
   1 m; as the particles will see them (41). */
static PetscErrorCode Answers(Explicit *e, double dt)
{
  const int width = LANES * Rows(A_Count(e->set));
  double(*own)[2 * CL_DIM], (*lead)[CL_DIM];

  PetscFunctionBeginUser;
  PetscCall(NodeMapSum(&e->map, &e->spring[0][0], CL_DIM));
  PetscCall(PetscCalloc2(e->rows, &own, e->rows, &lead));
  for (PetscInt I = 0; I < e->map.n_local; I++) {
    const NodeInfo *n = &e->node[I];

    AddRow(lead[I], 1.0, e->spring[I], CL_DIM);
    if (n->root != (int)I)
      AddRow(lead[n->root], 1.0 - n->own_v, e->spring[I], CL_DIM);
  }
  for (PetscInt I = 0; I < e->map.n_owned; I++) {
    for (int d = 0; d < CL_DIM; d++) {
      const double k = e->node[I].leads ? lead[I][d] : e->spring[I][d];
      double       lhs;

      if (k == 0.0 || !(Volume(e, e->set, I) > 0.0))
        continue;
      own[I][d]          = NodeFree(e, I, d, dt, &lhs);
      own[I][CL_DIM + d] = k / lhs;
    }
  }
  PetscCall(NodeMapBroadcast(&e->map, &own[0][0], 2 * CL_DIM));
  for (PetscInt I = 0; I < e->map.n_owned; I++) {
    const double *a = &e->A[I * width], M = a[A_M(e->set)];

    for (int d = 0; d < CL_DIM; d++) {
      double value;

      e->answer[I][d] = Blended(e, I, e->node[I].own_v, 2 * CL_DIM, &own[0][0], d) +
                        (M > 0.0 ? a[A_Momentum(e->set, 0) + d] / M : 0.0);
      e->answer[I][CL_DIM + d] = Blended(e, I, e->node[I].own_v, 2 * CL_DIM, &own[0][0], CL_DIM + d);
      if (Held(e, I, F_VS + d, &value)) {
        e->answer[I][d]          = value;
        e->answer[I][CL_DIM + d] = 0.0;
      }
    }
  }
  PetscCall(NodeMapBroadcast(&e->map, &e->answer[0][0], 2 * CL_DIM));
  PetscCall(PetscFree2(own, lead));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the springs of a face would bear along d with the plate where it was at the start, and how much less for every
   metre that it gives way: all faces of a node pull it alike, so that an even pressure is met exactly (75). */
static void FaceAnswer(const Explicit *e, const Face *f, int n, const PetscInt node[], int d, double dt, double *pull,
                       double *k)
{
  double v = 0.0, add = 0.0;

  for (int a = 0; a < n; a++) {
    v += f->N[a] * e->answer[node[a]][d];
    add += f->N[a] * e->answer[node[a]][CL_DIM + d];
  }
  *k    = f->K / (1.0 + dt * add);
  *pull = *k * (f->moved[d] + dt * v);
}

/* Force of a face's plate to its nodes, and to what is said of the plate. */
static void Push(Explicit *e, const Face *f, double dt, const double answer[2])
{
  const Bc    *b = &e->m->c->bc[f->bc[BC_PLATE]];
  const int    d = SideAxis(f->side);
  const double n = SideSign(f->side), bears = n * (answer[0] - answer[1] * e->m->bc.value[f->bc[BC_PLATE]]);
  double       force[CL_DIM] = {0.0}, *sum = e->m->plate[b->number], pull, k;
  PetscInt     node[CL_NODES];
  const int    nodes = FaceNodes(e, f, node);

  if (b->separates && bears <= 0.0)
    return;
  force[d] = -n * bears;
  sum[PLATE_FORCE] += bears;
  for (int t = 0; t < CL_DIM && b->rough; t++) {
    if (t == d)
      continue;
    FaceAnswer(e, f, nodes, node, t, dt, &pull, &k);
    force[t] = -pull;
    sum[PLATE_SHEAR] -= pull;
  }
  for (int a = 0; a < nodes; a++)
    AddRow(e->push[node[a]], f->N[a], force, CL_DIM);
}

/* Sums the forces over ranks and adds them to the balances, those of followers as (41) says. */
static PetscErrorCode Add(Explicit *e)
{
  const int width = LANES * Rows(A_Count(e->set)), at = A_Force(e->set);

  PetscFunctionBeginUser;
  PetscCall(NodeMapSum(&e->map, &e->push[0][0], CL_DIM));
  for (PetscInt I = 0; I < e->map.n_local; I++) {
    const NodeInfo *n = &e->node[I];

    AddRow(&e->A[I * width + at], 1.0, e->push[I], CL_DIM);
    if (n->leads)
      AddRow(&e->G[I * width + at], 1.0, e->push[I], CL_DIM);
    if (n->root != (int)I)
      AddRow(&e->G[n->root * width + at], 1.0 - n->own_v, e->push[I], CL_DIM);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PlatesForces(Explicit *e, double t, double dt)
{
  double(*face)[2];

  PetscFunctionBeginUser;
  PetscCall(Answers(e, dt));
  PetscCall(PetscCalloc1(e->nface, &face));
  for (PetscInt k = 0; k < e->nface; k++) {
    const Face *f = &e->face[k];
    PetscInt    node[CL_NODES];

    if (f->bc[BC_PLATE] >= 0 && f->touches) {
      const int n = FaceNodes(e, f, node);

      FaceAnswer(e, f, n, node, SideAxis(f->side), dt, &face[k][0], &face[k][1]);
    }
  }
  PetscCall(PlatesSeek(e->m->c, e->m->grid.comm, e->nface, e->face, face, t, e->m->bc.value, NULL));
  for (PetscInt k = 0; k < e->nface; k++) {
    if (e->face[k].bc[BC_PLATE] >= 0 && e->face[k].touches)
      Push(e, &e->face[k], dt, face[k]);
  }
  PetscCall(PetscFree(face));
  PetscCall(Add(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Area under the plates where the faces are now. */
static void Areas(Explicit *e)
{
  const double zero[CL_DIM] = {0.0};

  for (PetscInt k = 0; k < e->nface; k++) {
    Face *f = &e->face[k];

    if (f->bc[BC_PLATE] < 0)
      continue;
    FacePlace(e->m->c, &e->m->grid, &e->m->P, f);
    if (!e->m->c->bc[f->bc[BC_PLATE]].separates || PlateGap(f, e->m->bc.value[f->bc[BC_PLATE]], zero) > 0.0)
      e->m->plate[e->m->c->bc[f->bc[BC_PLATE]].number][PLATE_AREA] += SideSign(f->side) * f->n[SideAxis(f->side)];
  }
}

PetscErrorCode PlatesEnd(Explicit *e)
{
  PetscFunctionBeginUser;
  if (!e->m->plates)
    PetscFunctionReturn(PETSC_SUCCESS);
  Areas(e);
  PetscCall(ModelPlatesSum(e->m));
  PetscFunctionReturn(PETSC_SUCCESS);
}
