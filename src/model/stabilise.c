/* Ghost penalty (22) and pressure projection (23): both sum to zero over the nodes. */
#include "gather.h"

#define SLIVER 1e-6 /* of a cell */
#define FULL 0.75   /* cells filled less, or with a surface inside, are cut */

static PetscInt CellIndex(const Model *m, PetscInt i, PetscInt j)
{
  const Grid *g = &m->grid;

  if (i < g->gs[0] || j < g->gs[1] || i >= g->gs[0] + g->gm[0] || j >= g->gs[1] + g->gm[1])
    return -1;
  return m->map.index[GridPadded(g, i, j)]; /* a cell is named after its lower left node */
}

/* Share of [x-l, x+l] in its first cell; slivers to either side of a grid line do not count. */
static double FirstShare(const GridLines *line, double x, double l, PetscInt *first)
{
  const double from = LinesPlace(line, x - l);
  double       share;

  *first              = (PetscInt)floor(from + SLIVER);
  const double length = 2.0 * l / LinesWidth(line, *first); /* in its first cells */
  share               = ((double)*first + 1.0 - from) / length;
  return share > 1.0 - SLIVER ? 1.0 : share;
}

static double CellVolume(const Model *m, PetscInt i, PetscInt j)
{
  return LinesWidth(&m->grid.line[0], i) * LinesWidth(&m->grid.line[1], j);
}

static void FillCells(const Model *m, double *fill)
{
  for (PetscInt p = 0; p < m->P.n; p++) {
    const double ring = m->c->axisymmetric ? 2.0 * M_PI * m->P.f[P_X][p] : 1.0;
    PetscInt     first[CL_DIM];
    double       share[CL_DIM];

    for (int d = 0; d < CL_DIM; d++) {
      const GridLines *line = &m->grid.line[d];
      const double     x    = m->P.f[P_X + d][p];

      share[d] = FirstShare(line, x, BasisReach(line, x, m->P.f[P_L + d][p]), &first[d]);
    }
    for (int k = 0; k < 4; k++) {
      const double   w = (k % 2 ? 1.0 - share[0] : share[0]) * (k / 2 ? 1.0 - share[1] : share[1]);
      const PetscInt I = w > 0.0 ? CellIndex(m, first[0] + k % 2, first[1] + k / 2) : -1;

      if (I >= 0)
        fill[2 * I] += w * m->P.f[P_V][p] / (ring * CellVolume(m, first[0] + k % 2, first[1] + k / 2));
    }
  }
}

/* Cells with a surface face in their interior. */
static void MarkSurface(const Model *m, double *fill)
{
  for (PetscInt k = 0; k < m->nface; k++) {
    const Face *f    = &m->face[k];
    const int   axis = fabs(f->n[0]) > fabs(f->n[1]) ? 0 : 1;
    double      s[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      s[d] = LinesPlace(&m->grid.line[d], f->x[d]);
    if (fabs(s[axis] - round(s[axis])) < 1e-6 || (f->n[0] == 0.0 && f->n[1] == 0.0))
      continue; /* on a grid line, or the axis: nothing is cut */
    const PetscInt I = CellIndex(m, (PetscInt)floor(s[0]), (PetscInt)floor(s[1]));
    if (I >= 0)
      fill[2 * I + 1] = 1.0;
  }
}

/* A line belongs to a face whose two cells are active and one of which is cut or next to a cut one. */
static bool FaceNeedsPenalty(const Model *m, const double *fill, const unsigned char *near, PetscInt i, PetscInt j,
                             int d)
{
  const PetscInt I = CellIndex(m, i, j), K = CellIndex(m, i - (d == 0), j - (d == 1));

  return I >= 0 && K >= 0 && fill[2 * I] > 0.0 && fill[2 * K] > 0.0 && (near[I] || near[K]);
}

static bool IsCut(const double *fill, PetscInt I)
{
  return I >= 0 && fill[2 * I] > 0.0 && (fill[2 * I] < FULL || fill[2 * I + 1] > 0.0);
}

static PetscErrorCode BuildGhostLines(Model *m, const double *fill, const unsigned char *near)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(m->added->ghost));
  PetscCall(PetscMalloc1(2 * PetscMax(m->map.n_owned, 1), &m->added->ghost));
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    const PetscInt i = m->map.ij[I][0], j = m->map.ij[I][1];

    for (int d = 0; d < CL_DIM; d++) {
      const GridLines *line = &m->grid.line[d], *across = &m->grid.line[1 - d];
      const PetscInt   k = d ? j : i, l = d ? i : j;
      const PetscInt   lo = CellIndex(m, i - (d == 0), j - (d == 1)), hi = CellIndex(m, i + (d == 0), j + (d == 1));
      const bool       right = FaceNeedsPenalty(m, fill, near, i, j, d),
                 left        = FaceNeedsPenalty(m, fill, near, i - (d == 1), j - (d == 0), d);
      const double A         = LinesAround(across, l),
                   sides     = ((right ? LinesWidth(across, l) : 0.0) + (left ? LinesWidth(across, l - 1) : 0.0)) / A;
      const double *c        = &m->coef[I * NC_COUNT];

      if (!(right || left) || lo < 0 || hi < 0)
        continue;
      const double h     = LinesAround(line, k);
      const double depth = NodeVolume(m, I) / (d ? A * h : h * A); /* 1, or around the axis */
      const double below = h / LinesWidth(line, k - 1), above = h / LinesWidth(line, k);
      const double ratio = 0.5 * sides * depth * A / h; /* A/h */
      GhostLine   *ghost = &m->added->ghost[n++];

      *ghost = (GhostLine){.node   = {lo, I, hi},
                           .second = {below, -(below + above), above},
                           .a      = m->c->stabilisation.ghost_penalty * ratio,
                           .M      = c[NC_M],
                           .kappa  = c[NC_KAPPA],
                           .lambda = {c[NC_LAMBDA], c[NC_LAMBDA + 1]}};
      for (int f = 0; f < PHASE_COUNT; f++)
        ghost->store[f] = m->c->stabilisation.ghost_storage * ratio * h * h * c[NC_RHO + f] * c[NC_STORAGE + f];
    }
  }
  m->added->nghost = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BuildGhost(Model *m)
{
  double        *fill; /* [I][2]: filled share, surface inside */
  unsigned char *near;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(2 * m->map.n_local, &fill, m->map.n_local, &near));
  FillCells(m, fill);
  MarkSurface(m, fill);
  PetscCall(NodeMapSum(&m->map, fill, 2));
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    const PetscInt i = m->map.ij[I][0], j = m->map.ij[I][1];

    near[I] = IsCut(fill, I) || IsCut(fill, CellIndex(m, i - 1, j)) || IsCut(fill, CellIndex(m, i + 1, j)) ||
              IsCut(fill, CellIndex(m, i, j - 1)) || IsCut(fill, CellIndex(m, i, j + 1));
  }
  PetscCall(BuildGhostLines(m, fill, near));
  PetscCall(PetscFree2(fill, near));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums over the particles of one cell. */
typedef struct {
  double w, wN[4], wNN[4][4];
  double V, mass, compliance, s[PHASE_COUNT], rho[PHASE_COUNT]; /* compliance: V/G */
} CellSums;

static void AddParticle(const Model *m, PetscInt p, const PetscInt cell[], CellSums *c)
{
  PointProperties q;
  const char     *why;
  double          r[CL_DIM];

  if (ModelParticleProperties(m, p, &q, &why) != CL_OK)
    return; /* ModelBeginStep reported it */
  for (int d = 0; d < CL_DIM; d++)
    r[d] = LinesPlace(&m->grid.line[d], m->P.f[P_X + d][p]) - (double)cell[d];

  const double V = m->P.f[P_V][p], w = V * m->c->stabilisation.pressure_projection / (2.0 * q.G);
  const double N[4] = {(1 - r[0]) * (1 - r[1]), r[0] * (1 - r[1]), (1 - r[0]) * r[1], r[0] * r[1]};

  c->w += w;
  c->V += V;
  c->compliance += V / q.G;
  c->mass += m->P.f[P_MS][p] + m->P.f[P_MH][p];
  for (int a = 0; a < 4; a++) {
    c->wN[a] += w * N[a];
    for (int b = 0; b < 4; b++)
      c->wNN[a][b] += w * N[a] * N[b];
  }
  for (int f = 0; f < PHASE_COUNT; f++) {
    c->s[f] += V * q.s[f];
    c->rho[f] += V * q.rho[f];
    c->mass += V * q.phi * (1.0 - q.Sh) * q.s[f] * q.rho[f];
  }
}

static bool FinishCell(const Model *m, const PetscInt cell[], const CellSums *c, ProjectionCell *k)
{
  const double h[CL_DIM] = {LinesWidth(&m->grid.line[0], cell[0]), LinesWidth(&m->grid.line[1], cell[1])};
  const double h2        = 1.0 / (1.0 / PetscSqr(h[0]) + 1.0 / PetscSqr(h[1]));

  for (int a = 0; a < 4; a++) {
    k->node[a] = CellIndex(m, cell[0] + a % 2, cell[1] + a / 2);
    if (k->node[a] < 0)
      return false;
    for (int b = 0; b < 4; b++)
      k->K[a][b] = c->wNN[a][b] - c->wN[a] * c->wN[b] / c->w;
  }
  for (int f = 0; f < PHASE_COUNT; f++) {
    k->s[f]   = c->s[f] / c->V;
    k->rho[f] = c->rho[f] / c->V;
  }
  k->t_inertia = m->c->fields.inertia ? sqrt(c->mass / c->V * c->compliance / c->V * h2 / 15.0) : 0.0;
  return true;
}

static PetscErrorCode BuildProjection(Model *m)
{
  const Grid *g = &m->grid;
  CellSums   *sum;
  PetscInt    n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(g->gm[0] * g->gm[1], &sum));
  for (PetscInt p = 0; p < m->P.n; p++) {
    const double x[CL_DIM] = {m->P.f[P_X][p], m->P.f[P_X + 1][p]};
    PetscInt     cell[CL_DIM];

    if (GridCell(g, x, cell))
      AddParticle(m, p, cell, &sum[GridPadded(g, cell[0], cell[1])]);
  }
  PetscCall(PetscFree(m->added->cell));
  PetscCall(PetscMalloc1(g->xm[0] * g->xm[1], &m->added->cell));
  for (PetscInt j = g->xs[1]; j < g->xs[1] + g->xm[1]; j++) {
    for (PetscInt i = g->xs[0]; i < g->xs[0] + g->xm[0]; i++) {
      const PetscInt  cell[CL_DIM] = {i, j};
      const CellSums *s            = &sum[GridPadded(g, i, j)];

      if (s->w > 0.0 && FinishCell(m, cell, s, &m->added->cell[n]))
        n++;
    }
  }
  m->added->ncell = n;
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StabilisationBuild(Model *m)
{
  PetscFunctionBeginUser;
  m->added->nghost = m->added->ncell = 0;
  if (m->c->stabilisation.ghost_penalty > 0.0 || m->c->stabilisation.ghost_storage > 0.0)
    PetscCall(BuildGhost(m));
  if (m->c->stabilisation.pressure_projection > 0.0 && m->c->fields.solid && m->c->fields.fluid)
    PetscCall(BuildProjection(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coefficient of the penalties (22), (351) on each of the nine unknowns, zero where the set has none; none on the fluid
   velocities, which carry the boundary pressure. */
static void GhostCoefficients(const Model *m, const GhostLine *g, double dt, double c[F_COUNT])
{
  const FieldSet *fs = &m->c->fields;

  for (int k = 0; k < F_COUNT; k++)
    c[k] = 0.0;
  if (fs->solid)
    c[F_VSX] = c[F_VSY] = g->a * g->M * dt;
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (fs->phase[f])
      c[F_PW + f] =
          g->store[f] + g->a * dt / (1.0 / g->lambda[f] + (fs->inertia ? 1.0 / dt : 0.0)); /* and dt' rho tau */
  }
  if (fs->heat)
    c[F_T] = g->a * g->kappa;
}

/* Second difference of unknown k of the nodal values x. */
static double Jump(const Model *m, const GhostLine *g, const double *x, int k)
{
  const FieldSet *fs   = &m->c->fields;
  double          jump = 0.0;

  for (int a = 0; a < 3; a++)
    jump += g->second[a] * x[g->node[a] * fs->n + fs->at[k]];
  return jump;
}

static void GhostResidual(const Model *m, const GhostLine *g, const double *x, double *f)
{
  double c[F_COUNT];

  GhostCoefficients(m, g, m->stage.dt, c);
  for (int k = 0; k < F_COUNT; k++) {
    if (c[k] == 0.0)
      continue;
    double pull = c[k] * Jump(m, g, x, k);

    if (k == F_PW || k == F_PG) /* (351) is on the change from p* */
      pull -= g->store[k - F_PW] * Jump(m, g, m->stage.x_star, k);
    for (int a = 0; a < 3; a++)
      *RowOf(m, f, g->node[a], k) += pull * g->second[a];
  }
}

double GhostPower(const Model *m, const double *x)
{
  double power = 0.0;

  for (PetscInt k = 0; k < m->added->nghost; k++) {
    const GhostLine *g = &m->added->ghost[k];

    for (int d = 0; d < CL_DIM; d++)
      power += g->a * g->M * m->stage.dt * PetscSqr(Jump(m, g, x, F_VSX + d));
  }
  return power;
}

/* (275): what is left of 1/(2G) in a stage whose inertia holds the skeleton back. */
static double ProjectionShare(const Model *m, const ProjectionCell *c)
{
  return 1.0 / (1.0 + PetscSqr(c->t_inertia / m->stage.dt));
}

static void ProjectionResidual(const Model *m, const ProjectionCell *c, const double *x, double *f)
{
  const FieldSet *fs    = &m->c->fields;
  const double    share = ProjectionShare(m, c);
  double          dp[4] = {0.0};

  for (int b = 0; b < 4; b++) {
    for (int ph = 0; ph < PHASE_COUNT; ph++) {
      const PetscInt k = c->node[b] * fs->n + PlaceP(fs, ph);

      if (fs->phase[ph])
        dp[b] += c->s[ph] * (x[k] - m->stage.x_star[k]);
    }
  }
  for (int a = 0; a < 4; a++) {
    double Kdp = 0.0;

    for (int b = 0; b < 4; b++)
      Kdp += c->K[a][b] * dp[b];
    for (int ph = 0; ph < PHASE_COUNT; ph++) {
      if (fs->phase[ph])
        *MassRow(m, f, c->node[a], ph) += c->rho[ph] * c->s[ph] * share * Kdp;
    }
  }
}

void StabilisationResidual(const Model *m, const double *x, double *f)
{
  for (PetscInt k = 0; k < m->added->nghost; k++)
    GhostResidual(m, &m->added->ghost[k], x, f);
  for (PetscInt k = 0; k < m->added->ncell; k++)
    ProjectionResidual(m, &m->added->cell[k], x, f);
}

static void GhostBlock(const Model *m, const Assembly *to, const GhostLine *g)
{
  const int  n  = to->fs.n;
  const int *at = to->fs.at;
  double     c[F_COUNT];

  GhostCoefficients(m, g, m->stage.dt, c);
  for (int k = 0; k < F_COUNT; k++) {
    for (int a = 0; a < 3 && c[k] != 0.0; a++) {
      const double w = c[k] * g->second[a] * RowWeightOf(m, g->node[a], k);

      for (int b = 0; b < 3; b++)
        AssemblyBlock(m, to, g->node[a], g->node[b])[at[k] * n + at[k]] += w * g->second[b];
    }
  }
}

static void ProjectionBlock(const Model *m, const Assembly *to, const ProjectionCell *c)
{
  const FieldSet *fs    = &to->fs;
  const double    share = ProjectionShare(m, c);

  for (int a = 0; a < 4; a++) {
    for (int r = 0; r < PHASE_COUNT; r++) {
      if (!fs->phase[r])
        continue;
      const double w = RowWeight(m, c->node[a], r) * c->rho[r] * c->s[r] * share;

      for (int b = 0; b < 4; b++) {
        double *row = AssemblyBlock(m, to, c->node[a], c->node[b]) + PlaceP(fs, r) * fs->n;

        for (int q = 0; q < PHASE_COUNT; q++) {
          if (fs->phase[q])
            row[PlaceP(fs, q)] += w * c->s[q] * c->K[a][b];
        }
      }
    }
  }
}

void StabilisationJacobian(Model *m, const Assembly *to)
{
  for (PetscInt k = 0; k < m->added->nghost; k++)
    GhostBlock(m, to, &m->added->ghost[k]);
  for (PetscInt k = 0; k < m->added->ncell; k++)
    ProjectionBlock(m, to, &m->added->cell[k]);
}
