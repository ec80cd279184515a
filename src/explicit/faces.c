/* Surface faces: forces in the first pass, what crosses them in the second; docs/equations.md, sections 6 and 12. */
#include "lanes.h"

/* Nodes of a face's particle with their weights there; their number. */
static int Reach(const Explicit *e, const Face *f, PetscInt node[CL_NODES], double S[CL_NODES])
{
  Stencil s;
  double  G[CL_NODES][CL_DIM], H[CL_NODES];

  ParticleStencil(e->m->c, &e->m->grid, &e->m->P, f->particle, &s);
  return StencilExpand(&s, &e->m->grid, &e->map, node, S, G, H);
}

int FaceNodes(const Explicit *e, const Face *f, PetscInt node[CL_NODES])
{
  double S[CL_NODES];

  return Reach(e, f, node, S);
}

/* The faces that act; the rest are closed, adiabatic and free by themselves, but in the bare form, whose forces by
   parts end there. */
PetscErrorCode FacesBegin(Explicit *e)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(FacesBuild(e->m->c, &e->m->grid, &e->m->P, &e->nface, &e->face));
  for (PetscInt k = 0; k < e->nface; k++) {
    if (e->o.paper || FaceActs(e->m->c, &e->face[k]))
      e->face[n++] = e->face[k];
  }
  e->nface = n;
  PetscCall(PetscFree(e->pull));
  PetscCall(PetscCalloc1(n, &e->pull));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Inputs of a face at t_n: the particle's own values and gradients. */
static void Inputs(const Explicit *e, const Face *f, double in[IN_COUNT])
{
  double *const *P = e->m->P.f;
  const PetscInt p = f->particle;
  const Set      s = e->set;

  for (int q = 0; q < IN_COUNT; q++)
    in[q] = 0.0;
  in[IN_T] = s.heat ? P[P_T][p] : e->t[T_T][p];
  for (int k = 0; k < s.fluids; k++) {
    in[IN_P + k] = P[P_PW + k][p];
    for (int d = 0; d < CL_DIM; d++)
      in[VectorAt(IN_GP, k, d)] = P[VectorAt(P_GW, k, d)][p];
  }
  for (int d = 0; s.heat && d < CL_DIM; d++)
    in[IN_GT + d] = P[P_GT + d][p];
}

static const Material *MaterialOf(const Explicit *e, const Face *f)
{
  return &e->m->c->material[e->m->c->region[f->region].material];
}

static void Evaluate(const Explicit *e, const Face *f, const double in[IN_COUNT], double dt, FaceOutput *o)
{
  const Material *mat = MaterialOf(e, f);
  PointProperties q   = {0};
  const char     *why;
  double          p0[PHASE_COUNT], velocity[CL_DIM] = {0.0};

  for (int d = 0; e->set.solid && d < CL_DIM; d++)
    velocity[d] = e->m->P.f[P_VS + d][f->particle];
  ModelInitialAtFace(e->m, f, p0);
  if (f->bc[BC_FACE_TEMPERATURE] >= 0 || f->bc[BC_WELL] >= 0 ||
      mat->retention.hydrate > 0.0) /* who else asks for conductivity or S_h? */
    ModelParticleProperties(e->m, f->particle, &q, &why);
  FaceEvaluate(&(FaceInput){e->m->c, f, &e->m->bc, mat, p0, in, velocity, q.Sh, q.kappa, dt}, o);
}

PetscErrorCode FacesConductance(const Explicit *e, double *conductance)
{
  const Model *m    = e->m;
  Face        *face = NULL;
  PetscInt     n;

  PetscFunctionBeginUser;
  PetscCall(FacesBuild(m->c, &m->grid, &m->P, &n, &face));
  for (PetscInt k = 0; k < n; k++) {
    Face      *f = &face[k];
    FaceOutput o;
    double     in[IN_COUNT];

    if (f->bc[BC_FACE_TEMPERATURE] < 0 && f->bc[BC_CONVECTION] < 0)
      continue;
    FacePlace(m->c, &m->grid, &m->P, f);
    Inputs(e, f, in);
    Evaluate(e, f, in, 1.0, &o);
    conductance[f->particle] += o.D[F_T][IN_T];
  }
  PetscCall(PetscFree(face));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tractions, and for the fluids what a prescribed pressure differs from the body's own at the face. */
void FacesForces(Explicit *e, double dt)
{
  const Set s     = e->set;
  const int width = LANES * Rows(A_Count(s));

  for (PetscInt k = 0; k < e->nface; k++) {
    Face      *f = &e->face[k];
    FaceOutput o;
    double     in[IN_COUNT], force[PHASE_COUNT][CL_DIM] = {{0.0}};
    PetscInt   node[CL_NODES];
    double     S[CL_NODES];
    const int  n = Reach(e, f, node, S);

    FacePlace(e->m->c, &e->m->grid, &e->m->P, f);
    ModelFaceProperties(e->m, f, n, S);
    if (f->share > 0.0)
      continue; /* a well or a source pulls at nothing */
    Inputs(e, f, in);
    Evaluate(e, f, in, dt, &o);
    const double conduct = Conductance(e, s, f->particle);
    for (int d = 0; s.solid && d < CL_DIM; d++)
      e->pull[k][d] = -o.out[F_VS + d];
    if (f->bc[BC_PLATE] >= 0)
      PlatesDeposit(e, f, n, node);
    for (int ph = 0; ph < s.fluids; ph++) { /* the bare form's forces by parts end at the face */
      const double p = FacePressure(f, ph, in);

      for (int d = 0; d < CL_DIM; d++)
        force[ph][d] = -o.out[VectorAt(F_VW, ph, d)] - (e->o.paper ? p * f->n[d] : 0.0);
    }
    for (int ph = 0; ph < s.fluids; ph++)
      Drive(e, s, f->particle, force[ph]);
    for (int a = 0; a < n; a++) {
      double *row = &e->A[node[a] * width];

      for (int d = 0; d < CL_DIM; d++) {
        if (s.solid)
          row[A_Force(s) + d] += f->N[a] * e->pull[k][d];
        for (int ph = 0; ph < s.fluids; ph++)
          row[A_Fluid(s, ph) + FL_G + d] += conduct * f->N[a] * force[ph][d];
      }
    }
  }
}

void FacesWork(Explicit *e, double dt)
{
  const Set s     = e->set;
  const int width = LANES * Rows(B_Count(s));

  for (PetscInt k = 0; s.solid && k < e->nface; k++) {
    const double *pull = e->pull[k];
    PetscInt      node[CL_NODES];

    if (VectorDot(pull, pull) == 0.0)
      continue;
    const int n = FaceNodes(e, &e->face[k], node);
    for (int a = 0; a < n; a++) {
      const double *b = &e->B[node[a] * width];

      for (int d = 0; d < CL_DIM; d++)
        e->work[WORK_LOADS] += dt * pull[d] * e->face[k].N[a] * b[d];
    }
  }
}

/* What the nodes say at a face with its weights: Darcy fluxes (19), and to a well, as to the flow to it, the fields at
   t_n (367). */
static void NodalInputs(const Explicit *e, const Face *f, int n, const PetscInt node[], double in[IN_COUNT])
{
  const Set    s       = e->set;
  const int    width   = LANES * Rows(B_Count(s));
  const double conduct = Conductance(e, s, f->particle);
  const bool   well    = f->bc[BC_WELL] >= 0;

  for (int k = 0; well && k < s.fluids; k++)
    in[IN_P + k] = 0.0;
  in[IN_T] = well && s.heat ? 0.0 : in[IN_T];
  for (int a = 0; a < n; a++) {
    const double *b = &e->B[node[a] * width];

    in[IN_T] += well && s.heat ? f->N[a] * b[B_T(s)] : 0.0;
    for (int k = 0; k < s.fluids; k++) {
      in[IN_P + k] += well ? f->N[a] * b[B_P(s, k)] : 0.0;
      for (int d = 0; d < CL_DIM; d++)
        in[VectorAt(IN_J, k, d)] += conduct * f->N[a] * b[B_Fluid(s, k) + B_J + d];
    }
  }
  for (int k = 0; k < s.fluids; k++)
    Drive(e, s, f->particle, &in[VectorAt(IN_J, k, 0)]);
}

void FacesRates(Explicit *e, double dt, StageRates *rates)
{
  const Set s     = e->set;
  const int width = LANES * Rows(R_Count(s));

  for (PetscInt k = 0; k < e->nface; k++) {
    Face      *f = &e->face[k];
    FaceOutput o;
    double     in[IN_COUNT], weight = 0.0;
    PetscInt   node[CL_NODES];
    const int  n = FaceNodes(e, f, node);

    Inputs(e, f, in);
    NodalInputs(e, f, n, node, in);
    for (int ph = 0; ph < s.fluids; ph++)
      FaceDirection(f, ph, &in[VectorAt(IN_J, ph, 0)]);
    Evaluate(e, f, in, dt, &o);
    for (int a = 0; a < n; a++) {
      double *row = &e->R[node[a] * width];

      weight += f->N[a];
      for (int ph = 0; ph < s.fluids; ph++)
        row[ph] -= FaceWeight(f, a, F_PW + ph) * o.out[F_PW + ph];
      if (s.heat)
        row[s.fluids] -= dt * f->N[a] * o.out[F_T];
    }
    ModelCountFace(e->m->c, f, dt * weight, &o, rates);
  }
}
