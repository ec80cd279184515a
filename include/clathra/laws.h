/* laws: the constitutive relations, one pure function each, value and analytic derivatives side by side.
   No law sees PETSc, MPI, a particle or the grid.  SI units; temperature in degC unless a name says K; pore pressure
   compression-positive.  Equation numbers refer to docs/equations.md.  Every derivative pointer must be given. */
#pragma once

#include <stdbool.h>
#include "clathra/fields.h"

/* ---------------------------------------------------------------- retention: gas share of the fluid-filled pore space
   s_g = S_g/(1 - S_h) as a function of capillary pressure p_c = p_g - p_w (Pa) and hydrate; s_w = 1 - s_g. */
typedef struct Retention Retention;
struct Retention {
  double p0;       /* air-entry (reference) pressure, Pa, > 0 */
  double m;        /* van Genuchten m, (0,1) */
  double lambda;   /* Brooks-Corey pore-size index, > 0 */
  double Swr;      /* residual water saturation, [0,1) */
  double Sgr;      /* residual gas saturation, [0,1) */
  double p_smooth; /* smoothing width p_s, Pa; smooth form only; default 0.05 p0 */
  double p_trap;   /* pressure scale p_t of trapped gas, Pa; smooth form only; default p0 */
  double hydrate;  /* exponent of 1 - S_h by which hydrate raises p_c (320), >= 0; 0: it does not */
  double (*gas_share)(const Retention *, double pc, double *ds_dpc);
  void (*gas_share_loop)(const Retention *, int n, const double *pc, double *s, double *ds_dpc); /* the same of n */
  const char *type;
};
/* Sets the law by name (van_genuchten | van_genuchten_clamped | brooks_corey); false for an unknown name. */
bool               RetentionSetType(Retention *law, const char *type);
const char *const *RetentionTypes(void); /* NULL-terminated */
/* (320): (1 - S_h)^n, what p_c of a pore without hydrate is of that with hydrate, at the same s_g; dimensionless. */
double RetentionNarrowing(const Retention *law, double Sh);
/* Slope of s_g in S_h, of that in p_c (1/Pa), (320). */
double RetentionHydrateSlope(const Retention *law, double pc, double Sh, double ds_dpc);
/* Pressure scale of trapped gas, Pa: p_trap, or p_0 where that is zero or unset. */
static inline double RetentionTrapScale(const Retention *law)
{
  return law->p_trap > 0.0 ? law->p_trap : law->p0;
}
/* s_g at p_c (Pa) in pores that hydrate fills to S_h, with its slopes, 1/Pa and -. */
static inline double RetentionGasShare(const Retention *law, double pc, double Sh, double *ds_dpc, double *ds_dSh)
{
  const double r = RetentionNarrowing(law, Sh), s = law->gas_share(law, r * pc, ds_dpc);

  *ds_dpc *= r;
  *ds_dSh = RetentionHydrateSlope(law, pc, Sh, *ds_dpc);
  return s;
}
/* Capillary pressure, Pa, at which the gas share is s_g, by bracketing; false if the law never reaches s_g. */
bool RetentionInvert(const Retention *law, double sg, double Sh, double *pc);
/* Capillary pressure, Pa, at and below which a pore holds no gas (103); false if the law leaves some at any (a clamped
   law with S_gr > 0). */
bool RetentionNoGas(const Retention *law, double Sh, double *pc);

/* ---------------------------------------------------------------- relative permeability (modified Corey)
   base = (s - Sr_own)/(1 - Swr - Sgr) clipped to [0,1] with a C1 toe at 0; k_r = base^n.
   s is the share of the fluid-filled pore space, or with of_pores the saturation S = (1 - S_h) s of the whole. */
typedef struct {
  double Swr, Sgr; /* residual saturations of k_r, may differ from those of retention */
  double nw, ng;   /* Corey exponents, > 0 */
  bool   of_pores;
} RelPerm;
/* k_rw of the share s_w of the open pores (or of all, of_pores), in [0, 1], with its slope; dimensionless. */
double RelPermWater(const RelPerm *law, double sw, double *dkr_dsw);
/* k_rg of the share s_g likewise; dimensionless. */
double RelPermGas(const RelPerm *law, double sg, double *dkr_dsg);

/* ---------------------------------------------------------------- intrinsic permeability k_a = k0 f_phi f_Sh, m^2 */
typedef struct Permeability Permeability;
struct Permeability {
  double k0;      /* at porosity phi0 without hydrate, m^2 */
  double phi0;    /* reference porosity */
  double mh;      /* exponent of (1-S_h)^mh; type power */
  double kh, Shc; /* plateau and threshold of Masuda's ramp; type masuda_ramp */
  double ratio;   /* of what flows across the beds to what flows along them (306), (0,1] */
  double dip;     /* of the beds at the start, from x towards y, deg */
  double (*hydrate_factor)(const Permeability *, double Sh, double *df_dSh);
  double (*porosity_factor)(const Permeability *, double phi, double *df_dphi);
  /* the same of n, which multiply k */
  void (*hydrate_loop)(const Permeability *, int n, const double *Sh, double *k);
  void (*porosity_loop)(const Permeability *, int n, const double *phi, double *k);
  const char *hydrate_type, *porosity_type;
};
bool PermeabilitySetHydrateType(Permeability *law, const char *type);  /* power | masuda_ramp | none */
bool PermeabilitySetPorosityType(Permeability *law, const char *type); /* kozeny_carman | square_jacobian | none */
/* Words of the laws in S_h, NULL-terminated. */
const char *const *PermeabilityHydrateTypes(void);
/* Words of the laws in phi, NULL-terminated. */
const char *const *PermeabilityPorosityTypes(void);
/* kozeny_carman: (phi/phi0)^1.5 ((1-phi0)/(1-phi))^3.  square_jacobian: J^2 with J = (1-phi0)/(1-phi), for the exact
   large-strain consolidation solution of Xie and Leo (2004). */
double PermeabilityEvaluate(const Permeability *law, double phi, double Sh, double *dk_dphi, double *dk_dSh);

/* ---------------------------------------------------------------- phase equilibrium p_e(T) */
typedef struct Equilibrium Equilibrium;
struct Equilibrium {
  double A1, A2, A3; /* Sloan form p_e = A1 exp(A2 - A3/T_K); A1 Pa, A2 -, A3 K */
  double (*pressure)(const Equilibrium *, double T_degC, double *dpe_dT);
  void (*pressure_loop)(const Equilibrium *, int n, const double *T_degC, double *pe, double *dpe_dT);
  const char *type;
  double      shift; /* K by which salt lowers the temperature of equilibrium */
};
/* sloan | moridis (a polynomial ln p_e[MPa] in T_K, Moridis 2003) | kamath (over water and ice) | masuda */
bool EquilibriumSetType(Equilibrium *law, const char *type);
/* Words of the laws, NULL-terminated. */
const char *const *EquilibriumTypes(void);
/* p_e at T (degC), Pa, with its slope, Pa/K. */
static inline double EquilibriumPressure(const Equilibrium *law, double T, double *dpe_dT)
{
  return law->pressure(law, T, dpe_dT);
}
#define CL_CURVES 0.01 /* K, from one slope to the next */
/* p_e''/p_e', 1/K, from p_e' at T (Pa/K) and at T + CL_CURVES. */
static inline double EquilibriumCurvatureOf(double slope, double beyond)
{
  return (beyond / slope - 1.0) / CL_CURVES;
}
/* The same at T (degC). */
double EquilibriumCurvature(const Equilibrium *law, double T);
/* The temperature (degC, -50 to 60) at which hydrate is in equilibrium with p (Pa), to 1e-6 K. */
double EquilibriumTemperature(const Equilibrium *law, double p);

/* ---------------------------------------------------------------- Kim-Bishnoi kinetics
   R = K_d(T) A_s (p_e - p), mol/(m^3 s), positive for dissociation (P33)-(P37). */
typedef struct {
  double      K0;            /* mol/(m^2 Pa s) */
  double      dE;            /* activation energy J/mol; 0 = constant K_d */
  double      A_geo;         /* hydrate surface per volume, 1/m */
  double      M_h, M_w, M_g; /* molar masses, kg/mol, M_h = M_g + N_h M_w */
  double      N_h;           /* hydration number */
  Equilibrium equilibrium;
} Kinetics;
/* Water and methane that a kg of hydrate leaves, kg. */
static inline double KineticsWater(const Kinetics *law)
{
  return law->N_h * law->M_w / law->M_h;
}
/* ... methane, kg. */
static inline double KineticsMethane(const Kinetics *law)
{
  return law->M_g / law->M_h;
}
/* ... of a fluid, PHASE_..., kg. */
static inline double KineticsFluid(const Kinetics *law, int phase)
{
  return phase == PHASE_W ? KineticsWater(law) : KineticsMethane(law);
}
/* K_d = K0 exp(-dE/(R T_K)), mol/(m^2 Pa s), at T (degC), and its slope per K. */
double KineticsRateConstant(const Kinetics *law, double T, double *dKd_dT);
/* A surface, 1/m, with its slopes. */
typedef struct {
  double v, sw, wet, Sh;
} FormationArea;
/* Surface on which hydrate melts, A_geo phi S_h, 1/m (12). */
static inline double KineticsMeltingArea(const Kinetics *law, double phi, double Sh)
{
  return law->A_geo * phi * Sh;
}
/* Surface on which hydrate forms, A_geo s_w (s_g + W) (1-S_h)^3 (S_w S_g (1-S_h) where W = 0), 1/m; W
   (dimensionless): of the hydrate that is there, in water that holds methane (418). */
FormationArea KineticsFormationArea(const Kinetics *law, double sw, double wet, double Sh);

/* ---------------------------------------------------------------- equations of state, kg/m^3 */
typedef struct {
  double rho0; /* at p_ref, T_ref */
  double K;    /* bulk modulus, Pa; INFINITY = incompressible */
  double beta; /* volumetric thermal expansion, 1/K */
  double p_ref, T_ref;
} Liquid; /* rho = rho0 exp((p - p_ref)/K - beta (T - T_ref)); also solid and hydrate, with K infinite */
/* rho at p (Pa) and T (degC), kg/m^3, with slopes, kg/(m^3 Pa) and kg/(m^3 K). */
double LiquidDensity(const Liquid *law, double p, double T, double *drho_dp, double *drho_dT);
#define GAS_SOLUBILITY 1.9e-5 /* methane's in water at 10 degC, mol/(m^3 Pa): Sander 2015 */
typedef struct Gas Gas;
struct Gas {
  double M;         /* kg/mol */
  double Tc, pc;    /* critical temperature, K, and pressure, Pa; peng_robinson */
  double eccentric; /* acentric factor; peng_robinson */
  double trace;     /* H of (101), kg/(m^3 Pa); 0 where every region starts with gas and none dissolves */
  double henry;     /* solubility, mol/(m^3 Pa); 0: none is given */
  double carried;   /* H of what goes with the water (352), kg/(m^3 Pa): with a solubility that of (101), else 0 */
  /* of n states p (Pa), T (degC): rho, d rho/dp, d rho/dT; nothing may overlap.  NULL: ideal */
  void (*density)(const Gas *, int n, const double *p, const double *T, double *rho, double *drho_dp, double *drho_dT);
  /* beta at the density rho (kg/m^3), T_K, with its slopes in both */
  double (*expansion)(const Gas *, double rho, double TK, double *db_drho, double *db_dT);
  const char *type;
};
bool GasSetType(Gas *law, const char *type); /* peng_robinson | ideal (M p/(R T_K)) */
/* Words of the laws, NULL-terminated. */
const char *const *GasTypes(void);
/* rho at p (Pa) and T (degC), kg/m^3, with slopes, kg/(m^3 Pa) and kg/(m^3 K). */
double GasDensity(const Gas *law, double p, double T, double *drho_dp, double *drho_dT);
/* Volumetric thermal expansion -(1/rho) drho/dT at constant pressure, 1/K, with slopes in p and T (291). */
double GasExpansion(const Gas *law, double p, double T, double *dbeta_dp, double *dbeta_dT);
/* The same, 1/K, where the density rho (kg/m^3) at T (degC) is known; without slopes. */
double GasExpansionAt(const Gas *law, double rho, double T);

/* H (102), kg/(m^3 Pa): of the methane that gives p_g a meaning where there is no gas. */
double GasTrace(const Gas *law);

/* ---------------------------------------------------------------- salt water; salinity in kg of salt per kg of brine
 */
double BrineExcessDensity(double salinity, double T); /* over that of fresh water, kg/m^3 */
double BrineEquilibriumShift(double salinity);        /* K */
double BrineMelting(double salinity, double p);       /* degC: melting point of ice in it at p (Pa) */

/* ---------------------------------------------------------------- viscosity, Pa s */
enum { WATER_VISCOSITY_CONSTANT = 0, WATER_VISCOSITY_KESTIN };
enum { GAS_VISCOSITY_CONSTANT = 0, GAS_VISCOSITY_LEE };
typedef struct {
  int    law;
  double mu;       /* of the constant */
  double salinity; /* of water */
  double M;        /* of gas, kg/mol */
} Viscosity;
/* mu at T (degC), Pa s, with its slope, Pa s/K. */
double WaterViscosity(const Viscosity *law, double T, double *dmu_dT);
/* mu at rho (kg/m^3) and T (degC), Pa s, with slopes in both. */
double GasViscosity(const Viscosity *law, double rho, double T, double *dmu_drho, double *dmu_dT);

/* ---------------------------------------------------------------- heat */
/* Heat of dissociation per kg of hydrate, J/kg: C0 - C1 T_K, or that at T_ref and from there on with the heat
   capacities (Kirchhoff). */
typedef struct {
  double C0, C1;
  bool   kirchhoff;
  double T_ref; /* degC */
  double dc;    /* heat capacity of what a kg of hydrate leaves, less its own, J/(kg K) */
} LatentHeat;
/* L at T (degC), J/kg, with its slope, J/(kg K). */
double LatentHeatEvaluate(const LatentHeat *law, double T, double *dL_dT);
/* (442): of it, J/kg, what no enthalpy of the state stores, L(T) - L(0) - dc T: zero with Kirchhoff's law. */
static inline double LatentHeatBeyond(const LatentHeat *law, double T)
{
  return law->kirchhoff ? 0.0 : -(law->C1 + law->dc) * T;
}
/* (293): conductivity K (as cl_symmetric; W/(m K)) beside kappa that carries heat with the flow: a is the heat capacity
   that flows (W/(m^2 K)), h the size of a cell (m); false: a cell conducts more than it carries, and K is zero. */
bool HeatUpwind(double kappa, const double a[CL_DIM], const double h[CL_DIM], double K[CL_SYMMETRIC]);
/* Mixture property X = (1-phi) Xs + phi (Sh Xh + Sw Xw + Sg Xg), with S_w = (1-S_h) s_w; used for the conductivity
   (X = kappa, W/(m K)) and, with X = rho c, for the heat capacity (J/(m^3 K)); derivatives with respect to phi, S_h and
   s_w. */
double MixtureAverage(double phi, double Sh, double sw, const double X[4], double *d_dphi, double *d_dSh,
                      double *d_dsw);

/* ---------------------------------------------------------------- elasticity: E(S_h) = E0 + a_h E_h S_h^b_h, Pa */
/* What a change of hydrate makes of the stress: it follows E(S_h) both ways (the paper), follows its loss only, or
   hydrate bears a stress of its own, which goes with it. */
enum { STIFFNESS_BOTH = 0, STIFFNESS_LOSS_ONLY, STIFFNESS_BONDS };
typedef struct {
  double E0, Eh, ah, bh, nu;
  int    change; /* STIFFNESS_... */
} Elasticity;
double ElasticityYoung(const Elasticity *law, double Sh, double *dE_dSh); /* Pa; C1 toe where b_h < 1 at S_h = 0 */
/* Does hydrate bear a stress of its own that goes with it? */
static inline bool ElasticityHasBonds(const Elasticity *law)
{
  return law->change == STIFFNESS_BONDS && law->ah * law->Eh > 0.0;
}
/* G/E, dimensionless. */
static inline double ElasticityShearFactor(const Elasticity *law)
{
  return 0.5 / (1.0 + law->nu);
}
/* lambda/E, dimensionless. */
static inline double ElasticityLameFactor(const Elasticity *law)
{
  return law->nu / ((1.0 + law->nu) * (1.0 - 2.0 * law->nu));
}

/* Constrained modulus over E, dimensionless. */
static inline double ElasticityConstrainedFactor(const Elasticity *law)
{
  return 2.0 * ElasticityShearFactor(law) + ElasticityLameFactor(law);
}

/* ---------------------------------------------------------------- strength: Mohr-Coulomb with hydrate and softening
   Principal effective stresses y[0] >= y[1] >= y[2], tension-positive, Pa; angles in rad but for those that a case
   gives. */
enum { PLASTICITY_NONE = 0, PLASTICITY_MOHR_COULOMB };
enum { FLOW_MENETREY_WILLAM = 0, FLOW_MOHR_COULOMB };
typedef struct {
  int    type, flow;          /* PLASTICITY_..., FLOW_... */
  double c_max, c_min, c_res; /* cohesion: peak at Sh_max, its lower limit without hydrate, residual; Pa */
  double gradient, level;     /* c_max grows by this below a level, Pa/m and m along `axis`; the others in proportion */
  int    axis, up;            /* ... whose coordinate grows (1) or falls (-1) upwards */
  double phi_peak, phi_res;   /* friction, deg, [0, 90) */
  double psi_max, psi_min;    /* dilation at Sh_max and its lower limit, deg; softens to zero */
  double eta_h, Sh_max;       /* how strength falls with hydrate */
  double eta_s;               /* ... and with plastic strain */
  double length, cell;        /* softening_length (0: none) and size of a cell, m: eta_s is scaled by cell/length */
  double nonlocal;            /* nonlocal_length, m (0: none): neighbours whose plastic strain softens a particle */
  double eccentricity;        /* of the smooth potential in the meridian plane, of c_max */
  double cutoff;              /* largest tension, Pa; INFINITY: none */
  double heat;                /* share of the plastic work that becomes heat, [0,1] */
  double factor;              /* of the strength reduction (87), > 0; 0 stands for 1 */
} Plasticity;

/* Strength at a hydrate saturation and a deviatoric plastic strain, with slopes in both. */
typedef struct {
  double c, phi, psi, c_e, phi_e, psi_e, c_S, psi_S;
} Strength;
/* eta_s as a cell of this size sees it, dimensionless: dissipation per area of a band does not depend on the cell. */
static inline double SofteningRate(const Plasticity *law)
{
  return law->length > 0.0 ? law->eta_s * law->cell / law->length : law->eta_s;
}
/* (87): what the factor leaves of a strength in Pa. */
static inline double StrengthReduced(const Plasticity *law, double strength)
{
  return law->factor > 0.0 ? strength / law->factor : strength;
}
/* The tension cut-off that the factor leaves, Pa. */
static inline double StrengthCutoff(const Plasticity *law)
{
  return StrengthReduced(law, law->cutoff);
}
/* eccentricity c_max of the smooth potential (64), Pa. */
static inline double FlowRoundness(const Plasticity *law)
{
  return law->eccentricity * StrengthReduced(law, law->c_max);
}
/* (455): how far below the level a particle was at the start, m. */
static inline double StrengthDepth(const Plasticity *law, const double place[CL_DIM])
{
  const double depth = law->gradient > 0.0 ? law->up * (law->level - place[law->axis]) : 0.0;

  return depth > 0.0 ? depth : 0.0;
}
/* (455): what a cohesion c of the law, Pa, is at this depth. */
static inline double StrengthBelow(const Plasticity *law, double c, double depth)
{
  return c + (law->c_max > 0.0 ? c / law->c_max : 1.0) * law->gradient * depth;
}
/* The law at a depth (m); of its kind it has the same strength at every depth. */
static inline Plasticity StrengthAtDepth(const Plasticity *law, double depth)
{
  Plasticity at = *law;

  at.c_max    = StrengthBelow(law, law->c_max, depth);
  at.c_min    = StrengthBelow(law, law->c_min, depth);
  at.c_res    = StrengthBelow(law, law->c_res, depth);
  at.gradient = 0.0;
  return at;
}
/* Cohesion (Pa), friction and dilation angle (rad) at S_h and the deviatoric plastic strain eps, with slopes in both.
 */
void StrengthEvaluate(const Plasticity *law, double Sh, double eps, Strength *s);

/* F_eps/F_eps,allowed of a plastic state on the yield surface at mean stress sm, the largest over Lode angles, with
   Young's modulus E and Poisson's ratio nu: at 1 or above the strength falls faster with plastic strain than the
   elastic stress can follow (71), and the point snaps back. */
double SofteningRatio(const Plasticity *law, double E, double nu, double Sh, double eps, double sm);

/* F, Pa; slopes in y, phi (slope in c: -1). */
double MohrCoulombYield(double phi, double c, const double y[3], double dy[3], double *dphi);

/* Gradient P_y of the smooth potential of Menetrey and Willam with its slopes. */
typedef struct {
  double y[3], dev[3];   /* P_y; its deviator */
  double yy[3][3];       /* deviatoric as well */
  double phi[3], psi[3]; /* slopes of P_y; that in phi is deviatoric */
} FlowGradient;
/* P_y at principal stresses y (Pa) with friction phi and dilation psi (rad); apex: the rounding of the tip, Pa
 * (FlowRoundness). */
void MenetreyWillamGradient(double phi, double psi, double apex, const double y[3], FlowGradient *P);
