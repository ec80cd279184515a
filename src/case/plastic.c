/* plastic: what the keys of a material's strength must agree on. */
#include "case_private.h"
#include <stdio.h>

#define FAIL(key, ...) FAIL_AT(GROUP_MATERIAL, m->name, key, __VA_ARGS__)

/* Depth (m) of the grid's foot below the level from which on the strength grows. */
static double DeepestOf(const Scene *c, const Plasticity *p)
{
  return fmax(StrengthDepth(p, c->lower), StrengthDepth(p, c->upper));
}

/* The stress of a point must be able to follow its strength down, at every hydrate saturation. */
static void CheckSnapBack(Reader *r, const Scene *c, const Material *m)
{
  const Plasticity  deep = StrengthAtDepth(&m->plasticity, DeepestOf(c, &m->plasticity)); /* where most of it goes */
  const Plasticity *p    = &deep;

  const double eta = p->nonlocal > 0.0 ? 0.0 : SofteningRate(p); /* a strength given for the step cannot fall in it */

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

#define LEAST_CELLS 2.0 /* in a nonlocal_length: with less it is the grid again that decides */

/* A length over which plastic strain is averaged needs cells finer than itself, and strength that falls with strain. */
static void CheckNonlocal(Reader *r, const Scene *c, const Material *m)
{
  const Plasticity *p = &m->plasticity;
  double            h = 0.0;

  for (int d = 0; d < CL_DIM; d++) {
    const GridLines line = SceneLines(c, d);

    h = fmax(h, LinesWidest(&line));
  }
  if (p->nonlocal < LEAST_CELLS * h * (1.0 - 1e-9))
    FAIL("plasticity_nonlocal_length", "= %g m is less than two cells; allowed [%g m,1e+06 m], or 0 m for none",
         p->nonlocal, LEAST_CELLS * h);
  if (c->basis == BASIS_TOTAL)
    FAIL("plasticity_nonlocal_length", "is not known with basis: total");
  if (p->length > 0.0)
    FAIL("plasticity_nonlocal_length", "and plasticity_softening_length correct for the same thing: give one of them");
  if (p->eta_s == 0.0 || (p->c_res == p->c_max && p->phi_res == p->phi_peak && p->psi_max == 0.0))
    FAIL("plasticity_nonlocal_length",
         "needs strength that falls with plastic strain: eta_s is %g, cohesion, friction "
         "and dilation fall by %g Pa, %g deg, %g deg",
         p->eta_s, p->c_max - p->c_res, p->phi_peak - p->phi_res, p->psi_max);
}

void CheckPlasticity(Reader *r, const Case *c, const Material *m)
{
  const Plasticity *p = &m->plasticity;

  if (p->type != PLASTICITY_MOHR_COULOMB || !c->scene.fields.solid)
    return;
  if (p->gradient > 0.0 && SceneVertical(&c->scene) < 0)
    FAIL("plasticity_cohesion_gradient", "needs gravity, which says along which axis the depth is");
  if (p->c_max == 0.0 && p->phi_peak == 0.0 && p->gradient == 0.0)
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
  if (p->heat > 0.0 && !c->scene.fields.heat)
    FAIL("plasticity_heat", "is %g but heat is not among the fields of the scene (%s)", p->heat, c->fields_wanted);
  if (p->nonlocal > 0.0)
    CheckNonlocal(r, &c->scene, m);
  if (p->length > 0.0 && (c->scene.line[0].x || c->scene.line[1].x))
    FAIL("plasticity_softening_length",
         "needs equal cells: it adapts softening to one size of them; take plasticity_nonlocal_length on a grid with a "
         "spacing");
  if (isfinite(m->elasticity.E0) && p->c_res <= p->c_min)
    CheckSnapBack(r, &c->scene, m);
  if (p->psi_max > p->phi_peak)
    WARN_AT(FINDING_DILATION_ABOVE_FRICTION, GROUP_MATERIAL, m->name, "plasticity_dilation_max",
            "material %s dilates more than it rubs (dilation_max %g deg > friction_peak %g deg)", m->name, p->psi_max,
            p->phi_peak);
}

/* With a factor of their own stages soften by other amounts. */
static void CheckStages(Reader *r, const Case *c)
{
  for (PetscInt i = 0; i < c->nstage && !r->bad[GROUP_STAGE]; i++) {
    const Case *s = CaseInStage(c, i);

    for (PetscInt k = 0; k < s->scene.nmaterial && s->scene.strength_factor != c->scene.strength_factor; k++) {
      if (s->scene.material[k].plasticity.type != PLASTICITY_NONE && isfinite(s->scene.material[k].elasticity.E0))
        CheckSnapBack(r, &s->scene, &s->scene.material[k]);
    }
  }
}

void CheckReduction(Reader *r, const Case *c)
{
  bool reduced = c->scene.strength_factor != 1.0, strong = false;

  for (PetscInt i = 0; i < c->nstage; i++)
    reduced = reduced || CaseInStage(c, i)->scene.strength_factor != 1.0;
  for (PetscInt k = 0; k < c->scene.nmaterial; k++)
    strong = strong || (c->scene.material[k].plasticity.type != PLASTICITY_NONE && c->scene.fields.solid);
  if (!reduced)
    return;
  if (!strong)
    FAIL_AT(GROUP_CASE, "", "strength_factor", "needs a material with a plasticity_law: nothing here has a strength");
  CheckStages(r, c);
  for (PetscInt k = 0; k < c->scene.nmaterial; k++) {
    const Plasticity *p = &c->scene.material[k].plasticity;

    if (p->type != PLASTICITY_NONE && p->psi_max == 0.0 && p->phi_peak > 0.0)
      WARN_AT(FINDING_STRENGTH_BY_GRID, GROUP_CASE, "", "strength_factor",
              "strength_factor with a dilation of 0 deg (material %s): the factor at which a body fails then depends "
              "on the grid, even without softening; compare grids",
              c->scene.material[k].name);
  }
}
