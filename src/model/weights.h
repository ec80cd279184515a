/* Private to model/: what a particle counts at its nodes, and nodal values that several files ask for. */
#pragma once

#include "reach.h"

static inline const Material *ParticleMaterial(const Model *m, PetscInt p)
{
  return &m->c->material[m->c->region[m->P.i[PI_REGION][p]].material];
}

/* Weight of the projection (20): volume times permeability. */
static inline double ConductingVolume(const Model *m, PetscInt p)
{
  return m->P.f[P_V][p] * m->conduct[p];
}

/* (350) over S_I: 1 where all particles of the node are as permeable. */
static inline double LayerWeight(const Model *m, PetscInt p, PetscInt I)
{
  return m->conduct[p] * m->flow[I];
}

/* How far a particle lies upstream of a node, against the direction of flow there, m; negative downstream. */
static inline double Upstream(const Model *m, PetscInt p, PetscInt I, const double direction[CL_DIM])
{
  double way[CL_DIM];

  for (int d = 0; d < CL_DIM; d++)
    way[d] = GridNode(&m->grid, d, m->map.ij[I][d]) - ParticleGridX(&m->P, p, d);
  ParticleCarry(&m->P, p, way);
  return VectorDot(direction, way);
}

/* omega_Ip (332): 1 where all nodes of the particle are as mobile. */
static inline double DonorShare(const Model *m, PetscInt p, PetscInt I)
{
  const Donor *at = &m->added->donor[p];

  return at->base + fmax(-Upstream(m, p, I, at->up), 0.0);
}

static inline bool Donated(const Model *m, int f)
{
  return m->added->donor && f == PHASE_G;
}

/* The node's factor in both. */
static inline double NodeShare(const Model *m, PetscInt I, int f)
{
  return Donated(m, f) ? m->added->source[2 * I] : m->flow[I];
}

/* Share of a node's flux of a fluid that goes through an open face of the particle: (350), of gas (333) without
   omega. */
static inline double FaceShare(const Model *m, PetscInt p, PetscInt I, int f)
{
  return m->conduct[p] * NodeShare(m, I, f);
}

/* (197): what the wall of a well adds to the drag of a node's flow along axis i, of this rank's faces, Pa s m. */
static inline double WallDrag(const Model *m, PetscInt I, int f, int i)
{
  return m->wall && i == 0 ? m->wall[PHASE_COUNT * I + f] : 0.0;
}

/* W_Ip/S_I of a fluid: (350), of gas (333). */
static inline double FlowWeight(const Model *m, PetscInt p, PetscInt I, int f)
{
  return Donated(m, f) ? DonorShare(m, p, I) * FaceShare(m, p, I, f) : LayerWeight(m, p, I);
}

/* Weight of a node's projected gradient in the bracket of (19): S_I, of gas (334). */
static inline double ProjectedShare(const Model *m, PetscInt p, PetscInt I, int f, double S)
{
  return Donated(m, f) ? S * DonorShare(m, p, I) * m->coef[I * NC_COUNT + NC_KR + f] / m->added->donor[p].kr : S;
}

/* v := A v where particle p has beds (306). */
static inline void Drive(const Model *m, PetscInt p, double v[CL_DIM])
{
  if (m->beds)
    BedsDrive(&m->beds[p].A, v);
}

/* v := B v at a node (448). */
static inline void ShareOut(const Model *m, PetscInt I, double v[CL_DIM])
{
  if (m->share)
    BedsDrive(&m->share[I], v);
}

/* rho b of a fluid of particle p with beds at t_n, N/m^3. */
static inline void BedsWeight(const Model *m, PetscInt p, int f, double w[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    w[d] = m->beds[p].rho[f] * m->bc.gravity[d];
}

/* Share of water in the open pores at t_n. */
static inline double ParticleSw(const Model *m, PetscInt p)
{
  return m->P.f[P_SW] ? m->P.f[P_SW][p] / (1.0 - m->P.f[P_SH][p]) : 0.0;
}

/* Where the row of an unknown at a node is gathered. */
static inline double *RowOf(const Model *m, double *f, PetscInt I, int q)
{
  if (m->fluid && q >= F_VW && q < F_PW)
    return &m->fluid[PHASE_COUNT * I + (q - F_VW) / CL_DIM].F[(q - F_VW) % CL_DIM];
  return &f[I * m->c->fields.n + m->c->fields.at[q]];
}

/* What a face of particle p at node I adds to row q is weighted with besides: (350) in (16). */
static inline double FaceFlow(const Model *m, PetscInt p, PetscInt I, int q)
{
  return q >= F_VW && q < F_PW ? FlowWeight(m, p, I, (q - F_VW) / CL_DIM) : 1.0;
}

/* Widths of a particle's cell, m. */
static inline void CellWidths(const Model *m, PetscInt p, double h[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    h[d] = LinesWidth(&m->grid.line[d], m->stencil[p].axis[d].base + m->stencil[p].cell[d]);
}

/* Volume of a full cell about a node, m^3. */
static inline double NodeVolume(const Model *m, PetscInt I)
{
  const PetscInt *ij = m->map.ij[I];
  const double    h0 = LinesAround(&m->grid.line[0], ij[0]), r = GridNode(&m->grid, 0, ij[0]);
  double          V = h0;

  for (int d = 1; d < CL_DIM; d++)
    V *= LinesAround(&m->grid.line[d], ij[d]);
  return V * (m->c->axisymmetric ? 2.0 * M_PI * fmax(r, 0.25 * h0) : 1.0);
}

/* The smallest cell width at a node, m. */
static inline double NodeWidth(const Model *m, PetscInt I)
{
  double h = INFINITY;

  for (int d = 0; d < CL_DIM; d++)
    h = fmin(h, LinesLess(&m->grid.line[d], m->map.ij[I][d]));
  return h;
}

/* Darcy flux of a fluid at a node (19). */
static inline void DarcyFlux(const Model *m, PetscInt I, int f, const double *xI, double J[CL_DIM])
{
  const FieldSet *fs = &m->c->fields;
  const double    w = m->w[PHASE_COUNT * I + f], *v = &xI[PlaceV(fs, f)];

  for (int i = 0; i < CL_DIM; i++)
    J[i] = w * (fs->solid ? v[i] - xI[PlaceVs(fs) + i] : v[i]);
}

/* ... as it is shared out (448): B J. */
static inline void SharedFlux(const Model *m, PetscInt I, int f, const double *xI, double J[CL_DIM])
{
  DarcyFlux(m, I, f, xI, J);
  ShareOut(m, I, J);
}

/* Factor of the sum over particles in the root of k_r of a node: the layer's (108), or none (359). */
static inline double RootFactor(const Model *m, PetscInt I, int f)
{
  return Donated(m, f) ? 1.0 : m->flow[I];
}

/* Share of a particle in it (108), (359). */
static inline double MobilityShare(const Model *m, PetscInt p, PetscInt I, int f, double S)
{
  return S * (Donated(m, f) ? 1.0 : LayerWeight(m, p, I)) * m->P.f[P_V][p] / m->V[I];
}

/* Acceleration of the velocity at place k of a node's block; quasi-static: none. */
static inline void Rate(const Model *m, PetscInt I, const double *x, int k, double rate[CL_DIM])
{
  const PetscInt q = I * m->c->fields.n + k;

  for (int i = 0; i < CL_DIM; i++)
    rate[i] = m->c->fields.inertia ? (x[q + i] - m->stage.x_star[q + i]) / m->stage.dt : 0.0;
}

/* ... weighted, less gravity. */
static inline void Acceleration(const Model *m, PetscInt I, const double *x, int k, double weight, double acc[CL_DIM])
{
  Rate(m, I, x, k, acc);
  for (int i = 0; i < CL_DIM; i++)
    acc[i] = weight * acc[i] - m->bc.gravity[i];
}

/* (308): what the skeleton's acceleration and gravity have of that of fluid f beside weight a_f - b. */
static inline void BedsHold(const Model *m, PetscInt p, PetscInt I, const double *x, int f, double across[CL_DIM])
{
  const FieldSet *fs          = &m->c->fields;
  double          own[CL_DIM] = {0.0};

  if (fs->solid)
    Rate(m, I, x, PlaceVs(fs), own);
  for (int i = 0; i < CL_DIM; i++)
    across[i] = own[i] - m->bc.gravity[i];
  BedsDrive(&m->beds[p].A, across);
  for (int i = 0; i < CL_DIM; i++)
    across[i] -= FlowWeight(m, p, I, f) * own[i] - m->bc.gravity[i];
}

/* ... of a fluid of particle p with (310). */
static inline void FluidAcceleration(const Model *m, PetscInt p, PetscInt I, const double *x, int f, double acc[CL_DIM])
{
  double across[CL_DIM];

  Acceleration(m, I, x, PlaceV(&m->c->fields, f), FlowWeight(m, p, I, f), acc);
  if (!m->beds)
    return;
  BedsHold(m, p, I, x, f, across);
  for (int i = 0; i < CL_DIM; i++)
    acc[i] += across[i];
}

/* (424), Pa. */
static inline double ParticleChord(const Model *m, PetscInt p)
{
  return m->added->chord ? m->added->chord[p] : 0.0;
}

/* Own value at t_n of unknown q = F_PW, F_PG, F_T. */
static inline double OwnValue(const Model *m, PetscInt p, int q)
{
  return m->P.f[q == F_T ? P_T : P_PW + q - F_PW][p];
}

/* Nodal less own value at t_n of unknown q = F_PW, F_PG, F_T. */
static inline double Shift(const Model *m, PetscInt p, const Reach *r, int q)
{
  const FieldSet *fs = &m->c->fields;
  double          shift;

  if (fs->at[q] < 0)
    return 0.0;
  shift = -OwnValue(m, p, q);
  for (int a = 0; a < r->n; a++)
    shift += r->S[a] * m->x_n[r->node[a] * fs->n + fs->at[q]];
  return shift;
}
