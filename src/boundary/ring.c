/* What the grid does not resolve of the radial flow to a face about an axis; docs/equations.md (196)-(198). */
#include "clathra/boundary.h"

#define CELLS 10         /* resolved beyond the first; what is lost farther out falls with the square of the radius */
#define SIZE (CELLS + 4) /* nodes, and the jump */

/* Radial flow of one unit out of a ring of particles as wide as the face's own, per 2 pi k/mu and height: p at the
   nodes from the one below the face on, the last two of which have ln r; jump as the last unknown. */
typedef struct {
  double    A[SIZE][SIZE], b[SIZE];
  double    V[SIZE], W[SIZE]; /* int S r dr, int S dr */
  double    N[SIZE], E[SIZE]; /* weights of the face; of p extrapolated to it */
  double    dS[SIZE];         /* and of dp/dr there */
  double    depth;            /* from the face to where its particle's values belong, m */
  GridLines line;             /* of the nodes */
  double    place[SIZE + 1 + 2 * LINES_PAD];
  PetscInt  guess;
} Column;

static double NodeRadius(const Column *k, int i)
{
  return LinesAt(&k->line, i);
}

typedef struct {
  int    base;
  double S[3], dS[3], plain[3], r; /* plain: weights of (3) */
} Piece;

/* A particle of half-length l at radius r. */
static Piece PieceAt(const Scene *c, const Column *k, double r, double l)
{
  Piece  q;
  Axis   a;
  double hoop[3];

  BasisRadius(c->basis, r, l, &k->line, &a, hoop, &q.r);
  q.base = (int)a.base;
  for (int i = 0; i < 3; i++) {
    q.S[i]     = a.S[i];
    q.dS[i]    = a.dS[i];
    q.plain[i] = hoop[i] * q.r;
  }
  return q;
}

/* Weights of the face at radius r, and of its first particle's p extrapolated to it. */
static void FaceOf(Column *k, const Piece *q, double r)
{
  Axis at;

  BasisHat(r, &k->line, &at);
  k->depth = -r;
  for (int i = 0; i < 3; i++)
    k->depth += q->S[i] * NodeRadius(k, q->base + i);
  for (int i = 0; i < 3; i++) {
    k->N[(int)at.base + i] = at.S[i];
    k->E[q->base + i]      = q->S[i] - q->dS[i] * k->depth;
    k->dS[q->base + i]     = q->dS[i];
  }
}

/* (17) with f = dp/dr and, with `lift`, what the jump at the face adds to it through (16). */
static void Deposit(Column *k, const Piece *q, double width, bool lift)
{
  const double V      = q->r * width;
  double       lifted = 0.0;

  for (int i = 0; lift && i < 3; i++) {
    if (q->S[i] != 0.0)
      lifted += q->S[i] * k->N[q->base + i] / k->W[q->base + i];
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      k->A[q->base + i][q->base + j] += V * q->dS[i] * q->dS[j];
    k->A[q->base + i][SIZE - 1] += V * q->dS[i] * lifted;
    k->A[SIZE - 1][q->base + i] += V * q->dS[i] * lifted;
  }
}

/* (22) on the two lines beyond the face, where it cuts a cell. */
static void Ghost(const Scene *c, Column *k)
{
  for (int n = 1; n <= 2; n++) {
    const double h = LinesAround(&k->line, n), below = h / LinesWidth(&k->line, n - 1),
                 above     = h / LinesWidth(&k->line, n);
    const double second[3] = {below, -(below + above), above};

    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++)
        k->A[n - 1 + i][n - 1 + j] += c->stabilisation.ghost_penalty * NodeRadius(k, n) / h * second[i] * second[j];
    }
  }
}

/* Prescribes the unknown n. */
static void Hold(Column *k, int n, double value)
{
  for (int j = 0; j < SIZE; j++)
    k->A[n][j] = j == n ? 1.0 : 0.0;
  k->b[n] = value;
}

static void Solve(Column *k)
{
  for (int n = 0; n < SIZE; n++) {
    int pivot = n;

    for (int i = n + 1; i < SIZE; i++)
      pivot = fabs(k->A[i][n]) > fabs(k->A[pivot][n]) ? i : pivot;
    for (int j = n; j < SIZE; j++) {
      const double a = k->A[n][j];

      k->A[n][j]     = k->A[pivot][j];
      k->A[pivot][j] = a;
    }
    const double b = k->b[n];
    k->b[n]        = k->b[pivot];
    k->b[pivot]    = b;
    for (int i = n + 1; i < SIZE; i++) {
      const double f = k->A[i][n] / k->A[n][n];

      for (int j = n; j < SIZE; j++)
        k->A[i][j] -= f * k->A[n][j];
      k->b[i] -= f * k->b[n];
    }
  }
  for (int n = SIZE - 1; n >= 0; n--) {
    for (int j = n + 1; j < SIZE; j++)
      k->b[n] -= k->A[n][j] * k->b[j];
    k->b[n] /= k->A[n][n];
  }
}

/* One unit leaves the face; the law of the jump: (16) at the nodes, or (199). */
static void Outflow(Column *k, double r, double penalty)
{
  double *row = k->A[SIZE - 1];

  for (int i = 0; i < SIZE - 1; i++) {
    k->b[i] = -k->N[i];
    if (penalty > 0.0)
      row[i] = r * k->dS[i];
    else if (k->W[i] > 0.0)
      row[SIZE - 1] += k->N[i] * k->N[i] * k->V[i] / (k->W[i] * k->W[i]);
  }
  if (penalty > 0.0)
    row[SIZE - 1] = r * penalty / k->depth;
  k->b[SIZE - 1] = 1.0;
}

/* The cells from the face's own on, as wide as the last one beyond the grid's end. */
static void TakeLines(const GridLines *line, PetscInt cell, Column *k)
{
  const double first = LinesAt(line, cell);

  k->line = (GridLines){.lower = first, .cells = SIZE, .h = line->h};
  if (!line->x)
    return;
  k->line.nguess = 1;
  k->line.guess  = &k->guess;
  k->line.x      = k->place + LINES_PAD;
  for (PetscInt i = -LINES_PAD; i <= SIZE + LINES_PAD; i++) {
    const PetscInt at = cell + i, end = line->cells;

    k->line.x[i] = at <= end ? LinesAt(line, at) : line->upper + (double)(at - end) * LinesWidth(line, end - 1);
  }
  k->line.upper = k->line.x[SIZE];
}

/* What linear elements lose of ln r beyond the column: 1/12 (h/r)^3 each. */
static double Beyond(const GridLines *line, PetscInt first, double last)
{
  double sum = 0.0;

  if (!line->x)
    return line->h * line->h / (24.0 * last * last);
  for (PetscInt i = first; i < line->cells; i++)
    sum += pow(LinesWidth(line, i) / (LinesAt(line, i) + LinesAt(line, i + 1)), 3.0) * 8.0 / 12.0;
  return sum;
}

/* The next particle outwards: as many in its cell as in the first. */
static double Next(const Column *k, double l, double *x, double half)
{
  const double edge = *x + half, next = l * (LinesWidthAt(&k->line, edge + 1e-6 * l) / LinesWidth(&k->line, 0));

  *x += half + next;
  return next;
}

double FaceRing(const Scene *c, const Grid *g, double r, double l, double penalty)
{
  const GridLines *line = &g->line[0];
  const double     s = BasisSnap(LinesPlace(line, r)), cell = floor(s);
  Column           k = {.guess = 0};
  double           p = 0.0;

  TakeLines(line, (PetscInt)cell, &k);
  const double last = NodeRadius(&k, SIZE - 3);
  if (c->basis == BASIS_LINEAR || !(r > 0.0) || l > 0.5 * LinesWidth(&k.line, 0) * (1.0 + BASIS_SNAP))
    return 0.0;
  for (double x = r + l, half = l; x - half < last; half = Next(&k, l, &x, half)) {
    const Piece q = PieceAt(c, &k, x, half);

    for (int i = 0; i < 3; i++) {
      k.V[q.base + i] += q.S[i] * q.r * 2.0 * half;
      k.W[q.base + i] += q.plain[i] * 2.0 * half;
    }
    if (x == r + l)
      FaceOf(&k, &q, r);
  }
  for (double x = r + l, half = l; x - half < last; half = Next(&k, l, &x, half)) {
    const Piece q = PieceAt(c, &k, x, half);

    Deposit(&k, &q, 2.0 * half, penalty == 0.0);
  }
  if (s != cell)
    Ghost(c, &k);
  Outflow(&k, r, penalty);
  for (int i = SIZE - 3; i < SIZE - 1; i++)
    Hold(&k, i, log(NodeRadius(&k, i)));
  Solve(&k);
  for (int i = 0; i < SIZE - 1; i++)
    p += k.E[i] * k.b[i];
  return p - k.b[SIZE - 1] - log(r) + Beyond(line, (PetscInt)cell + SIZE - 3, last);
}
