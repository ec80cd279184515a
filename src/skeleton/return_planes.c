/* Return to the planes of Mohr and Coulomb with the classical potential (planes of the dilation angle): faces, edges,
   apex, tension cut-off.  At given strength the state is closed; strength follows from one equation in the plastic
   strain (docs/equations.md, section 14). */
#include "plastic.h"

#define ITERATIONS 200
#define PLANES 3 /* at most, at once */

/* Planes a.y = h with flows b: of the yield function for the pairs of stresses, and of tension. */
enum { PAIR_13 = 0, PAIR_23, PAIR_12, TENSION_1, TENSION_2, TENSION_3, PLANE_COUNT };
static const int pair[3][2] = {{0, 2}, {1, 2}, {0, 1}};

typedef struct {
  int n, plane[PLANES];
} Active;

/* Closest state of a set of planes at a strength, with slopes. */
typedef struct {
  double y[3], mu[PLANES];
  double dy[3][3], c[3], phi[3], psi[3];
} Closest;

static double Value(const Trial3 *t, const Strength *k, int plane, const double y[3])
{
  if (plane >= TENSION_1)
    return y[plane - TENSION_1] - StrengthCutoff(t->law);
  const double hi = y[pair[plane][0]], lo = y[pair[plane][1]];

  return hi - lo + (hi + lo) * sin(k->phi) - 2.0 * k->c * cos(k->phi);
}

/* Normal of a plane with the sine s of an angle (friction: yield, dilation: flow), and its slope in s. */
static void Normal(int plane, double s, double a[3], double da[3])
{
  for (int i = 0; i < 3; i++)
    a[i] = da[i] = 0.0;
  if (plane >= TENSION_1) {
    a[plane - TENSION_1] = 1.0;
    return;
  }
  a[pair[plane][0]]  = 1.0 + s;
  a[pair[plane][1]]  = -(1.0 - s);
  da[pair[plane][0]] = da[pair[plane][1]] = 1.0;
}

static void Hooke(const Trial3 *t, const double b[3], double Db[3])
{
  const double tr = t->lame * (b[0] + b[1] + b[2]);

  for (int i = 0; i < 3; i++)
    Db[i] = t->G2 * b[i] + tr;
}

/* Inverse of the leading n x n part; false if it is singular. */
static bool Invert(int n, double M[PLANES][PLANES], double inv[PLANES][PLANES])
{
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++)
      inv[i][j] = i == j;
  }
  for (int k = 0; k < n; k++) {
    int top = k;

    for (int i = k + 1; i < n; i++)
      top = fabs(M[i][k]) > fabs(M[top][k]) ? i : top;
    if (!(fabs(M[top][k]) > 1e-14))
      return false;
    for (int j = 0; top != k && j < n; j++) {
      const double m = M[k][j], v = inv[k][j];

      M[k][j]     = M[top][j];
      M[top][j]   = m;
      inv[k][j]   = inv[top][j];
      inv[top][j] = v;
    }
    const double p = M[k][k];
    for (int j = 0; j < n; j++) {
      M[k][j] /= p;
      inv[k][j] /= p;
    }
    for (int i = 0; i < n; i++) {
      const double f = M[i][k];

      for (int j = 0; i != k && j < n; j++) {
        M[i][j] -= f * M[k][j];
        inv[i][j] -= f * inv[k][j];
      }
    }
  }
  return true;
}

/* Active planes with their normals and flows, slopes of these in the sines of the angles, and the inverse of A^T D B.
 */
typedef struct {
  double a[PLANES][3], Db[PLANES][3], dDb[PLANES][3], inv[PLANES][PLANES];
} Levers;

static bool LeversOf(const Trial3 *t, const Strength *k, const Active *s, Levers *l)
{
  double M[PLANES][PLANES];

  for (int m = 0; m < s->n; m++) {
    double b[3], db[3], unused[3];

    Normal(s->plane[m], sin(k->phi), l->a[m], unused);
    Normal(s->plane[m], sin(k->psi), b, db);
    Hooke(t, b, l->Db[m]);
    Hooke(t, db, l->dDb[m]);
  }
  for (int m = 0; m < s->n; m++) {
    for (int n = 0; n < s->n; n++)
      M[m][n] = l->a[m][0] * l->Db[n][0] + l->a[m][1] * l->Db[n][1] + l->a[m][2] * l->Db[n][2];
  }
  return Invert(s->n, M, l->inv);
}

/* What keeps the equation of active plane m when y_tr, c, phi, psi change. */
static void PlaneSlopes(const Strength *k, const Active *s, const Levers *l, int m, Closest *o)
{
  const int    plane = s->plane[m];
  const bool   mc    = plane < TENSION_1;
  const double sum   = mc ? o->y[pair[plane][0]] + o->y[pair[plane][1]] : 0.0;
  const double by_c  = mc ? -2.0 * cos(k->phi) : 0.0;
  const double by_f  = mc ? sum * cos(k->phi) + 2.0 * k->c * sin(k->phi) : 0.0;
  double       by_p  = 0.0;

  for (int n = 0; n < s->n; n++)
    by_p -=
        o->mu[n] * cos(k->psi) * (l->a[m][0] * l->dDb[n][0] + l->a[m][1] * l->dDb[n][1] + l->a[m][2] * l->dDb[n][2]);
  for (int i = 0; i < 3; i++) {
    double lever = 0.0; /* of plane m on y_i */

    for (int n = 0; n < s->n; n++)
      lever += l->Db[n][i] * l->inv[n][m];
    o->c[i] -= lever * by_c;
    o->phi[i] -= lever * by_f;
    o->psi[i] -= lever * by_p + o->mu[m] * cos(k->psi) * l->dDb[m][i];
    for (int j = 0; j < 3; j++)
      o->dy[i][j] -= lever * l->a[m][j];
  }
}

/* The nearest state on active planes (67). */
static bool ClosestState(const Trial3 *t, const Strength *k, const Active *s, Closest *o)
{
  Levers l;

  if (!LeversOf(t, k, s, &l))
    return false;
  *o = (Closest){.y = {t->y[0], t->y[1], t->y[2]}};
  for (int m = 0; m < s->n; m++) {
    for (int n = 0; n < s->n; n++)
      o->mu[m] += l.inv[m][n] * Value(t, k, s->plane[n], t->y);
  }
  for (int i = 0; i < 3; i++) {
    o->dy[i][i] = 1.0;
    for (int m = 0; m < s->n; m++)
      o->y[i] -= o->mu[m] * l.Db[m][i];
  }
  for (int m = 0; m < s->n; m++)
    PlaneSlopes(k, s, &l, m, o);
  return true;
}

/* Return to the apex (66). */
static void Apex(const Strength *k, Closest *o)
{
  const double at = k->c / tan(k->phi), si = sin(k->phi);

  *o = (Closest){.y = {at, at, at}};
  for (int i = 0; i < 3; i++) {
    o->c[i]   = 1.0 / tan(k->phi);
    o->phi[i] = -k->c / (si * si);
  }
}

/* Without a cut-off: the face, or the edge on the side where it is missed, or the apex. */
static bool NoCutoff(const Trial3 *t, const Strength *k, Closest *o, ReturnRegion *region)
{
  static const Active face = {1, {PAIR_13}}, upper = {2, {PAIR_13, PAIR_23}}, lower = {2, {PAIR_13, PAIR_12}};

  *region = RETURN_FACE;
  if (!ClosestState(t, k, &face, o))
    return false;
  if (o->y[0] >= o->y[1] && o->y[1] >= o->y[2])
    return true;
  const double s    = sin(k->psi);
  const double side = (1.0 - s) * t->y[0] - 2.0 * t->y[1] + (1.0 + s) * t->y[2];
  *region           = RETURN_EDGE;
  if (!ClosestState(t, k, side < 0.0 ? &upper : &lower, o))
    return false;
  if (o->y[0] >= o->y[2] || !(sin(k->phi) > 0.0))
    return true;
  *region = RETURN_APEX;
  Apex(k, o);
  return true;
}

/* Admissible and reached by flows that act outwards only? */
static bool Holds(const Trial3 *t, const Strength *k, const Active *s, const Closest *o)
{
  const double slack = 1e-12 * (fabs(t->y[0]) + fabs(t->y[1]) + fabs(t->y[2]) + k->c);

  for (int m = 0; m < s->n; m++) {
    if (o->mu[m] < 0.0)
      return false;
  }
  for (int plane = 0; plane < PLANE_COUNT; plane++) {
    if (Value(t, k, plane, o->y) > slack)
      return false;
  }
  return o->y[0] >= o->y[1] - slack && o->y[1] >= o->y[2] - slack;
}

static bool WithCutoff(const Trial3 *t, const Strength *k, Closest *o, ReturnRegion *region)
{
  static const Active set[] = {{1, {TENSION_1}},
                               {1, {PAIR_13}},
                               {2, {TENSION_1, TENSION_2}},
                               {2, {PAIR_13, TENSION_1}},
                               {2, {PAIR_13, PAIR_23}},
                               {2, {PAIR_13, PAIR_12}},
                               {3, {TENSION_1, TENSION_2, TENSION_3}},
                               {3, {PAIR_13, PAIR_12, TENSION_1}},
                               {3, {PAIR_13, TENSION_1, TENSION_2}},
                               {3, {PAIR_23, TENSION_1, TENSION_2}},
                               {3, {PAIR_13, PAIR_23, TENSION_1}},
                               {3, {PAIR_13, PAIR_23, TENSION_2}}};

  for (size_t i = 0; i < sizeof(set) / sizeof(*set); i++) {
    if (ClosestState(t, k, &set[i], o) && Holds(t, k, &set[i], o)) {
      *region = set[i].plane[set[i].n - 1] >= TENSION_1 ? RETURN_TENSION : set[i].n == 1 ? RETURN_FACE : RETURN_EDGE;
      return true;
    }
  }
  return false;
}

static bool AtStrength(const Trial3 *t, const Strength *k, Closest *o, ReturnRegion *region)
{
  const bool apex_first = !(sin(k->phi) * StrengthCutoff(t->law) < k->c * cos(k->phi));

  return apex_first ? NoCutoff(t, k, o, region) : WithCutoff(t, k, o, region);
}

/* Plastic strain less what the state asks for, and its slopes in itself, the trial stresses and S_h. */
static double Excess(const Trial3 *t, double eps, const Closest *o, const Strength *k, double *slope,
                     double by[BY_COUNT], double y_eps[3])
{
  const double over[3] = {t->y[0] - o->y[0], t->y[1] - o->y[1], t->y[2] - o->y[2]}, per = 1.0 / (t->G2 * t->E);
  double       dn[3];
  const double n = per * DeviatoricNorm(over, dn);

  *slope    = 1.0;
  by[BY_E]  = n / t->E;
  by[BY_SH] = 0.0;
  for (int j = 0; j < 3; j++)
    by[j] = -per * dn[j];
  for (int i = 0; i < 3; i++) {
    y_eps[i] = o->c[i] * k->c_e + o->phi[i] * k->phi_e + o->psi[i] * k->psi_e;
    *slope += per * dn[i] * y_eps[i];
    by[BY_SH] += per * dn[i] * (o->c[i] * k->c_S + o->psi[i] * k->psi_S);
    for (int j = 0; j < 3; j++)
      by[j] += per * dn[i] * o->dy[i][j];
  }
  return eps - t->eps - n;
}

static void Finish(const Closest *o, const Strength *k, double slope, const double by[BY_COUNT], const double y_eps[3],
                   bool slopes, Returned *r)
{
  for (int i = 0; i < 3; i++) {
    r->y[i] = o->y[i];
    for (int j = 0; slopes && j < BY_COUNT; j++) {
      const double direct = j < 3 ? o->dy[i][j] : j == BY_SH ? o->c[i] * k->c_S + o->psi[i] * k->psi_S : 0.0;

      r->dy[i][j] = direct - y_eps[i] * by[j] / slope;
    }
  }
}

/* Newton in the plastic strain, kept in a bracket: at its start the state asks for more, at the strain that takes the
   whole deviator away for less. */
bool ReturnPlanes(const Trial3 *t, bool slopes, Returned *r)
{
  double       dn[3], by[BY_COUNT], y_eps[3], slope;
  double       lo = t->eps, hi = t->eps + 2.0 * DeviatoricNorm(t->y, dn) / (t->G2 * t->E), eps = lo;
  const double close = 1e-16 + 1e-15 * hi;
  const bool   given = SofteningRate(t->law) == 0.0 || t->law->nonlocal > 0.0; /* strength, whatever the strain */

  r->region     = RETURN_FACE;
  r->iterations = 0;
  for (int it = 0; it < ITERATIONS; it++) {
    Strength k;
    Closest  o;

    r->iterations++;
    StrengthAt(t, eps, &k);
    if (!AtStrength(t, &k, &o, &r->region))
      return false;
    const double f         = Excess(t, eps, &o, &k, &slope, by, y_eps);
    *(f < 0.0 ? &lo : &hi) = eps;
    double next            = slope > 0.0 ? eps - f / slope : lo - 1.0;
    if (!(next >= lo && next <= hi))
      next = 0.5 * (lo + hi);
    if (fabs(next - eps) <= close || hi - lo <= 4.0 * close || given) {
      r->eps = given ? eps - f : eps;
      Finish(&o, &k, slope, by, y_eps, slopes, r);
      return slope > 0.0;
    }
    eps = next;
  }
  return false;
}

bool ReturnApex(const Trial3 *t, double slack, bool slopes, Returned *r)
{
  double       dn[3], y_eps[3];
  const double per = 1.0 / (t->G2 * t->E), n = per * DeviatoricNorm(t->y, dn), sm = (t->y[0] + t->y[1] + t->y[2]) / 3.0;
  const double by[BY_COUNT] = {-per * dn[0], -per * dn[1], -per * dn[2], n / t->E, 0.0};
  Strength     k;
  Closest      o;

  r->eps    = t->eps + n;
  r->region = RETURN_APEX;
  StrengthAt(t, r->eps, &k);
  if (!(k.phi > 0.0) || (sm + slack) * tan(k.phi) < k.c)
    return false;
  Apex(&k, &o);
  for (int i = 0; i < 3; i++)
    y_eps[i] = o.c[i] * k.c_e + o.phi[i] * k.phi_e;
  Finish(&o, &k, 1.0, by, y_eps, slopes, r);
  return true;
}
