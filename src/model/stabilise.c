/* Ghost penalty (22) with the ties (351), (417) of changes of pressure, and pressure projection (23): all sum to zero
   over the nodes. */
#include "gather.h"

#define FULL 0.75 /* cells filled less, or with a surface inside, are cut */

/* A cell is named after its lowest node: the one so many cells on along an axis. */
static PetscInt CellBeside(const Model *m, const PetscInt cell[CL_DIM], int d, PetscInt by)
{
  PetscInt beside[CL_DIM];

  memcpy(beside, cell, sizeof(beside));
  beside[d] += by;
  return NodeMapAt(&m->grid, &m->map, beside);
}

/* Corner k of a cell, or cell k of those about a node. */
static void Corner(const PetscInt lowest[CL_DIM], int k, PetscInt ij[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    ij[d] = lowest[d] + (k >> d) % 2;
}

static double CellVolume(const Model *m, const PetscInt cell[CL_DIM])
{
  double V = LinesWidth(&m->grid.line[0], cell[0]);

  for (int d = 1; d < CL_DIM; d++)
    V *= LinesWidth(&m->grid.line[d], cell[d]);
  if (m->c->axisymmetric)
    V *= M_PI * (GridNode(&m->grid, 0, cell[0]) + GridNode(&m->grid, 0, cell[0] + 1));
  return V;
}

/* Volume of the particle over that in the grid's configuration. */
static double Swollen(const Model *m, PetscInt p)
{
  double F[CL_DIM][CL_DIM], cof[CL_DIM][CL_DIM];

  if (!m->P.total)
    return 1.0;
  ParticleDeformation(&m->P, p, F);
  return CofactorOf(F, cof) * (m->c->axisymmetric ? m->P.f[P_X][p] / ParticleGridX(&m->P, p, 0) : 1.0);
}

static void FillCells(const Model *m, double *fill)
{
  for (PetscInt p = 0; p < m->P.n; p++) {
    const double V = m->P.f[P_V][p] / Swollen(m, p);
    AxisParts    part[CL_DIM];
    PetscInt     cell[CL_CORNERS];
    double       share[CL_CORNERS];

    StencilCells(&m->stencil[p], &m->grid, &m->map, part, cell, share);
    for (int k = 0; k < CL_CORNERS; k++) {
      if (cell[k] >= 0)
        fill[2 * cell[k]] += share[k] * V / CellVolume(m, m->map.ij[cell[k]]);
    }
  }
}

/* Cells with a surface face in their interior. */
static void MarkSurface(const Model *m, double *fill)
{
  for (PetscInt k = 0; k < m->nface; k++) {
    const Face *f    = &m->face[k];
    int         axis = CL_DIM - 1;
    PetscInt    cell[CL_DIM];
    double      s[CL_DIM];

    for (int d = CL_DIM - 1; d >= 0; d--) {
      axis = fabs(f->n[d]) > fabs(f->n[axis]) ? d : axis;
      s[d] = LinesPlace(&m->grid.line[d], f->x[d]);
    }
    if (fabs(s[axis] - round(s[axis])) < 1e-6 || VectorDot(f->n, f->n) == 0.0)
      continue; /* on a grid line, or the axis: nothing is cut */
    for (int d = 0; d < CL_DIM; d++)
      cell[d] = (PetscInt)floor(s[d]);
    const PetscInt I = NodeMapAt(&m->grid, &m->map, cell);
    if (I >= 0)
      fill[2 * I + 1] = 1.0;
  }
}

/* A line belongs to a face whose two cells are active and one of which is cut or next to a cut one. */
static bool FaceNeedsPenalty(const Model *m, const double *fill, const unsigned char *near, const PetscInt cell[CL_DIM],
                             int d)
{
  const PetscInt I = NodeMapAt(&m->grid, &m->map, cell), K = CellBeside(m, cell, d, -1);

  return I >= 0 && K >= 0 && fill[2 * I] > 0.0 && fill[2 * K] > 0.0 && (near[I] || near[K]);
}

/* Area of those of the faces about a node across an axis, per metre of thickness. */
static double PenaltyArea(const Model *m, const double *fill, const unsigned char *near, PetscInt I, int d)
{
  double area = 0.0;

  for (int k = 0; k < CL_CORNERS; k++) {
    PetscInt cell[CL_DIM];
    double   A = 1.0;

    if ((k >> d) % 2)
      continue;
    for (int e = 0; e < CL_DIM; e++) {
      cell[e] = m->map.ij[I][e] - (k >> e) % 2;
      A *= e == d ? 1.0 : LinesWidth(&m->grid.line[e], cell[e]);
    }
    area += FaceNeedsPenalty(m, fill, near, cell, d) ? A : 0.0;
  }
  return area;
}

static bool IsCut(const double *fill, PetscInt I)
{
  return I >= 0 && fill[2 * I] > 0.0 && (fill[2 * I] < FULL || fill[2 * I + 1] > 0.0);
}

/* w V_i (351), m^3: what the least filled of three nodes has, less as it comes to a quarter of what the fullest has:
   half of it is the edge of filled cells. */
static double SliverVolume(const Model *m, const PetscInt node[3])
{
  double least = INFINITY, most = 0.0;

  for (int a = 0; a < 3; a++) {
    const double fill = m->V[node[a]] / NodeVolume(m, node[a]);

    least = fmin(least, fill);
    most  = fmax(most, fill);
  }
  return least > 0.0 ? fmax(1.0 - 4.0 * least / most, 0.0) * least * NodeVolume(m, node[1]) : 0.0;
}

static PetscErrorCode BuildGhostLines(Model *m, const double *fill, const unsigned char *near)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(m->added->ghost));
  PetscCall(PetscMalloc1(2 * CL_DIM * PetscMax(m->map.n_owned, 1), &m->added->ghost)); /* of them half for (417) */
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int d = 0; d < CL_DIM; d++) {
      const GridLines *line = &m->grid.line[d];
      const PetscInt   k    = m->map.ij[I][d];
      const PetscInt   lo = CellBeside(m, m->map.ij[I], d, -1), hi = CellBeside(m, m->map.ij[I], d, 1);
      const double     area = PenaltyArea(m, fill, near, I, d), *c = &m->coef[I * NC_COUNT];
      double           A = 1.0;

      if (lo < 0 || hi < 0)
        continue;
      const PetscInt node[3] = {lo, I, hi};
      const double   sliver  = m->c->fields.fluid ? SliverVolume(m, node) : 0.0;
      if (area == 0.0 && sliver == 0.0)
        continue;
      for (int e = 0; e < CL_DIM; e++)
        A *= e == d ? 1.0 : LinesAround(&m->grid.line[e], m->map.ij[I][e]);
      const double h = LinesAround(line, k), depth = NodeVolume(m, I) / (A * h); /* 1, or around the axis */
      const double below = h / LinesWidth(line, k - 1), above = h / LinesWidth(line, k);
      const double ratio = area / A / (CL_CORNERS / 2) * depth * A / h; /* A/h */
      GhostLine   *ghost = &m->added->ghost[n++];

      *ghost = (GhostLine){.node    = {lo, I, hi},
                           .second  = {below, -(below + above), above},
                           .a       = m->c->stabilisation.ghost_penalty * ratio,
                           .M       = c[NC_M],
                           .kappa   = c[NC_KAPPA],
                           .lambda  = {c[NC_LAMBDA], c[NC_LAMBDA + 1]},
                           .carried = CarriedAt(m, I)};
      for (int f = 0; f < PHASE_COUNT; f++)
        ghost->store[f] = STORAGE_SHARE * sliver * StoredAt(m, I, f);
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
    near[I] = IsCut(fill, I);
    for (int d = 0; d < CL_DIM; d++)
      near[I] =
          near[I] || IsCut(fill, CellBeside(m, m->map.ij[I], d, -1)) || IsCut(fill, CellBeside(m, m->map.ij[I], d, 1));
  }
  PetscCall(BuildGhostLines(m, fill, near));
  if (m->c->fields.fluid)
    PetscCall(PressureModesBuild(m));
  PetscCall(PetscFree2(fill, near));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums over the particles of one cell. */
typedef struct {
  double w, wN[CL_CORNERS], wNN[CL_CORNERS][CL_CORNERS];
  double V, mass, compliance, s[PHASE_COUNT], rho[PHASE_COUNT]; /* compliance: V/G */
  double methane;                                               /* that water holds, kg */
} CellSums;

static void AddParticle(const Model *m, PetscInt p, const PetscInt cell[], CellSums *c)
{
  PointProperties q;
  const char     *why;
  double          r[CL_DIM];

  if (ModelParticleProperties(m, p, &q, &why) != CL_OK)
    return; /* ModelBeginStep reported it */
  for (int d = 0; d < CL_DIM; d++)
    r[d] = LinesPlace(&m->grid.line[d], ParticleGridX(&m->P, p, d)) - (double)cell[d];

  const double V = m->P.f[P_V][p], w = V / (2.0 * q.G);
  double       N[CL_CORNERS];

  for (int a = 0; a < CL_CORNERS; a++) {
    N[a] = 1.0;
    for (int d = 0; d < CL_DIM; d++)
      N[a] *= (a >> d) % 2 ? r[d] : 1.0 - r[d];
  }
  c->w += w;
  c->V += V;
  c->compliance += V / q.G;
  c->mass += m->P.f[P_MS][p] + m->P.f[P_MH][p];
  for (int a = 0; a < CL_CORNERS; a++) {
    c->wN[a] += w * N[a];
    for (int b = 0; b < CL_CORNERS; b++)
      c->wNN[a][b] += w * N[a] * N[b];
  }
  if (m->c->fields.phase[PHASE_G])
    c->methane += V * q.s[PHASE_W] * DissolvedMethane(ParticleMaterial(m, p)->gas.carried, m->P.f[P_PG][p]);
  for (int f = 0; f < PHASE_COUNT; f++) {
    c->s[f] += V * q.s[f];
    c->rho[f] += V * q.rho[f];
    c->mass += V * q.phi * (1.0 - q.Sh) * q.s[f] * q.rho[f];
  }
}

static bool FinishCell(const Model *m, const PetscInt cell[], const CellSums *c, ProjectionCell *k)
{
  PetscInt corner[CL_DIM];
  double   k2 = 0.0;

  for (int d = 0; d < CL_DIM; d++)
    k2 += 1.0 / PetscSqr(LinesWidth(&m->grid.line[d], cell[d]));
  for (int a = 0; a < CL_CORNERS; a++) {
    Corner(cell, a, corner);
    k->node[a] = NodeMapAt(&m->grid, &m->map, corner);
    if (k->node[a] < 0)
      return false;
    for (int b = 0; b < CL_CORNERS; b++)
      k->K[a][b] = c->wNN[a][b] - c->wN[a] * c->wN[b] / c->w;
  }
  for (int f = 0; f < PHASE_COUNT; f++) {
    k->s[f]       = c->s[f] / c->V;
    k->content[f] = k->s[f] * c->rho[f] / c->V;
  }
  k->content[PHASE_G] += c->methane / c->V;
  k->t_inertia = m->c->fields.inertia ? sqrt(c->mass / c->V * c->compliance / c->V * (1.0 / k2) / 15.0) : 0.0;
  return true;
}

static PetscErrorCode BuildProjection(Model *m)
{
  const Grid *g = &m->grid;
  CellSums   *sum;
  PetscInt    n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(GridPaddedSize(g), &sum));
  for (PetscInt p = 0; p < m->P.n; p++) {
    double x[CL_DIM];

    ParticleGridPlace(&m->P, p, x);
    PetscInt cell[CL_DIM];

    if (GridCell(g, x, cell))
      AddParticle(m, p, cell, &sum[GridPadded(g, cell)]);
  }
  PetscCall(PetscFree(m->added->cell));
  PetscCall(PetscMalloc1(BoxSize(g->xm), &m->added->cell));
  for (PetscInt k = 0; k < BoxSize(g->xm); k++) {
    PetscInt cell[CL_DIM];

    BoxAt(g->xs, g->xm, k, cell);
    const CellSums *s = &sum[GridPadded(g, cell)];
    if (s->w > 0.0 && FinishCell(m, cell, s, &m->added->cell[n]))
      n++;
  }
  m->added->ncell = n;
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StabilisationBuild(Model *m)
{
  PetscFunctionBeginUser;
  m->added->nghost = m->added->ncell = 0;
  if (m->c->stabilisation.ghost_penalty > 0.0 || m->c->fields.fluid)
    PetscCall(BuildGhost(m));
  if (m->c->fields.solid && m->c->fields.fluid)
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
  for (int d = 0; fs->solid && d < CL_DIM; d++)
    c[F_VS + d] = g->a * g->M * dt;
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

static void GhostResidual(const Model *m, const GhostLine *g, const double *x, bool slope, double *f)
{
  double c[F_COUNT];

  GhostCoefficients(m, g, m->stage.dt, c);
  for (int k = 0; k < F_COUNT; k++) {
    if (c[k] == 0.0)
      continue;
    double pull = c[k] * Jump(m, g, x, k);

    if (!slope && (k == F_PW || k == F_PG)) /* (351) is on the change from p* */
      pull -= g->store[k - F_PW] * Jump(m, g, m->stage.x_star, k);
    for (int a = 0; a < 3; a++) {
      *RowOf(m, f, g->node[a], k) += pull * g->second[a];
      if (k == F_PW && g->carried > 0.0)
        *RowOf(m, f, g->node[a], F_PG) += g->carried * pull * g->second[a];
    }
  }
}

double GhostPower(const Model *m, const double *x)
{
  double power = 0.0;

  for (PetscInt k = 0; k < m->added->nghost; k++) {
    const GhostLine *g = &m->added->ghost[k];

    for (int d = 0; d < CL_DIM; d++)
      power += g->a * g->M * m->stage.dt * PetscSqr(Jump(m, g, x, F_VS + d));
  }
  return power;
}

/* (275): what is left of 1/(2G) in a stage whose inertia holds the skeleton back. */
static double ProjectionShare(const Model *m, const ProjectionCell *c)
{
  return 1.0 / (1.0 + PetscSqr(c->t_inertia / m->stage.dt));
}

static void ProjectionResidual(const Model *m, const ProjectionCell *c, const double *x, bool slope, double *f)
{
  const FieldSet *fs             = &m->c->fields;
  const double    share          = ProjectionShare(m, c);
  double          dp[CL_CORNERS] = {0.0};

  for (int b = 0; b < CL_CORNERS; b++) {
    for (int ph = 0; ph < PHASE_COUNT; ph++) {
      const PetscInt k = c->node[b] * fs->n + PlaceP(fs, ph);

      if (fs->phase[ph])
        dp[b] += c->s[ph] * (x[k] - (slope ? 0.0 : m->stage.x_star[k]));
    }
  }
  for (int a = 0; a < CL_CORNERS; a++) {
    double Kdp = 0.0;

    for (int b = 0; b < CL_CORNERS; b++)
      Kdp += c->K[a][b] * dp[b];
    for (int ph = 0; ph < PHASE_COUNT; ph++) {
      if (fs->phase[ph])
        *RowOf(m, f, c->node[a], F_PW + ph) += c->content[ph] * share * Kdp;
    }
  }
}

void StabilisationResidual(const Model *m, const double *x, bool slope, double *f)
{
  for (PetscInt k = 0; k < m->added->nghost; k++)
    GhostResidual(m, &m->added->ghost[k], x, slope, f);
  for (PetscInt k = 0; k < m->added->ncell; k++)
    ProjectionResidual(m, &m->added->cell[k], x, slope, f);
}

static void GhostBlock(const Model *m, const Assembly *to, const GhostLine *g)
{
  const int  n  = to->fs.n;
  const int *at = to->fs.at;
  double     c[F_COUNT];

  GhostCoefficients(m, g, m->stage.dt, c);
  for (int k = 0; k < F_COUNT; k++) {
    for (int a = 0; a < 3 && c[k] != 0.0; a++) {
      const double w = c[k] * g->second[a];

      for (int b = 0; b < 3; b++) {
        double *block = AssemblyBlock(m, to, g->node[a], g->node[b]);

        block[at[k] * n + at[k]] += w * g->second[b];
        if (k == F_PW && g->carried > 0.0)
          block[at[F_PG] * n + at[F_PW]] += g->carried * w * g->second[b];
      }
    }
  }
}

static void ProjectionBlock(const Model *m, const Assembly *to, const ProjectionCell *c)
{
  const FieldSet *fs    = &to->fs;
  const double    share = ProjectionShare(m, c);

  for (int a = 0; a < CL_CORNERS; a++) {
    for (int r = 0; r < PHASE_COUNT; r++) {
      if (!fs->phase[r])
        continue;
      const double w = c->content[r] * share;

      for (int b = 0; b < CL_CORNERS; b++) {
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
