/* Plates in the implicit model: stiffness of their springs, position where the force is prescribed, reaction.
   docs/equations.md, section 6. */
#include "gather.h"

PetscErrorCode ModelPlatesCreate(Model *m)
{
  const Scene *c = m->c;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->nlisted; k++)
    m->plates += c->listed[k].type == BC_PLATE;
  PetscCall(PetscCalloc2(c->nlisted, &m->plate, c->nlisted, &m->plate_K));
  for (PetscInt k = 0; k < c->nlisted; k++) {
    if (c->listed[k].type == BC_PLATE)
      m->plate[k][PLATE_POSITION] = PlatePosition(&c->listed[k], 0.0);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ModelPlateStiffness(const Model *m, Face *f)
{
  PointProperties q;
  const char     *why;

  f->K =
      ModelParticleProperties(m, f->particle, &q, &why) == CL_OK
          ? PlateStiffness(&m->c->bc[f->bc[BC_PLATE]], f, &q,
                           LinesWidthAt(&m->grid.line[SideAxis(f->side)], m->P.f[P_X + SideAxis(f->side)][f->particle]))
          : 0.0; /* the projection says why */
}

/* Displacement of a face along its plate's axis since t_n. */
static double FaceMotion(const Model *m, const Face *f, const double *x)
{
  const FieldSet *fs = &m->c->fields;
  const int       d  = SideAxis(f->side);
  double          u  = 0.0;
  Reach           r;

  ReachExpand(m, f->particle, &r);
  for (int a = 0; a < r.n; a++)
    u += f->N[a] * (m->stage.u_star[r.node[a] * CL_DIM + d] + m->stage.dt * x[r.node[a] * fs->n + PlaceVs(fs) + d]);
  return u;
}

/* One pass of (73): sums of K s and K over the faces that touch a plate at its present position (all of them at first),
   and their number. */
static void SumSprings(const Model *m, const double *u, bool first, double (*sum)[3])
{
  for (PetscInt k = 0; k < m->nface; k++) {
    const Face *f = &m->face[k];
    const Bc   *b = f->bc[BC_PLATE] >= 0 ? &m->c->bc[f->bc[BC_PLATE]] : NULL;

    if (!b || !b->force.n)
      continue;
    const double s = SideSign(f->side) * (f->moved[SideAxis(f->side)] + u[k]);
    if (b->separates && !first && s <= SideSign(f->side) * m->bc.value[f->bc[BC_PLATE]])
      continue;
    sum[f->bc[BC_PLATE]][0] += f->K * s;
    sum[f->bc[BC_PLATE]][1] += f->K;
    sum[f->bc[BC_PLATE]][2] += 1.0;
  }
}

static bool AnyForce(const Scene *c)
{
  for (PetscInt k = 0; k < c->nbc; k++) {
    if (c->bc[k].force.n)
      return true;
  }
  return false;
}

PetscErrorCode PlatesPosition(Model *m, const double *x)
{
  const Scene *c     = m->c;
  bool         again = true;
  double      *u, (*sum)[3], *touching;

  PetscFunctionBeginUser;
  if (!m->plates || !AnyForce(c))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc3(m->nface, &u, c->nbc, &sum, c->nbc, &touching));
  for (PetscInt k = 0; k < m->nface; k++) {
    if (m->face[k].bc[BC_PLATE] >= 0)
      u[k] = FaceMotion(m, &m->face[k], x);
  }
  /* fewer and fewer faces touch: the force is a convex function of the position, met from the left */
  for (bool first = true; again; first = false) {
    again = false;
    PetscCall(PetscArrayzero(sum, c->nbc));
    SumSprings(m, u, first, sum);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(3 * c->nbc), MPI_DOUBLE, MPI_SUM, m->grid.comm));
    for (PetscInt k = 0; k < c->nbc; k++) {
      if (!c->bc[k].force.n || sum[k][2] == 0.0 || (!first && sum[k][2] == touching[k]))
        continue;
      m->bc.value[k] = SideSign(c->bc[k].side) * (sum[k][0] - PlateForce(&c->bc[k], m->stage.t)) / sum[k][1];
      m->plate_K[k]  = sum[k][1];
      touching[k]    = sum[k][2];
      again          = again || c->bc[k].separates;
    }
  }
  PetscCall(PetscFree3(u, sum, touching));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void PlatesMark(Model *m, const double *x)
{
  for (PetscInt k = 0; m->plates && k < m->nface; k++) {
    Face *f = &m->face[k];

    if (f->bc[BC_PLATE] < 0)
      continue;
    const double s = f->moved[SideAxis(f->side)] + FaceMotion(m, f, x) - m->bc.value[f->bc[BC_PLATE]];
    f->touches     = !m->c->bc[f->bc[BC_PLATE]].separates || SideSign(f->side) * s > 0.0;
  }
}

/* (74) */
PetscErrorCode PlatesMult(const Model *m, const double *x, double *f)
{
  const Scene *c = m->c;
  double      *t;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(c->nbc, &t));
  for (int pass = 0; pass < 2; pass++) {
    for (PetscInt k = 0; k < m->nface; k++) {
      const Face *face = &m->face[k];
      const int   d    = SideAxis(face->side);
      Reach       r;

      if (face->bc[BC_PLATE] < 0 || !c->bc[face->bc[BC_PLATE]].force.n || !face->touches)
        continue;
      ReachExpand(m, face->particle, &r);
      for (int a = 0; a < r.n; a++) {
        const PetscInt q = r.node[a] * c->fields.n + PlaceVs(&c->fields) + d;
        const double   w = face->K * face->N[a];

        if (pass == 0)
          t[face->bc[BC_PLATE]] += w * m->stage.dt * x[q];
        else
          f[q] -= w * t[face->bc[BC_PLATE]] / m->plate_K[face->bc[BC_PLATE]];
      }
    }
    if (pass == 0)
      PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, t, (PetscMPIInt)c->nbc, MPI_DOUBLE, MPI_SUM, m->grid.comm));
  }
  PetscCall(PetscFree(t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

bool PlatesCouple(const Model *m)
{
  return m->plates && AnyForce(m->c);
}

PetscErrorCode ModelPlatesCheck(Model *m, ClStatus *status)
{
  char why[CL_WHY];

  PetscFunctionBeginUser;
  *status = CL_OK;
  if (!m->plates)
    PetscFunctionReturn(PETSC_SUCCESS);
  m->failure.status = CL_OK;
  for (PetscInt k = 0; k < m->nface && m->failure.status == CL_OK; k++) {
    const Face *f = &m->face[k];

    if (f->bc[BC_PLATE] < 0 || m->c->bc[f->bc[BC_PLATE]].force.n)
      continue;
    *status = PlateCheck(m->c, &m->grid, f, m->bc.value[f->bc[BC_PLATE]], why, sizeof(why));
    if (*status != CL_OK)
      ModelNoteFailure(m, *status, why, f->particle);
  }
  PetscCall(ModelReduceStatus(m, status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PlatesReport(Model *m, const double *x)
{
  PetscFunctionBeginUser;
  if (!m->plates)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PlatesPosition(m, x));
  PetscCall(PetscArrayzero(m->plate, m->c->nlisted));
  for (PetscInt k = 0; k < m->nface; k++) {
    Reach      r;
    FaceOutput o;

    if (m->face[k].bc[BC_PLATE] < 0)
      continue;
    FaceAt(m, &m->face[k], x, &r, &o);
    for (int q = PLATE_FORCE; q < PLATE_COUNT; q++)
      m->plate[m->c->bc[m->face[k].bc[BC_PLATE]].number][q] += o.plate[q];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, m->plate, (PetscMPIInt)(PLATE_COUNT * m->c->nlisted), MPI_DOUBLE, MPI_SUM,
                             m->grid.comm));
  for (PetscInt k = 0; k < m->c->nbc; k++) {
    if (m->c->bc[k].type == BC_PLATE)
      m->plate[m->c->bc[k].number][PLATE_POSITION] = m->bc.value[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
