/* The columns of probes.csv: their names, when they are there, and the value of a particle in each. */
#include "io_private.h"
#include <string.h>

/* A column, the quantity it belongs to, and the component of the store that holds it, or COMPUTED + a row of
   io_derived, which then has its name, unit and fields. */
#define COMPUTED P_COUNT
#define DERIVED(row, quantity)                                                                                         \
  {                                                                                                                    \
    NULL, 0, quantity, COMPUTED + (row)                                                                                \
  }
#if CL_DIM == 2
  #define IN_SPACE(...)
#else
  #define IN_SPACE(...) __VA_ARGS__
#endif
/* One row for a number, CL_TENSOR for a tensor. */
#define COLUMN_1(id, has, name, quantity) {name, has, quantity, id},
#define COLUMN_CL_TENSOR(id, has, name, quantity)                                                                      \
  {name "_xx", has, quantity, id}, {name "_yy", has, quantity, id + 1}, {name "_zz", has, quantity, id + 2},           \
      {name "_xy", has, quantity, id + 3},                                                                             \
      IN_SPACE({name "_yz", has, quantity, id + 4}, {name "_xz", has, quantity, id + 5}, )
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
    [PROBE_P] = DERIVED(DERIVED_P, QUANTITY_P),
    {"p_w_Pa", HAS_WATER, QUANTITY_PW, P_PW},
    {"p_g_Pa", HAS_GAS, QUANTITY_PG, P_PG},
    {"T_degC", HAS_HEAT, QUANTITY_T, P_T},
    {"S_h", HAS_ALL, QUANTITY_SH, P_SH},
    {"S_w", HAS_WATER, QUANTITY_SW, P_SW},
    [PROBE_SG] = DERIVED(DERIVED_SG, QUANTITY_SG),
    {"u_x_m", HAS_SOLID, QUANTITY_U, P_U},
    {"u_y_m", HAS_SOLID, QUANTITY_U, P_U + 1},
    IN_SPACE({"u_z_m", HAS_SOLID, QUANTITY_U, P_U + 2}, ){"sxx_Pa", HAS_SOLID, QUANTITY_STRESS, P_SIG},
    {"syy_Pa", HAS_SOLID, QUANTITY_STRESS, P_SIG + 1},
    {"szz_Pa", HAS_SOLID, QUANTITY_STRESS, P_SIG + 2},
    {"sxy_Pa", HAS_SOLID, QUANTITY_STRESS, P_SIG + 3},
    IN_SPACE({"syz_Pa", HAS_SOLID, QUANTITY_STRESS, P_SIG + 4},
             {"sxz_Pa", HAS_SOLID, QUANTITY_STRESS, P_SIG + 5}, ){"x_m", HAS_ALL, QUANTITY_X, P_X},
    {"y_m", HAS_ALL, QUANTITY_X, P_X + 1},
    IN_SPACE({"z_m", HAS_ALL, QUANTITY_X, P_X + 2}, )[PROBE_HISTORY] = CL_SKELETON_HISTORY(HISTORY_COLUMN)[PROBE_MEAN] =
        DERIVED(DERIVED_MEAN, QUANTITY_MEAN),
    [PROBE_Q]      = DERIVED(DERIVED_Q, QUANTITY_Q),
    [PROBE_STRAIN] = {"eps_v", HAS_PLASTIC, QUANTITY_STRAIN, P_LOGJ},
    [PROBE_SHEAR]  = DERIVED(DERIVED_SHEAR, QUANTITY_STRAIN),
    [PROBE_MARGIN] = DERIVED(DERIVED_MARGIN, QUANTITY_YIELD),
    [PROBE_YIELDS] = DERIVED(DERIVED_YIELDS, QUANTITY_YIELD)};

static const DerivedQuantity *Derived(int q)
{
  return column[q].component >= COMPUTED ? &io_derived[column[q].component - COMPUTED] : NULL;
}

bool ProbeWanted(const Case *c, int q)
{
  const unsigned has = Derived(q) ? Derived(q)->has : column[q].has;

  return (c->scene.fields.has & has) && (c->quantities == 0 || ((c->quantities >> column[q].quantity) & 1u));
}

/* What a column adds to its name, of the skeleton's history or computed; the other names hold their unit. */
static const char *Unit(int q)
{
  const int   k    = column[q].quantity - QUANTITY_HISTORY;
  const char *unit = Derived(q) ? Derived(q)->unit : k >= 0 && k < SKELETON_HISTORY ? history_unit[k] : "-";

  return strcmp(unit, "-") ? unit : "";
}

void ProbesHeader(const Case *c, FILE *f)
{
  fprintf(f, "time_s");
  for (PetscInt k = 0; k < c->nprobe; k++) {
    for (int q = 0; q < PROBE_COUNT; q++) {
      if (ProbeWanted(c, q))
        fprintf(f, ",%s.%s%s%s", c->probe[k].name, Derived(q) ? Derived(q)->name : column[q].name, *Unit(q) ? "_" : "",
                Unit(q));
    }
  }
  fprintf(f, "\n");
}

double ProbeQuantity(const Model *m, PetscInt p, int q)
{
  return Derived(q) ? Derived(q)->of(m, p) : m->P.f[column[q].component][p];
}
