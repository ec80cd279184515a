/* Names of the fields, and the sets of them. */
#include "clathra/fields.h"
#include <stdio.h>
#include <string.h>
#include <strings.h>

#define AXIS(name, equation, axis)                                                                                     \
  {                                                                                                                    \
    name "," axis, "m/s", equation ", " axis                                                                           \
  }
#if CL_DIM == 2
  #define AXES(name, equation) AXIS(name, equation, "x"), AXIS(name, equation, "y")
#else
  #define AXES(name, equation) AXIS(name, equation, "x"), AXIS(name, equation, "y"), AXIS(name, equation, "z")
#endif
const FieldInfo cl_field[F_COUNT] = {
    [F_VS] = AXES("v_s", "mixture momentum"), [F_VW] = AXES("v_w", "water momentum"),
    [F_VG] = AXES("v_g", "gas momentum"),     [F_PW] = {"p_w", "Pa", "water mass"},
    [F_PG] = {"p_g", "Pa", "gas mass"},       [F_T] = {"T", "degC", "energy"},
};

const char *const cl_field_word[] = {"solid", "water", "gas", "heat", NULL};

/* t heat, h fluids, m mechanics, c the gas that hydrate needs. */
static const struct {
  const char *name;
  unsigned    has;
} set_name[] = {
    {"thmc", HAS_ALL},
    {"thc", HAS_WATER | HAS_GAS | HAS_HEAT},
    {"hmc", HAS_SOLID | HAS_WATER | HAS_GAS},
    {"hc", HAS_WATER | HAS_GAS},
    {"thm", HAS_SOLID | HAS_WATER | HAS_HEAT},
    {"hm", HAS_SOLID | HAS_WATER},
    {"th", HAS_WATER | HAS_HEAT},
    {"h", HAS_WATER},
    {"tm", HAS_SOLID | HAS_HEAT},
    {"m", HAS_SOLID},
    {"t", HAS_HEAT},
};
#define SETS ((int)(sizeof(set_name) / sizeof(*set_name)))

bool FieldSetMake(unsigned has, bool inertia, FieldSet *fs)
{
  static const unsigned velocity[] = {HAS_SOLID, HAS_WATER, HAS_GAS}, scalar[] = {HAS_WATER, HAS_GAS, HAS_HEAT};

  *fs = (FieldSet){.has     = has,
                   .solid   = has & HAS_SOLID,
                   .heat    = has & HAS_HEAT,
                   .fluid   = has & (HAS_WATER | HAS_GAS),
                   .phase   = {has & HAS_WATER, has & HAS_GAS},
                   .inertia = inertia};
  for (int q = 0; q < F_COUNT; q++) {
    fs->at[q] = -1;
    if (!(has & (q < F_PW ? velocity[q / CL_DIM] : scalar[q - F_PW])))
      continue;
    fs->at[q]          = fs->n;
    fs->field[fs->n++] = q;
  }
  return fs->n > 0 && (fs->phase[PHASE_W] || !fs->phase[PHASE_G]);
}

void FieldSetPrint(const FieldSet *fs, char *text, int size)
{
  int n = 0;

  text[0] = '\0';
  for (int k = 0; cl_field_word[k]; k++) {
    if (fs->has & (1u << k) && n < size)
      n += snprintf(text + n, (size_t)(size - n), "%s%s", n ? ", " : "", cl_field_word[k]);
  }
  for (int k = 0; k < SETS; k++) {
    const bool reacts = (set_name[k].has & HAS_GAS) && (fs->has & HAS_HYDRATE), gas = set_name[k].has & HAS_GAS;

    if (set_name[k].has == (fs->has & HAS_ALL) && (reacts || !gas) && n < size) /* c is for hydrate */
      n += snprintf(text + n, (size_t)(size - n), " (%s)", set_name[k].name);
  }
  if (!fs->inertia && n < size)
    snprintf(text + n, (size_t)(size - n), ", quasi-static");
}

unsigned FieldSetByName(const char *name)
{
  for (int k = 0; k < SETS; k++) {
    if (!strcasecmp(set_name[k].name, name))
      return set_name[k].has;
  }
  return 0;
}
