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
    const double *mix = &e->A[I * width + A_Mix(e->set)];

    for (int d = 0; d < CL_DIM; d++) {
      double value;

      e->answer[I][d] = Blended(e, I, e->node[I].own_v, 2 * CL_DIM, &own[0][0], d) +
                        (mix[MIX_M] > 0.0 ? mix[MIX_VX + d] / mix[MIX_M] : 0.0);
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

/* (73) with the answers of the nodes: position outwards of plate `which` such that its springs bear F. */
static PetscErrorCode Position(Explicit *e, PetscInt which, double F, const double (*face)[2])
{
  const Bc    *b  = &e->m->c->bc[which];
  const double n  = SideSign(b->side);
  double       at = 0.0, touching = 0.0;
  bool         again = true;

  PetscFunctionBeginUser;
  for (bool first = true; again; first = false) {
    double sum[3] = {0.0};

    for (PetscInt k = 0; k < e->nface; k++) {
      if (e->face[k].bc[BC_PLATE] != which || (b->separates && !first && n * face[k][0] <= face[k][1] * at))
        continue;
      sum[0] += n * face[k][0];
      sum[1] += face[k][1];
      sum[2] += 1.0;
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPI_DOUBLE, MPI_SUM, e->m->grid.comm));
    again = b->separates && sum[2] > 0.0 && (first || sum[2] != touching);
    if (sum[2] > 0.0 && (first || again)) {
      at       = (sum[0] - F) / sum[1];
      touching = sum[2];
    }
  }
  e->m->bc.value[which] = n * at;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Force of a face's plate to its nodes, and to what is said of the plate. */
static void Push(Explicit *e, const Face *f, double dt, const double answer[2])
{
  const Bc    *b = &e->m->c->bc[f->bc[BC_PLATE]];
  const int    d = SideAxis(f->side);
  const double n = SideSign(f->side), bears = n * (answer[0] - answer[1] * e->m->bc.value[f->bc[BC_PLATE]]);
  double       force[CL_DIM] = {0.0}, *sum = e->plate_sum[b->number], pull, k;
  PetscInt     node[CL_NODES];
  const int    nodes = FaceNodes(e, f, node);

  if (b->separates && bears <= 0.0)
    return;
  force[d] = -n * bears;
  sum[PLATE_FORCE] += bears;
  if (b->rough) {
    FaceAnswer(e, f, nodes, node, 1 - d, dt, &pull, &k);
    force[1 - d] = -pull;
    sum[PLATE_SHEAR] -= pull;
  }
  for (int a = 0; a < nodes; a++)
    AddRow(e->push[node[a]], f->N[a], force, CL_DIM);
}

/* Sums the forces over ranks and adds them to the balances, those of followers as (41) says. */
static PetscErrorCode Add(Explicit *e)
{
  const int width = LANES * Rows(A_Count(e->set)), at = A_Mix(e->set) + MIX_FX;

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
  const Scene *c = e->m->c;
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
  for (PetscInt k = 0; k < c->nbc; k++) {
    if (c->bc[k].type == BC_PLATE && c->bc[k].force.n)
      PetscCall(Position(e, k, PlateForce(&c->bc[k], t), (const double(*)[2])face));
  }
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
    FacesPlace(e, f);
    if (!e->m->c->bc[f->bc[BC_PLATE]].separates || PlateGap(f, e->m->bc.value[f->bc[BC_PLATE]], zero) > 0.0)
      e->plate_sum[e->m->c->bc[f->bc[BC_PLATE]].number][PLATE_AREA] += SideSign(f->side) * f->n[SideAxis(f->side)];
  }
}

PetscErrorCode PlatesEnd(Explicit *e)
{
  Model *m = e->m;

  PetscFunctionBeginUser;
  if (!e->nplate)
    PetscFunctionReturn(PETSC_SUCCESS);
  Areas(e);
  PetscCallMPI(MPI_Allreduce(e->plate_sum, m->plate, (PetscMPIInt)(PLATE_COUNT * m->c->nlisted), MPI_DOUBLE, MPI_SUM,
                             m->grid.comm));
  for (PetscInt k = 0; k < m->c->nbc; k++) {
    if (m->c->bc[k].type == BC_PLATE)
      m->plate[m->c->bc[k].number][PLATE_POSITION] = m->bc.value[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
