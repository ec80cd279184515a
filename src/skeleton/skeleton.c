/* The laws of the skeleton by name, and what they share at the end of a stage. */
#include "elastic.h"
#include "plastic.h"

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
