/* Linear elasticity (14) over blocks, as the integrators without a matrix take them. */
#include "elastic.h"
#include "plastic.h"

INLINE SkeletonStep StepOf(const SkeletonBlock *B, int q)
{
  SkeletonStep d = {
      .turn = RotationAt(B->turn, q), .thermal = B->thermal[q], .E_n = B->E_n[q], .E = B->E[q], .Sh = B->Sh[q]};

#pragma GCC unroll 6
  for (int k = 0; k < CL_TENSOR; k++)
    d.e[k] = B->e[k][q];
  return d;
}

static void Block_Bonds(const Material *mat, const SkeletonBlock *b)
{
  const Elasticity    el = mat->elasticity;
  const SkeletonBlock B  = *b;

  INDEPENDENT
  for (int q = 0; q < B.n; q++) {
    SkeletonStep    d = StepOf(&B, q);
    SkeletonHistory h;
    SkeletonState   s;

    d.kept = B.kept[q];
    SkeletonTakeStress(&B.store, q, &h);
#pragma GCC unroll 6
    for (int k = 0; k < CL_TENSOR; k++) {
      h.from.sig[k]              = h.sig[k];
      h.from.strain[k]           = 0.0;
      h.from.own[OWN_P_BOND + k] = B.store.own[OWN_P_BOND + k][q];
    }
    BondedStress(&el, &h, &d, &s);
    SkeletonKeepStress(&B.store, q, &s);
#pragma GCC unroll 6
    for (int k = 0; k < CL_TENSOR; k++)
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
  INDEPENDENT
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
