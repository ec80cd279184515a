/* The seal of a checkpoint: a few lines of text in front of the HDF5 data that say what it is, how long, and its
   checksum.  It is checked byte by byte before HDF5 sees the file, so that a damaged one never reaches the library. */
#include "io_private.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define MAGIC "clathra checkpoint\n"

typedef struct {
  int      version;
  uint64_t fingerprint, bytes, checksum;
} Seal;

uint64_t HashBytes(uint64_t hash, const void *data, size_t bytes)
{
  const unsigned char *c = data;

  for (size_t k = 0; k < bytes; k++)
    hash = (hash ^ c[k]) * UINT64_C(1099511628211);
  return hash;
}

/* ---------------------------------------------------------------- fingerprint */
static uint64_t Reals(uint64_t hash, const double *v, size_t n)
{
  for (size_t k = 0; k < n; k++) {
    const double x = v[k] + 0.0; /* -0 is 0 */

    hash = HashBytes(hash, &x, sizeof(x));
  }
  return hash;
}

static uint64_t Ints(uint64_t hash, const int64_t *v, size_t n)
{
  return HashBytes(hash, v, n * sizeof(*v));
}

static uint64_t Text(uint64_t hash, const char *s)
{
  return s ? HashBytes(hash, s, strlen(s) + 1) : HashBytes(hash, "", 1);
}

#define REALS(hash, ...) Reals(hash, (const double[]){__VA_ARGS__}, sizeof((double[]){__VA_ARGS__}) / sizeof(double))
#define INTS(hash, ...) Ints(hash, (const int64_t[]){__VA_ARGS__}, sizeof((int64_t[]){__VA_ARGS__}) / sizeof(int64_t))

static uint64_t HashLiquid(uint64_t h, const Liquid *l)
{
  return REALS(h, l->rho0, l->K, l->beta, l->p_ref, l->T_ref);
}

static uint64_t HashMaterial(uint64_t h, const Material *m)
{
  const Retention    *r = &m->retention;
  const RelPerm      *k = &m->relperm;
  const Permeability *a = &m->permeability;
  const Kinetics     *q = &m->kinetics;
  const Elasticity   *e = &m->elasticity;
  const Plasticity   *p = &m->plasticity;

  h = REALS(h, m->porosity, m->gas.M, m->mu_w, m->mu_g, m->c_s, m->c_h, m->c_w, m->c_g);
  h = REALS(h, m->kappa_s, m->kappa_h, m->kappa_w, m->kappa_g, m->latent.C0, m->latent.C1);
  h = HashLiquid(HashLiquid(HashLiquid(h, &m->solid), &m->hydrate), &m->water);
  h = REALS(Text(h, r->type), r->p0, r->m, r->lambda, r->Swr, r->Sgr, r->p_smooth, r->p_trap);
  h = INTS(REALS(h, k->Swr, k->Sgr, k->nw, k->ng), k->of_pores);
  h = REALS(Text(Text(h, a->hydrate_type), a->porosity_type), a->k0, a->phi0, a->mh, a->kh, a->Shc);
  h = REALS(h, q->K0, q->dE, q->A_geo, q->M_h, q->M_w, q->M_g, q->N_h);
  h = REALS(Text(h, q->equilibrium.type), q->equilibrium.A1, q->equilibrium.A2, q->equilibrium.A3);
  h = REALS(h, e->E0, e->Eh, e->ah, e->bh, e->nu);
  if (p->type != PLASTICITY_NONE)
    h = REALS(INTS(h, p->type, p->flow), p->c_max, p->c_min, p->c_res, p->phi_peak, p->phi_res, p->psi_max, p->psi_min,
              p->eta_h, p->Sh_max, p->eta_s, p->length, p->eccentricity, p->cutoff, p->heat);
  return INTS(h, m->reacts, e->loss_only);
}

static uint64_t HashPoints(uint64_t h, const Points *points)
{
  return Reals(INTS(h, points->n), points->x, (size_t)(2 * points->n));
}

static uint64_t HashRegion(uint64_t h, const Region *r)
{
  h = Reals(Reals(Reals(h, r->lower, CL_DIM), r->upper, CL_DIM), r->stress, 6);
  h = REALS(h, r->pressure, r->temperature, r->Sh, r->Sw, r->Sg, r->datum, r->K0, r->geothermal, r->geothermal_datum);
  h = HashPoints(HashPoints(INTS(h, r->shape, r->minus.n), &r->polygon), &r->below);
  h = Reals(h, r->circle, 3);
  for (PetscInt k = 0; k < r->minus.n; k++)
    h = INTS(h, r->minus.i[k]);
  return INTS(h, r->ppc[0], r->ppc[1], r->material, r->hydrostatic, r->consolidated);
}

static uint64_t HashSchedule(uint64_t h, const Schedule *s)
{
  h = INTS(h, s->n, s->steps);
  return Reals(Reals(h, s->t, (size_t)s->n), s->y, (size_t)s->n);
}

static uint64_t HashBc(uint64_t h, const Bc *b)
{
  h = INTS(h, b->type, b->side, b->region, b->axis, b->initial, b->natural, b->open, b->drained);
  h = HashPoints(REALS(h, b->from, b->to, b->position, b->alpha, b->zero), &b->along);
  h = HashSchedule(HashSchedule(h, &b->value), &b->shear);
  return HashSchedule(HashSchedule(h, &b->phase[PHASE_W]), &b->phase[PHASE_G]);
}

static uint64_t HashMeter(uint64_t h, const Meter *m)
{
  return HashPoints(REALS(INTS(h, m->side, m->region), m->from, m->to), &m->along);
}

static uint64_t HashScene(uint64_t h, const Case *c)
{
  h = Reals(Reals(Reals(h, c->lower, CL_DIM), c->upper, CL_DIM), c->gravity, CL_DIM);
  h = REALS(h, c->gravity_ramp);
  h = INTS(h, c->cells[0], c->cells[1], c->basis, c->axisymmetric, (int64_t)c->fields.has, c->nmaterial, c->nregion,
           c->nbc);
  h = REALS(HashSchedule(HashSchedule(h, &c->ambient_pressure), &c->ambient_level), c->ambient_density);
  for (PetscInt k = 0; k < c->nmaterial; k++)
    h = HashMaterial(h, &c->material[k]);
  for (PetscInt k = 0; k < c->nregion; k++)
    h = HashRegion(h, &c->region[k]);
  for (PetscInt k = 0; k < c->nbc; k++)
    h = HashBc(h, &c->bc[k]);
  for (PetscInt k = 0; k < c->nmeter; k++)
    h = HashMeter(h, &c->meter[k]);
  return h;
}

/* Of a case with stages: the scene of each, and when it begins. */
uint64_t CaseFingerprint(const Case *c)
{
  uint64_t h = FNV_START;

  if (!c->nstage)
    return HashScene(h, c);
  for (PetscInt k = 0; k < c->nstage; k++) {
    const CaseStage *s = &c->stage[k];

    h = INTS(HashScene(REALS(h, s->c.t_begin), &s->c), s->reset, s->c.inertia);
  }
  return h;
}

/* ---------------------------------------------------------------- the block itself */
static void Format(const Seal *seal, bool with_checksum, char block[SEAL_BYTES])
{
  int n;

  memset(block, 0, SEAL_BYTES);
  n = snprintf(block, SEAL_BYTES, MAGIC "version %d\ncase %016" PRIx64 "\nbytes %" PRIu64 "\n", seal->version,
               seal->fingerprint, seal->bytes);
  if (with_checksum)
    snprintf(block + n, SEAL_BYTES - (size_t)n, "fnv1a64 %016" PRIx64 "\n", seal->checksum);
}

static bool Parse(const char block[SEAL_BYTES], Seal *seal)
{
  return block[SEAL_BYTES - 1] == '\0' &&
         sscanf(block, MAGIC "version %d case %16" SCNx64 " bytes %20" SCNu64 " fnv1a64 %16" SCNx64, &seal->version,
                &seal->fingerprint, &seal->bytes, &seal->checksum) == 4;
}

/* Checksum of the block without it, and of the rest of the stream. */
static PetscErrorCode Checksum(FILE *f, const Seal *seal, uint64_t *hash)
{
  const size_t size = 1 << 20;
  char         block[SEAL_BYTES], *buffer;
  size_t       n;

  PetscFunctionBeginUser;
  Format(seal, false, block);
  *hash = HashBytes(FNV_START, block, SEAL_BYTES);
  PetscCall(PetscMalloc(size, &buffer));
  while ((n = fread(buffer, 1, size, f)) > 0)
    *hash = HashBytes(*hash, buffer, n);
  PetscCall(PetscFree(buffer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SealWrite(const char *path, uint64_t fingerprint)
{
  Seal  seal = {.version = CHECKPOINT_VERSION, .fingerprint = fingerprint};
  char  block[SEAL_BYTES];
  FILE *f = fopen(path, "r+b");
  bool  ok;

  PetscFunctionBeginUser;
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot open %s: %s", path, strerror(errno));
  ok         = fseeko(f, 0, SEEK_END) == 0;
  seal.bytes = (uint64_t)ftello(f);
  ok         = ok && fseeko(f, SEAL_BYTES, SEEK_SET) == 0;
  PetscCall(Checksum(f, &seal, &seal.checksum));
  Format(&seal, true, block);
  ok = ok && !ferror(f) && fseeko(f, 0, SEEK_SET) == 0 && fwrite(block, SEAL_BYTES, 1, f) == 1;
  ok = ok && fflush(f) == 0 && fsync(fileno(f)) == 0;
  ok = fclose(f) == 0 && ok;
  PetscCheck(ok, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write %s: %s", path, strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckStream(FILE *f, uint64_t bytes, Seal *seal, bool *ok, char *why, size_t size)
{
  char     block[SEAL_BYTES], expected[SEAL_BYTES] = {0};
  uint64_t hash = 0;

  PetscFunctionBeginUser;
  *ok = false;
  if (fread(block, 1, sizeof(MAGIC) - 1, f) != sizeof(MAGIC) - 1 || memcmp(block, MAGIC, sizeof(MAGIC) - 1)) {
    snprintf(why, size, "it is not a checkpoint of Clathra");
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (fread(block + sizeof(MAGIC) - 1, sizeof(block) - (sizeof(MAGIC) - 1), 1, f) != 1) {
    snprintf(why, size, "it is cut off after %" PRIu64 " bytes", bytes);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (sscanf(block, MAGIC "version %d", &seal->version) == 1 && seal->version != CHECKPOINT_VERSION) {
    snprintf(why, size, "it has format version %d; this program reads version %d", seal->version, CHECKPOINT_VERSION);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  *ok = Parse(block, seal);
  if (*ok)
    Format(seal, true, expected);
  *ok = *ok && memcmp(block, expected, SEAL_BYTES) == 0;
  if (!*ok)
    snprintf(why, size, "its first %d bytes are damaged", SEAL_BYTES);
  else if (bytes != seal->bytes)
    snprintf(why, size, "it has %" PRIu64 " bytes instead of %" PRIu64, bytes, seal->bytes);
  else {
    PetscCall(Checksum(f, seal, &hash));
    if (hash != seal->checksum)
      snprintf(why, size, "it is damaged: its checksum is wrong");
  }
  *ok = *ok && bytes == seal->bytes && hash == seal->checksum;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SealCheck(const char *path, uint64_t *fingerprint, bool *ok, char *why, size_t size)
{
  struct stat st;
  Seal        seal = {0};
  FILE       *f    = fopen(path, "rb");

  PetscFunctionBeginUser;
  *ok = false;
  if (!f || fstat(fileno(f), &st) != 0)
    snprintf(why, size, "%s", strerror(errno));
  else if (!S_ISREG(st.st_mode))
    snprintf(why, size, "it is not a file");
  else
    PetscCall(CheckStream(f, (uint64_t)st.st_size, &seal, ok, why, size));
  if (f)
    fclose(f);
  *fingerprint = seal.fingerprint;
  PetscFunctionReturn(PETSC_SUCCESS);
}
