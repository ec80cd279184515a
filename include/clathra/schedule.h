/* schedule: a piecewise-linear function of time with known kinks; constant, ramp and table are all of this kind,
   `piecewise` holds each value until the next time (jumps), `sine` adds waves (267) to a constant.  Units: times in s,
   values in SI units of the key that they are of. */
#pragma once

#include "clathra/base.h"

typedef struct {
  double amplitude, period, begin; /* SI; s; s */
} Wave;

typedef struct {
  PetscInt n;     /* points; 1 = constant */
  double  *t, *y; /* ascending times (s) and values (SI) */
  bool     steps; /* piecewise constant */
  PetscInt nwave;
  Wave    *wave;
} Schedule;

/* Value at time t; held constant outside [t_0, t_n).  With jumps the value belongs to the interval that starts at t. */
double ScheduleValue(const Schedule *s, double t);
/* Integral from 0 to t. */
double ScheduleIntegral(const Schedule *s, double t);
/* First kink strictly later than t (by more than a relative 1e-12), INFINITY if none: no step crosses one. */
double ScheduleNextKink(const Schedule *s, double t);
/* First eighth of a period of its waves later than t, INFINITY without waves: no step crosses one. */
double ScheduleNextMark(const Schedule *s, double t);
/* Sum of the amplitudes: how far its waves leave what is left without them. */
double ScheduleSwing(const Schedule *s);
/* Is it zero at all times?  Also where it has no point. */
bool ScheduleIsZero(const Schedule *s);
/* Lowest and highest value at any time; infinite, -infinite where it has no point. */
void ScheduleSpan(const Schedule *s, double *low, double *high);
/* Frees its points and waves; it is empty then. */
void ScheduleDestroy(Schedule *s);
