/* Intrinsic permeability k_a = k_0 f_phi(phi) f_Sh(S_h), (P38)-(P41). */
#include "clathra/laws.h"
#include "laws_private.h"

/* A factor that is switched off: 1 for any porosity or hydrate saturation. */
static double Factor_None(const Permeability *law, double x, double *df)
{
  (void)law;
  (void)x;
  *df = 0.0;
  return 1.0;
}

/* (229): f = (1 - S_h)^mh; C1 toe near S_h = 1 where mh < 2, so that the slope stays finite. */
static double Hydrate_Power(const Permeability *law, double Sh, double *df_dSh)
{
  const double f = LawToePower(1.0 - Sh, law->mh, df_dSh);

  *df_dSh = -*df_dSh;
  return f;
}

/* (230), Masuda (1999): f = k_h + (1 - k_h)(S_hc - S_h)/S_hc below S_hc, k_h above; the printed (P40) divides by S_h
 * and diverges. */
static double Hydrate_MasudaRamp(const Permeability *law, double Sh, double *df_dSh)
{
  *df_dSh = 0.0;
  if (Sh >= law->Shc)
    return law->kh;
  *df_dSh = -(1.0 - law->kh) / law->Shc;
  return law->kh + (1.0 - law->kh) * (law->Shc - Sh) / law->Shc;
}

/* (227): f = (phi/phi_0)^1.5 J^3, J = (1 - phi_0)/(1 - phi); the second factor of the printed (P39) is inverted.
 */
static double Porosity_KozenyCarman(const Permeability *law, double phi, double *df_dphi)
{
  const double r = phi / law->phi0, root = sqrt(r), J = (1.0 - law->phi0) / (1.0 - phi), J3 = J * J * J;

  *df_dphi = J3 * root * (1.5 / law->phi0 + 3.0 * r / (1.0 - phi));
  return r * root * J3;
}

/* (228): f = J^2 with J = (1 - phi_0)/(1 - phi) the volume ratio at constant solid volume (Xie and Leo 2004). */
static double Porosity_SquareJacobian(const Permeability *law, double phi, double *df_dphi)
{
  const double J = (1.0 - law->phi0) / (1.0 - phi);

  *df_dphi = 2.0 * J * J / (1.0 - phi);
  return J * J;
}

/* (226): k_a (m^2) at porosity phi and hydrate saturation S_h, and its derivatives. */
double PermeabilityEvaluate(const Permeability *law, double phi, double Sh, double *dk_dphi, double *dk_dSh)
{
  double       dphi, dSh;
  const double f_phi = law->porosity_factor(law, phi, &dphi), f_Sh = law->hydrate_factor(law, Sh, &dSh);

  *dk_dphi = law->k0 * dphi * f_Sh;
  *dk_dSh  = law->k0 * f_phi * dSh;
  return law->k0 * f_phi * f_Sh;
}

typedef double (*Factor)(const Permeability *, double, double *);
static const char *const hydrate_names[]  = {"power", "masuda_ramp", "none", NULL};
static const Factor      hydrate_laws[]   = {Hydrate_Power, Hydrate_MasudaRamp, Factor_None};
static const char *const porosity_names[] = {"kozeny_carman", "square_jacobian", "none", NULL};
static const Factor      porosity_laws[]  = {Porosity_KozenyCarman, Porosity_SquareJacobian, Factor_None};
_Static_assert(sizeof hydrate_names / sizeof *hydrate_names == sizeof hydrate_laws / sizeof *hydrate_laws + 1,
               "a name for every law");
_Static_assert(sizeof porosity_names / sizeof *porosity_names == sizeof porosity_laws / sizeof *porosity_laws + 1,
               "a name for every law");

const char *const *PermeabilityHydrateTypes(void)
{
  return hydrate_names;
}

const char *const *PermeabilityPorosityTypes(void)
{
  return porosity_names;
}

/* Sets f_Sh by name; false, and nothing set, for an unknown name. */
bool PermeabilitySetHydrateType(Permeability *law, const char *type)
{
  const int i = LawFind(hydrate_names, type);

  if (i < 0)
    return false;
  law->hydrate_factor = hydrate_laws[i];
  law->hydrate_type   = hydrate_names[i];
  return true;
}

/* Sets f_phi by name; false, and nothing set, for an unknown name. */
bool PermeabilitySetPorosityType(Permeability *law, const char *type)
{
  const int i = LawFind(porosity_names, type);

  if (i < 0)
    return false;
  law->porosity_factor = porosity_laws[i];
  law->porosity_type   = porosity_names[i];
  return true;
}
