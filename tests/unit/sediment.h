/* Shared by the unit tests of particles and of the model: one material.  Include after cmocka.h. */
#pragma once

#include <math.h>
#include "clathra/point.h"

/* Sediment of BP2 with a little of everything switched on. */
static inline Material SedimentMaterial(void)
{
  Material m = {.porosity     = 0.3,
                .solid        = {2600.0, INFINITY, 3e-5, 0.0, 4.0},
                .hydrate      = {900.0, INFINITY, 2e-4, 0.0, 4.0},
                .water        = {1000.0, 2.2e9, 2.1e-4, 3.25e6, 4.0},
                .mu_w         = {.mu = 1e-3, .salinity = 0.03},
                .mu_g         = {.mu = 7e-6, .M = 0.016},
                .c_s          = 800.0,
                .c_h          = 2010.0,
                .c_w          = 4200.0,
                .c_g          = 2100.0,
                .kappa_s      = 3.0,
                .kappa_h      = 0.5,
                .kappa_w      = 0.5,
                .kappa_g      = 0.044,
                .retention    = {.p0 = 5e4, .m = 0.3, .lambda = 1.5, .Swr = 0.2, .Sgr = 0.1},
                .relperm      = {0.2, 0.1, 4.0, 2.0, false},
                .permeability = {.k0 = 1.53e-15, .phi0 = 0.3, .mh = 3.0, .kh = 0.1, .Shc = 0.4, .ratio = 1.0},
                .kinetics   = {2.5e-10, 0.0, 1e6, 0.124, 0.018, 0.016, 6.0, {.A1 = 1000.0, .A2 = 38.98, .A3 = 8533.8}},
                .latent     = {.C0 = 473632.0, .C1 = 140.117},
                .elasticity = {90e6, 2e9, 1.0, 1.0, 0.3, false}};

  m.gas = (Gas){.M = 0.016, .Tc = 190.564, .pc = 4.5992e6, .eccentric = 0.01142};
  assert_true(GasSetType(&m.gas, "ideal"));
  assert_true(RetentionSetType(&m.retention, "van_genuchten"));
  assert_true(PermeabilitySetHydrateType(&m.permeability, "power"));
  assert_true(PermeabilitySetPorosityType(&m.permeability, "kozeny_carman"));
  assert_true(EquilibriumSetType(&m.kinetics.equilibrium, "sloan"));
  return m;
}

/* Methane dissolves in the water and goes with it (352): k in mol/(m^3 Pa). */
static inline void SetSolubility(Gas *gas, double k)
{
  gas->henry   = k;
  gas->carried = gas->trace = gas->M * k;
}

/* Weak against the stresses of the tests, so that nearly all states are plastic; heat: share of the work. */
static inline Plasticity WeakPlasticity(int flow, double heat)
{
  return (Plasticity){.type         = PLASTICITY_MOHR_COULOMB,
                      .flow         = flow,
                      .c_max        = 2e5,
                      .c_min        = 1e5,
                      .c_res        = 5e4,
                      .phi_peak     = 25.0,
                      .phi_res      = 20.0,
                      .psi_max      = 12.0,
                      .psi_min      = 8.0,
                      .eta_h        = 3.0,
                      .Sh_max       = 0.4,
                      .eta_s        = 1.0,
                      .eccentricity = 0.1,
                      .cutoff       = INFINITY,
                      .heat         = heat};
}

/* The full set of fields. */
static inline const FieldSet *AllFields(void)
{
  static FieldSet all;

  if (all.n == 0)
    FieldSetMake(HAS_ALL, true, &all);
  return &all;
}

static inline double GasShareOf(const Material *mat, double pc, double Sh)
{
  double d[2];

  return RetentionGasShare(&mat->retention, pc, Sh, &d[0], &d[1]);
}

/* Masses of a particle that its pressures ask for. */
static inline void InitialMasses(const Material *mat, double V, double phi, double Sh, double pw, double pg, double T,
                                 double *m_s, double *m_h, double *m_w, double *m_g)
{
  double m[4];

  PointInitialMasses(AllFields(), mat, &(PointStart){V, phi, Sh, GasShareOf(mat, pg - pw, Sh), pw, pg, T}, m);
  *m_s = m[0];
  *m_h = m[1];
  *m_w = m[2];
  *m_g = m[3];
}
