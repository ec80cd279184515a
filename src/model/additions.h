/* Private to model/: what the scheme adds to the balances so that they are well posed and do not oscillate. */
#pragma once

#include "clathra/model.h"

/* Second difference of the ghost penalties (22), (351): a node with its neighbours along one axis; or the difference
   (417) of two. */
typedef struct {
  PetscInt node[3];
  double   second[3];           /* h times the jump of the gradient (303); 1, -2, 1 where cells are equal */
  double   a;                   /* g A/h */
  double   M, kappa;            /* Pa, W/(m K) */
  double   lambda[PHASE_COUNT]; /* rho k k_r/mu, s */
  double   store[PHASE_COUNT];  /* STORAGE_SHARE w V rho s, kg/Pa */
  double   carried;             /* methane in a kg of water (352) */
} GhostLine;

/* Pressure projection of one cell. */
typedef struct {
  PetscInt node[CL_CORNERS];
  double   K[CL_CORNERS][CL_CORNERS];            /* m^2/Pa */
  double   t_inertia;                            /* of (275), s */
  double   s[PHASE_COUNT], content[PHASE_COUNT]; /* shares; rho s, of gas with what water holds of it (352): at t_n */
} ProjectionCell;

/* Where the gas that moves through a particle comes from (332). */
typedef struct {
  double up[CL_DIM]; /* beta_p over the mean distance of the nodes upstream, along the flow, 1/m */
  double base;       /* 1 - beta_p */
  double kr;         /* k^_r,p at t_n (334) */
} Donor;

/* What evens out the pressures of a cell's particles (353). */
typedef struct {
  double mobility, storage;  /* at t_n: of all fluids, m^2/(Pa s); per volume and pressure, 1/Pa */
  double share[PHASE_COUNT]; /* s_w, s_g at t_n */
  double change;             /* of the particle's pressures at the end of the step, Pa */
} Exchange;

struct Additions {
  PetscInt        nghost, ncell;
  GhostLine      *ghost;     /* [nghost] */
  ProjectionCell *cell;      /* [ncell] (23) */
  Donor          *donor;     /* [n] (332); NULL when off */
  Exchange       *exchange;  /* [n] (353); NULL when off */
  double         *source;    /* [n_local][2] V/Vk and Vk of gas (333), as particles take it; NULL when off */
  double         *spread;    /* [n][2] (200), (456); NULL when off */
  double         *upwind;    /* [n][3] (293); NULL when off */
  double         *long_cell; /* [n] (444), W m/K; NULL when off */
  double         *held;      /* [n] (381); NULL when off */
  double         *chord;     /* [n] (424), Pa; NULL when off */
};
