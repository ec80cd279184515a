/* Reading a checkpoint: each rank reads and checks an equal share of the particles, then sends them to the owners of
   their cells.  To go on with the same case, or as the initial state of another one. */
#include "io_private.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
  StepperState s;
  Particles    P;                /* this rank's share, by id */
  H5Part       part;             /* its rows */
  PetscInt     ranks;            /* of the run that wrote it */
  PetscInt     nborder, *border; /* /borders; none unless there are as many here */
  PetscInt    *rank, *place;     /* where each particle was */
  uint64_t     run;              /* that wrote it */
  bool         initial;          /* as the initial state of a run */
  char         why[1280];        /* reason of a refusal */
} Loaded;

#define Refuse(L, ...)                                                                                                 \
  do {                                                                                                                 \
    snprintf((L)->why, sizeof((L)->why), __VA_ARGS__);                                                                 \
    PetscFunctionReturn(PETSC_SUCCESS);                                                                                \
  } while (0)

static bool Finite(const double *v, PetscInt n)
{
  for (PetscInt k = 0; k < n; k++) {
    if (!isfinite(v[k]))
      return false;
  }
  return true;
}

/* What no running program can have written of a variable of the particles, in its unit: wide, for a scheme may leave a
   share a little outside of 0 to 1. */
static const struct {
  const char *name;
  double      low, high;
} range[] = {{"S_h", -0.1, 1.1},           {"S_w", -0.1, 1.1},
             {"porosity", 0.0, 1.0},       {"T", -CL_ZERO_CELSIUS, 1e5},
             {"p_w", -1e13, 1e13},         {"p_g", -1e13, 1e13},
             {"p_w_initial", -1e13, 1e13}, {"p_g_initial", -1e13, 1e13},
             {"stress", -1e15, 1e15},      {"stress_initial", -1e15, 1e15},
             {"log_J", -50.0, 50.0},       {"deformation_gradient", -1e9, 1e9},
             {"v_s", -3e8, 3e8},           {"v_w", -3e8, 3e8},
             {"v_g", -3e8, 3e8},           {"mass_solid", 0.0, INFINITY}};

static PetscErrorCode CheckRange(const ParticleVariable *v, const double *data, Loaded *L)
{
  size_t k = 0;

  PetscFunctionBeginUser;
  while (k < sizeof(range) / sizeof(*range) && strcmp(range[k].name, v->name))
    k++;
  for (PetscInt i = 0; k < sizeof(range) / sizeof(*range) && i < L->P.n * v->nc; i++) {
    if (data[i] < range[k].low || data[i] > range[k].high)
      Refuse(L, "particle %d has an impossible %s: %g %s is not from %g to %g", (int)L->P.i[PI_ID][i / v->nc], v->name,
             data[i], v->unit, range[k].low, range[k].high);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadState(hid_t file, Loaded *L)
{
  PetscFunctionBeginUser;
  for (const StateField *f = io_state_field; f->name; f++) {
    void *to = (char *)&L->s + f->offset;
    char  name[64];

    snprintf(name, sizeof(name), "/state/%s", f->name);
    if (!H5Read(file, name, f->integer ? H5_INT : H5T_NATIVE_DOUBLE, (hsize_t)f->n, to))
      Refuse(L, "%s is missing or of wrong size", name);
    if (!f->integer && !Finite(to, f->n))
      Refuse(L, "%s is not finite", name);
    if (f->integer && *(PetscInt *)to < (strcmp(f->name, "hold") ? 0 : -1)) /* a fixed step that grows back */
      Refuse(L, "%s is negative", name);
  }
  if (L->s.next_snapshot > L->s.step + 1)
    Refuse(L, "/state/next_snapshot is impossible: %d after %d steps", (int)L->s.next_snapshot, (int)L->s.step);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadReals(hid_t group, Loaded *L)
{
  const PetscInt n = L->P.n;
  double        *data;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(PetscMax(n, 1) * P_MOST, &data));
  for (const ParticleVariable *v = cl_particle_variable; v->name && !L->why[0]; v++) {
    if (!ParticlesHold(&L->P, v))
      continue;
    if (!H5ReadPart(group, v->name, H5T_NATIVE_DOUBLE, &L->part, v->nc, data)) {
      snprintf(L->why, sizeof(L->why), "/particles/%s is missing or of wrong size", v->name);
    } else if (!Finite(data, n * v->nc)) {
      snprintf(L->why, sizeof(L->why), "/particles/%s is not finite", v->name);
    } else {
      PetscCall(CheckRange(v, data, L));
      for (PetscInt p = 0; p < n; p++) {
        for (int c = 0; c < v->nc; c++)
          L->P.f[v->first + c][p] = data[p * v->nc + c];
      }
    }
  }
  PetscCall(PetscFree(data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadInts(hid_t group, Loaded *L)
{
  const char *name[] = {"id", "region", "faces", "rank", "place"};
  PetscInt   *to[]   = {L->P.i[PI_ID], L->P.i[PI_REGION], L->P.i[PI_FACES], L->rank, L->place};

  PetscFunctionBeginUser;
  for (int k = 0; k < 5; k++) {
    if (!H5ReadPart(group, name[k], H5_INT, &L->part, 1, to[k]))
      Refuse(L, "/particles/%s is missing or of wrong size", name[k]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What no running program can have written; before: id of the particle before the first, -1 if there is none. */
static PetscErrorCode CheckParticles(const Model *m, PetscInt before, Loaded *L)
{
  const Particles *P = &L->P;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < P->n; p++) {
    const PetscInt id = P->i[PI_ID][p], region = P->i[PI_REGION][p], faces = P->i[PI_FACES][p];
    double         x[CL_DIM];
    PetscInt       cell[CL_DIM];

    ParticleGridPlace(P, p, x);

    if (id <= (p > 0 ? P->i[PI_ID][p - 1] : before))
      Refuse(L, "its particles are not in order");
    if (region < 0 || region >= m->c->nregion)
      Refuse(L, "particle %d belongs to no region", (int)id);
    if (faces < 0 || faces >= 1 << SIDE_COUNT)
      Refuse(L, "particle %d has impossible faces", (int)id);
    if (!GridCell(&m->grid, x, cell))
      Refuse(L, "particle %d lies outside the grid", (int)id);
    bool thick = P->f[P_V][p] > 0.0;
    for (int d = 0; d < CL_DIM; d++)
      thick = thick && P->f[P_L + d][p] > 0.0;
    if (!thick)
      Refuse(L, "particle %d has no volume", (int)id);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The parts of /borders; false if it has none such. */
static bool Borders(PetscInt n, PetscInt *border, PetscInt *start[CL_DIM])
{
  PetscInt at = CL_DIM;

  for (int d = 0; d < CL_DIM; d++) {
    if (border[d] < 1 || border[d] >= n)
      return false;
    start[d] = border + at;
    at += border[d] + 1;
  }
  return at == n;
}

/* The borders of as many ranks as run now; others choose their own. */
static PetscErrorCode LoadBorders(const Grid *g, hid_t file, Loaded *L)
{
  PetscInt *start[CL_DIM];
  hsize_t   n = 0;

  PetscFunctionBeginUser;
  if (L->ranks != g->size)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (!H5Rows(file, "borders", &n) || n < CL_DIM || n > CL_DIM * ((hsize_t)g->size + 2))
    Refuse(L, "/borders is missing or of wrong size");
  L->nborder = (PetscInt)n;
  PetscCall(PetscMalloc1(L->nborder, &L->border));
  if (!H5Read(file, "borders", H5_INT, n, L->border) || !Borders((PetscInt)n, L->border, start) ||
      !GridSound(g, L->border, start))
    Refuse(L, "/borders are impossible");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The share of this rank of n particles, and the id before it. */
static PetscErrorCode TakeShare(const Grid *g, hid_t file, hsize_t n, Loaded *L, PetscInt *before)
{
  const hsize_t share = n / (hsize_t)g->size + 1, first = PetscMin((hsize_t)g->rank * share, n);
  H5Part        one = {.nd = 1, .all = {n}, .start = {first - 1}, .count = {1}};

  PetscFunctionBeginUser;
  L->part = (H5Part){.nd = 1, .all = {n}, .start = {first}, .count = {PetscMin(share, n - first)}};
  *before = -1;
  if (first > 0 && !H5ReadPart(file, "/particles/id", H5_INT, &one, 1, before))
    Refuse(L, "/particles/id is missing or of wrong size");
  PetscCall(ParticlesResize(&L->P, (PetscInt)L->part.count[0]));
  PetscCall(PetscMalloc2(L->P.n, &L->rank, L->P.n, &L->place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadParticles(const Model *m, hid_t file, Loaded *L)
{
  hsize_t  n = 0;
  PetscInt before;
  hid_t    group;

  PetscFunctionBeginUser;
  if (!H5Rows(file, "/particles/id", &n) || n > PETSC_MAX_INT / 2)
    Refuse(L, "/particles/id is missing or of wrong size");
  PetscCall(TakeShare(&m->grid, file, n, L, &before));
  if (L->why[0])
    PetscFunctionReturn(PETSC_SUCCESS);
  H5Check(group = H5Gopen2(file, "/particles", H5P_DEFAULT));
  PetscCall(LoadInts(group, L));
  if (!L->why[0])
    PetscCall(LoadReals(group, L));
  if (!L->why[0])
    PetscCall(CheckParticles(m, before, L));
  H5Check(H5Gclose(group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadFile(const Model *m, hid_t file, Loaded *L)
{
  PetscFunctionBeginUser;
  if (!H5ReadInt(file, "ranks", &L->ranks))
    Refuse(L, "the attribute ranks is missing");
  PetscCall(LoadBorders(&m->grid, file, L));
  if (!L->why[0])
    PetscCall(LoadState(file, L));
  if (!L->why[0] && !L->initial && L->s.stage >= PetscMax(CaseOf(m->c)->nstage, 1))
    Refuse(L, "the case has no stage %d", (int)L->s.stage + 1);
  if (!L->why[0])
    PetscCall(LoadParticles(m, file, L));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first line in which two scenes differ; false: none. */
static bool Differ(char *theirs, char *ours, char *why, size_t size)
{
  char *ends[2], *a = strtok_r(theirs, "\n", &ends[0]), *b = strtok_r(ours, "\n", &ends[1]);

  while (a && b && !strcmp(a, b)) {
    a = strtok_r(NULL, "\n", &ends[0]);
    b = strtok_r(NULL, "\n", &ends[1]);
  }
  if (a && b) {
    char        *value = strrchr(a, ':'), *other = strrchr(b, ':');
    const size_t length = (size_t)(value - a);

    if (length == (size_t)(other - b) && !strncmp(a, b, length)) {
      *value = '\0';
      snprintf(why, size, "%.200s is%.100s in it but%.100s here", a, value + 1, other + 1);
      return true;
    }
  }
  if (a || b)
    snprintf(why, size, "it says '%.200s' where this case says '%.200s'", a ? a : "nothing more",
             b ? b : "nothing more");
  return a || b;
}

static PetscErrorCode CheckScene(const Model *m, hid_t file, Loaded *L)
{
  hsize_t n;
  size_t  size;
  char   *theirs, *ours;

  PetscFunctionBeginUser;
  if (!H5Rows(file, "scene", &n) || n > PETSC_MAX_INT / 8)
    Refuse(L, "/scene is missing or of wrong size");
  PetscCall(PetscCalloc1((PetscInt)n + 1, &theirs));
  if (!H5Read(file, "scene", H5T_NATIVE_CHAR, n, theirs))
    snprintf(L->why, sizeof(L->why), "/scene is no text");
  else {
    PetscCall(CaseText(CaseOf(m->c), CaseWriteState, &ours, &size));
    (void)Differ(theirs, ours, L->why, sizeof(L->why));
    free(ours);
  }
  PetscCall(PetscFree(theirs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* L->why stays empty if all is well with what this rank reads. */
static PetscErrorCode Load(const Model *m, const char *path, Loaded *L)
{
  uint64_t fingerprint;
  hid_t    file;
  bool     ok;

  PetscFunctionBeginUser;
  PetscCall(SealCheck(m->grid.comm, path, &fingerprint, &L->run, &ok, L->why, sizeof(L->why)));
  if (!ok)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(H5FileOpen(path, &file));
  if (file < 0)
    Refuse(L, "HDF5 cannot read it");
  if (L->initial)
    PetscCall(CheckScene(m, file, L));
  else if (fingerprint != CaseFingerprint(CaseOf(m->c)))
    PetscCall(BoundDiffers(file, CaseOf(m->c), L->why, sizeof(L->why)));
  if (!L->why[0])
    PetscCall(LoadFile(m, file, L));
  PetscCall(H5FileClose(&file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The reason of the first rank that has one is that of all. */
static PetscErrorCode Agree(const Grid *g, Loaded *L)
{
  PetscMPIInt first = L->why[0] ? g->rank : g->size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, g->comm));
  if (first < g->size)
    PetscCallMPI(MPI_Bcast(L->why, sizeof(L->why), MPI_CHAR, first, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- dealing out */
/* To the owners of their cells: on as many ranks in the order they had, else by id. */
static PetscErrorCode Deal(const Grid *g, Loaded *L)
{
  const bool     same  = L->ranks == g->size;
  const PetscInt total = (PetscInt)L->part.all[0], first = (PetscInt)L->part.start[0];
  PetscMPIInt   *owner;
  PetscInt      *key;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(L->P.n, &owner, L->P.n, &key));
  for (PetscInt p = 0; p < L->P.n; p++) {
    double   x[CL_DIM];
    PetscInt cell[CL_DIM];

    ParticleGridPlace(&L->P, p, x);
    PetscCheck(GridCell(g, x, cell), PETSC_COMM_SELF, PETSC_ERR_PLIB, "a particle outside the grid was not noticed");
    owner[p] = GridCellOwner(g, cell);
    key[p]   = same && L->rank[p] == owner[p] ? L->place[p] : total + first + p;
  }
  PetscCall(ParticlesSend(g->comm, owner, key, &L->P));
  PetscCall(PetscFree2(owner, key));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ranks own what they owned when the file was written. */
static PetscErrorCode TakeBorders(Model *m, const Loaded *L)
{
  PetscInt *start[CL_DIM];

  PetscFunctionBeginUser;
  if (L->nborder == 0)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(Borders(L->nborder, L->border, start), m->grid.comm, PETSC_ERR_PLIB,
             "impossible borders were not noticed");
  PetscCall(ModelShare(m, L->border, start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (445): the run before may have stretched them. */
static void InitialDomains(const Scene *c, Particles *P)
{
  for (PetscInt p = 0; P->total && p < P->n; p++) {
    double X[CL_DIM], l[CL_DIM];

    ParticleInitialPlace(P, p, X);
    ParticlesInitialHalfLength(c, P->i[PI_REGION][p], X, l);
    for (int d = 0; d < CL_DIM; d++)
      P->f[P_L + d][p] = l[d];
  }
}

/* s NULL: as an initial state. */
static PetscErrorCode ReadAll(Model *m, StepperState *s, const char *path, Origin *origin, bool *ok)
{
  const Grid *g = &m->grid;
  Loaded      L = {.initial = s == NULL};

  PetscFunctionBeginUser;
  PetscCall(ParticlesCreate(m->c->fields.has, &L.P));
  L.P.total = m->P.total;
  PetscCall(Load(m, path, &L));
  PetscCall(Agree(g, &L));
  *ok = L.why[0] == '\0';
  if (*ok) {
    PetscCall(TakeBorders(m, &L));
    PetscCall(Deal(g, &L));
    PetscCall(ParticlesDestroy(&m->P));
    m->P = L.P;
    InitialDomains(m->c, &m->P);
    if (s)
      *s = L.s;
    *origin = (Origin){.run = L.run, .t = L.s.t, .unseen = {L.s.unseen, L.s.unseen_steps}};
  } else {
    if (g->rank == 0)
      fprintf(stderr, "%s: cannot %s this file: %s\n", path, s ? "restart from" : "start from the state of", L.why);
    PetscCall(ParticlesDestroy(&L.P));
  }
  PetscCall(PetscFree2(L.rank, L.place));
  PetscCall(PetscFree(L.border));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointRead(Model *m, StepperState *s, const char *path, Origin *origin, bool *ok)
{
  PetscFunctionBeginUser;
  PetscCall(ReadAll(m, s, path, origin, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointReadInitial(Model *m, const char *path, Origin *origin, bool *ok)
{
  PetscFunctionBeginUser;
  PetscCall(ReadAll(m, NULL, path, origin, ok));
  if (*ok)
    ParticlesBecomeInitial(&m->P);
  PetscFunctionReturn(PETSC_SUCCESS);
}
