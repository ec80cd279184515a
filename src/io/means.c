/* Probes that are means: over a region, weighted with the current volumes of its particles; over a part of the surface,
   weighted with the current areas of its faces, of the true surface (70). */
#include "io_private.h"
#include "clathra/boundary.h"
#include "clathra/shape.h"

/* Does the mean take particle p?  A region without particles is a shape: whatever was in it first, or is in it now. */
static bool Takes(const Model *m, const Probe *b, PetscInt p)
{
  const Particles *P = &m->P;
  double           x[CL_DIM];

  if (!b->fixed && !RegionEmpty(&m->c->region[b->over]))
    return P->i[PI_REGION][p] == b->over;
  for (int d = 0; d < CL_DIM; d++)
    x[d] = b->fixed ? P->f[P_X + d][p] : ParticleInitialX(P, p, d);
  return RegionHolds(m->c, b->over, x);
}

static void AddParticle(const Model *m, PetscInt p, double weight, double value[PROBE_COUNT])
{
  for (int q = 0; q < PROBE_COUNT; q++) {
    if (ProbeWanted(CaseOf(m->c), q))
      value[q] += weight * ProbeQuantity(m, p, q);
  }
}

static void AddRegion(const Model *m, const Probe *b, double value[PROBE_COUNT], double *weight)
{
  for (PetscInt p = 0; p < m->P.n; p++) {
    if (!Takes(m, b, p))
      continue;
    AddParticle(m, p, m->P.f[P_V][p], value);
    *weight += m->P.f[P_V][p];
  }
}

/* What a value of the particle changes by on the way to its face, along its gradient. */
static double Along(const Particles *P, const Face *f, int gradient)
{
  double sum = 0.0;

  for (int d = 0; P->f[gradient] && d < CL_DIM; d++)
    sum += P->f[gradient + d][f->particle] * f->r[d];
  return sum;
}

static void AddFace(const Model *m, const Face *f, double value[PROBE_COUNT], double *weight)
{
  const Particles *P    = &m->P;
  const PetscInt   p    = f->particle;
  const double     area = VectorLength(f->s);
  const double     gw = Along(P, f, P_GW), gg = P->f[P_GG] ? Along(P, f, P_GG) : gw;

  AddParticle(m, p, area, value);
  *weight += area;
  if (P->f[P_PW]) {
    const double sw = P->f[P_SW][p] / (1.0 - P->f[P_SH][p]);

    value[PROBE_P] += area * (sw * gw + (1.0 - sw) * gg);
    value[PROBE_PW] += area * gw;
    value[PROBE_PW + 1] += area * gg;
  }
  value[PROBE_PW + 2] += area * Along(P, f, P_GT);
  for (int d = 0; d < CL_DIM; d++)
    value[PROBE_X + d] += area * (f->x[d] - P->f[P_X + d][p]);
}

PetscErrorCode MeansAdd(const Model *m, double value[][PROBE_COUNT], double *weight)
{
  const Case *c    = CaseOf(m->c);
  Face       *face = NULL;
  PetscInt    n    = 0;
  bool        any  = false;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->nprobe; k++) {
    if (ProbeIsMean(&c->probe[k]) && c->probe[k].over >= 0)
      AddRegion(m, &c->probe[k], value[k], &weight[k]);
    any = any || (ProbeIsMean(&c->probe[k]) && c->probe[k].over < 0);
  }
  if (any)
    PetscCall(FacesBuild(m->c, &m->grid, &m->P, &n, &face));
  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt k = 0; k < c->nprobe; k++) {
      const Probe *b = &c->probe[k];

      if (ProbeIsMean(b) && b->over < 0 && FaceNamed(&c->scene, &b->surface, face[i].region, face[i].x0, face[i].side))
        AddFace(m, &face[i], value[k], &weight[k]);
    }
  }
  PetscCall(PetscFree(face));
  PetscFunctionReturn(PETSC_SUCCESS);
}
