/* Flow of the fluids through a particle: every relation once, with its slopes, for one particle and for loops over
   blocks (point_state.h). */
#pragma once

#include <math.h>
#include <stdbool.h>
#include "clathra/dimension.h"
#include "clathra/fields.h"
#include "clathra/inline.h"

#define CL_MOBILITY_FLOOR 1e-9 /* of k_r: an immobile fluid has one pressure in all directions, and a velocity */

/* A of (306), what drives a fluid per gradient in units of k_a, by cl_symmetric; 1 without beds. */
typedef struct {
  double A[CL_SYMMETRIC];
} Beds;

/* (306), (307) of a material whose beds dip by `dip` (rad) from x towards y (in space they hold z) and lay like that
   where the deformation gradient F was 1; ratio of k across them to k along them. */
INLINE Beds BedsOf(double ratio, double dip, const double F[CL_DIM][CL_DIM])
{
  const double n0[CL_DIM] = {-sin(dip), cos(dip)};
  double       cof[CL_DIM][CL_DIM], n[CL_DIM];
  Beds         beds = {0};

  CofactorOf(F, cof);
  for (int i = 0; i < CL_DIM; i++)
    n[i] = VectorDot(cof[i], n0);
  const double c = (1.0 - ratio) / VectorDot(n, n);

  for (int i = 0; i < CL_DIM; i++) {
    for (int j = i; j < CL_DIM; j++)
      beds.A[cl_symmetric[i][j]] = (i == j ? 1.0 : 0.0) - c * n[i] * n[j];
  }
  return beds;
}

/* v := A v; A dimensionless. */
INLINE void BedsDrive(const Beds *beds, double v[CL_DIM])
{
  double x[CL_DIM];

  for (int i = 0; i < CL_DIM; i++) {
    x[i] = beds->A[cl_symmetric[i][0]] * v[0];
    for (int j = 1; j < CL_DIM; j++)
      x[i] += beds->A[cl_symmetric[i][j]] * v[j];
  }
  for (int i = 0; i < CL_DIM; i++)
    v[i] = x[i];
}

/* n . A n, with n (x) n or a mean of such, of trace 1, in N; dimensionless. */
INLINE double BedsAcross(const Beds *beds, const double N[CL_SYMMETRIC])
{
  double sum = 0.0;

  for (int k = 0; k < CL_SYMMETRIC; k++)
    sum += (k < CL_DIM ? 1.0 : 2.0) * beds->A[k] * N[k];
  return sum;
}

/* A := A - (1 - ratio) A N A/(N : A): what it lets across is less by that ratio. */
INLINE void BedsLessen(Beds *beds, const double N[CL_SYMMETRIC], double ratio)
{
  const double c = (1.0 - ratio) / BedsAcross(beds, N);
  double       AN[CL_DIM][CL_DIM], less[CL_DIM][CL_DIM];

  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++) {
      AN[i][j] = 0.0;
      for (int k = 0; k < CL_DIM; k++)
        AN[i][j] += beds->A[cl_symmetric[i][k]] * N[cl_symmetric[k][j]];
    }
  }
  for (int i = 0; i < CL_DIM; i++) {
    for (int j = i; j < CL_DIM; j++) {
      less[i][j] = 0.0;
      for (int k = 0; k < CL_DIM; k++)
        less[i][j] += c * AN[i][k] * beds->A[cl_symmetric[k][j]];
    }
  }
  for (int i = 0; i < CL_DIM; i++) {
    for (int j = i; j < CL_DIM; j++)
      beds->A[cl_symmetric[i][j]] -= less[i][j];
  }
}

/* A^-1 */
INLINE Beds BedsInverse(const Beds *beds)
{
  double A[CL_DIM][CL_DIM], cof[CL_DIM][CL_DIM];
  Beds   inverse = {{0.0}};

  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++)
      A[i][j] = beds->A[cl_symmetric[i][j]];
  }
  const double det = CofactorOf(A, cof);
  for (int i = 0; i < CL_DIM; i++) {
    for (int j = i; j < CL_DIM; j++)
      inverse.A[cl_symmetric[i][j]] = cof[i][j] / det;
  }
  return inverse;
}

/* Mean of A at a node, of the sums of V S k_p A (by cl_symmetric) and of V S k_p over its particles; B of (448) is its
   inverse. */
INLINE Beds BedsMean(const double sum[CL_SYMMETRIC], double Vk)
{
  Beds mean = {{0.0}};

  for (int k = 0; k < CL_SYMMETRIC; k++)
    mean.A[k] = sum[k] / Vk;
  return mean;
}

/* What k_r is a function of, with slopes in the fluid's share of the open pores and in S_h. */
typedef struct {
  double v, share, Sh;
} KrArgument;

/* share: of the open pores, in [0, 1], dimensionless. */
INLINE KrArgument KrArgumentOf(bool of_pores, double share, double Sh)
{
  const double of = of_pores ? 1.0 - Sh : 1.0;

  return (KrArgument){of * share, of, of_pores ? -share : 0.0};
}

/* k_r, or the least that a mobility is taken with; dimensionless. */
INLINE double KrFloored(double kr)
{
  return kr < CL_MOBILITY_FLOOR ? CL_MOBILITY_FLOOR : kr;
}

/* Mobility with what inertia holds, m^2/(Pa s), with slopes in k_r, mu/k_a and rho. */
typedef struct {
  double v, kr, resist, rho;
} Tau;

/* (20); resist: Pa s/m^2, rho: kg/m^3; per_dt: 1/dt' (1/s), with mass scaling, or 0 without inertia. */
INLINE Tau TauOf(double kr, double resist, double rho, double per_dt)
{
  const double sum = resist + kr * rho * per_dt, v = kr / sum;

  return (Tau){v, resist / (sum * sum), -v / sum, -v * v * per_dt};
}

/* (353): share of what a particle's pressure differs by from its nodes' that flow within the cell takes away in
   dt (s); mobility: sum over the fluids of k_a k_r/mu, m^2/(Pa s); storage per volume of sediment, 1/Pa; half-lengths
   l, m. */
INLINE double ExchangeShare(double mobility, double storage, const double l[CL_DIM], double dt)
{
  double sum = 0.0;

  for (int d = 0; d < CL_DIM; d++)
    sum += 0.5 / (l[d] * l[d]);
  return -expm1(-dt * sum * mobility / storage);
}

/* Two fluids that flow through a particle at t_n. */
typedef struct {
  double mobility[PHASE_COUNT];                /* l = k_a k_r/mu, m^2/(Pa s) */
  double less[PHASE_COUNT], more[PHASE_COUNT]; /* those at p_c - half and p_c + half */
  double half;                                 /* by how much p_c differs within the cell, Pa */
  double heavier;                              /* rho_w - rho_g, kg/m^3 */
  double J[CL_DIM];                            /* volume of both, relative to the skeleton, m/s */
  double grad_pc[CL_DIM];                      /* Pa/m */
  double h[CL_DIM];                            /* h* of the cell, m */
} TwoFluids;

/* h* of (456), m: the width h of a cell times four times the mean product of its two nodes' weights over particles of
   half-length l, what storage has in common with a neighbour.  3/4 h for two particles. */
INLINE double CarryingWidth(double h, double l)
{
  const double part = l < 0.5 * h ? l / h : 0.5;

  return h * (2.0 + 4.0 * part * part) / 3.0;
}

/* Share of gravity's drive of the fluids past each other that the gradient of p_c does not hold: 0 where they are at
   rest, 1 where p_c is uniform; dimensionless.  Gravity b, m/s^2. */
INLINE double Segregating(const TwoFluids *f, const double b[CL_DIM])
{
  const double by_gravity = f->heavier * VectorDot(b, b);

  if (by_gravity == 0.0)
    return 0.0;
  const double share = 1.0 + VectorDot(f->grad_pc, b) / by_gravity;
  return share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share;
}

#define CL_PECLET_LEAST 1e-4 /* below, Pe coth Pe - 1 is Pe^2/3 to all digits */

/* (456) but for theta: diffusion of p_c that carries the saturations with the flow of both fluids together, m^2/(Pa s);
   gravity b, m/s^2; beds: null where there are none. */
INLINE double SaturationDiffusion(const TwoFluids *f, const double b[CL_DIM], const Beds *beds)
{
  const double l[PHASE_COUNT] = {f->mobility[PHASE_W], f->mobility[PHASE_G]};
  const double both = l[PHASE_W] * l[PHASE_G] / (l[PHASE_W] + l[PHASE_G]), segregating = Segregating(f, b);
  const double water[2]    = {f->less[PHASE_W] / (f->less[PHASE_W] + f->less[PHASE_G]),
                              f->more[PHASE_W] / (f->more[PHASE_W] + f->more[PHASE_G])};
  const double per_flow    = (water[1] - water[0]) / (2.0 * f->half);
  const double per_gravity = (water[1] * f->more[PHASE_G] - water[0] * f->less[PHASE_G]) / (2.0 * f->half) * f->heavier;
  double       down[CL_DIM], Pe = 0.0;

  for (int d = 0; d < CL_DIM; d++)
    down[d] = segregating * b[d];
  if (beds)
    BedsDrive(beds, down);
  for (int d = 0; d < CL_DIM; d++)
    Pe += f->h[d] * fabs(per_flow * f->J[d] + per_gravity * down[d]) / (2.0 * both);
  return both * (Pe < CL_PECLET_LEAST ? Pe * Pe / 3.0 : Pe / tanh(Pe) - 1.0);
}

/* (18) along one axis, kg m/s: Darcy flux J and projected less own gradient, both on the configuration at t_n. */
INLINE double MassFlux(double V, double rho, double rho_tau, double J, double gradient)
{
  return V * (rho * J + rho_tau * gradient);
}
