/* The columns of probes.csv: their names, when they are there, and the value of a particle in each. */
#include "io_private.h"
#include <string.h>

/* A column, the quantity it belongs to, and the component of the store that holds it (-1: computed). */
/* One row for a number, four for a tensor. */
#define COLUMN_1(id, has, name, quantity) {name, has, quantity, id},
#define COLUMN_4(id, has, name, quantity)                                                                              \
  {name "_xx", has, quantity, id}, {name "_yy", has, quantity, id + 1}, {name "_zz", has, quantity, id + 2},           \
      {name "_xy", has, quantity, id + 3},
#define HISTORY_COLUMN(id, has, name, nc, unit, doc) COLUMN_##nc(id, has, name, QUANTITY_HISTORY + PLACE_##id)
#define HISTORY_PLACE(id, has, name, nc, unit, doc) PLACE_##id,
#define HISTORY_UNIT(id, has, name, nc, unit, doc) unit,
enum { CL_SKELETON_HISTORY(HISTORY_PLACE) };
static const char *const history_unit[] = {CL_SKELETON_HISTORY(HISTORY_UNIT)};
static const struct {
  const char *name;
  unsigned    has; /* fields it goes with */
  int         quantity, component;
} column[PROBE_COUNT] = {
    [PROBE_P] = {"p_Pa", HAS_WATER, QUANTITY_P, -1},
    {"p_w_Pa", HAS_WATER, QUANTITY_PW, P_PW},
    {"p_g_Pa", HAS_GAS_PRESSURE, QUANTITY_PG, P_PG},
    {"T_degC", HAS_HEAT, QUANTITY_T, P_T},
    {"S_h", HAS_ALL, QUANTITY_SH, P_SH},
    {"S_w", HAS_WATER, QUANTITY_SW, P_SW},
    [PROBE_SG] = {"S_g", HAS_GAS, QUANTITY_SG, -1},
    {"u_x_m", HAS_SOLID, QUANTITY_U, P_U},
    {"u_y_m", HAS_SOLID, QUANTITY_U, P_U + 1},
    {"sxx_Pa", HAS_SOLID, QUANTITY_STRESS, P_SIG},
    {"syy_Pa", HAS_SOLID, QUANTITY_STRESS, P_SIG + 1},
    {"szz_Pa", HAS_SOLID, QUANTITY_STRESS, P_SIG + 2},
    {"sxy_Pa", HAS_SOLID, QUANTITY_STRESS, P_SIG + 3},
    {"x_m", HAS_ALL, QUANTITY_X, P_X},
    {"y_m", HAS_ALL, QUANTITY_X, P_X + 1},
    [PROBE_HISTORY] = CL_SKELETON_HISTORY(HISTORY_COLUMN)[PROBE_MEAN] = {"p_eff_Pa", HAS_PLASTIC, QUANTITY_MEAN, -1},
    [PROBE_Q]                                                         = {"q_Pa", HAS_PLASTIC, QUANTITY_Q, -1},
    [PROBE_STRAIN]                                                    = {"eps_v", HAS_PLASTIC, QUANTITY_STRAIN, P_LOGJ},
    [PROBE_SHEAR]                                                     = {"eps_d", HAS_PLASTIC, QUANTITY_STRAIN, -1},
    [PROBE_MARGIN] = {"yield_distance_Pa", HAS_PLASTIC, QUANTITY_YIELD, -1},
    [PROBE_YIELDS] = {"yields", HAS_PLASTIC, QUANTITY_YIELD, -1}};

bool ProbeWanted(const Case *c, int q)
{
  return (c->scene.fields.has & column[q].has) && (c->quantities == 0 || ((c->quantities >> column[q].quantity) & 1u));
}

/* What a column of the skeleton's history adds to its name; the other names hold their unit. */
static const char *Unit(int q)
{
  const int   k    = column[q].quantity - QUANTITY_HISTORY;
  const char *unit = k >= 0 && k < SKELETON_HISTORY ? history_unit[k] : "-";

  return strcmp(unit, "-") ? unit : "";
}

void ProbesHeader(const Case *c, FILE *f)
{
  fprintf(f, "time_s");
  for (PetscInt k = 0; k < c->nprobe; k++) {
    for (int q = 0; q < PROBE_COUNT; q++) {
      if (ProbeWanted(c, q))
        fprintf(f, ",%s.%s%s%s", c->probe[k].name, column[q].name, *Unit(q) ? "_" : "", Unit(q));
    }
  }
  fprintf(f, "\n");
}

double ProbeQuantity(const Model *m, PetscInt p, int q)
{
  const Particles *P = &m->P;

  if (column[q].component >= 0)
    return P->f[column[q].component][p];
  switch (q) {
  case PROBE_P:
    return ParticlePressure(P, p);
  case PROBE_SG:
    return GasSaturation(P, p);
  case PROBE_SHEAR:
    return DerivedShear(m->c, P, p);
  case PROBE_MARGIN:
    return DerivedMargin(m, p);
  case PROBE_YIELDS:
    return P->f[P_YIELD][p] != (double)RETURN_ELASTIC;
  default:
    return DerivedStress(P, p, q == PROBE_Q);
  }
}
