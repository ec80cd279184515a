/* Surface faces: forces in the first pass, what crosses them in the second; docs/equations.md, sections 6 and 12. */
#include "lanes.h"

static bool Acts(const Scene *c, const Face *f)
{
  bool acts = c->ambient_drag > 0.0 && c->fields.solid;

  for (PetscInt k = 0; k < c->nmeter; k++)
    acts = acts || (f->meters >> k & 1);
  for (int kind = BC_NONE + 1; kind < BC_FACES; kind++)
    acts = acts || f->bc[kind] >= 0;
  return acts;
}

/* Weights of a face's particle where it is now. */
static void Place(const Explicit *e, PetscInt p, Stencil *s)
{
  const Grid *g = &e->m->grid;

  s->r = 0.0;
  for (int d = 0; d < CL_DIM; d++)
    BasisAxis(e->m->c->basis, e->m->P.f[P_X + d][p], e->m->P.f[P_L + d][p], &g->line[d], &s->axis[d]);
}

void FacesPlace(const Explicit *e, Face *f)
{
  Stencil s;

  Place(e, f->particle, &s);
  FacePlace(e->m->c, &e->m->grid, &e->m->P, &s, f);
}

int FaceNodes(const Explicit *e, const Face *f, PetscInt node[CL_NODES])
{
  Stencil s;
  double  S[CL_NODES], G[CL_NODES][CL_DIM], H[CL_NODES];

  Place(e, f->particle, &s);
  return StencilExpand(&s, &e->m->grid, &e->map, node, S, G, H);
}

/* The faces on which something is prescribed or counted; the rest are closed, adiabatic and free by themselves, but in
   the bare form, whose forces by parts end there. */
PetscErrorCode FacesBegin(Explicit *e)
{
  Stencil *stencil;
  PetscInt n     = 0;
  bool     wells = false;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(e->m->P.n, &stencil));
  for (PetscInt k = 0; k < e->m->c->nbc; k++)
    wells = wells || e->m->c->bc[k].type == BC_WELL;
  for (PetscInt p = 0; p < e->m->P.n; p++) {
    if (wells || e->m->P.i[PI_FACES][p])
      Place(e, p, &stencil[p]);
  }
  PetscCall(FacesBuild(e->m->c, &e->m->grid, &e->m->P, stencil, &e->nface, &e->face));
  for (PetscInt k = 0; k < e->nface; k++) {
    if (e->o.particle_pressures || Acts(e->m->c, &e->face[k]))
      e->face[n++] = e->face[k];
  }
  e->nface = n;
  PetscCall(PetscFree(e->pull));
  PetscCall(PetscCalloc1(n, &e->pull));
  PetscCall(PetscFree(stencil));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  int      n;
  PetscInt node[CL_NODES];
} Nodes;

/* A face with its nodes, in the order of its weights. */
static void Reach(const Explicit *e, Face *f, bool place, Nodes *r)
{
  Stencil         s;
  PointProperties q;
  const char     *why;
  double          S[CL_NODES], G[CL_NODES][CL_DIM], H[CL_NODES];

  Place(e, f->particle, &s);
  r->n = StencilExpand(&s, &e->m->grid, &e->map, r->node, S, G, H);
  if (!place)
    return;
  FacePlace(e->m->c, &e->m->grid, &e->m->P, &s, f);
  if ((f->bc[BC_INFLOW] < 0 && f->share == 0.0) || ModelParticleProperties(e->m, f->particle, &q, &why) != CL_OK)
    return;
  FaceInflow(f, r->n, S, q.kr);
  WellProperties(&q, f);
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
  if (f->bc[BC_FACE_TEMPERATURE] >= 0 || f->share > 0.0 ||
      mat->retention.hydrate > 0.0) /* who else asks for conductivity or S_h? */
    ModelParticleProperties(e->m, f->particle, &q, &why);
  FaceEvaluate(e->m->c, f, &e->m->bc, mat, p0, q.Sh, in, velocity, q.kappa, dt, o);
}

/* Tractions, and for the fluids what a prescribed pressure differs from the body's own at the face. */
void FacesForces(Explicit *e, double dt)
{
  const Set s     = e->set;
  const int width = LANES * Rows(A_Count(s));

  for (PetscInt k = 0; k < e->nface; k++) {
    Face      *f = &e->face[k];
    Nodes      r;
    FaceOutput o;
    double     in[IN_COUNT], force[PHASE_COUNT][CL_DIM] = {{0.0}};

    Reach(e, f, true, &r);
    if (f->share > 0.0)
      continue; /* a well pulls at nothing */
    Inputs(e, f, in);
    Evaluate(e, f, in, dt, &o);
    const double conduct = Conductance(e, s, f->particle);
    for (int d = 0; s.solid && d < CL_DIM; d++)
      e->pull[k][d] = -o.out[F_VS + d];
    if (f->bc[BC_PLATE] >= 0)
      PlatesDeposit(e, f, r.n, r.node);
    for (int ph = 0; ph < s.fluids; ph++) { /* the bare form's forces by parts end at the face */
      const double p = FacePressure(f, ph, in);

      for (int d = 0; d < CL_DIM; d++)
        force[ph][d] = -o.out[VectorAt(F_VW, ph, d)] - (e->o.particle_pressures ? p * f->n[d] : 0.0);
    }
    for (int ph = 0; s.beds && ph < s.fluids; ph++) {
      const Beds A = BedsAt(e, f->particle);

      BedsDrive(&A, force[ph]);
    }
    for (int a = 0; a < r.n; a++) {
      double *row = &e->A[r.node[a] * width];

      for (int d = 0; d < CL_DIM; d++) {
        if (s.solid)
          row[A_Mix(s) + MIX_FX + d] += f->N[a] * e->pull[k][d];
        for (int ph = 0; ph < s.fluids; ph++)
          row[A_Fluid(s, ph) + FL_GX + d] += conduct * f->N[a] * force[ph][d];
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
    Nodes         r;

    if (pull[0] == 0.0 && pull[1] == 0.0)
      continue;
    Reach(e, &e->face[k], false, &r);
    for (int a = 0; a < r.n; a++) {
      const double *b = &e->B[r.node[a] * width];

      for (int d = 0; d < CL_DIM; d++)
        e->work[WORK_LOADS] += dt * pull[d] * e->face[k].N[a] * b[d];
    }
  }
}

/* Darcy fluxes at the face (19), with its own weights. */
static void Fluxes(const Explicit *e, const Face *f, const Nodes *r, double in[IN_COUNT])
{
  const Set    s       = e->set;
  const int    width   = LANES * Rows(B_Count(s));
  const double conduct = Conductance(e, s, f->particle);

  for (int a = 0; a < r->n; a++) {
    for (int ph = 0; ph < s.fluids; ph++) {
      for (int d = 0; d < CL_DIM; d++)
        in[VectorAt(IN_J, ph, d)] += conduct * f->N[a] * e->B[r->node[a] * width + B_Fluid(s, ph) + B_J + d];
    }
  }
}

/* (367): a well sees the fields of the nodes at t_n, as the flow to it does. */
static void NodalInputs(const Explicit *e, const Nodes *r, const double N[CL_NODES], double in[IN_COUNT])
{
  const Set s              = e->set;
  const int width          = LANES * Rows(B_Count(s));
  double    p[PHASE_COUNT] = {0.0}, T = 0.0;

  for (int a = 0; a < r->n; a++) {
    const double *b = &e->B[r->node[a] * width];

    T += s.heat ? N[a] * b[B_T(s)] : 0.0;
    for (int k = 0; k < s.fluids; k++)
      p[k] += N[a] * b[B_P(s, k)];
  }
  in[IN_T] = s.heat ? T : in[IN_T];
  for (int k = 0; k < s.fluids; k++)
    in[IN_P + k] = p[k];
}

void FacesRates(Explicit *e, double dt, StageRates *rates)
{
  const Set s     = e->set;
  const int width = LANES * Rows(R_Count(s));

  for (PetscInt k = 0; k < e->nface; k++) {
    Face      *f = &e->face[k];
    Nodes      r;
    FaceOutput o;
    double     in[IN_COUNT], weight = 0.0;

    Reach(e, f, false, &r);
    Inputs(e, f, in);
    Fluxes(e, f, &r, in);
    if (f->share > 0.0)
      NodalInputs(e, &r, f->N, in);
    for (int ph = 0; ph < s.fluids; ph++)
      FaceDirection(e->m->c, f, ph, &in[VectorAt(IN_J, ph, 0)]);
    Evaluate(e, f, in, dt, &o);
    for (int a = 0; a < r.n; a++) {
      double *row = &e->R[r.node[a] * width];

      weight += f->N[a];
      for (int ph = 0; ph < s.fluids; ph++)
        row[ph] -= FaceWeight(f, a, F_PW + ph) * o.out[F_PW + ph];
      if (s.heat)
        row[s.fluids] -= dt * f->N[a] * o.out[F_T];
    }
    ModelCountFace(e->m->c, f, dt * weight, &o, rates);
  }
}
