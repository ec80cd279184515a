/* kinematics: rotation, logarithmic strain and cofactor of a plane increment; docs/equations.md (5)-(7). */
#pragma once

#include <stdbool.h>

typedef struct {
  double F[2][2], cof[2][2], J; /* F = 1 + grad u; cof = J F^-T */
  double dcof[2][2][4];         /* d cof_ij / d(grad u)_k, k = 2*row + column */
  double dJ[4];
  double theta, dtheta[4]; /* rotation of the polar decomposition, rad */
  double e[3], de[3][4];   /* logarithmic strain xx, yy, xy */
  double stretch[2];       /* diagonal of the right stretch tensor U */
} Kinematics;

/* gradu: [i][j] = d u_i / d X_j on the configuration at t_n.  False if J <= 0 or not finite. */
bool KinematicsEvaluate(const double gradu[2][2], Kinematics *k);
