/* kinematics: rotation, logarithmic strain and cofactor of an increment in the plane, about an axis or in space;
 * docs/equations.md (5)-(7). */
#pragma once

#include <stdbool.h>
#include "clathra/tensor.h"

/* Independent numbers of the motion: grad u row by row, and the hoop strain u_r/r (zero but about an axis). */
enum { MOTION_HOOP = CL_DIM * CL_DIM, MOTION_COUNT };

typedef struct {
  double   F[CL_DIM][CL_DIM], lambda, J;       /* F = 1 + grad u, lambda = 1 + u_r/r, J = det F lambda */
  double   cof[CL_DIM][CL_DIM], cof_hoop;      /* J F^-T = lambda cof F_2; hoop: det F_2 */
  double   dcof[CL_DIM][CL_DIM][MOTION_COUNT]; /* d cof_ij / d motion */
  double   dJ[MOTION_COUNT];                   /* dcof_hoop = dJ/lambda but for the hoop strain, where it is zero */
  Rotation turn;                               /* of the polar decomposition F = V R */
  double   dtheta[CL_SPINS][MOTION_HOOP];      /* spins (rad) of dR R^T, by axis as in Spin6 */
  double   e[CL_TENSOR], de[CL_TENSOR][MOTION_COUNT]; /* logarithmic strain xx yy zz xy (yz xz) */
  double   stretch[CL_DIM];                           /* diagonal of the right stretch tensor U */
} Kinematics;

/* motion: d u_i / d X_j on the configuration at t_n, then u_r/r.  False if J <= 0 or not finite. */
bool KinematicsEvaluate(const double motion[MOTION_COUNT], Kinematics *k);
/* The same without the slopes, which stay as they are; motion dimensionless. */
bool KinematicsValues(const double motion[MOTION_COUNT], Kinematics *k);
