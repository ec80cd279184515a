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
  const Rotation back = RotationBack(d->turn);
  double         e[CL_TENSOR];

  for (size_t i = 0; i < sizeof(own) / sizeof(*own); i++) {
    const double *from = s->own + own[i].first;
    double       *to   = end->own + own[i].first;

    if (own[i].nc == CL_TENSOR)
      Rotate(from, back, to);
    for (int k = 0; own[i].nc != CL_TENSOR && k < own[i].nc; k++)
      to[k] = from[k];
  }
  BareStrain(d, e);
  Rotate(e, back, end->strain);
  Rotate(s->sig, back, end->sig);
  for (int k = 0; k < CL_TENSOR; k++)
    end->plastic[k] = s->plastic[k];
  end->work = h->from.work + V * s->work;
}
