/* Private to model/: the nodes that a particle reaches. */
#pragma once

#include "additions.h"

/* A particle's nodes with their values; H only about an axis; M, K are G, H as the motion sees them (160); B (88)
   unless Model.cell is null. */
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

/* What strains a particle and carries its forces: (160), then (88). */
static inline void CellMotion(const Model *m, PetscInt p, Reach *r)
{
  const Stencil *s     = &m->stencil[p];
  const bool     ring  = m->c->axisymmetric;
  const double   share = m->c->mean_strain, mean = (1.0 - share) / 3.0;
  double         Q[CL_NODES][CL_DIM] = {{0.0}}, hoop[CL_NODES] = {0.0};
  PetscInt       cell[CL_CORNERS];
  double         part[CL_CORNERS];
  AxisParts      axis[CL_DIM];

  StencilCells(s, &m->grid, &m->map, axis, cell, part);
  for (int c = 0; c < CL_CORNERS; c++) {
    if (cell[c] < 0)
      continue;
    const CellMean *of    = &m->cell[cell[c]];
    const PetscInt *first = m->map.ij[cell[c]];
    for (int a = 0; a < r->n; a++) {
      const PetscInt *at = m->map.ij[r->node[a]];
      int             i  = 0;
      bool            in = true;

      for (int d = 0; d < CL_DIM; d++) {
        const PetscInt k = at[d] - first[d];

        in = in && (k == 0 || k == 1);
        i |= (k == 1) << d;
      }
      for (int d = 0; in && d < CL_DIM; d++)
        Q[a][d] += part[c] * of->Q[i][d];
      hoop[a] += in ? part[c] * of->hoop[i] : 0.0;
    }
  }
  for (int a = 0; a < r->n; a++) {
    const double beyond = ring ? hoop[a] - r->H[a] : 0.0;

    for (int d = 0; d < CL_DIM; d++) {
      const double more = Q[a][d] - r->G[a][d] / axis[d].whole;

      r->mixed[a][d] = r->G[a][d] + share * more;
      r->B[a][d]     = mean * more;
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
}

/* With M, K and B. */
static inline void ReachMotion(const Model *m, PetscInt p, Reach *r)
{
  ReachExpand(m, p, r);
  if (m->cell)
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
    if (m->cell)
      more += VectorDot(u[a], r->B[a]);
  }
  for (int d = 0; d < CL_DIM; d++)
    g[VectorAt(0, d, d)] += more;
  if (CL_DIM == 2)
    g[MOTION_HOOP] += more;
}

/* Weights that carry the particle's middle along: S in the plane, the plain average about an axis. */
static inline double MotionWeight(const Model *m, PetscInt p, const Reach *r, int a)
{
  return m->c->axisymmetric ? r->H[a] * (m->P.total ? m->P.f[P_X][p] : m->stencil[p].r) : r->S[a];
}
