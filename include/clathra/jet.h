/* jet: a value with its derivatives with respect to the four scalars (J, p_w, p_g, T) that fix a particle's state.
   Arithmetic carries the chain rule, so that value and tangent are one expression and cannot drift apart.
   Units: of the value; its slopes in that per 1 (J), Pa (p_w, p_g), K (T). */
#pragma once

#include <math.h>

enum { JET_J = 0, JET_PW, JET_PG, JET_T, JET_COUNT };

typedef struct {
  double v, d[JET_COUNT];
} Jet;

/* A number whose slopes are zero. */
static inline Jet JetConstant(double v)
{
  return (Jet){v, {0.0}};
}

/* The variable of place `which`: slope 1 in itself. */
static inline Jet JetVariable(double v, int which)
{
  Jet r = JetConstant(v);

  r.d[which] = 1.0;
  return r;
}

/* f(a) with f' = df. */
static inline Jet JetChain(double f, double df, Jet a)
{
  Jet r = {f, {0.0}};

  for (int k = 0; k < JET_COUNT; k++)
    r.d[k] = df * a.d[k];
  return r;
}

/* f(a, b) with partial derivatives fa, fb. */
static inline Jet JetChain2(double f, double fa, Jet a, double fb, Jet b)
{
  Jet r = {f, {0.0}};

  for (int k = 0; k < JET_COUNT; k++)
    r.d[k] = fa * a.d[k] + fb * b.d[k];
  return r;
}

/* f(a, b, c) with partial derivatives fa, fb, fc. */
static inline Jet JetChain3(double f, double fa, Jet a, double fb, Jet b, double fc, Jet c)
{
  Jet r = {f, {0.0}};

  for (int k = 0; k < JET_COUNT; k++)
    r.d[k] = fa * a.d[k] + fb * b.d[k] + fc * c.d[k];
  return r;
}

/* a + b. */
static inline Jet JetAdd(Jet a, Jet b)
{
  return JetChain2(a.v + b.v, 1.0, a, 1.0, b);
}

/* a - b. */
static inline Jet JetSub(Jet a, Jet b)
{
  return JetChain2(a.v - b.v, 1.0, a, -1.0, b);
}

/* a b. */
static inline Jet JetMul(Jet a, Jet b)
{
  return JetChain2(a.v * b.v, b.v, a, a.v, b);
}

/* a/b; b must not be zero. */
static inline Jet JetDiv(Jet a, Jet b)
{
  const double q = a.v / b.v;

  return JetChain2(q, 1.0 / b.v, a, -q / b.v, b);
}

/* c a. */
static inline Jet JetScale(double c, Jet a)
{
  return JetChain(c * a.v, c, a);
}

/* a + c. */
static inline Jet JetShift(Jet a, double c)
{
  a.v += c;
  return a;
}
