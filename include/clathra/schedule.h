/* schedule: a piecewise-linear function of time with known kinks; constant, ramp and table are all of this kind,
   `piecewise` holds each value until the next time (jumps). */
#pragma once

#include "clathra/base.h"

typedef struct {
  PetscInt n;     /* points; 1 = constant */
  double  *t, *y; /* ascending times (s) and values (SI) */
  bool     steps; /* piecewise constant */
} Schedule;

/* Value at time t; held constant outside [t_0, t_n).  With jumps the value belongs to the interval that starts at t. */
double ScheduleValue(const Schedule *s, double t);
/* Integral from 0 to t. */
double ScheduleIntegral(const Schedule *s, double t);
/* First kink strictly later than t (by more than a relative 1e-12), INFINITY if none: no step crosses one. */
double ScheduleNextKink(const Schedule *s, double t);
void   ScheduleDestroy(Schedule *s);
