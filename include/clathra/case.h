/* case: everything a scene says, in SI units (T in degC), read from cases/<name>/case.yaml and the command line. */
#pragma once

#include "clathra/conditions.h"
#include "clathra/lines.h"
#include "clathra/material.h"
#include "clathra/skeleton.h"

typedef struct {
  PetscInt n, *i; /* indices into a list of the case */
} Names;

typedef enum { SHAPE_BOX = 0, SHAPE_POLYGON, SHAPE_BELOW, SHAPE_CIRCLE } ShapeKind;

typedef struct {
  char     name[64];
  double   lower[CL_DIM], upper[CL_DIM]; /* m: the box, or bounds of another shape */
  PetscInt ppc[CL_DIM];                  /* particles per cell, per axis */
  PetscInt material;                     /* index into Case.material; -1: no particles, only cut out of others */
  /* initial state */
  double pressure;     /* mean pore pressure (10), Pa */
  double temperature;  /* degC */
  double Sh, Sw, Sg;   /* saturations of the pore space; sum 1 */
  double stress[6];    /* initial effective stress, tension-positive: xx yy zz xy yz xz, Pa */
  double K0;           /* stress: vertical from the weight above, horizontal K0 times it; infinite: from `stress` */
  bool   consolidated; /* the same, with K0 = 1 - sin(friction angle) */
  bool   hydrostatic;  /* water in balance with gravity */
  double datum;        /* m: coordinate against gravity where p = pressure */
  double geothermal,
      geothermal_datum; /* K/m below it, m (infinite: top of the body); T = temperature there and above */
  ShapeKind shape;
  Points    polygon;   /* closed by itself */
  Points    below;     /* all under this line, down to `lower` */
  double    circle[3]; /* centre and radius, m */
  Names     minus;     /* regions whose shapes are cut out */
} Region;

/* What a probe writes; words in src/case/quantities.c. */
enum {
  QUANTITY_P = 0,
  QUANTITY_PW,
  QUANTITY_PG,
  QUANTITY_T,
  QUANTITY_SH,
  QUANTITY_SW,
  QUANTITY_SG,
  QUANTITY_U,
  QUANTITY_STRESS,
  QUANTITY_X,
  QUANTITY_HISTORY,                                    /* of the skeleton, variable by variable */
  QUANTITY_MEAN = QUANTITY_HISTORY + SKELETON_HISTORY, /* mean effective stress, compression-positive */
  QUANTITY_Q,                                          /* deviatoric stress sqrt(3 J2) */
  QUANTITY_STRAIN,                                     /* volumetric and deviatoric */
  QUANTITY_YIELD,                                      /* distance to yield; is it reached? */
  QUANTITY_COUNT
};

#define CL_METERS 16 /* at most */

/* Counts what crosses a part of the body's surface, whatever the conditions there. */
typedef struct {
  char     name[64];
  Side     side;
  PetscInt region;   /* -1: all */
  double   from, to; /* m, along the side */
  Points   along;    /* or those on this line */
} Meter;

/* A point whose history is written, or what the history of a mean is taken over. */
typedef struct {
  char     name[64];
  double   x[CL_DIM]; /* m, initial position; infinite: a mean */
  bool     fixed;     /* stays there in space, not with the material */
  PetscInt over;      /* mean over this region, by volume; -1: not */
  Meter    surface;   /* mean over this part of the surface, by area; SIDE_COUNT without a line: not */
} Probe;

enum { WITHOUT_GAS_AUTO = 0, WITHOUT_GAS_YES, WITHOUT_GAS_NO };
enum { ICE_WARN = 0, ICE_STOP };
enum { SURFACE_FREE = 0, SURFACE_TIED, SURFACE_VELOCITIES_FREE }; /* (41): nothing, all, p and T alone */
enum { PRESSURES_NODES = 0, PRESSURES_PARTICLES, PRESSURES_RELATIVE };
typedef enum { BASIS_CPGIMP, BASIS_UGIMP, BASIS_LINEAR } BasisType;

#define SPACING 1024 /* characters */

typedef struct Case {
  char      file[PETSC_MAX_PATH_LEN]; /* the case file */
  char      title[256];
  double    lower[CL_DIM], upper[CL_DIM]; /* background grid, m */
  PetscInt  cells[CL_DIM];
  char      spacing[CL_DIM][SPACING]; /* as given; none: equal cells */
  char      table[CL_DIM][SPACING];   /* the other form of it */
  GridLines line[CL_DIM];             /* of an axis with a spacing */
  BasisType basis;
  bool      axisymmetric;      /* x is the radius, y runs along the axis; all per full ring */
  char      fields_wanted[64]; /* auto, or the words of cl_field_word, or the name of a set */
  bool      inertia, one_pressure;
  bool      compression_heat;                /* heat of compression and throttling of the fluids (290) */
  FieldSet  fields;                          /* what the scene needs, as named or derived */
  double    gravity[CL_DIM];                 /* m/s^2 */
  double    gravity_ramp;                    /* s: it grows from gravity_before over this time; 0 = at once */
  bool      mean_dilatation;                 /* volume change of the cell, not of the particle's own place (88) */
  double    mean_strain;                     /* share of the cell's mean in a particle's strain (160) */
  double    strength_factor;                 /* all strength is divided by it (87) */
  int       ice;                             /* ICE_... */
  int       without_gas;                     /* WITHOUT_GAS_... */
  Schedule  ambient_pressure, ambient_level; /* of the fluid around the body: Pa; m, coordinate against gravity */
  double    ambient_density;                 /* kg/m^3 */
  double    ambient_drag;                    /* C of (152) */
  PetscInt  nmaterial, nregion, nbc, nprobe, nmeter;
  Material *material;
  Region   *region;
  Bc       *bc;
  Probe    *probe;
  Meter    *meter;
  double    standard_pressure, standard_temperature; /* Pa, degC: what standard volumes are said to be at */
  double    standard_gas_density;                    /* kg/m^3 there: what they are computed with */
  /* stabilisation */
  double ghost_penalty;       /* g, 0 = off; default 0.1 */
  double ghost_storage;       /* g_s, 0 = off (default) */
  double pressure_projection; /* alpha, 0 = off; default 1 */
  bool   flux_interpolation;  /* momentum-interpolated mass flux; default true */
  bool   upstream;            /* drag of the fluids from upstream; default false */
  bool   saturation_upwind;   /* (200); default false */
  bool   heat_upwind;         /* (293); default false */
  bool   lumped_reaction;     /* (265); default false */
  /* time: the command line's -stepper_* options win over these */
  double   t_end;
  char     stepper[16]; /* sdirk2 | euler | hybrid | explicit | auto */
  bool     adaptive;
  double   dt, dt_min, dt_max; /* s; dt = first (adaptive) or fixed step */
  double   tol;                /* relative tolerance of the error estimate */
  double   error_exponent;     /* of its mean over the particles (292) */
  PetscInt max_failures;       /* cuts in a row before the run is given up */
  /* hybrid and explicit */
  double cfl;          /* step as a share of the stable one */
  bool   force_dt;     /* take a fixed step above the stable one all the same */
  double flip;         /* 1: FLIP, 0: PIC */
  double relaxation;   /* s: pressures and temperature of particles tend to those of the nodes; INFINITY: never */
  double damping;      /* local damping */
  double mass_scaling; /* factor on inertia */
  int    surface;      /* SURFACE_...: what of nearly empty nodes follows their fullest neighbour in part */
  int    pressures;    /* PRESSURES_...: rates of pressure shared over nodes, by the particle (the paper's form), or
                          shared, p_g's in proportion */
  /* output */
  char     output_dir[PETSC_MAX_PATH_LEN]; /* default results/<case name> */
  PetscInt ntimes;                         /* field snapshots at these times (hit exactly) ... */
  double  *times;
  char     quantities_wanted[128]; /* all, or words */
  unsigned quantities;             /* bits 1 << QUANTITY_... that probes write; 0 = all of the scene's fields */
  double   every;                  /* ... and every so many seconds (0 = off) */
  double   probe_every;            /* s between probe rows, hit exactly; 0 = every step */
  double   checkpoint_every;       /* s; 0 = only at the end and on failure */
  /* stages, the same in the case and in all of them; where this one starts from (of the case: zeros) */
  PetscInt          nstage;
  struct CaseStage *stage;
  double            t_begin, gravity_before[CL_DIM]; /* s, m/s^2 */
  PetscInt          nlisted;
  const Bc         *listed; /* all boundaries of the case */
} Case;

/* The grid's lines along an axis; they stay the case's. */
static inline GridLines CaseLines(const Case *c, int d)
{
  return c->line[d].x ? c->line[d] : LinesEqual(c->lower[d], c->upper[d], c->cells[d]);
}

/* One of the stages of a run, which follow each other in time. */
typedef struct CaseStage {
  char   name[64];
  double end;                         /* s; it begins where the one before ends */
  bool   reset;                       /* displacements count from its begin */
  bool   reaction;                    /* hydrate forms and dissociates, where a material reacts */
  char   boundaries[2048], off[2048]; /* those that act: all, or names; or all but these names */
  char   materials[2048];             /* region, material, region, material, ... */
  Case   c; /* the case as it holds in this stage: conditions and materials of its own, the rest shared */
} CaseStage;

/* The case as it holds in stage k; the case itself if it has no stages. */
static inline const Case *CaseInStage(const Case *c, PetscInt k)
{
  return c->nstage ? &c->stage[k].c : c;
}

/* Times closer than this are the same, s. */
static inline double CaseTimeSlack(const Case *c, double t)
{
  return 1e-12 * fabs(t - c->t_begin) + 4.0 * PETSC_MACHINE_EPSILON * fabs(t);
}

static inline bool CaseAtEnd(const Case *c, double t)
{
  return t >= c->t_end - CaseTimeSlack(c, c->t_end);
}

static inline double CaseGravity(const Case *c) /* m/s^2 */
{
  return hypot(c->gravity[0], c->gravity[1]);
}

/* Coordinate against gravity, m; 0 without gravity. */
static inline double CaseHeight(const Case *c, const double x[])
{
  const double g = CaseGravity(c);

  return g > 0.0 ? -(x[0] * c->gravity[0] + x[1] * c->gravity[1]) / g : 0.0;
}

/* Axis that gravity points along, -1 if it is oblique or zero. */
static inline int CaseVertical(const Case *c)
{
  return (c->gravity[0] != 0.0) == (c->gravity[1] != 0.0) ? -1 : c->gravity[0] != 0.0 ? 0 : 1;
}

/* Height of the highest point of the regions, m. */
double CaseTop(const Case *c);

static inline bool RegionGeostatic(const Region *r)
{
  return r->consolidated || (r->K0 > 0.0 && !isinf(r->K0));
}

/* Friction angle of a material, rad; NAN for one that has none. */
static inline double MaterialFrictionAngle(const Material *m)
{
  return m->plasticity.type != PLASTICITY_MOHR_COULOMB ? NAN : m->plasticity.phi_peak * M_PI / 180.0;
}

/* Horizontal over vertical effective stress of a geostatic region; NAN without a friction angle. */
static inline double RegionK0(const Case *c, const Region *r)
{
  return r->consolidated ? 1.0 - sin(MaterialFrictionAngle(&c->material[r->material])) : r->K0;
}

/* Does a region start without gas where there are two pressures (section 19 of docs/equations.md)? */
static inline bool CaseStartsWithoutGas(const Case *c)
{
  bool without = false;

  for (PetscInt k = 0; k < c->nregion; k++) /* a region without material holds nothing: it names a place */
    without = without || ((c->fields.has & HAS_GAS_PRESSURE) && c->region[k].material >= 0 && c->region[k].Sg == 0.0);
  return without;
}

/* ... and is gas let in? */
static inline bool CaseLetsGasIn(const Case *c)
{
  bool enters = false;

  for (PetscInt k = 0; k < c->nbc; k++) {
    const Schedule *gas = &c->bc[k].phase[PHASE_G];

    for (PetscInt i = 0; c->bc[k].type == BC_INFLOW && i < gas->n; i++)
      enters = enters || gas->y[i] > 0.0;
  }
  return enters && CaseStartsWithoutGas(c);
}

/* k_p of (350) over the first material's k0, at a saturation of hydrate. */
static inline double CaseConductance(const Case *c, const Material *mat, double Sh)
{
  const Permeability *law = &mat->permeability;
  double              slope;

  return law->k0 * (mat->reacts ? 1.0 : law->hydrate_factor(law, Sh, &slope)) / c->material[0].permeability.k0;
}

/* The largest ratio of k_p of the regions at the start; 1 without fluids.  Where it is 1, so are the weights (350). */
static inline double CaseContrast(const Case *c)
{
  double least = INFINITY, most = 0.0;

  for (PetscInt k = 0; c->fields.fluid && k < c->nregion; k++) {
    if (c->region[k].material < 0)
      continue;
    const double conduct = CaseConductance(c, &c->material[c->region[k].material], c->region[k].Sh);

    least = fmin(least, conduct);
    most  = fmax(most, conduct);
  }
  return most > 0.0 ? most / least : 1.0;
}

/* First condition that the integrators without a matrix do not know, or NULL. */
static inline const Bc *CaseBcNeedsMatrix(const Case *c)
{
  for (PetscInt k = 0; k < c->nbc; k++) {
    if (c->bc[k].type != BC_NONE && !(BC_LOCAL >> c->bc[k].type & 1u))
      return &c->bc[k];
  }
  return NULL;
}

/* What keeps a scene from the integrators without a matrix, as the case says it (a boundary by its name); NULL if
   nothing does. */
static inline const char *CaseNeedsImplicit(const Case *c)
{
  const Bc *b = CaseBcNeedsMatrix(c);

  return b                      ? b->name
         : c->axisymmetric      ? "geometry: axisymmetric"
         : c->one_pressure      ? "pressures: one"
         : c->upstream          ? "stabilisation_upstream"
         : c->saturation_upwind ? "stabilisation_saturation"
         : c->lumped_reaction   ? "stabilisation_reaction"
         : !c->inertia          ? "inertia: no"
         : CaseLetsGasIn(c)     ? "an inflow of gas where a region has Sg: 0"
                                : NULL;
}

/* Reads and checks a case (a folder or a .yaml file) together with the options database, collectively.
   On bad input prints the error (file, key, value, unit, allowed range, nearest key) on rank 0, sets *ok = false and
   returns success; nothing has been written. */
PetscErrorCode CaseRead(MPI_Comm comm, const char *path, Case *c, bool *ok);
PetscErrorCode CaseWriteResolved(const Case *c, FILE *out); /* SI, itself a case that runs to the same result */
/* What a restart must find unchanged: all keys but names, outputs, and the numerics of time and of the solver. */
uint64_t CaseFingerprint(const Case *c);
/* What a state of its particles needs to be the initial state of another case: lines "key: value" of the grid, regions
   and what their materials tie it to, in SI; both cases must have the same. */
PetscErrorCode CaseWriteState(const Case *c, FILE *out);
/* What CaseWriteResolved or CaseWriteState writes, to be freed. */
PetscErrorCode CaseText(const Case *c, PetscErrorCode (*write)(const Case *c, FILE *out), char **text, size_t *size);
PetscErrorCode CaseDestroy(Case *c);
/* Prints every case key (name, kind, unit, range, default, meaning) as Markdown: the source of docs/options.md and
 * -help. */
PetscErrorCode CasePrintKeys(FILE *out);
