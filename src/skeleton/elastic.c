/* Linear elasticity (14), one particle at a time. */
#include "elastic.h"

bool Update_Elastic(const Material *mat, const SkeletonHistory *h, const SkeletonStep *d, SkeletonState *s,
                    SkeletonTangent *t, const char **why)
{
  (void)why;
  TrialState(&mat->elasticity, h, d, s, t);
  return true;
}
