/* point: one particle.  History and increments in; state, fluxes and consistent tangent out.
   Knows the laws, nothing of nodes, ranks or solvers.  Symbols and numbers of docs/equations.md. */
#pragma once

#include "clathra/ambient.h"
#include "clathra/base.h"
#include "clathra/fields.h"
#include "clathra/kinematics.h"
#include "clathra/point_flow.h"
#include "clathra/skeleton.h"

/* Of phi S_pi at a node (107): a fluid that is not there moves with the skeleton. */
#define CL_SHARE_FLOOR 1e-6

/* What the interpolation gives a particle; the tangent is taken with respect to these numbers in this order. */
enum {
  IN_GRADU = 0,                        /* [i][j], on the configuration at t_n */
  IN_HOOP  = IN_GRADU + MOTION_HOOP,   /* u_r/r; zero in the plane */
  IN_P     = IN_GRADU + MOTION_COUNT,  /* p_w, p_g, Pa */
  IN_T     = IN_P + PHASE_COUNT,       /* degC */
  IN_GP    = IN_T + 1,                 /* [pi][i] gradients of p_w, p_g, Pa/m */
  IN_GT    = IN_GP + CL_FLUID_VECTORS, /* [i] gradient of T, K/m */
  IN_J     = IN_GT + CL_DIM,           /* [pi][i] Darcy fluxes of water, gas, m/s; with beds A^-1 of them (448) */
  IN_U     = IN_J + CL_FLUID_VECTORS,  /* [i] displacement of the step, m */
  IN_COUNT = IN_U + CL_DIM
};

/* What a particle writes to its nodes. */
enum {
  /* tested with G_I */
  OUT_P    = 0,                           /* [i][j] V_n (sigma' - (p - p_a) 1) cof F, N m/m */
  OUT_FLUX = OUT_P + CL_DIM * CL_DIM,     /* [pi][j] mass flux Phi, kg m/s (18) */
  OUT_HEAT = OUT_FLUX + CL_FLUID_VECTORS, /* [j] conducted heat, W m */
  /* tested with H_I, in the radial row */
  OUT_HOOP = OUT_HEAT + CL_DIM, /* V_n (sigma'_tt - (p - p_a)) det F_2, N m */
  /* tested with S_I */
  OUT_G    = OUT_HOOP + 1,             /* [pi][i] V_n cof F g_pi, N: force of a fluid's pressure gradient */
  OUT_M    = OUT_G + CL_FLUID_VECTORS, /* m_s + m_h, m_w, m_g, kg */
  OUT_MI   = OUT_M + 1 + PHASE_COUNT,  /* [pi] V rho_pi, kg */
  OUT_D    = OUT_MI + PHASE_COUNT,     /* [pi] V mu/k_a, Pa s m: drag per Darcy flux where k_r = 1 */
  OUT_ROOT = OUT_D + PHASE_COUNT,      /* [pi] sqrt(k_r) (108) */
  OUT_DM   = OUT_ROOT + PHASE_COUNT,   /* [pi] mass gained minus released by hydrate, kg */
  OUT_C    = OUT_DM + PHASE_COUNT,     /* heat capacity, J/K */
  OUT_Q, /* advected minus released heat, less what compression and throttling of the fluids give, W */
  OUT_A, /* [i] V grad p_a, N; where there is an ambient pressure */
  OUT_COUNT = OUT_A + CL_DIM
};

/* History of the particle at the start of the stage (t_n; starred masses of equations.md (24)). */
typedef struct {
  double          V, m_s;
  double          m_star[3]; /* m_h*, m_w*, m_g*, kg */
  double          T_n, Sh_n; /* at t_n */
  SkeletonHistory skeleton;
  double          spread[PHASE_COUNT];  /* (200), (456) at t_n, m^2/(Pa s) */
  double          upwind[CL_SYMMETRIC]; /* (293), W/(m K) */
  double proj[PHASE_COUNT][CL_DIM];     /* projected pressure gradients (Pi g)_p, Pa/m: frozen part of the tangent */
  double shift[3]; /* nodal less own value of p_w, p_g (Pa), T (K) at t_n: the reaction sees the nodal fields (11) */
  double
      withheld; /* (1 - a)/a (416): both pressures lack so much of what p_g has changed by since p_g,n; then also ... */
  double         pg_n;                /* ... the particle's p_g at t_n, Pa */
  double         held;                /* (381), at t_n; 0: the reaction is as fast as its law */
  double         chord;               /* (424), at t_n, Pa */
  double         mobility;            /* k_r of gas in the bracket of (19), at t_n (334); 0: the particle's own */
  bool           compression;         /* heat of compression and throttling (290); then also ... */
  double         p_star[PHASE_COUNT]; /* ... starred p_w, p_g, Pa */
  double         gravity[CL_DIM];     /* ... m/s^2 */
  double         dt;                  /* dt' of the stage */
  const Beds    *beds;                /* at t_n; NULL: none; then also ... */
  double         weight[PHASE_COUNT][CL_DIM]; /* ... rho b of the fluids at t_n, N/m^3 */
  const Ambient *ambient;                     /* at the end of the stage; NULL: no pressure around the body */
  double         x[CL_DIM]; /* where the particle's values belong at t_n, m; for the ambient pressure */
} PointHistory;

/* What PointEvaluate is given. */
typedef struct {
  const FieldSet     *fs;
  const Material     *mat;
  const PointHistory *h;
  const double       *in; /* [IN_COUNT] */
} PointInput;

/* State at the end of the stage. */
typedef struct {
  double        V, phi, Sh, Sw, Sg, m_h, m_w, m_g, p;
  SkeletonState skeleton;
  SkeletonStage end; /* ... as the body lay at t_n */
  double        stretch[CL_DIM];
  double        F[CL_DIM][CL_DIM]; /* of the step, in the plane */
  double        rho[PHASE_COUNT], tau[PHASE_COUNT];
  bool          limited;  /* hydrate positivity limiter acted */
  double        squeezed; /* heat of compression and throttling (290), W */
  double        gain;     /* hydrate, by the reaction, kg */
} PointState;

typedef struct {
  double out[OUT_COUNT];
  double D[OUT_COUNT][IN_COUNT]; /* d out / d in */
  double dJ[MOTION_COUNT];       /* d det F / d in[IN_GRADU], ...: motion changes scalars through it alone */
  double wide[PHASE_COUNT][PHASE_COUNT][CL_DIM][CL_DIM]; /* d flux[pi][i] / d proj[of][j] (27), (352) */
  double wide_q[PHASE_COUNT][CL_DIM];                    /* d q / d proj[of][j] */
} PointOutput;

/* Evaluates (8)-(21) at a particle for the fields of the set, in SI units with T in degC; inputs of other fields are
   not read (but p_g = p_w and T as given where gas and heat have no field), outputs and columns of other fields are not
   written.  tangent = false leaves D, dJ and wide untouched.  Returns CL_OK, or CL_DOMAIN / CL_NONFINITE with *why
   pointing to a sentence. */
ClStatus PointEvaluate(const PointInput *x, bool tangent, PointState *state, PointOutput *o, const char **why);

/* A new particle: m^3, shares, Pa, degC. */
typedef struct {
  double V, phi, Sh, sg, pw, pg, T;
} PointStart;
/* Its masses m_s, m_h, m_w, m_g, kg. */
void PointInitialMasses(const FieldSet *fs, const Material *mat, const PointStart *x, double m[4]);

/* Methane of a unit of open pore space beside hydrate of S_h, kg/m^3 (101), with its slopes in p_w and p_g. */
double PointMethane(const Material *mat, double Sh, double pw, double pg, double T, double slope[PHASE_COUNT]);
/* p_g between a and b (Pa) at which it is `want` (kg/m^3), to 1e-4 of p_0; b where there is none between them. */
double PointGasPressure(const Material *mat, double want, double Sh, double pw, double T, double a, double b);

/* Properties at t_n that projections, scales and stabilisation need. */
typedef struct {
  double rho[PHASE_COUNT];                     /* kg/m^3 */
  double resist[PHASE_COUNT], kr[PHASE_COUNT]; /* mu/k_a, Pa s/m^2; relative permeability */
  double mobility_slope[PHASE_COUNT];          /* d(k_a k_r/mu)/dp_c, m^2/(Pa^2 s) */
  double s[PHASE_COUNT], phi, Sh;              /* s_w, s_g, porosity, hydrate saturation */
  double capacity, kappa;                      /* V C_m (J/K), W/(m K) */
  double M, G;                                 /* constrained and shear modulus, Pa */
  double storage[PHASE_COUNT];                 /* d(phi S_pi rho_pi)/dp_pi / rho_pi, 1/Pa */
  double cross[PHASE_COUNT];                   /* ... /dp of the other fluid / rho_pi, 1/Pa */
  double compressibility;                      /* sum over pi of that in a pressure that both have, 1/Pa */
  double reaction, reaction_heat;              /* hydrate that the reaction makes or takes, kg/(m^3 s Pa), W/(m^3 Pa) */
} PointProperties;
/* What a particle holds: m^3, kg, Pa, degC. */
typedef struct {
  double V, m_s, m_h, pw, pg, T;
} PointContents;
/* Returns why the state is inadmissible, with a sentence in *why; r is not to be used then. */
ClStatus PointPropertiesEvaluate(const FieldSet *fs, const Material *mat, const PointContents *x, PointProperties *r,
                                 const char **why);
