/* Private to model/: what passes between nodes and one particle. */
#pragma once

#include "clathra/model.h"

/* A particle's nodes with their values. */
typedef struct {
  int      n;
  PetscInt node[CL_NODES];
  double   S[CL_NODES], G[CL_NODES][CL_DIM];
} Reach;

static inline void ReachExpand(const Model *m, PetscInt p, Reach *r)
{
  r->n = StencilExpand(&m->stencil[p], &m->grid, &m->map, r->node, r->S, r->G);
}

static inline const Material *ParticleMaterial(const Model *m, PetscInt p)
{
  return &m->c->material[m->c->region[m->P.i[PI_REGION][p]].material];
}

/* Inputs (1), (5), (19) of particle p from the nodal values x; N replaces S for the Darcy fluxes (NULL: S). */
static inline void GatherInputs(const Model *m, PetscInt p, const Reach *r, const double *x, const double *N,
                                double in[IN_COUNT])
{
  for (int q = 0; q < IN_COUNT; q++)
    in[q] = 0.0;
  in[IN_P]     = m->P.f[P_PW][p];
  in[IN_P + 1] = m->P.f[P_PG][p];
  in[IN_T]     = m->P.f[P_T][p];
  for (int a = 0; a < r->n; a++) {
    const PetscInt I  = r->node[a];
    const double  *xI = &x[I * F_COUNT], *xn = &m->x_n[I * F_COUNT], *us = &m->stage.u_star[I * CL_DIM],
                 *w = &m->w[I * 2];
    const double S = r->S[a], SJ = N ? N[a] : S, *G = r->G[a];

    for (int i = 0; i < 2; i++) {
      const double u = us[i] + m->stage.dt * xI[F_VSX + i];

      in[IN_GRADU + 2 * i] += u * G[0];
      in[IN_GRADU + 2 * i + 1] += u * G[1];
      in[IN_J + i] += SJ * w[PHASE_W] * (xI[F_VWX + i] - xI[F_VSX + i]);
      in[IN_J + 2 + i] += SJ * w[PHASE_G] * (xI[F_VGX + i] - xI[F_VSX + i]);
    }
    for (int f = 0; f < PHASE_COUNT; f++) {
      in[IN_P + f] += S * (xI[F_PW + f] - xn[F_PW + f]);
      in[IN_GP + 2 * f] += G[0] * xI[F_PW + f];
      in[IN_GP + 2 * f + 1] += G[1] * xI[F_PW + f];
    }
    in[IN_T] += S * (xI[F_T] - xn[F_T]);
    in[IN_GT] += G[0] * xI[F_T];
    in[IN_GT + 1] += G[1] * xI[F_T];
  }
}

static inline void GatherHistory(const Model *m, PetscInt p, const Reach *r, PointHistory *h)
{
  h->V       = m->P.f[P_V][p];
  h->m_s     = m->P.f[P_MS][p];
  h->T_n     = m->P.f[P_T][p];
  h->Sh_n    = m->P.f[P_SH][p];
  h->dt      = m->stage.dt;
  h->bracket = m->c->flux_interpolation ? 1.0 : 0.0;
  for (int k = 0; k < 3; k++)
    h->m_star[k] = m->stage.m_star[3 * p + k];
  for (int s = 0; s < 6; s++) {
    h->sig[s]  = m->P.f[P_SIG + s][p];
    h->sig0[s] = m->P.f[P_SIG0 + s][p];
  }
  for (int k = 0; k < 3; k++) {
    h->shift[k] = -m->P.f[P_PW + k][p];
    for (int a = 0; a < r->n; a++)
      h->shift[k] += r->S[a] * m->x_n[r->node[a] * F_COUNT + F_PW + k];
  }
  for (int f = 0; f < PHASE_COUNT; f++) {
    for (int i = 0; i < 2; i++) {
      h->proj[f][i] = 0.0;
      for (int a = 0; a < r->n; a++)
        h->proj[f][i] += r->S[a] * m->proj[4 * r->node[a] + 2 * f + i];
    }
  }
}

static inline void NoteFailure(Model *m, ClStatus status, const char *why, PetscInt p)
{
  if (m->status != CL_OK)
    return;
  m->status   = status;
  m->why      = why;
  m->where[0] = m->P.f[P_X][p];
  m->where[1] = m->P.f[P_X + 1][p];
}

/* Everything about particle p at the nodal values x: its reach, inputs, state, outputs.  A failure is noted in the
 * model. */
ClStatus ParticleEvaluate(Model *m, PetscInt p, const double *x, bool tangent, Reach *r, double in[IN_COUNT],
                          PointState *s, PointOutput *o);
/* The same for a surface face. */
void FaceAt(const Model *m, const Face *face, const double *x, Reach *r, FaceOutput *o);
/* Projected pressure gradients (20) of the nodal pressures x into proj (n_local x 4), all ranks. */
PetscErrorCode ModelProjectGradients(Model *m, const double *x, double *proj);
/* Scaled, owned Vec -> unscaled nodal values on owned and ghost nodes. */
PetscErrorCode ModelUnscale(Model *m, Vec X, double *x);
/* (22) and (23): lists on the configuration at t_n, residual, Jacobian. */
PetscErrorCode StabilisationBuild(Model *m);
void           StabilisationResidual(const Model *m, const double *x, double *f);
PetscErrorCode StabilisationJacobian(Model *m);
/* Adds an n-node block (n F_COUNT square, row major, unscaled) to J2, with scales and Dirichlet rows. */
PetscErrorCode JacobianAdd(Model *m, int n, const PetscInt *node, double *block);
PetscErrorCode WideCreate(Model *m, Mat *A);
PetscErrorCode ModelResizeNodal(Model *m);
