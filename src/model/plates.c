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

bool PlatesCouple(const Model *m)
{
  return PlatesForced(m->c);
}

PetscErrorCode PlatesPosition(Model *m, const double *x)
{
  double(*answer)[2];

  PetscFunctionBeginUser;
  if (!PlatesCouple(m))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(m->nface, &answer));
  for (PetscInt k = 0; k < m->nface; k++) {
    const Face *f = &m->face[k];

    if (f->bc[BC_PLATE] < 0)
      continue;
    answer[k][0] = f->K * (f->moved[SideAxis(f->side)] + FaceMotion(m, f, x));
    answer[k][1] = f->K;
  }
  PetscCall(PlatesSeek(m->c, m->grid.comm, m->nface, m->face, answer, m->stage.t, m->bc.value, m->plate_K));
  PetscCall(PetscFree(answer));
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

/* Adds the stiffness of free plates, of rank one each (74). */
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

PetscErrorCode ModelPlatesSum(Model *m)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, m->plate, (PetscMPIInt)(PLATE_COUNT * m->c->nlisted), MPI_DOUBLE, MPI_SUM,
                             m->grid.comm));
  for (PetscInt k = 0; k < m->c->nbc; k++) {
    if (m->c->bc[k].type == BC_PLATE)
      m->plate[m->c->bc[k].number][PLATE_POSITION] = m->bc.value[k];
  }
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
  PetscCall(ModelPlatesSum(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}
