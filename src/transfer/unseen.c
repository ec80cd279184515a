/* Motion that no node sees (452), (453): velocities of the particles about a node whose mean is none. */
#include "clathra/transfer.h"

#define PASSES 8  /* before and after the share of a place */
#define HALF 0.3  /* (453): unseen part of the variance at which half of it is taken, ... */
#define STEEP 8.0 /* ... and how steeply more or less is */

/* A particle's nodes, local active numbers, and its weights there. */
typedef struct {
  int      n;
  PetscInt at[CL_NODES];
  double   S[CL_NODES];
} Seen;

static void SeenOf(const Transfer *t, PetscInt k, Seen *to)
{
  double G[CL_NODES][CL_DIM], H[CL_NODES];

  to->n = StencilExpand(&t->stencil[k], t->grid, t->map, to->at, to->S, G, H);
}

typedef struct {
  const Transfer *t;
  Seen           *seen; /* [n] */
  double         *m;    /* [n] kg, of all phases */
  double         *mass; /* [n_local] kg */
  double         *mean; /* [n_local][CL_DIM] m/s */
} Sieve;

/* Velocity of the mixture, m/s, and its mass. */
static double Mixture(const FieldSet *fs, const Particles *P, PetscInt p, double v[CL_DIM])
{
  double sum = 0.0;

  for (int d = 0; d < CL_DIM; d++)
    v[d] = 0.0;
  for (int phase = 0; phase <= PHASE_COUNT; phase++) {
    if (phase > 0 && !fs->phase[phase - 1])
      continue;
    const double m = ParticlePhaseMass(P, p, phase);

    sum += m;
    for (int d = 0; d < CL_DIM; d++)
      v[d] += m * P->f[VectorAt(P_VS, phase, d)][p];
  }
  for (int d = 0; d < CL_DIM; d++)
    v[d] /= sum;
  return sum;
}

static PetscErrorCode Masses(Sieve *s)
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < s->t->n; p++) {
    SeenOf(s->t, p, &s->seen[p]);
    for (int a = 0; a < s->seen[p].n; a++)
      s->mass[s->seen[p].at[a]] += s->seen[p].S[a] * s->m[p];
  }
  PetscCall(NodeMapSum(s->t->map, s->mass, 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* v := v less what nodes see of it, [n][CL_DIM]. */
static PetscErrorCode Pass(const Sieve *s, double *v)
{
  NodeMap *map = s->t->map;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(s->mean, CL_DIM * map->n_local));
  for (PetscInt p = 0; p < s->t->n; p++) {
    const Seen *to = &s->seen[p];

    for (int a = 0; a < to->n; a++) {
      for (int d = 0; d < CL_DIM; d++)
        s->mean[CL_DIM * to->at[a] + d] += to->S[a] * s->m[p] * v[CL_DIM * p + d];
    }
  }
  PetscCall(NodeMapSum(map, s->mean, CL_DIM));
  for (PetscInt I = 0; I < map->n_local; I++) {
    for (int d = 0; d < CL_DIM && s->mass[I] > 0.0; d++)
      s->mean[CL_DIM * I + d] /= s->mass[I];
  }
  for (PetscInt p = 0; p < s->t->n; p++) {
    const Seen *to = &s->seen[p];

    for (int a = 0; a < to->n; a++) {
      for (int d = 0; d < CL_DIM; d++)
        v[CL_DIM * p + d] -= to->S[a] * s->mean[CL_DIM * to->at[a] + d];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the particles about a node: momentum, then mass times square, of v, and of what nodes do not see of it. */
enum { ABOUT_V = 0, ABOUT_SQUARE = CL_DIM, ABOUT_UNSEEN, ABOUT_SUMS };

/* (453) of the variance of the velocity about a place and the unseen part of it, m^2/s^2. */
static double PlaceShare(double variance, double unseen)
{
  return unseen > 0.0 ? 1.0 / (1.0 + pow(HALF * fmax(variance, 0.0) / unseen, STEEP)) : 0.0;
}

/* Takes of the unseen motion q, [n][CL_DIM], its share by place (453). */
static PetscErrorCode ByPlace(const Sieve *s, const double *v, double *q)
{
  NodeMap *map = s->t->map;
  double  *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(ABOUT_SUMS * map->n_local, &sum));
  for (PetscInt p = 0; p < s->t->n; p++) {
    const Seen   *to = &s->seen[p];
    const double *vp = &v[CL_DIM * p], *qp = &q[CL_DIM * p], square[2] = {VectorDot(vp, vp), VectorDot(qp, qp)};

    for (int a = 0; a < to->n; a++) {
      const double m  = to->S[a] * s->m[p];
      double      *at = &sum[ABOUT_SUMS * to->at[a]];

      for (int d = 0; d < CL_DIM; d++)
        at[ABOUT_V + d] += m * vp[d];
      at[ABOUT_SQUARE] += m * square[0];
      at[ABOUT_UNSEEN] += m * square[1];
    }
  }
  PetscCall(NodeMapSum(map, sum, ABOUT_SUMS));
  for (PetscInt I = 0; I < map->n_local; I++) {
    double *at = &sum[ABOUT_SUMS * I];

    for (int k = 0; k < ABOUT_SUMS && s->mass[I] > 0.0; k++)
      at[k] /= s->mass[I];
    at[ABOUT_SQUARE] -= VectorDot(&at[ABOUT_V], &at[ABOUT_V]);
  }
  for (PetscInt p = 0; p < s->t->n; p++) {
    double variance = 0.0, unseen = 0.0;

    for (int a = 0; a < s->seen[p].n; a++) {
      const double *at = &sum[ABOUT_SUMS * s->seen[p].at[a]];

      variance += s->seen[p].S[a] * at[ABOUT_SQUARE];
      unseen += s->seen[p].S[a] * at[ABOUT_UNSEEN];
    }
    const double w = PlaceShare(variance, unseen);

    for (int d = 0; d < CL_DIM; d++)
      q[CL_DIM * p + d] *= w;
  }
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Passes of q. */
static PetscErrorCode Sift(const Sieve *s, double *q)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < PASSES; k++)
    PetscCall(Pass(s, q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TransferUnseen(const Transfer *t, const FieldSet *fs, double share, Particles *P)
{
  Sieve   s = {.t = t};
  double *v, *q;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(t->n, &s.seen, t->n, &s.m, CL_DIM * t->n, &v, CL_DIM * t->n, &q));
  PetscCall(PetscCalloc2(t->map->n_local, &s.mass, CL_DIM * t->map->n_local, &s.mean));
  for (PetscInt p = 0; p < t->n; p++)
    s.m[p] = Mixture(fs, P, p, &v[CL_DIM * p]);
  PetscCall(Masses(&s));
  PetscCall(PetscArraycpy(q, v, CL_DIM * t->n));
  PetscCall(Sift(&s, q));
  PetscCall(ByPlace(&s, v, q));
  PetscCall(Sift(&s, q));
  for (int phase = 0; phase <= PHASE_COUNT; phase++) {
    for (int d = 0; d < CL_DIM && (phase == 0 || fs->phase[phase - 1]); d++) {
      for (PetscInt p = 0; p < t->n; p++)
        P->f[VectorAt(P_VS, phase, d)][p] -= share * q[CL_DIM * p + d];
    }
  }
  PetscCall(PetscFree4(s.seen, s.m, v, q));
  PetscCall(PetscFree2(s.mass, s.mean));
  PetscFunctionReturn(PETSC_SUCCESS);
}
