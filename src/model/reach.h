/* Private to model/: the nodes that a particle reaches. */
#pragma once

#include "additions.h"

/* A particle's nodes with their values; H only about an axis; M, K are G, H as the motion sees them (160); B (88) only
   with mean dilatation. */
typedef struct {
  int      n;
  PetscInt node[CL_NODES];
  double   S[CL_NODES], G[CL_NODES][CL_DIM], H[CL_NODES], B[CL_NODES][CL_DIM];
  const double (*M)[CL_DIM], *K;
  double mixed[CL_NODES][CL_DIM], mixed_hoop[CL_NODES];
} Reach;

/* (445): gradients on the configuration at t_n from those on the grid's. */
static inline void CarryGradients(const Model *m, PetscInt p, Reach *r)
{
  const double hoop = m->c->axisymmetric ? m->stencil[p].r / m->P.f[P_X][p] : 0.0;
  double       A[CL_DIM][CL_DIM];

  ParticleInverse(&m->P, p, A);

  for (int a = 0; a < r->n; a++) {
    double G[CL_DIM];

    for (int i = 0; i < CL_DIM; i++)
      G[i] = VectorDot(A[i], r->G[a]);
    memcpy(r->G[a], G, sizeof(G));
    if (m->c->axisymmetric)
      r->H[a] *= hoop;
  }
}

/* (160), then (88) */
static inline void CellMotion(const Model *m, PetscInt p, Reach *r)
{
  const Stencil *s    = &m->stencil[p];
  const bool     ring = m->c->axisymmetric;
  PetscInt       cell[CL_DIM];
  double         h[CL_DIM];

  for (int d = 0; d < CL_DIM; d++) {
    cell[d] = s->axis[d].base + s->cell[d];
    h[d]    = LinesWidth(&m->grid.line[d], cell[d]);
  }
  const double radius = GridNode(&m->grid, 0, cell[0]), share = m->c->mean_strain;
  const double mean = m->c->mean_dilatation ? (1.0 - share) / (ring ? CL_DIM + 1 : CL_DIM) : 0.0;

  for (int a = 0; a < r->n; a++) {
    PetscInt i[CL_DIM];
    double   Q[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      i[d] = m->map.ij[r->node[a]][d] - cell[d];
    const double hoop = CellGradient(h, ring, i, radius, Q), beyond = ring ? hoop - r->H[a] : 0.0;

    for (int d = 0; d < CL_DIM; d++) {
      r->mixed[a][d] = r->G[a][d] + share * (Q[d] - r->G[a][d]);
      r->B[a][d]     = mean * (Q[d] - r->G[a][d]);
    }
    r->mixed_hoop[a] = ring ? r->H[a] + share * beyond : 0.0;
    r->B[a][0] += mean * beyond;
  }
  r->M = r->mixed;
  r->K = r->mixed_hoop;
}

static inline void ReachExpand(const Model *m, PetscInt p, Reach *r)
{
  r->n = StencilExpand(&m->stencil[p], &m->grid, &m->map, r->node, r->S, r->G, r->H);
  if (m->P.total)
    CarryGradients(m, p, r);
  r->M = r->G;
  r->K = r->H;
  if (m->c->mean_dilatation || m->c->mean_strain > 0.0)
    CellMotion(m, p, r);
}

/* Gradient and hoop strain of what moves with the nodes, u: of each of the particle's nodes. */
static inline void MotionGradient(const Model *m, const Reach *r, double (*u)[CL_DIM], double g[MOTION_COUNT])
{
  double more = 0.0;

  for (int k = 0; k < MOTION_COUNT; k++)
    g[k] = 0.0;
  for (int a = 0; a < r->n; a++) {
    for (int i = 0; i < CL_DIM; i++) {
      for (int j = 0; j < CL_DIM; j++)
        g[VectorAt(0, i, j)] += u[a][i] * r->M[a][j];
    }
    if (m->c->axisymmetric)
      g[MOTION_HOOP] += u[a][0] * r->K[a];
    if (m->c->mean_dilatation)
      more += VectorDot(u[a], r->B[a]);
  }
  for (int d = 0; d < CL_DIM; d++)
    g[VectorAt(0, d, d)] += more;
  if (m->c->axisymmetric)
    g[MOTION_HOOP] += more;
}

/* Weights that carry the particle's middle along: S in the plane, the plain average about an axis. */
static inline double MotionWeight(const Model *m, PetscInt p, const Reach *r, int a)
{
  return m->c->axisymmetric ? r->H[a] * (m->P.total ? m->P.f[P_X][p] : m->stencil[p].r) : r->S[a];
}
