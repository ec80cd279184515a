/* Intrinsic permeability k_a = k_0 f_phi(phi) f_Sh(S_h), (P38)-(P41). */
#include "clathra/laws_batch.h"
#include "laws_private.h"

/* A factor that is switched off: 1 for any porosity or hydrate saturation. */
INLINE double Hydrate_None(const Permeability *law, double Sh, double *df_dSh)
{
  (void)law;
  (void)Sh;
  *df_dSh = 0.0;
  return 1.0;
}

INLINE double Porosity_None(const Permeability *law, double phi, double *df_dphi)
{
  return Hydrate_None(law, phi, df_dphi);
}

/* (229): f = (1 - S_h)^mh; C1 toe near S_h = 1 where mh < 2, so that the slope stays finite. */
INLINE double Hydrate_Power(const Permeability *law, double Sh, double *df_dSh)
{
  const double f = LawToePower(1.0 - Sh, law->mh, df_dSh);

  *df_dSh = -*df_dSh;
  return f;
}

/* (230), Masuda (1999): f = k_h + (1 - k_h)(S_hc - S_h)/S_hc below S_hc, k_h above; the printed (P40) divides by S_h
 * and diverges. */
INLINE double Hydrate_MasudaRamp(const Permeability *law, double Sh, double *df_dSh)
{
  *df_dSh = Sh < law->Shc ? -(1.0 - law->kh) / law->Shc : 0.0;
  return law->kh + (1.0 - law->kh) * LawAtLeast(law->Shc - Sh, 0.0) / law->Shc;
}

/* (227): f = (phi/phi_0)^1.5 J^3, J = (1 - phi_0)/(1 - phi); the second factor of the printed (P39) is inverted.
 */
INLINE double Porosity_KozenyCarman(const Permeability *law, double phi, double *df_dphi)
{
  const double r = phi / law->phi0, root = sqrt(r), J = (1.0 - law->phi0) / (1.0 - phi), J3 = J * J * J;

  *df_dphi = J3 * root * (1.5 / law->phi0 + 3.0 * r / (1.0 - phi));
  return r * root * J3;
}

/* (228): f = J^2 with J = (1 - phi_0)/(1 - phi) the volume ratio at constant solid volume (Xie and Leo 2004). */
INLINE double Porosity_SquareJacobian(const Permeability *law, double phi, double *df_dphi)
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

void PermeabilityBatch(const Permeability *law, int n, const double *phi, const double *Sh, double *k)
{
  for (int q = 0; q < n; q++)
    k[q] = law->k0;
  law->hydrate_loop(law, n, Sh, k);
  law->porosity_loop(law, n, phi, k);
}

/* The laws by name.  A row makes its function of one state and its loop over n, which multiplies k by the factor. */
#define POROSITY_LAWS(X)                                                                                               \
  X("kozeny_carman", Porosity_KozenyCarman)                                                                            \
  X("square_jacobian", Porosity_SquareJacobian)                                                                        \
  X("none", Porosity_None)
#define HYDRATE_LAWS(X)                                                                                                \
  X("power", Hydrate_Power)                                                                                            \
  X("masuda_ramp", Hydrate_MasudaRamp)                                                                                 \
  X("none", Hydrate_None)

#define NAME(name, Law) name,
#define FUNCTION(name, Law) Law,
#define LOOP(name, Law)                                                                                                \
  static void Law##_Loop(const Permeability *law, int n, const double *restrict x, double *restrict k)                 \
  {                                                                                                                    \
    const Permeability l = *law;                                                                                       \
    double             d;                                                                                              \
                                                                                                                       \
    for (int q = 0; q < n; q++)                                                                                        \
      k[q] *= Law(&l, x[q], &d);                                                                                       \
  }
#define LOOP_NAME(name, Law) Law##_Loop,

typedef double (*Factor)(const Permeability *, double, double *);
typedef void (*FactorLoop)(const Permeability *, int, const double *, double *);
static const char *const porosity_names[] = {POROSITY_LAWS(NAME) NULL}, *const hydrate_names[] = {HYDRATE_LAWS(NAME)
                                                                                                      NULL};
static const Factor porosity_laws[] = {POROSITY_LAWS(FUNCTION)}, hydrate_laws[] = {HYDRATE_LAWS(FUNCTION)};
POROSITY_LAWS(LOOP)
HYDRATE_LAWS(LOOP)
static const FactorLoop porosity_loops[] = {POROSITY_LAWS(LOOP_NAME)}, hydrate_loops[] = {HYDRATE_LAWS(LOOP_NAME)};

LAW_CHOICE(PermeabilityHydrateTypes, PermeabilitySetHydrateType, Permeability, hydrate_names,
           law->hydrate_factor = hydrate_laws[i], law->hydrate_loop = hydrate_loops[i],
           law->hydrate_type = hydrate_names[i])
LAW_CHOICE(PermeabilityPorosityTypes, PermeabilitySetPorosityType, Permeability, porosity_names,
           law->porosity_factor = porosity_laws[i], law->porosity_loop = porosity_loops[i],
           law->porosity_type = porosity_names[i])
