/* The laws of the skeleton by name, and the first of them, linear elasticity (14). */
#include "elastic.h"
#include "plastic.h"

static bool Update_Elastic(const Material *mat, const SkeletonHistory *h, const SkeletonStep *d, SkeletonState *s,
                           SkeletonTangent *t, const char **why)
{
  (void)why;
  TrialState(&mat->elasticity, h, d, s, t);
  return true;
}

INLINE SkeletonStep StepOf(const SkeletonBlock *B, int q)
{
  return (SkeletonStep){.c       = B->c[q],
                        .s       = B->s[q],
                        .e       = {B->xx[q], B->yy[q], 0.0, B->xy[q]},
                        .thermal = B->thermal[q],
                        .E_n     = B->E_n[q],
                        .E       = B->E[q],
                        .Sh      = B->Sh[q]};
}

static void Block_Bonds(const Material *mat, const SkeletonBlock *b)
{
  const Elasticity    el = mat->elasticity;
  const SkeletonBlock B  = *b;

#pragma GCC ivdep
  for (int q = 0; q < B.n; q++) {
    SkeletonStep    d = StepOf(&B, q);
    SkeletonHistory h;
    SkeletonState   s;

    d.kept = B.kept[q];
    SkeletonTakeStress(&B.store, q, &h);
#pragma GCC unroll 4
    for (int k = 0; k < 4; k++) {
      h.from.sig[k]              = h.sig[k];
      h.from.strain[k]           = 0.0;
      h.from.own[OWN_P_BOND + k] = B.store.own[OWN_P_BOND + k][q];
    }
    BondedStress(&el, &h, &d, &s);
    SkeletonKeepStress(&B.store, q, &s);
#pragma GCC unroll 4
    for (int k = 0; k < 4; k++)
      B.store.own[OWN_P_BOND + k][q] = s.own[OWN_P_BOND + k];
  }
}

bool Block_Elastic(const Material *mat, const SkeletonBlock *b, const char **why)
{
  const Elasticity    el = mat->elasticity;
  const SkeletonBlock B  = *b;

  (void)why;
  for (int q = 0; B.work && q < B.n; q++)
    B.work[q] = 0.0;
  if (ElasticityHasBonds(&el)) {
    Block_Bonds(mat, b);
    return true;
  }
#pragma GCC ivdep
  for (int q = 0; q < B.n; q++) {
    const SkeletonStep d = StepOf(&B, q);
    SkeletonHistory    h;
    SkeletonState      s;

    SkeletonTakeStress(&B.store, q, &h);
    ElasticStress(&el, &h, &d, &s);
    SkeletonKeepStress(&B.store, q, &s);
  }
  return true;
}

/* By PLASTICITY_... */
static const SkeletonLaw laws[] = {{.name = "none", .update = Update_Elastic, .block = Block_Elastic},
                                   {.name   = "mohr_coulomb",
                                    .has    = HAS_PLASTIC,
                                    .update = Update_MohrCoulomb,
                                    .block  = Block_MohrCoulomb,
                                    .margin = Margin_MohrCoulomb}};

const SkeletonLaw *SkeletonLawOf(const Material *mat)
{
  return &laws[mat->plasticity.type];
}

#define OWN_ROW(id, has, name, nc, unit, doc) {OWN_##id, nc},
static const struct {
  int first, nc;
} own[] = {CL_SKELETON_HISTORY(OWN_ROW)};

void SkeletonEndStage(const SkeletonHistory *h, const SkeletonStep *d, const SkeletonState *s, double V,
                      SkeletonStage *end)
{
  const double e[4] = {d->e[0] - d->thermal, d->e[1] - d->thermal, d->e[2] - d->thermal, d->e[3]};

  for (size_t i = 0; i < sizeof(own) / sizeof(*own); i++) {
    const double *from = s->own + own[i].first;
    double       *to   = end->own + own[i].first;

    if (own[i].nc == 4)
      Turn4(from, d->c, -d->s, to);
    for (int k = 0; own[i].nc != 4 && k < own[i].nc; k++)
      to[k] = from[k];
  }
  Turn4(e, d->c, -d->s, end->strain);
  Turn4(s->sig, d->c, -d->s, end->sig);
  for (int k = 0; k < 4; k++)
    end->plastic[k] = s->plastic[k];
  end->work = h->from.work + V * s->work;
}
