/* Unit tests of src/io on a made-up model: probes reproduce linear fields, checkpoints come back bit for bit and refuse
   damage, snapshots open in h5py, a restart cuts the files back.  Runs on any number of ranks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>
#include "io/io_private.h"
#include "ranks.h"

#define PYTHON "/usr/bin/python3"

#define RUN UINT64_C(0x1234567890abcdef)

static char   folder[256];
static Origin origin; /* of the checkpoint read last */

static uint64_t rng = 88172645463325252ULL;

static uint64_t Random(void)
{
  rng ^= rng << 13;
  rng ^= rng >> 7;
  return rng ^= rng << 17;
}

/* Equal on all ranks: a number in [0,1) that belongs to (a, b). */
static double Noise(PetscInt a, PetscInt b)
{
  const int64_t key[2] = {a, b};

  return (double)(HashBytes(FNV_START, key, sizeof(key)) >> 11) * 0x1p-53;
}

static void PathOf(char path[512], const char *name)
{
  snprintf(path, 512, "%s/%s", folder, name);
}

static void WriteCheckpoint(const Model *m, const StepperState *s, const char *path)
{
  bool ok = false;

  Call(CheckpointWrite(m, s, RUN, path, &ok));
  Check(ok);
}

static void CloseOutput(Output **out)
{
  bool ok = false;

  Call(OutputDestroy(out, PETSC_COMM_WORLD, &ok));
  Check(ok);
}

/* ---------------------------------------------------------------- a made-up model */
typedef struct {
  Case     c;
  Material material;
  Region   region[1];
  Bc       bc[1];
  Probe    probe[6];
  double   t[2], y[2];
  Model    m;
} IoScene;

enum { PROBE_END = 0, PROBE_MIDDLE, PROBE_CORNER, PROBE_FIXED, PROBE_EMPTY, PROBE_OUTSIDE, PROBES };
static const char *const probe_name[PROBES] = {"end", "middle", "corner", "fixed", "empty", "outside"};

/* The body moves by this affine map of its initial position. */
static void Displacement(const double X[2], double u[2])
{
  u[0] = 0.01 - 0.05 * X[0] + 0.3 * X[1];
  u[1] = 0.002 + 0.01 * X[0] - 0.2 * X[1];
}

static double Linear(int k, const double X[2])
{
  return 1.0 + 0.1 * k + (0.3 + 0.05 * k) * X[0] - (0.2 + 0.07 * k) * X[1];
}

static void FillParticle(Particles *P, PetscInt p, PetscInt id, const double X[2])
{
  double u[2];

  Displacement(X, u);
  for (int k = 0; k < P_COUNT; k++)
    P->f[k][p] = k < P_SIG ? 0.5 + Noise(id, k) : Linear(k, X) * 1e5;
  for (int d = 0; d < 2; d++) {
    P->f[P_X + d][p]  = X[d] + u[d];
    P->f[P_U + d][p]  = u[d];
    P->f[P_X0 + d][p] = X[d];
  }
  P->f[P_PW][p]      = Linear(0, X) * 1e6;
  P->f[P_PG][p]      = P->f[P_PW][p]; /* no capillary pressure: p is linear, too */
  P->f[P_T][p]       = Linear(1, X);
  P->f[P_SH][p]      = 0.1 * Linear(2, X);
  P->f[P_SW][p]      = 0.2 * Linear(3, X);
  P->f[P_PHI][p]     = 0.3 * Linear(4, X);
  P->i[PI_ID][p]     = id;
  P->i[PI_REGION][p] = 0;
  P->i[PI_FACES][p]  = (PetscInt)(id % 16);
}

/* The nx x ny particles of the box [0,1] x [0,0.04], in a shuffled order on the owners of their cells. */
static void Seed(IoScene *s, const PetscInt n[2])
{
  Particles     *P     = &s->m.P;
  const PetscInt total = n[0] * n[1];

  Call(ParticlesCreate(~0u, P));
  Call(ParticlesResize(P, 0));
  for (PetscInt k = 0; k < total; k++) {
    const PetscInt id = (PetscInt)(((int64_t)k * 7919 + 13) % total); /* 7919 is prime */
    const double X[2] = {((double)(id % n[0]) + 0.5) / (double)n[0], 0.04 * ((double)(id / n[0]) + 0.5) / (double)n[1]};
    double       u[2];
    PetscInt     cell[2];

    Displacement(X, u);
    Check(GridCell(&s->m.grid, (double[]){X[0] + u[0], X[1] + u[1]}, cell));
    if (GridCellOwner(&s->m.grid, cell) != s->m.grid.rank)
      continue;
    Call(ParticlesResize(P, P->n + 1));
    FillParticle(P, P->n - 1, id, X);
  }
}

static void SceneCreate(IoScene *s, MPI_Comm comm, PetscInt across)
{
  const double   lower[2] = {-0.1, -0.02}, upper[2] = {1.1, 0.06};
  const PetscInt cells[2] = {60, 4}, n[2] = {100, across};
  const Probe    probe[PROBES] = {{.x = {1.0, 0.02}},
                                  {.x = {0.6, 0.017}},
                                  {.x = {0.0, 0.0}},
                                  {.x = {0.5, 0.02}, .fixed = true},
                                  {.x = {1.08, 0.02}, .fixed = true},
                                  {.x = {3.0, 0.02}}};

  memset(s, 0, sizeof(*s));
  Check(FieldSetMake(HAS_ALL, true, &s->c.scene.fields));
  s->c.scene.fields.has |= ~0u;
  memcpy(s->c.scene.lower, lower, sizeof(lower));
  memcpy(s->c.scene.upper, upper, sizeof(upper));
  memcpy(s->c.scene.cells, cells, sizeof(cells));
  memcpy(s->probe, probe, sizeof(probe));
  for (int k = 0; k < PROBES; k++)
    snprintf(s->probe[k].name, sizeof(s->probe[k].name), "%s", probe_name[k]);
  snprintf(s->c.output_dir, sizeof(s->c.output_dir), "%s/deep/run", folder);
  s->region[0] = (Region){.lower = {0.0, 0.0}, .upper = {1.0, 0.04}, .ppc = {2, across == 1 ? 1 : 2}};
  s->material  = (Material){.porosity = 0.4, .c_s = 800.0, .c_w = 4200.0, .c_h = 2000.0, .c_g = 2200.0};
  Check(RetentionSetType(&s->material.retention, "van_genuchten") && GasSetType(&s->material.gas, "ideal") &&
        EquilibriumSetType(&s->material.kinetics.equilibrium, "sloan") &&
        PermeabilitySetHydrateType(&s->material.permeability, "power") &&
        PermeabilitySetPorosityType(&s->material.permeability, "none"));
  s->t[1]              = 1.0;
  s->y[1]              = 5e6;
  s->bc[0]             = (Bc){.type = BC_TRACTION, .value = {.n = 2, .t = s->t, .y = s->y}};
  s->c.scene.nmaterial = s->c.scene.nregion = s->c.scene.nbc = 1;
  s->c.nprobe                                                = PROBES;
  s->c.scene.material                                        = &s->material;
  s->c.scene.region                                          = s->region;
  s->c.scene.bc                                              = s->bc;
  s->c.probe                                                 = s->probe;
  s->m.c                                                     = &s->c.scene;
  Call(GridCreate(comm, lower, upper, cells, &s->m.grid));
  Seed(s, n);
}

/* Active nodes: the two lower rows; their values tell where they are. */
static void AddNodes(IoScene *s)
{
  Grid          *g = &s->m.grid;
  unsigned char *flag;
  bool           changed;

  Call(PetscCalloc1(g->gm[0] * g->gm[1], &flag));
  for (PetscInt j = 0; j < 2; j++) {
    for (PetscInt i = 0; i <= g->cells[0]; i++) {
      if (i >= g->xs[0] && i < g->xs[0] + g->xm[0] && j >= g->xs[1] && j < g->xs[1] + g->xm[1])
        flag[GridPadded(g, (PetscInt[]){i, j})] = 1;
    }
  }
  Call(NodeMapUpdate(g, flag, &s->m.map, &changed));
  Call(PetscFree(flag));
  Call(PetscMalloc1(PetscMax(s->m.map.n_local, 1) * F_COUNT, &s->m.x_n));
  for (PetscInt k = 0; k < s->m.map.n_local; k++) {
    for (int f = 0; f < F_COUNT; f++)
      s->m.x_n[k * F_COUNT + f] = 1000.0 * f + 100.0 * s->m.map.ij[k][1] + s->m.map.ij[k][0];
  }
}

static void SceneDestroy(IoScene *s)
{
  Call(ParticlesDestroy(&s->m.P));
  Call(PetscFree(s->m.x_n));
  Call(NodeMapDestroy(&s->m.map));
  Call(GridDestroy(&s->m.grid));
}

static StepperState SomeState(void)
{
  StepperState s = {.step = 17, .t = 123.4567890123456789, .dt = 0.1, .err_old = 0.7, .hold = -1, .fresh = 1};

  s.newton_total  = 40;
  s.out[1]        = 1.0 / 3.0;
  s.heat_gain     = -5.0;
  s.water0        = 3.0;
  s.methane0      = 2.0;
  s.capacity0     = 1e6;
  s.scale_u       = 0.01;
  s.next_snapshot = 0;
  return s;
}

/* ---------------------------------------------------------------- probes */
/* Value of a column in the last row of a CSV file; rank 0 reads. */
static double Cell(const char *path, const char *column, int *rows)
{
  char  *line = NULL, *header = NULL;
  size_t cap = 0, hcap = 0;
  FILE  *f    = fopen(path, "r");
  int    want = -1, k = 0;
  double value = NAN;

  Check(f && getline(&header, &hcap, f) > 0);
  for (char *c = strtok(header, ",\n"); c; c = strtok(NULL, ",\n"), k++) {
    if (!strcmp(c, column))
      want = k;
  }
  Check(want >= 0);
  for (*rows = 0; getline(&line, &cap, f) > 0; (*rows)++) {
    char *c = line;

    for (k = 0; k < want; k++)
      c = strchr(c, ',') + 1;
    value = strtod(c, NULL);
  }
  fclose(f);
  free(line);
  free(header);
  return value;
}

static void ExpectProbe(const char *path, int k, const char *column, double expected)
{
  char         name[128];
  int          rows;
  const double scale = fmax(fabs(expected), 1e-3);

  snprintf(name, sizeof(name), "%s.%s", probe_name[k], column);
  const double value = Cell(path, name, &rows);
  if (!(fabs(value - expected) <= 2e-11 * scale))
    fprintf(stderr, "%s = %.15g instead of %.15g\n", name, value, expected);
  Check(fabs(value - expected) <= 2e-11 * scale);
}

/* Initial position of what is at x now. */
static void Back(const double x[2], double X[2])
{
  const double a = 0.95, b = 0.3, c = 0.01, d = 0.8, f = x[0] - 0.01, g = x[1] - 0.002, det = a * d - b * c;

  X[0] = (f * d - b * g) / det;
  X[1] = (a * g - c * f) / det;
}

static void ExpectProbes(const IoScene *s, const char *path)
{
  for (int k = 0; k < PROBES; k++) {
    double X[2] = {s->probe[k].x[0], s->probe[k].x[1]}, u[2];
    int    rows;

    if (k == PROBE_EMPTY) {
      Check(isnan(Cell(path, "empty.T_degC", &rows)));
      continue;
    }
    if (k == PROBE_FIXED)
      Back(s->probe[k].x, X);
    Displacement(X, u);
    ExpectProbe(path, k, "u_x_m", u[0]);
    ExpectProbe(path, k, "u_y_m", u[1]);
    ExpectProbe(path, k, "x_m", X[0] + u[0]);
    ExpectProbe(path, k, "y_m", X[1] + u[1]);
    ExpectProbe(path, k, "p_w_Pa", Linear(0, X) * 1e6);
    ExpectProbe(path, k, "p_Pa", Linear(0, X) * 1e6);
    ExpectProbe(path, k, "T_degC", Linear(1, X));
    ExpectProbe(path, k, "S_h", 0.1 * Linear(2, X));
    ExpectProbe(path, k, "S_g", 1.0 - 0.1 * Linear(2, X) - 0.2 * Linear(3, X));
    ExpectProbe(path, k, "sxx_Pa", Linear(P_SIG, X) * 1e5);
    ExpectProbe(path, k, "szz_Pa", Linear(P_SIG + 2, X) * 1e5);
    ExpectProbe(path, k, "sxy_Pa", Linear(P_SIG + 3, X) * 1e5);
  }
}

static void ProbesReproduceLinearFields(void **state)
{
  IoScene      s;
  StepperState z = SomeState();
  Output      *out;
  char         path[512];

  SceneCreate(&s, PETSC_COMM_WORLD, 4);
  Call(OutputCreate(&s.m, &z, false, &out));
  Call(OutputProbes(out, &s.m, &z));
  PathOf(path, "deep/run/probes.csv");
  if (world_rank == 0)
    ExpectProbes(&s, path);
  CloseOutput(&out);
  SceneDestroy(&s);
}

/* One row of particles: no slope across, values of the row. */
static void ProbesDropADirectionWithoutExtent(void **state)
{
  IoScene      s;
  StepperState z = SomeState();
  Output      *out;
  char         path[512];

  SceneCreate(&s, PETSC_COMM_WORLD, 1);
  Call(OutputCreate(&s.m, &z, false, &out));
  Call(OutputProbes(out, &s.m, &z));
  PathOf(path, "deep/run/probes.csv");
  if (world_rank == 0) {
    const double X[2] = {0.6, 0.02}, end[2] = {1.0, 0.02};
    double       u[2];

    ExpectProbe(path, PROBE_MIDDLE, "T_degC", Linear(1, X));
    Displacement(end, u);
    ExpectProbe(path, PROBE_END, "u_x_m", u[0]);
  }
  CloseOutput(&out);
  SceneDestroy(&s);
}

/* ---------------------------------------------------------------- checkpoints */
static uint64_t HashParticles(const Particles *P)
{
  uint64_t h = HashBytes(FNV_START, &P->n, sizeof(P->n));

  for (int k = 0; k < P_COUNT; k++)
    h = HashBytes(h, P->f[k], sizeof(double) * (size_t)P->n);
  for (int k = 0; k < PI_COUNT; k++)
    h = HashBytes(h, P->i[k], sizeof(PetscInt) * (size_t)P->n);
  return h;
}

static void ExpectState(const StepperState *a, const StepperState *b)
{
  for (const StateField *f = io_state_field; f->name; f++) {
    const size_t size = (size_t)f->n * (f->integer ? sizeof(PetscInt) : sizeof(double));

    Check(memcmp((const char *)a + f->offset, (const char *)b + f->offset, size) == 0);
  }
}

static void CheckpointComesBackBitForBit(void **state)
{
  IoScene            s;
  const StepperState z    = SomeState();
  StepperState       back = {0};
  char               path[512], old[520];
  uint64_t           hash;
  bool               ok;

  SceneCreate(&s, PETSC_COMM_WORLD, 4);
  PathOf(path, "checkpoint.h5");
  snprintf(old, sizeof(old), "%s.old", path);
  hash = HashParticles(&s.m.P);
  WriteCheckpoint(&s.m, &z, path);
  Check(access(old, F_OK) != 0);
  for (PetscInt p = 0; p < s.m.P.n; p++)
    s.m.P.f[P_T][p] = -1.0;
  Call(ParticlesResize(&s.m.P, s.m.P.n / 2));
  Call(CheckpointRead(&s.m, &back, path, &origin, &ok));
  Check(ok && origin.run == RUN && origin.t == back.t);
  Check(HashParticles(&s.m.P) == hash);
  ExpectState(&back, &z);

  back.step++;
  WriteCheckpoint(&s.m, &back, path); /* the first one becomes .old */
  Call(CheckpointRead(&s.m, &back, old, &origin, &ok));
  Check(ok && back.step == z.step);
  Call(CheckpointRead(&s.m, &back, path, &origin, &ok));
  Check(ok && back.step == z.step + 1);
  SceneDestroy(&s);
}

/* Every particle of b has its twin in the sum over ranks of a: compares sums that do not depend on the order. */
static uint64_t HashUnordered(const Particles *P)
{
  uint64_t sum = 0;

  for (PetscInt p = 0; p < P->n; p++) {
    uint64_t h = FNV_START;

    for (int k = 0; k < P_COUNT; k++)
      h = HashBytes(h, &P->f[k][p], sizeof(double));
    for (int k = 0; k < PI_COUNT; k++)
      h = HashBytes(h, &P->i[k][p], sizeof(PetscInt));
    sum += h;
  }
  return sum;
}

static void CheckpointGoesToOtherRanks(void **state)
{
  IoScene            one, all;
  const StepperState z = SomeState();
  StepperState       back;
  char               path[512];
  uint64_t           sum, expected;
  bool               ok;

  PathOf(path, "other.h5");
  SceneCreate(&all, PETSC_COMM_WORLD, 4);
  SceneCreate(&one, PETSC_COMM_SELF, 4);
  expected = HashUnordered(&one.m.P);
  if (world_rank == 0)
    WriteCheckpoint(&one.m, &z, path); /* 1 -> all */
  Call(MPI_Barrier(PETSC_COMM_WORLD));
  Call(CheckpointRead(&all.m, &back, path, &origin, &ok));
  Check(ok);
  sum = HashUnordered(&all.m.P);
  Call(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, PETSC_COMM_WORLD));
  Check(sum == expected);
  for (PetscInt p = 0; p < all.m.P.n; p++) { /* each with the owner of its cell */
    PetscInt cell[2];

    Check(GridCell(&all.m.grid, (double[]){all.m.P.f[P_X][p], all.m.P.f[P_X + 1][p]}, cell));
    Check(GridCellOwner(&all.m.grid, cell) == world_rank);
  }
  WriteCheckpoint(&all.m, &z, path); /* all -> 1 */
  if (world_rank == 0) {
    Call(CheckpointRead(&one.m, &back, path, &origin, &ok));
    Check(ok && HashUnordered(&one.m.P) == expected);
    if (world_size > 1)
      Check(one.m.P.i[PI_ID][0] == 0 && one.m.P.i[PI_ID][1] == 1); /* by id */
    ExpectState(&back, &z);
  }
  SceneDestroy(&one);
  SceneDestroy(&all);
}

/* Reads a file that must be refused, in one sentence that names it, with the model untouched. */
static void ExpectRefused(IoScene *s, const char *path, const char *reason)
{
  const uint64_t hash = HashParticles(&s->m.P);
  StepperState   z = SomeState(), before = z;
  char           log[512], text[1024]    = "";
  bool           ok          = true;
  int            stderr_copy = -1;
  const int      errors      = (int)H5Eget_num(H5E_DEFAULT);

  PathOf(log, "stderr.txt");
  fflush(stderr);
  if (world_rank == 0) {
    stderr_copy = dup(2);
    Check(stderr_copy >= 0 && freopen(log, "w", stderr));
  }
  const PetscErrorCode ierr = CheckpointRead(&s->m, &z, path, &origin, &ok);
  if (world_rank == 0) {
    fflush(stderr);
    dup2(stderr_copy, 2);
    close(stderr_copy);
    FILE *f = fopen(log, "r");

    Check(f);
    text[fread(text, 1, sizeof(text) - 1, f)] = '\0';
    fclose(f);
    if (!strstr(text, path) || !strstr(text, reason))
      fprintf(stderr, "not \"%s\" but: %s\n", reason, text);
    Check(strstr(text, path) && strstr(text, reason));
    Check(strchr(text, '\n') == text + strlen(text) - 1); /* one line */
  }
  Call(ierr);
  Check(!ok && HashParticles(&s->m.P) == hash);
  Check(memcmp(&z, &before, sizeof(z)) == 0 && errors == (int)H5Eget_num(H5E_DEFAULT));
}

static void WriteBytes(const char *path, const char *data, size_t n)
{
  FILE *f = fopen(path, "wb");

  Check(f && fwrite(data, 1, n, f) == n);
  Check(fclose(f) == 0);
}

static char *ReadBytes(const char *path, size_t *n)
{
  struct stat st;
  FILE       *f = fopen(path, "rb");
  char       *data;

  Check(f && fstat(fileno(f), &st) == 0);
  *n   = (size_t)st.st_size;
  data = malloc(*n);
  Check(data && fread(data, 1, *n, f) == *n);
  fclose(f);
  return data;
}

static void DamagedFilesAreRefused(void **state)
{
  IoScene            s;
  const StepperState z = SomeState();
  char               path[512], bad[512], *data = NULL;
  size_t             n = 0;

  SceneCreate(&s, PETSC_COMM_WORLD, 4);
  PathOf(path, "good.h5");
  PathOf(bad, "bad.h5");
  WriteCheckpoint(&s.m, &z, path);
  if (world_rank == 0)
    data = ReadBytes(path, &n);
  for (int k = 0; k < 20; k++) { /* cut off, from nothing to all but one byte */
    if (world_rank == 0)
      WriteBytes(bad, data, k == 19 ? n - 1 : k < 4 ? (size_t)k * 200 : n * (size_t)k / 20);
    ExpectRefused(&s, bad, "it");
  }
  for (int k = 0; k < 60; k++) { /* one byte turned: anywhere, then in the seal */
    const uint64_t random = Random();
    const size_t   at     = k < 50 ? (size_t)(random % PetscMax(n, 1)) : (size_t)(random % SEAL_BYTES);

    if (world_rank == 0) {
      data[at] ^= (char)(1 << (k % 8));
      WriteBytes(bad, data, n);
      data[at] ^= (char)(1 << (k % 8));
    }
    ExpectRefused(&s, bad, "it");
  }
  if (world_rank == 0) { /* something appended */
    data = realloc(data, n + 1);
    Check(data);
    data[n] = 0;
    WriteBytes(bad, data, n + 1);
  }
  ExpectRefused(&s, bad, "bytes instead of");
  if (world_rank == 0)
    WriteBytes(bad, "# not a checkpoint\n", 19);
  ExpectRefused(&s, bad, "not a checkpoint");
  if (world_rank == 0) {
    *strstr(data, "version ") = 'V'; /* the line is gone */
    WriteBytes(bad, data, n);
  }
  ExpectRefused(&s, bad, "damaged");
  if (world_rank == 0) {
    memcpy(strstr(data, "Version "), "version 8", 9);
    WriteBytes(bad, data, n);
  }
  ExpectRefused(&s, bad, "format version 8");
  PathOf(bad, "nowhere.h5");
  ExpectRefused(&s, bad, "No such file");
  ExpectRefused(&s, folder, "not a file");
  free(data);
  SceneDestroy(&s);
}

/* A checkpoint of another case, of each kind of difference. */
static void ForeignFilesAreRefused(void **state)
{
  IoScene            s;
  const StepperState z = SomeState();
  char               path[512];
  bool               ok;
  StepperState       back;

  SceneCreate(&s, PETSC_COMM_WORLD, 4);
  s.material.reacts      = true; /* so that K0 counts */
  double *const change[] = {&s.c.scene.gravity[1],   &s.region[0].upper[1],
                            &s.material.kappa_s,     &s.material.elasticity.E0,
                            &s.material.kinetics.K0, &s.y[1],
                            &s.bc[0].alpha};

  PathOf(path, "case.h5");
  WriteCheckpoint(&s.m, &z, path);
  for (size_t k = 0; k < sizeof(change) / sizeof(*change); k++) {
    const double was = *change[k];

    *change[k] = was + 1.0;
    ExpectRefused(&s, path, "another case");
    *change[k] = was;
  }
  s.material.retention.type = "brooks_corey";
  ExpectRefused(&s, path, "another case");
  s.material.retention.type = "van_genuchten";
  s.material.kappa_s += 1.0;
  ExpectRefused(&s, path, "conductivity is ");
  s.material.kappa_s -= 1.0;
  snprintf(s.c.title, sizeof(s.c.title), "another title");
  s.c.t_end = 7.0;
  Call(CheckpointRead(&s.m, &back, path, &origin, &ok));
  Check(ok);
  SceneDestroy(&s);
}

static void Reseal(const char *path, uint64_t fingerprint)
{
  size_t n;
  char  *data = ReadBytes(path, &n);

  SealMake(data, fingerprint, RUN, n, SealSum(data + SEAL_BYTES, n - SEAL_BYTES));
  WriteBytes(path, data, n);
  free(data);
}

/* Values that no run has. */
static const struct {
  const char *name;
  double      value;
  const char *reason;
} impossible[] = {{"/particles/S_w", 1e10, "an impossible S_w: 1e+10 - is not from -0.1 to 1.1"},
                  {"/particles/S_h", -0.5, "particle 0 has an impossible S_h: -0.5"},
                  {"/particles/porosity", 1.5, "an impossible porosity"},
                  {"/particles/T", -300.0, "an impossible T: -300 degC"},
                  {"/particles/p_w", 1e20, "an impossible p_w"},
                  {"/particles/p_g", -1e20, "an impossible p_g"},
                  {"/particles/stress", 1e20, "an impossible stress"},
                  {"/particles/log_J", 100.0, "an impossible log_J"},
                  {"/particles/v_g", 1e10, "an impossible v_g"},
                  {"/particles/mass_solid", -1.0, "an impossible mass_solid"},
                  {"/particles/volume", -1.0, "has no volume"},
                  {"/particles/position", 1e10, "lies outside the grid"},
                  {"/state/next_snapshot", 1e9, "/state/next_snapshot is impossible: 1000000000 after 17 steps"}};
#define IMPOSSIBLE (sizeof(impossible) / sizeof(*impossible))

/* Changes the first value of a dataset. */
static void OneValue(hid_t f, const char *name, double value)
{
  const hsize_t none[2] = {0, 0}, one[2] = {1, 1};
  hid_t         set = H5Dopen2(f, name, H5P_DEFAULT), space, memory;

  Check(set >= 0);
  space  = H5Dget_space(set);
  memory = H5Screate_simple(1, one, NULL);
  Check(H5Sselect_hyperslab(space, H5S_SELECT_SET, none, NULL, one, NULL) >= 0);
  Check(H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, &value) >= 0);
  H5Sclose(memory);
  H5Sclose(space);
  H5Dclose(set);
}

/* Files with a valid seal whose insides are wrong. */
static void Spoil(const char *path, uint64_t fingerprint, int kind)
{
  const hsize_t three = 3;
  double        x[3]  = {0, 0, 0};
  hid_t         f;

  f = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
  Check(f >= 0);
  if (kind == 0)
    Check(H5Ldelete(f, "/particles/porosity", H5P_DEFAULT) >= 0);
  if (kind == 1)
    Check(H5Ldelete(f, "/particles", H5P_DEFAULT) >= 0);
  if (kind == 2 || kind == 3) {
    Check(H5Ldelete(f, kind == 2 ? "/particles/T" : "/state/t", H5P_DEFAULT) >= 0);
    Call(H5Write(f, kind == 2 ? "/particles/T" : "/state/t", H5T_NATIVE_DOUBLE, three, x, NULL));
  }
  if (kind == 4 || kind == 5)
    OneValue(f, kind == 4 ? "/particles/T" : "/particles/region", kind == 4 ? NAN : 1000.0);
  if (kind == 6)
    Check(H5Adelete(f, "ranks") >= 0);
  if (kind == 7 || kind == 8) {
    const int     wrong[6] = {1, 1, 0, 3, 0, 100000};
    const hsize_t six = 6, five = 5;

    Check(H5Ldelete(f, "/borders", H5P_DEFAULT) >= 0);
    Call(H5Write(f, "/borders", H5T_NATIVE_INT, kind == 7 ? six : five, wrong, NULL));
  }
  if (kind == 9)
    Check(H5Ldelete(f, "/case", H5P_DEFAULT) >= 0);
  for (size_t j = 0; j < IMPOSSIBLE; j++) {
    if (kind == 10 + (int)j)
      OneValue(f, impossible[j].name, impossible[j].value);
  }
  Check(H5Fclose(f) >= 0);
  Reseal(path, fingerprint);
}

static void WrongInsidesAreRefused(void **state)
{
  static const char *const reason[] = {"/particles/porosity is missing",
                                       "/particles/id is missing",
                                       "/particles/T is missing or of wrong size",
                                       "/state/t is missing or of wrong size",
                                       "/particles/T is not finite",
                                       "belongs to no region",
                                       "ranks is missing",
                                       "/borders are impossible",
                                       "/borders are impossible"};
  IoScene                  s;
  const StepperState       z = SomeState();
  StepperState             back;
  bool                     ok;
  char                     path[512];

  SceneCreate(&s, PETSC_COMM_WORLD, 4);
  PathOf(path, "spoilt.h5");
  for (int k = 0; k < 9; k++) {
    WriteCheckpoint(&s.m, &z, path);
    if (world_rank == 0)
      Spoil(path, CaseFingerprint(&s.c), k);
    ExpectRefused(&s, path, reason[k]);
  }
  for (size_t k = 0; k < IMPOSSIBLE; k++) {
    WriteCheckpoint(&s.m, &z, path);
    if (world_rank == 0)
      Spoil(path, CaseFingerprint(&s.c), 10 + (int)k);
    ExpectRefused(&s, path, impossible[k].reason);
  }
  WriteCheckpoint(&s.m, &z, path);
  if (world_rank == 0) /* of another case, and does not hold it in words, as one of before */
    Spoil(path, CaseFingerprint(&s.c) ^ 1, 9);
  ExpectRefused(&s, path, "another case (grid, regions,");
  if (world_rank == 0)
    Reseal(path, CaseFingerprint(&s.c));
  Call(CheckpointRead(&s.m, &back, path, &origin, &ok));
  Check(ok);
  if (world_rank == 0) { /* a sealed file that is not HDF5 */
    char *block = calloc(1, 4096);

    WriteBytes(path, block, 4096);
    free(block);
    Reseal(path, CaseFingerprint(&s.c));
  }
  ExpectRefused(&s, path, "HDF5 cannot read it");
  SceneDestroy(&s);
}

/* Numbers in a checkpoint as a PETSc with indices of the other width would write them. */
static void ChangeWidth(const char *path, uint64_t fingerprint)
{
  const bool  wide   = sizeof(PetscInt) == 8;
  const char *name[] = {"/state/step", "/particles/id", "/borders"};
  hid_t       f      = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);

  Check(f >= 0);
  for (size_t k = 0; k < sizeof(name) / sizeof(*name); k++) {
    hsize_t  n = 0;
    int64_t *value;

    Check(H5Rows(f, name[k], &n));
    value = calloc((size_t)n, sizeof(*value));
    Check(H5Read(f, name[k], wide ? H5T_NATIVE_INT32 : H5T_NATIVE_INT64, n, value));
    Check(H5Ldelete(f, name[k], H5P_DEFAULT) >= 0);
    Call(H5Write(f, name[k], wide ? H5T_NATIVE_INT32 : H5T_NATIVE_INT64, n, value, NULL));
    free(value);
  }
  Check(H5Fclose(f) >= 0);
  Reseal(path, fingerprint);
}

static void NumbersOfTheOtherWidthAreRead(void **state)
{
  const StepperState z = SomeState();
  StepperState       back;
  IoScene            s;
  char               path[512];
  bool               ok;

  SceneCreate(&s, PETSC_COMM_WORLD, 4);
  PathOf(path, "width.h5");
  WriteCheckpoint(&s.m, &z, path);
  if (world_rank == 0)
    ChangeWidth(path, CaseFingerprint(&s.c));
  const PetscInt n = s.m.P.n, last = n > 0 ? s.m.P.i[PI_ID][n - 1] : -1;

  Call(CheckpointRead(&s.m, &back, path, &origin, &ok));
  Check(ok && back.step == z.step && s.m.P.n == n);
  Check(n == 0 || s.m.P.i[PI_ID][n - 1] == last);
  SceneDestroy(&s);
}

/* ---------------------------------------------------------------- snapshots, balance, restart */
static const char script[] =
    "import sys, h5py, numpy as np, xml.etree.ElementTree as ET\n"
    "run, count, grids = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])\n"
    "h = h5py.File(run + '/fields.h5', 'r')\n"
    "assert h.attrs['format_version'] == 1\n"
    "assert sorted(h['particles']) == ['%06d' % k for k in range(count)], list(h['particles'])\n"
    "for k in range(count):\n"
    "    g = h['particles/%06d' % k]\n"
    "    assert g.attrs['time'] == 10.0 * k\n"
    "    assert list(g['id'][()]) == list(range(400)) == list(g['vertex'][()])\n"
    "    X = g['position'][()] - g['displacement'][()]\n"
    "    assert np.allclose(X[:, 0], (np.arange(400) % 100 + .5) / 100, atol=1e-14)\n"
    "    assert g['stress'].shape == (400, 6) and g['T'].shape == (400,) and g['T'].dtype == 'f8'\n"
    "    assert g['T'].attrs['unit'] in ('degC', b'degC')\n"
    "    assert [str(np.asarray(g['rate_' + q].attrs['unit']).astype(str)) for q in ('p_w', 'p_g', 'T', 'S_h')] == "
    "['Pa/s', 'Pa/s', 'K/s', '1/s']\n"
    "    assert np.allclose(g['S_g'][()] + g['S_w'][()] + g['S_h'][()], 1) and np.allclose(g['p'][()], g['p_w'][()])\n"
    "    assert 'region' in g\n"
    "n = h['grid/%06d' % (count - 1)]\n"
    "assert n['v_w'].shape == (5, 61, 2) and n['T'].shape == (5, 61)\n"
    "assert (n['v_w'][:2, :, 1] == 3000 + 100 * np.arange(2)[:, None] + np.arange(61)).all() and n['T'][0, 60] == "
    "8060\n"
    "assert np.isnan(n['T'][2:]).all() and not np.isnan(n['T'][:2]).any()\n"
    "trees = [ET.parse(run + '/' + kind + '.xdmf').getroot() for kind in ('particles', 'grid')]\n"
    "series = {s.get('Name'): s.findall('Grid') for tree in trees for s in tree.find('Domain').findall('Grid')}\n"
    "assert len(series['particles']) == count and len(series['grid']) == grids\n"
    "assert [float(s.find('Time').get('Value')) for s in series['particles']] == [10.0 * k for k in range(count)]\n"
    "for item in (i for tree in trees for i in tree.iter('DataItem')):\n"
    "    if item.get('Format') != 'HDF': continue\n"
    "    name, path = item.text.split(':')\n"
    "    d = h5py.File(run + '/' + name, 'r')[path]\n"
    "    shape = [int(x) for x in item.get('Dimensions').split()]\n"
    "    assert int(np.prod(shape)) == d.size and int(item.get('Precision')) == d.dtype.itemsize, item.text\n";

static void ExpectSnapshots(int count, int grids)
{
  char path[512], command[2048];

  if (world_rank != 0)
    return;
  PathOf(path, "check.py");
  WriteBytes(path, script, sizeof(script) - 1);
  snprintf(command, sizeof(command), "LD_PRELOAD= " PYTHON " %s %s/deep/run %d %d", path, folder, count, grids);
  Check(system(command) == 0);
}

static void TakeSteps(Output *out, const Model *m, StepperState *z, int n)
{
  for (int k = 0; k < n; k++) {
    const StepInfo info = {.dt = 10.0, .newton = 3};

    z->step++;
    z->t += 10.0;
    Call(OutputBalance(out, m, z, &info));
    Call(OutputProbes(out, m, z));
    Call(OutputSnapshot(out, m, z));
    z->next_snapshot++;
  }
}

/* Nodes dealt out to the ranks in any way, all but every fifth: each rank's strip has the values of its nodes. */
static void NodesComeToTheirStrips(void **state)
{
  static const PetscInt cells[][CL_DIM] = {{5, 40}, {40, 5}, {1, 1}, {0, 30}};

  for (size_t c = 0; c < sizeof(cells) / sizeof(*cells); c++) {
    Model          m  = {.grid = {.comm = PETSC_COMM_WORLD, .rank = world_rank, .size = world_size}};
    const PetscInt nx = cells[c][0] + 1, nodes = nx * (cells[c][1] + 1);
    PetscInt       found = 0;
    Slab           s;

    PetscInt(*ij)[CL_DIM] = malloc((size_t)nodes * sizeof(*ij));
    double *x             = malloc((size_t)nodes * sizeof(double));
    for (int d = 0; d < CL_DIM; d++)
      m.grid.cells[d] = cells[c][d];
    for (PetscInt k = 0; k < nodes; k++) {
      if (k % 5 == 3 || (k * 7 + k / 3) % world_size != world_rank)
        continue;
      ij[m.map.n_owned][0] = k % nx;
      ij[m.map.n_owned][1] = k / nx;
      x[m.map.n_owned++]   = (double)k;
    }
    m.map.ij = ij;
    m.x_n    = x;
    Call(SlabNodes(&m, &s));
    Check(s.total == nodes - (nodes + 1) / 5);
    Call(SlabReals(&s, x, 1, 0, 1));
    for (hsize_t j = 0; j < s.part.count[0]; j++) {
      for (hsize_t i = 0; i < s.part.count[1]; i++) {
        const PetscInt k = (PetscInt)((s.part.start[0] + j) * (hsize_t)nx + s.part.start[1] + i);
        const double   v = s.data[j * s.part.count[1] + i];

        Check(k % 5 == 3 ? isnan(v) : v == (double)k);
        found++;
      }
    }
    Check(found == s.rows);
    Call(MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
    Check(found == nodes);
    Call(SlabDestroy(&s));
    free(ij);
    free(x);
  }
}

/* Particles in any order on any rank, their ids with gaps: rows in the order of ids, shares of equal ranges. */
static void ParticlesComeInOrder(void **state)
{
  enum { N = 101 };
  PetscInt id[N], last = -1, total, before = 0, *come;
  double   x[N];
  Model    m = {.grid = {.comm = PETSC_COMM_WORLD, .rank = world_rank, .size = world_size}};
  Slab     s;

  for (int k = 0; k < N; k++) {
    const int q = k * 37 % N;

    if (q % 3 == 2 || q % 7 % world_size != world_rank)
      continue;
    id[m.P.n]  = q * q;
    x[m.P.n++] = sqrt(2.0 + q);
  }
  m.P.i[PI_ID] = id;
  Call(SlabParticles(&m, &s));
  Call(MPI_Allreduce(&m.P.n, &total, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  Check(s.total == total && (PetscInt)s.part.all[0] == total && (PetscInt)s.part.count[0] == s.rows);
  Call(MPI_Exscan(&s.rows, &before, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  Check((PetscInt)s.part.start[0] == before);
  Call(SlabInts(&s, id));
  come = malloc((size_t)(s.rows + 1) * sizeof(*come));
  memcpy(come, s.data, (size_t)s.rows * sizeof(*come));
  Call(SlabReals(&s, x, 1, 1, 3));
  for (PetscInt k = 0; k < s.rows; k++) {
    Check(come[k] > last && s.data[3 * k + 1] == sqrt(2.0 + sqrt((double)come[k])));
    last = come[k];
  }
  free(come);
  Call(SlabDestroy(&s));
}

/* A run of five steps with a state in its middle. */
static void WriteRun(IoScene *s, ModelTotals *total, StepperState *middle)
{
  StepperState z = {.capacity0 = 2.0, .heat_gain = 6.0, .heat_in = 2.0};
  Output      *out;

  SceneCreate(s, PETSC_COMM_WORLD, 4);
  Call(ModelComputeTotals(&s->m, total));
  z.water0   = total->water * 2.0;
  z.methane0 = total->methane;
  Call(OutputCreate(&s->m, &z, false, &out));
  Call(OutputProbes(out, &s->m, &z));
  Call(OutputSnapshot(out, &s->m, &z)); /* before the first step: no nodes */
  z.next_snapshot++;
  AddNodes(s);
  TakeSteps(out, &s->m, &z, 2);
  *middle = z;
  TakeSteps(out, &s->m, &z, 3);
  CloseOutput(&out);
  ExpectSnapshots(6, 5);
}

static void ExpectBalance(const char *path, const ModelTotals *total)
{
  int rows;

  Check(Cell(path, "time_s", &rows) == 20.0 && rows == 2);
  Check(Cell(path, "newton", &rows) == 3.0);
  Check(fabs(Cell(path, "water_error", &rows) + 0.5) < 1e-12);
  Check(Cell(path, "water_kg", &rows) == total->water);
  Check(fabs(Cell(path, "heat_error", &rows) - 2.0) < 1e-12);
}

static void FilesAreCutBackAtARestart(void **state)
{
  IoScene      s;
  StepperState middle;
  ModelTotals  total;
  Output      *out;
  char         probes[512], balance[512];
  int          rows;

  WriteRun(&s, &total, &middle);
  PathOf(probes, "deep/run/probes.csv");
  PathOf(balance, "deep/run/balance.csv");
  if (world_rank == 0) { /* killed while writing a row */
    FILE *f = fopen(probes, "a");

    Check(f && fputs("1.0e+01,3.4", f) >= 0 && fclose(f) == 0);
  }
  Call(OutputCreate(&s.m, &middle, true, &out));
  ExpectSnapshots(3, 2);
  if (world_rank == 0) {
    Check(Cell(probes, "time_s", &rows) == 20.0 && rows == 3);
    ExpectBalance(balance, &total);
  }
  TakeSteps(out, &s.m, &middle, 1);
  CloseOutput(&out);
  ExpectSnapshots(4, 3);
  if (world_rank == 0)
    Check(Cell(probes, "time_s", &rows) == 30.0 && rows == 4);
  SceneDestroy(&s);
}

/* Other probes, an unreadable list of snapshots and an unreadable snapshot: set aside, the rest goes on. */
static void FilesThatDoNotFitAreKeptAside(void **state)
{
  IoScene      s;
  StepperState z;
  ModelTotals  total;
  Output      *out;
  char         path[512];
  int          rows;

  WriteRun(&s, &total, &z);
  s.c.nprobe = 2;
  PathOf(path, "deep/run/fields.h5");
  if (world_rank == 0)
    WriteBytes(path, "rubbish", 7);
  PathOf(path, "deep/run/fields/000001.h5");
  if (world_rank == 0)
    WriteBytes(path, "rubbish", 7);
  Call(OutputCreate(&s.m, &z, true, &out));
  TakeSteps(out, &s.m, &z, 1);
  CloseOutput(&out);
  if (world_rank == 0) {
    PathOf(path, "deep/run/probes.csv");
    Check(Cell(path, "end.p_Pa", &rows) > 0.0 && rows == 1);
    PathOf(path, "deep/run/probes.csv.old");
    Check(access(path, F_OK) == 0);
    PathOf(path, "deep/run/fields/000001.h5.damaged");
    Check(access(path, F_OK) == 0);
    PathOf(path, "deep/run/fields.h5");
    hid_t f = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    Check(f >= 0 && H5Lexists(f, "/particles/000000", H5P_DEFAULT) > 0 && H5Fclose(f) >= 0);
  }
  SceneDestroy(&s);
}

static int MakeFolder(void **state)
{
  (void)state;
  snprintf(folder, sizeof(folder), "%s/clathra_io_XXXXXX", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
  if (world_rank == 0 && !mkdtemp(folder))
    return 1;
  return MPI_Bcast(folder, sizeof(folder), MPI_CHAR, 0, PETSC_COMM_WORLD);
}

static int RemoveFolder(void **state)
{
  char command[512];

  (void)state;
  snprintf(command, sizeof(command), "rm -rf '%s'", folder);
  if (MPI_Barrier(PETSC_COMM_WORLD))
    return 1;
  return world_rank == 0 && system(command);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(ProbesReproduceLinearFields),  cmocka_unit_test(ProbesDropADirectionWithoutExtent),
      cmocka_unit_test(CheckpointComesBackBitForBit), cmocka_unit_test(CheckpointGoesToOtherRanks),
      cmocka_unit_test(DamagedFilesAreRefused),       cmocka_unit_test(ForeignFilesAreRefused),
      cmocka_unit_test(WrongInsidesAreRefused),       cmocka_unit_test(NumbersOfTheOtherWidthAreRead),
      cmocka_unit_test(NodesComeToTheirStrips),       cmocka_unit_test(ParticlesComeInOrder),
      cmocka_unit_test(FilesAreCutBackAtARestart),    cmocka_unit_test(FilesThatDoNotFitAreKeptAside)};

  return RunTests(argc, argv, tests, MakeFolder, RemoveFolder);
}
