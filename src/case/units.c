/* units: numbers with units, reduced to SI.  Decimal prefixes are kept as a power of ten and applied in one rounding,
   so that 20 mm is the same double as 0.02 m. */
#include "case_private.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const char *name;
  int         dim[UNIT_DIMS]; /* kg m s K mol deg */
  int         pow10;
  double      factor;
  bool        prefixed; /* takes k, M, m, ... */
} BaseUnit;

static const BaseUnit base_unit[] = {
    {"m", {0, 1, 0, 0, 0}, 0, 1, true},
    {"g", {1, 0, 0, 0, 0}, -3, 1, true},
    {"s", {0, 0, 1, 0, 0}, 0, 1, true},
    {"K", {0, 0, 0, 1, 0}, 0, 1, true},
    {"mol", {0, 0, 0, 0, 1}, 0, 1, true},
    {"Pa", {1, -1, -2, 0, 0}, 0, 1, true},
    {"N", {1, 1, -2, 0, 0}, 0, 1, true},
    {"J", {1, 2, -2, 0, 0}, 0, 1, true},
    {"W", {1, 2, -3, 0, 0}, 0, 1, true},
    {"Hz", {0, 0, -1, 0, 0}, 0, 1, true},
    {"bar", {1, -1, -2, 0, 0}, 5, 1, true},
    {"atm", {1, -1, -2, 0, 0}, 0, 101325, false},
    {"min", {0, 0, 1, 0, 0}, 0, 60, false},
    {"h", {0, 0, 1, 0, 0}, 0, 3600, false},
    {"d", {0, 0, 1, 0, 0}, 0, 86400, false},
    {"day", {0, 0, 1, 0, 0}, 0, 86400, false},
    {"seconds", {0, 0, 1, 0, 0}, 0, 1, false},
    {"minutes", {0, 0, 1, 0, 0}, 0, 60, false},
    {"hour", {0, 0, 1, 0, 0}, 0, 3600, false},
    {"hours", {0, 0, 1, 0, 0}, 0, 3600, false},
    {"days", {0, 0, 1, 0, 0}, 0, 86400, false},
    {"week", {0, 0, 1, 0, 0}, 0, 604800, false},
    {"weeks", {0, 0, 1, 0, 0}, 0, 604800, false},
    {"month", {0, 0, 1, 0, 0}, 0, 2629800, false}, /* a twelfth of a year */
    {"months", {0, 0, 1, 0, 0}, 0, 2629800, false},
    {"year", {0, 0, 1, 0, 0}, 0, 31557600, false}, /* 365.25 days */
    {"years", {0, 0, 1, 0, 0}, 0, 31557600, false},
    {"a", {0, 0, 1, 0, 0}, 0, 31557600, false},
    {"yr", {0, 0, 1, 0, 0}, 0, 31557600, false},
    {"degC", {0, 0, 0, 1, 0}, 0, 1, false},
    {"D", {0, 2, 0, 0, 0}, -19, 9869233, true},
    {"darcy", {0, 2, 0, 0, 0}, -19, 9869233, false},
    {"Darcy", {0, 2, 0, 0, 0}, -19, 9869233, false},
    {"P", {1, -1, -1, 0, 0}, -1, 1, true},
    {"L", {0, 3, 0, 0, 0}, -3, 1, true},
    {"t", {1, 0, 0, 0, 0}, 3, 1, false},
    {"%", {0, 0, 0, 0, 0}, -2, 1, false},
    {"deg", {0, 0, 0, 0, 0, 1}, 0, 1, false},
    {"rad", {0, 0, 0, 0, 0, 1}, 0, 57.29577951308232, false},
    {NULL, {0, 0, 0, 0, 0}, 0, 0, false},
};

static const struct {
  const char *name;
  int         pow10;
} unit_prefix[] = {
    {"da", 1}, {"T", 12}, {"G", 9},  {"M", 6},  {"k", 3},  {"h", 2},
    {"d", -1}, {"c", -2}, {"m", -3}, {"u", -6}, {"n", -9}, {"p", -12},
};

static const struct {
  const char *si, *name;
} quantity_name[] = {
    {"", "a plain number"},
    {"m", "a length"},
    {"s", "a time"},
    {"kg", "a mass"},
    {"Pa", "a pressure"},
    {"degC", "a temperature"},
    {"K", "a temperature in kelvin"},
    {"m^2", "a permeability"},
    {"m/s", "a velocity"},
    {"m/s^2", "an acceleration"},
    {"kg/m^3", "a density"},
    {"kg/mol", "a molar mass"},
    {"Pa s", "a viscosity"},
    {"J/(kg K)", "a specific heat"},
    {"J/kg", "an energy per mass"},
    {"J/mol", "an energy per amount"},
    {"W/(m K)", "a thermal conductivity"},
    {"W/m^2", "a heat flux"},
    {"W/m^3", "a heat source"},
    {"W/(m^2 K)", "a heat transfer coefficient"},
    {"Pa/s", "a pressure per time"},
    {"Pa/m", "a pressure per length"},
    {"K/s", "a temperature per time"},
    {"deg", "an angle"},
    {"1/K", "a thermal expansion"},
    {"1/m", "a surface per volume"},
    {"mol/(m^2 Pa s)", "a rate constant"},
    {"mol/(m^3 Pa)", "a solubility"},
};

const char *QuantityName(const char *si)
{
  for (size_t i = 0; i < sizeof quantity_name / sizeof *quantity_name; i++)
    if (!strcmp(si, quantity_name[i].si))
      return quantity_name[i].name;
  return "a quantity";
}

bool NumberParse(const char *text, double *value, const char **end)
{
  const char *p      = text;
  int         digits = 0;
  char       *stop;

  if (*p == '+' || *p == '-')
    p++;
  for (; isdigit((unsigned char)*p); p++)
    digits++;
  if (*p == '.')
    for (p++; isdigit((unsigned char)*p); p++)
      digits++;
  if (!digits)
    return false;
  if ((text[0] == '0' || text[1] == '0') && (*p == 'x' || *p == 'X'))
    return false;
  *value = strtod(text, &stop);
  *end   = stop;
  return isfinite(*value);
}

/* Rewrites the printable forms (degree sign, superscripts, micro, middle dot) to ASCII. */
static void ToAscii(const char *text, char *out, size_t size)
{
  static const char *const form[][2] = {{"\xc2\xb0"
                                         "C",
                                         "degC"},
                                        {"\xc2\xb2", "^2"},
                                        {"\xc2\xb3", "^3"},
                                        {"\xc2\xb5", "u"},
                                        {"\xce\xbc", "u"},
                                        {"\xc2\xb7", " "}};
  size_t                   n         = 0;

  while (*text && n + 5 < size) {
    size_t i, len = 0;
    for (i = 0; i < sizeof form / sizeof *form; i++) {
      len = strlen(form[i][0]);
      if (!strncmp(text, form[i][0], len))
        break;
    }
    if (i < sizeof form / sizeof *form) {
      for (const char *q = form[i][1]; *q; q++)
        out[n++] = *q;
      text += len;
    } else
      out[n++] = *text++;
  }
  out[n] = 0;
}

static bool UnitLookup(const char *name, BaseUnit *unit)
{
  for (const BaseUnit *u = base_unit; u->name; u++) {
    if (!strcmp(u->name, name)) {
      *unit = *u;
      return true;
    }
  }
  for (size_t i = 0; i < sizeof unit_prefix / sizeof *unit_prefix; i++) {
    size_t len = strlen(unit_prefix[i].name);
    if (strncmp(name, unit_prefix[i].name, len))
      continue;
    for (const BaseUnit *u = base_unit; u->name; u++) {
      if (u->prefixed && !strcmp(u->name, name + len)) {
        *unit = *u;
        unit->pow10 += unit_prefix[i].pow10;
        return true;
      }
    }
  }
  return false;
}

typedef struct {
  const char *p;
  int         depth;
  char       *why;
} UnitText;

static bool UnitProduct(UnitText *t, Unit *unit);

static void UnitTimes(Unit *a, const Unit *b, int power)
{
  for (int d = 0; d < UNIT_DIMS; d++)
    a->dim[d] += power * b->dim[d];
  a->pow10 += power * b->pow10;
  a->factor *= pow(power > 0 ? b->factor : b->divisor, abs(power));
  a->divisor *= pow(power > 0 ? b->divisor : b->factor, abs(power));
}

static bool UnitPower(UnitText *t, int *power)
{
  char *end;
  long  e;

  *power = 1;
  if (*t->p != '^')
    return true;
  e = strtol(t->p + 1, &end, 10);
  if (end == t->p + 1 || e < -9 || e > 9 || isspace((unsigned char)t->p[1])) {
    snprintf(t->why, CASE_WHY, "a whole exponent from -9 to 9 must follow '^'");
    return false;
  }
  t->p   = end;
  *power = (int)e;
  return true;
}

/* factor := name[^n] | 1 | ( product )[^n] */
static bool UnitFactor(UnitText *t, Unit *unit)
{
  char     name[16];
  size_t   n     = 0;
  int      power = 1;
  Unit     inner = {.factor = 1, .divisor = 1};
  BaseUnit base;

  memset(unit, 0, sizeof *unit);
  unit->factor = unit->divisor = 1;
  if (*t->p == '(') {
    t->p++;
    if (++t->depth > 4 || !UnitProduct(t, &inner))
      return false;
    t->depth--;
    if (*t->p != ')') {
      snprintf(t->why, CASE_WHY, "')' is missing in the unit");
      return false;
    }
    t->p++;
  } else if (t->p[0] == '1' && !isdigit((unsigned char)t->p[1]) && t->p[1] != '.') {
    t->p++;
    return true;
  } else {
    while ((isalpha((unsigned char)*t->p) || *t->p == '%') && n + 1 < sizeof name)
      name[n++] = *t->p++;
    name[n] = 0;
    if (!n || !UnitLookup(name, &base)) {
      if (n)
        snprintf(t->why, CASE_WHY, "'%s' is not a known unit", name);
      else
        snprintf(t->why, CASE_WHY, "'%.20s' is not a unit", t->p);
      return false;
    }
    memcpy(inner.dim, base.dim, sizeof inner.dim);
    inner.pow10   = base.pow10;
    inner.factor  = base.factor;
    inner.celsius = !strcmp(name, "degC");
  }
  if (!UnitPower(t, &power))
    return false;
  UnitTimes(unit, &inner, power);
  unit->celsius = inner.celsius && power == 1;
  return true;
}

/* product := factor { (' ' | '*' | '/') factor }: '/' divides by the next factor only */
static bool UnitProduct(UnitText *t, Unit *unit)
{
  Unit next;
  int  n = 0, sign = 1;

  memset(unit, 0, sizeof *unit);
  unit->factor = unit->divisor = 1;
  while (true) {
    bool celsius;
    while (*t->p == ' ')
      t->p++;
    if (!UnitFactor(t, &next))
      return false;
    celsius = n++ == 0 && next.celsius && sign == 1;
    UnitTimes(unit, &next, sign);
    unit->celsius = celsius;
    while (*t->p == ' ')
      t->p++;
    if (!*t->p || *t->p == ')')
      return true;
    sign = *t->p == '/' ? -1 : 1;
    if (*t->p == '/' || *t->p == '*')
      t->p++;
    if (n > 12) {
      snprintf(t->why, CASE_WHY, "the unit is too long");
      return false;
    }
  }
}

bool UnitParse(const char *text, Unit *unit, char why[CASE_WHY])
{
  char     ascii[128];
  UnitText t = {ascii, 0, why};

  memset(unit, 0, sizeof *unit);
  unit->factor = unit->divisor = 1;
  snprintf(why, CASE_WHY, "the unit cannot be read");
  ToAscii(text, ascii, sizeof ascii);
  while (*t.p == ' ')
    t.p++;
  if (!*t.p)
    return true;
  if (!UnitProduct(&t, unit))
    return false;
  return !*t.p;
}

static double UnitApply(const Unit *u, double number)
{
  double value = number * u->factor / u->divisor;
  return u->pow10 >= 0 ? value * pow(10.0, u->pow10) : value / pow(10.0, -u->pow10);
}

bool QuantityParse(const char *text, const char *si, double *value, char why[CASE_WHY])
{
  const char *rest;
  Unit        want, unit;
  double      number;
  char        reason[CASE_WHY];
  bool        absolute = !strcmp(si, "degC"), plain;

  while (*text == ' ')
    text++;
  if (!UnitParse(si, &want, why))
    return false;
  if (!NumberParse(text, &number, &rest)) {
    snprintf(why, CASE_WHY, "must be a finite number%s%s", *si ? " and a unit, e.g. 1 " : "", si);
    return false;
  }
  while (*rest == ' ')
    rest++;
  plain = !*rest;
  if (!UnitParse(rest, &unit, reason)) {
    snprintf(why, CASE_WHY, "%.120s; expected %s%s%s", reason, QuantityName(si), *si ? ", e.g. in " : "", si);
    return false;
  }
  if (plain && *si) {
    snprintf(why, CASE_WHY, "needs the unit of %s, e.g. %.40s %s", QuantityName(si), text, si);
    return false;
  }
  if (memcmp(unit.dim, want.dim, sizeof want.dim)) {
    if (*si)
      snprintf(why, CASE_WHY, "the unit '%.40s' does not measure %s; write it e.g. in %s", rest, QuantityName(si), si);
    else
      snprintf(why, CASE_WHY, "takes no unit, but '%.40s' is given", rest);
    return false;
  }
  if (unit.celsius && !absolute) {
    snprintf(why, CASE_WHY, "is not a temperature on the Celsius scale; write it in K");
    return false;
  }
  *value = UnitApply(&unit, number);
  if (absolute && !unit.celsius)
    *value -= CL_ZERO_CELSIUS;
  if (!isfinite(*value)) {
    snprintf(why, CASE_WHY, "is not a finite number");
    return false;
  }
  return true;
}
