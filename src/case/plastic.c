/* plastic: what the keys of a material's strength must agree on. */
#include "case_private.h"
#include <stdio.h>

#define FAIL(key, ...) FAIL_AT(GROUP_MATERIAL, m->name, key, __VA_ARGS__)

/* The stress of a point must be able to follow its strength down, at every hydrate saturation. */
static void CheckSnapBack(Reader *r, const Material *m)
{
  const Plasticity *p = &m->plasticity;

  const double eta = SofteningRate(p);

  for (int k = 0; k <= 10; k++) {
    double       dE, worst = 0.0;
    const double Sh = 0.1 * k * p->Sh_max, E = ElasticityYoung(&m->elasticity, Sh, &dE);
    Strength     s;

    for (double eps = 0.0; eta > 0.0 && eps <= 2.0 / eta; eps += 0.2 / eta)
      worst = fmax(worst, SofteningRatio(p, E, m->elasticity.nu, Sh, eps, 0.0));
    if (worst < 1.0)
      continue;
    StrengthEvaluate(p, Sh, 0.0, &s);
    FAIL("plasticity_eta_s",
         "= %g softens faster than the elastic stress can follow (a point snaps back) at S_h = %g, where E = %g Pa and "
         "c_max - c_res = %g Pa: %.3g times too fast%s; lower eta_s, lower c_max - c_res, or raise E",
         p->eta_s, Sh, E, s.c - p->c_res, worst, p->length > 0.0 ? " on these cells (softening_length)" : "");
    return;
  }
}

void CheckPlasticity(Reader *r, const Case *c, const Material *m)
{
  const Plasticity *p = &m->plasticity;

  if (p->type != PLASTICITY_MOHR_COULOMB || !c->fields.solid)
    return;
  if (p->c_max == 0.0 && p->phi_peak == 0.0)
    FAIL("plasticity_cohesion_max", "is 0 Pa and plasticity_friction_peak 0 deg: the material has no strength at all");
  if (p->c_min > p->c_max)
    FAIL("plasticity_cohesion_min", "must not be above plasticity_cohesion_max (%g Pa > %g Pa)", p->c_min, p->c_max);
  if (p->c_res > p->c_min)
    FAIL("plasticity_cohesion_residual", "must not be above plasticity_cohesion_min, the least peak (%g Pa > %g Pa)",
         p->c_res, p->c_min);
  if (p->phi_res > p->phi_peak)
    FAIL("plasticity_friction_residual", "must not be above plasticity_friction_peak (%g deg > %g deg)", p->phi_res,
         p->phi_peak);
  if (p->psi_min > p->psi_max)
    FAIL("plasticity_dilation_min", "must not be above plasticity_dilation_max (%g deg > %g deg)", p->psi_min,
         p->psi_max);
  if (isfinite(p->cutoff) && p->flow != FLOW_MOHR_COULOMB)
    FAIL("plasticity_tension_cutoff", "needs plasticity_flow: mohr_coulomb");
  if (p->heat > 0.0 && !c->fields.heat)
    FAIL("plasticity_heat", "is %g but heat is not among the fields of the scene (%s)", p->heat, c->fields_wanted);
  if (isfinite(m->elasticity.E0) && p->c_res <= p->c_min)
    CheckSnapBack(r, m);
  if (p->psi_max > p->phi_peak && r->rank == 0)
    fprintf(stderr,
            "clathra: warning: material %s dilates more than it rubs (dilation_max %g deg > friction_peak %g deg)\n",
            m->name, p->psi_max, p->phi_peak);
}
