/* jet: a value with its derivatives with respect to the four scalars (J, p_w, p_g, T) that fix a particle's state.
   Arithmetic carries the chain rule, so that value and tangent are one expression and cannot drift apart.
   Units: of the value; its slopes in that per 1 (J), Pa (p_w, p_g), K (T). */
#pragma once

#include <math.h>

enum { JET_J = 0, JET_PW, JET_PG, JET_T, JET_COUNT };

typedef double JetSlopes __attribute__((vector_size(JET_COUNT * sizeof(double))));

typedef struct {
  double    v;
  JetSlopes d;
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
  return (Jet){f, df * a.d};
}

/* f(a, b) with partial derivatives fa, fb. */
static inline Jet JetChain2(double f, double fa, Jet a, double fb, Jet b)
{
  return (Jet){f, fa * a.d + fb * b.d};
}

/* f(a, b, c) with partial derivatives fa, fb, fc. */
static inline Jet JetChain3(double f, double fa, Jet a, double fb, Jet b, double fc, Jet c)
{
  return (Jet){f, fa * a.d + fb * b.d + fc * c.d};
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
