/* Between the second and the third pass: increments of p_w, p_g, T at the nodes (37). */
#include "nodes.h"

/* What the row of a balance k of (37), r, lacks with the increments d: kg, J. */
INLINE double Lacking(const Set s, const double *r, int k, const double *d)
{
  const int n   = Scalars(s);
  double    sum = -r[k];

  for (int j = 0; j < n; j++)
    sum += r[R_Matrix(s) + k * n + j] * d[j];
  return sum;
}

/* Increments of p_w, p_g, T of a node, with what its followers gave it; a held temperature takes the heat it needs. */
INLINE void NodeScalars(Explicit *e, const Set s, PetscInt I)
{
  const int     n = Scalars(s);
  const double *r = &e->R[I * LANES * Rows(R_Count(s))], *a = &e->A[I * LANES * Rows(A_Count(s))];
  double        A[9], b[3], T;

  for (int k = 0; k < n; k++)
    b[k] = r[k];
  for (int k = 0; k < n * n; k++)
    A[k] = r[R_Matrix(s) + k];
  const bool held = s.heat && Held(e, I, F_T, &T);
  if (held) {
    for (int j = 0; j < n; j++)
      A[(n - 1) * n + j] = j == n - 1;
    b[n - 1] = e->again ? 0.0 : T - a[s.fluids] / a[A_C(s)];
  }
  SolveSmall(n, A, b, &e->gain[3 * I]);
  if (held && e->node[I].root == (int)I)
    e->heat_in += Lacking(s, r, n - 1, &e->gain[3 * I]);
}

/* Adds what a node gives up of its rows to those of the node it follows.  A temperature prescribed there is its own:
   what it does to the masses is known, and its row of heat says what it needs. */
static void Join(Explicit *e, PetscInt I)
{
  const Set     s     = e->set;
  const double  share = 1.0 - e->node[I].own;
  const int     n = Scalars(s), width = LANES * Rows(R_Count(s));
  const double *from = &e->R[I * width], *a = &e->A[I * LANES * Rows(A_Count(s))];
  double       *to = &e->R[e->node[I].root * width], T;

  if (e->again) { /* the matrix has it */
    AddRow(to, share, from, s.heat && Held(e, I, F_T, &T) ? s.fluids : n);
    return;
  }
  if (!s.heat || !Held(e, I, F_T, &T)) {
    AddRow(to, share, from, width);
    return;
  }
  const double dT = T - a[s.fluids] / a[A_C(s)];
  for (int k = 0; k < s.fluids; k++) {
    to[k] += share * (from[k] - from[R_Matrix(s) + k * n + s.fluids] * dT);
    for (int j = 0; j < s.fluids; j++)
      to[R_Matrix(s) + k * n + j] += share * from[R_Matrix(s) + k * n + j];
  }
}

/* Increments, to those so far where the node solves again. */
INLINE void WriteScalars(Explicit *e, const Set s, PetscInt I)
{
  const int     n = Scalars(s);
  const double *a = &e->A[I * LANES * Rows(A_Count(s))], *r = &e->R[I * LANES * Rows(R_Count(s))];
  double       *c = &e->C[I * C_Width(s)], d[3], T;

  for (int k = 0; k < n; k++)
    d[k] = Blended(e, I, e->node[I].own, 3, e->gain, k);
  if (s.heat && e->node[I].root != (int)I && Held(e, I, F_T, &T)) {
    d[s.fluids] = e->again ? 0.0 : T - a[s.fluids] / a[A_C(s)];
    e->heat_in += Lacking(s, r, s.fluids, d);
  }
  for (int k = 0; k < n; k++)
    c[k] = e->again ? c[k] + d[k] : d[k];
}

/* Row that the particles read: increments, end values, velocity of the skeleton. */
INLINE void WriteEnds(Explicit *e, const Set s, PetscInt I)
{
  const int     n = Scalars(s);
  const double *a = &e->A[I * LANES * Rows(A_Count(s))];
  double       *c = &e->C[I * C_Width(s)];

  for (int k = 0; k < n; k++)
    c[C_End(s) + k] = (k < s.fluids ? NodalPressure(s, a, k) : a[k] / a[A_C(s)]) + c[k];
  if (Relative(e, s)) {
    double d[2];

    PressuresOf(NodalPressure(s, a, PHASE_G), c, d);
    for (int k = 0; k < 2; k++)
      c[C_End(s) + k] = NodalPressure(s, a, k) + d[k];
  }
  if (s.fluids == 2 && fabs(c[1] - c[0]) > e->straight) /* (105): not to be believed; particles will say */
    c[C_End(s) + 1] = NodalPressure(s, a, PHASE_G);
  if (s.heat)
    e->warmed += a[A_C(s)] * c[s.fluids];
  for (int d = 0; s.solid && d < CL_DIM; d++)
    c[C_Vs(s) + d] = e->B[I * LANES * Rows(B_Count(s)) + d];
}

/* Loops over the nodes of this rank that particles reach. */
INLINE void ScalarsRun(Explicit *e, const Set s, Run r, double dt)
{
  (void)dt;
  for (PetscInt I = r.p; I < r.p + r.n; I++) {
    if (Volume(e, s, I) > 0.0)
      NodeScalars(e, s, I);
  }
}

INLINE void WriteRun(Explicit *e, const Set s, Run r, double dt)
{
  (void)dt;
  for (PetscInt I = r.p; I < r.p + r.n; I++) {
    if (Volume(e, s, I) > 0.0)
      WriteScalars(e, s, I);
    else
      memset(&e->C[I * C_Width(s)], 0, sizeof(Lanes));
  }
}

INLINE void EndsRun(Explicit *e, const Set s, Run r, double dt)
{
  (void)dt;
  for (PetscInt I = r.p; I < r.p + r.n; I++) {
    if (Volume(e, s, I) > 0.0)
      WriteEnds(e, s, I);
  }
}

MAKE_LOOPS(ScalarsRun)
MAKE_LOOPS(WriteRun)
MAKE_LOOPS(EndsRun)

/* Solves the rows as they stand for increments, which the particles can read then. */
static PetscErrorCode Solve(Explicit *e)
{
  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < e->map.n_local; I++) {
    if (e->node[I].root != (int)I)
      Join(e, I);
  }
  ForNodes(e, ScalarsRun_loops, 0.0);
  PetscCall(NodeMapBroadcast(&e->map, e->gain, 3));
  ForNodes(e, WriteRun_loops, 0.0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (413): solves for what lumped storage has given nodes of their particles' part beyond the particles' own. */
static PetscErrorCode Correct(Explicit *e)
{
  const Set s = e->set;
  const int n = Scalars(s), width = C_Width(s);

  PetscFunctionBeginUser;
  PetscCall(NodeMapBroadcast(&e->map, e->C, width));
  PetscCall(PetscArrayzero(e->given, e->rows * LANES));
  Stored(e);
  PetscCall(NodeMapSum(&e->map, e->given, LANES));
  for (PetscInt I = 0; I < e->rows; I++) {
    const double *stored = &e->given[I * LANES], *d = &e->C[I * width];
    double       *r = &e->R[I * LANES * Rows(R_Count(s))];

    for (int k = 0; k < n; k++) {
      r[k] = k < s.fluids ? -stored[k] : 0.0;
      for (int j = 0; k < s.fluids && j < s.fluids; j++)
        r[k] += stored[Stored_Matrix(s) + k * s.fluids + j] * d[j];
    }
  }
  e->again = true;
  PetscCall(Solve(e));
  e->again = false;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NodesScalars(Explicit *e, StageRates *rates)
{
  PetscFunctionBeginUser;
  e->warmed = e->heat_in = 0.0;
  PetscCall(Solve(e));
  if (Corrects(e))
    PetscCall(Correct(e));
  ForNodes(e, EndsRun_loops, 0.0);
  PetscCall(NodeMapBroadcast(&e->map, e->C, C_Width(e->set)));
  rates->heat_in += e->heat_in;
  rates->heat_rate += e->warmed;
  PetscFunctionReturn(PETSC_SUCCESS);
}
