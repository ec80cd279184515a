/* Equations of state: intrinsic densities, kg/m^3, of pressure (Pa) and temperature (degC). */
#include "clathra/laws_batch.h"
#include "laws_private.h"

/* rho = rho_0 exp((p - p_ref)/K - beta (T - T_ref)), (221), (P10); K = INFINITY is incompressible.  Also solid,
 * hydrate.
 */
INLINE double Density(const Liquid *law, double p, double T, double *drho_dp, double *drho_dT)
{
  double       de;
  const double e = LawExp((p - law->p_ref) / law->K - law->beta * (T - law->T_ref), &de);

  *drho_dp = law->rho0 * de / law->K;
  *drho_dT = -law->rho0 * de * law->beta;
  return law->rho0 * e;
}

/* The same everywhere? */
INLINE bool Constant(const Liquid *law)
{
  return isinf(law->K) && law->beta == 0.0;
}

double LiquidDensity(const Liquid *law, double p, double T, double *drho_dp, double *drho_dT)
{
  if (Constant(law)) {
    *drho_dp = *drho_dT = 0.0;
    return law->rho0;
  }
  return Density(law, p, T, drho_dp, drho_dT);
}

void LiquidDensityBatch(const Liquid *law, int n, const double *restrict p, const double *restrict T,
                        double *restrict rho)
{
  const Liquid l = *law;
  double       dp, dT;

  if (Constant(&l)) {
    for (int q = 0; q < n; q++)
      rho[q] = l.rho0;
    return;
  }
  for (int q = 0; q < n; q++)
    rho[q] = Density(&l, p[q], T[q], &dp, &dT);
}

/* Ideal gas, (222), (P11): rho = M p/(R T_K). */
static void Gas_Ideal(const Gas *law, int n, const double *restrict p, const double *restrict T, double *restrict rho,
                      double *restrict rho_p, double *restrict rho_T)
{
  for (int q = 0; q < n; q++) {
    const double TK = T[q] + LAW_ZERO_CELSIUS;

    rho_p[q] = law->M / (LAW_GAS_CONSTANT * TK);
    rho[q]   = rho_p[q] * p[q];
    rho_T[q] = -rho[q] / TK;
  }
}

#define GAS_BLOCK 32
#define ROOT_NEAR 1e-9 /* Newton's step that ends the search: the next one would be of the order of its square */
#define ROOT_STEPS 200 /* only at a critical point, where three roots meet, are more than ten taken */

/* Largest Z of (120), by Newton's method from the side on which it is monotone: from 1 + B, where the cubic is A > 0
   and convex, or, where its right extremum (or inflection) lies above zero, from B, where it is -2 B^2 and concave. */
static void GasRoot(int n, const double *restrict A, const double *restrict B, double *restrict Z)
{
  int more = 1;

  for (int q = 0; q < n; q++) {
    const double e = 1.0 - B[q], c1 = A[q] - B[q] * (3.0 * B[q] + 2.0), c0 = B[q] * (A[q] - B[q] * (1.0 + B[q]));
    const double D = e * e - 3.0 * c1, at = (e + sqrt(D > 0.0 ? D : 0.0)) / 3.0;

    Z[q] = ((at - e) * at + c1) * at - c0 <= 0.0 ? 1.0 + B[q] : B[q];
  }
  for (int step = 0; step < ROOT_STEPS && more; step++) {
    more = 0;
    for (int q = 0; q < n; q++) {
      const double e = 1.0 - B[q], c1 = A[q] - B[q] * (3.0 * B[q] + 2.0), c0 = B[q] * (A[q] - B[q] * (1.0 + B[q]));
      const double z = Z[q], f = ((z - e) * z + c1) * z - c0, f_Z = (3.0 * z - 2.0 * e) * z + c1, d = f / f_Z;

      Z[q] = z - d;
      more |= fabs(d) > ROOT_NEAR * z;
    }
  }
}

/* Peng and Robinson (1976), (120), (121); slopes by the implicit function theorem.  Below p = 0 the gas is ideal, with
   value and slopes that meet. */
static void Gas_PengRobinson(const Gas *law, int n, const double *restrict p, const double *restrict T,
                             double *restrict rho, double *restrict rho_p, double *restrict rho_T)
{
  const double R = LAW_GAS_CONSTANT, RTc = R * law->Tc, b = 0.07779607 * RTc / law->pc,
               a     = 0.45723553 * RTc * RTc / law->pc,
               kappa = 0.37464 + law->eccentric * (1.54226 - 0.26992 * law->eccentric);
  double A[GAS_BLOCK], B[GAS_BLOCK], Z[GAS_BLOCK], A_p[GAS_BLOCK], A_T[GAS_BLOCK];

  for (int q = 0; q < n; q++) {
    const double TK = T[q] + LAW_ZERO_CELSIUS, RT = R * TK, root = sqrt(TK / law->Tc), s = 1.0 + kappa * (1.0 - root);
    const double s_T = -0.5 * kappa * root / TK, P = p[q] > 0.0 ? p[q] : 0.0;

    A_p[q] = a * s * s / (RT * RT);
    A_T[q] = 2.0 * a * s * P / (RT * RT) * (s_T - s / TK);
    A[q]   = A_p[q] * P;
    B[q]   = b * P / RT;
  }
  GasRoot(n, A, B, Z);
  for (int q = 0; q < n; q++) {
    const double TK = T[q] + LAW_ZERO_CELSIUS, P = p[q] > 0.0 ? p[q] : 0.0, z = Z[q], B_p = b / (R * TK);
    const double f_Z = (3.0 * z - 2.0 * (1.0 - B[q])) * z + A[q] - B[q] * (3.0 * B[q] + 2.0), f_A = z - B[q],
                 f_B = (z - 6.0 * B[q] - 2.0) * z - A[q] + B[q] * (2.0 + 3.0 * B[q]);
    const double Z_p = -(f_A * A_p[q] + f_B * B_p) / f_Z, Z_T = -(f_A * A_T[q] - f_B * B[q] / TK) / f_Z;
    const double c = law->M / (z * R * TK);

    rho[q]   = c * p[q];
    rho_p[q] = c * (1.0 - P * Z_p / z);
    rho_T[q] = -rho[q] * (1.0 / TK + Z_T / z);
  }
}

static double Expansion_Ideal(const Gas *law, double rho, double TK, double *db_drho, double *db_dT)
{
  (void)law;
  (void)rho;
  *db_drho = 0.0;
  *db_dT   = -1.0 / (TK * TK);
  return 1.0 / TK;
}

/* (291): -y/x with x = v^2 dp/dv and y = v dp/dT of p(v, T), in the molar density d = 1/v. */
static double Expansion_PengRobinson(const Gas *law, double rho, double TK, double *db_drho, double *db_dT)
{
  const double R = LAW_GAS_CONSTANT, RTc = R * law->Tc, b = 0.07779607 * RTc / law->pc,
               a     = 0.45723553 * RTc * RTc / law->pc,
               kappa = 0.37464 + law->eccentric * (1.54226 - 0.26992 * law->eccentric);
  const double root = sqrt(TK / law->Tc), s = 1.0 + kappa * (1.0 - root), s_T = -0.5 * kappa * root / TK,
               s_TT = 0.25 * kappa * root / (TK * TK);
  const double A = a * s * s, A_T = 2.0 * a * s * s_T, A_TT = 2.0 * a * (s_T * s_T + s * s_TT);
  const double d = rho <= 0.0 ? 0.0 : rho / law->M, e = 1.0 - b * d, Q = 1.0 + b * d * (2.0 - b * d),
               Q_d = 2.0 * b * (1.0 - b * d), t = 2.0 * d * (1.0 + b * d) / (Q * Q);
  const double t_d = 2.0 * (1.0 + 2.0 * b * d) / (Q * Q) - 2.0 * t * Q_d / Q;
  const double x = -R * TK / (e * e) + A * t, x_d = -2.0 * b * R * TK / (e * e * e) + A * t_d,
               x_T = -R / (e * e) + A_T * t;
  const double y = R / e - A_T * d / Q, y_d = R * b / (e * e) - A_T / Q * (1.0 - d * Q_d / Q), y_T = -A_TT * d / Q;

  *db_drho = -(y_d - y * x_d / x) / (x * law->M);
  *db_dT   = -(y_T - y * x_T / x) / x;
  return -y / x;
}

typedef void (*GasLaw)(const Gas *, int, const double *, const double *, double *, double *, double *);
typedef double (*ExpansionLaw)(const Gas *, double, double, double *, double *);
static const char *const  gas_names[]      = {"peng_robinson", "ideal", NULL};
static const GasLaw       gas_laws[]       = {Gas_PengRobinson, Gas_Ideal};
static const ExpansionLaw expansion_laws[] = {Expansion_PengRobinson, Expansion_Ideal};
_Static_assert(sizeof gas_names / sizeof *gas_names == sizeof gas_laws / sizeof *gas_laws + 1, "a name for every law");

LAW_CHOICE(GasTypes, GasSetType, Gas, gas_names, law->density = gas_laws[i], law->expansion = expansion_laws[i],
           law->type = gas_names[i])

void GasDensityBatch(const Gas *law, int n, const double *p, const double *T, double *rho, double *drho_dp,
                     double *drho_dT)
{
  const GasLaw density = law->density ? law->density : Gas_Ideal;

  for (int q = 0; q < n; q += GAS_BLOCK)
    density(law, n - q < GAS_BLOCK ? n - q : GAS_BLOCK, &p[q], &T[q], &rho[q], &drho_dp[q], &drho_dT[q]);
}

double GasDensity(const Gas *law, double p, double T, double *drho_dp, double *drho_dT)
{
  double rho;

  GasDensityBatch(law, 1, &p, &T, &rho, drho_dp, drho_dT);
  return rho;
}

double GasExpansion(const Gas *law, double p, double T, double *dbeta_dp, double *dbeta_dT)
{
  double             rho_p, rho_T, b_rho, b_T;
  const double       rho       = GasDensity(law, p, T, &rho_p, &rho_T);
  const ExpansionLaw expansion = law->expansion ? law->expansion : Expansion_Ideal;
  const double       beta      = expansion(law, rho, T + LAW_ZERO_CELSIUS, &b_rho, &b_T);

  *dbeta_dp = p > 0.0 ? b_rho * rho_p : 0.0;
  *dbeta_dT = b_T + (p > 0.0 ? b_rho * rho_T : 0.0);
  return beta;
}

double GasExpansionAt(const Gas *law, double rho, double T)
{
  const ExpansionLaw expansion = law->expansion ? law->expansion : Expansion_Ideal;
  double             b_rho, b_T;

  return expansion(law, rho, T + LAW_ZERO_CELSIUS, &b_rho, &b_T);
}

#define TRACE 1e-7      /* of the ideal gas at TRACE_AT; water really holds 0.04 of it */
#define TRACE_AT 283.15 /* K */

double GasTrace(const Gas *law)
{
  return TRACE * law->M / (LAW_GAS_CONSTANT * TRACE_AT);
}
