/* scene: what a case says of the body, its surroundings and how they are modelled, in SI units (T in degC): all that
   the physics sees of a case. */
#pragma once

#include "clathra/conditions.h"
#include "clathra/lines.h"
#include "clathra/material.h"
#include "clathra/skeleton.h"

typedef struct {
  PetscInt n, *i; /* indices into a list of the case */
} Names;

/* In space polygons, lines and circles are prisms along z. */
typedef enum { SHAPE_BOX = 0, SHAPE_POLYGON, SHAPE_BELOW, SHAPE_CIRCLE } ShapeKind;

typedef struct {
  char     name[64];
  double   lower[CL_DIM], upper[CL_DIM]; /* m: the box, or bounds of another shape */
  PetscInt ppc[CL_DIM];                  /* particles per cell, per axis */
  PetscInt material;                     /* index into Scene.material; -1: no particles, only cut out of others */
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

#define CL_METERS 16 /* at most */

/* Counts what crosses a part of the body's surface, whatever the conditions there. */
typedef struct {
  char     name[64];
  Side     side;
  PetscInt region;   /* -1: all */
  double   from, to; /* m, along the side, in the plane */
  Points   along;    /* or those on this line */
  PetscInt well;     /* or the particles of this well, its place in the list of the case; -1: none */
} Meter;

enum { WITHOUT_GAS_AUTO = 0, WITHOUT_GAS_YES, WITHOUT_GAS_NO };
/* BASIS_TOTAL: uGIMP on the initial configuration, whose cells deform with the body (445). */
typedef enum { BASIS_CPGIMP, BASIS_UGIMP, BASIS_LINEAR, BASIS_TOTAL } BasisType;

#define SPACING 1024 /* characters */

/* Numerics of the model, which a restart may change. */
typedef struct {
  double ghost_penalty; /* g, 0 = off; default 0.1 */
  bool   donor;         /* (332): gas has the mobility of where it comes from; default false */
} Stabilisation;

typedef struct Scene {
  double        lower[CL_DIM], upper[CL_DIM]; /* background grid, m */
  PetscInt      cells[CL_DIM];
  char          spacing[CL_DIM][SPACING]; /* as given; none: equal cells */
  char          table[CL_DIM][SPACING];   /* the other form of it */
  GridLines     line[CL_DIM];             /* of an axis with a spacing */
  BasisType     basis;
  bool          axisymmetric; /* x is the radius, y runs along the axis; all per full ring */
  bool          inertia;
  bool          compression_heat;                /* heat of compression and throttling of the fluids (290) */
  FieldSet      fields;                          /* what the scene needs, as named or derived */
  double        gravity[CL_DIM];                 /* m/s^2 */
  double        gravity_ramp;                    /* s: it grows from gravity_before over this time; 0 = at once */
  double        t_begin, gravity_before[CL_DIM]; /* where a stage starts from, s, m/s^2; of a whole case zeros */
  double        mean_strain;                     /* share of the cell's mean in a particle's strain (160) */
  double        strength_factor;                 /* all strength is divided by it (87) */
  int           without_gas;                     /* WITHOUT_GAS_... */
  Schedule      ambient_pressure, ambient_level; /* of the fluid around the body: Pa; m, coordinate against gravity */
  double        ambient_density;                 /* kg/m^3 */
  double        ambient_drag;                    /* C of (152) */
  PetscInt      nmaterial, nregion, nbc, nmeter;
  Material     *material;
  Region       *region;
  Bc           *bc; /* those that act */
  PetscInt      nlisted;
  const Bc     *listed; /* all boundaries of the case, also those that do not act in this stage */
  Meter        *meter;
  Stabilisation stabilisation;
} Scene;

/* The grid's lines along an axis; they stay the case's. */
static inline GridLines SceneLines(const Scene *c, int d)
{
  return c->line[d].x ? c->line[d] : LinesEqual(c->lower[d], c->upper[d], c->cells[d]);
}

/* Times closer than this are the same, s. */
static inline double SceneTimeSlack(const Scene *c, double t)
{
  return 1e-12 * fabs(t - c->t_begin) + 4.0 * PETSC_MACHINE_EPSILON * fabs(t);
}

/* Its magnitude once the ramp is over, m/s^2. */
static inline double SceneGravity(const Scene *c) /* m/s^2 */
{
  return VectorLength(c->gravity);
}

/* Coordinate against gravity, m; 0 without gravity. */
static inline double SceneHeight(const Scene *c, const double x[])
{
  const double g = SceneGravity(c);

  return g > 0.0 ? -VectorDot(x, c->gravity) / g : 0.0;
}

/* Unit vector against gravity times `sign`, both dimensionless; not without gravity. */
static inline void SceneUp(const Scene *c, double sign, double up[CL_DIM])
{
  const double g = SceneGravity(c);

  for (int d = 0; d < CL_DIM; d++)
    up[d] = -sign * c->gravity[d] / g;
}

/* Axis that layers lie across: the one nearest to gravity's direction, the later of two; -1 without gravity. */
static inline int SceneVertical(const Scene *c)
{
  int axis = -1;

  for (int d = 0; d < CL_DIM; d++)
    axis = c->gravity[d] != 0.0 && (axis < 0 || fabs(c->gravity[d]) >= fabs(c->gravity[axis])) ? d : axis;
  return axis;
}

/* Middle of a region's bounds, m. */
static inline void RegionMiddle(const Region *r, double x[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    x[d] = 0.5 * (r->lower[d] + r->upper[d]);
}

/* Does the stress of the region follow from the weight above it? */
static inline bool RegionGeostatic(const Region *r)
{
  return r->consolidated || (r->K0 > 0.0 && !isinf(r->K0));
}

/* Does it start without a stress? */
static inline bool RegionUnstressed(const Region *r)
{
  bool without = !RegionGeostatic(r);

  for (int i = 0; i < 6; i++)
    without = without && r->stress[i] == 0.0;
  return without;
}

/* Friction angle of a material, rad; NAN for one that has none. */
static inline double MaterialFrictionAngle(const Material *m)
{
  return m->plasticity.type != PLASTICITY_MOHR_COULOMB ? NAN : m->plasticity.phi_peak * M_PI / 180.0;
}

/* Horizontal over vertical effective stress of a geostatic region, dimensionless; NAN without a friction angle. */
static inline double RegionK0(const Scene *c, const Region *r)
{
  return r->consolidated ? 1.0 - sin(MaterialFrictionAngle(&c->material[r->material])) : r->K0;
}

/* Does hydrate form or melt anywhere? */
static inline bool SceneReacts(const Scene *c)
{
  bool reacts = false;

  for (PetscInt k = 0; k < c->nmaterial; k++)
    reacts = reacts || c->material[k].reacts;
  return reacts;
}

/* Does a region start without gas in a scene that has some (section 19 of docs/equations.md)? */
static inline bool SceneStartsWithoutGas(const Scene *c)
{
  bool without = false;

  for (PetscInt k = 0; k < c->nregion; k++) /* a region without material holds nothing: it names a place */
    without = without || ((c->fields.has & HAS_GAS) && c->region[k].material >= 0 && c->region[k].Sg == 0.0);
  return without;
}

/* Is a fluid let in by its rate? */
static inline bool SceneLetsIn(const Scene *c, int f)
{
  bool enters = false;

  for (PetscInt k = 0; k < c->nbc; k++) {
    const Schedule *rate = c->bc[k].type == BC_WELL ? &c->bc[k].rate[f] : &c->bc[k].phase[f];

    for (PetscInt i = 0; (c->bc[k].type == BC_INFLOW || c->bc[k].type == BC_WELL) && i < rate->n; i++)
      enters = enters || rate->y[i] > 0.0;
  }
  return enters;
}

/* Is gas let in where a region starts without? */
static inline bool SceneLetsGasIn(const Scene *c)
{
  return SceneLetsIn(c, PHASE_G) && SceneStartsWithoutGas(c);
}

/* Is there gas from the start on or let in (200)?  Else it comes from hydrate alone. */
static inline bool SceneCarriesGas(const Scene *c)
{
  bool carries = SceneLetsIn(c, PHASE_G);

  for (PetscInt k = 0; k < c->nregion; k++)
    carries = carries || (c->region[k].material >= 0 && c->region[k].Sg > 0.0);
  return carries;
}

/* Does all of the sediment hold gas, so that its pressure may change in proportion to itself (151), (416)?  Not where
   it may vanish (101). */
static inline bool SceneKeepsGas(const Scene *c)
{
  return (c->fields.has & HAS_GAS) && c->nmaterial > 0 && c->material[0].gas.trace == 0.0;
}

/* Are saturations carried wherever they bend (456), as fronts are let in or gas may vanish?  Else where they alternate.
 */
static inline bool SceneHasFronts(const Scene *c)
{
  return SceneLetsIn(c, PHASE_W) || SceneLetsIn(c, PHASE_G) || !SceneKeepsGas(c);
}

/* Has gas the mobility of where it comes from (332)? */
static inline bool SceneDonor(const Scene *c)
{
  return c->stabilisation.donor && c->fields.phase[PHASE_G];
}

/* k_p of (350) over the first material's k0, at a saturation of hydrate. */
static inline double SceneConductance(const Scene *c, const Material *mat, double Sh)
{
  const Permeability *law = &mat->permeability;
  double              slope;

  return law->k0 * (mat->reacts ? 1.0 : law->hydrate_factor(law, Sh, &slope)) / c->material[0].permeability.k0;
}

/* The largest ratio of k_p of the regions at the start; 1 without fluids; dimensionless.  Where it is 1, so are the
 * weights (350). */
static inline double SceneContrast(const Scene *c)
{
  double least = INFINITY, most = 0.0;

  for (PetscInt k = 0; c->fields.fluid && k < c->nregion; k++) {
    if (c->region[k].material < 0)
      continue;
    const double conduct = SceneConductance(c, &c->material[c->region[k].material], c->region[k].Sh);

    least = fmin(least, conduct);
    most  = fmax(most, conduct);
  }
  return most > 0.0 ? most / least : 1.0;
}

/* Does a region's permeability differ along and across its beds (306)? */
static inline bool SceneHasBeds(const Scene *c)
{
  bool beds = false;

  for (PetscInt k = 0; c->fields.fluid && k < c->nregion; k++)
    beds = beds || (c->region[k].material >= 0 && c->material[c->region[k].material].permeability.ratio != 1.0);
  return beds;
}

/* Do particles share a node's flow in proportion to k_p (350)?  Hybrid knows beds with such shares alone. */
static inline bool SceneSharesFlow(const Scene *c)
{
  return SceneHasBeds(c) || SceneContrast(c) > 1.0;
}

/* Do pressures even out within cells (353)?  Where layers differ in permeability. */
static inline bool SceneExchanges(const Scene *c)
{
  return SceneContrast(c) > 1.0;
}

/* May particles take the volume change of their cells (88)?  Not on cells that deform with the body (445). */
static inline bool SceneHasCellMeans(const Scene *c)
{
  return c->fields.solid && c->basis != BASIS_TOTAL;
}

/* Do they in this stage?  Where a skeleton may yield, and with (160). */
static inline bool SceneTakesCellMeans(const Scene *c)
{
  bool takes = c->mean_strain > 0.0;

  for (PetscInt k = 0; k < c->nmaterial; k++)
    takes = takes || c->material[k].plasticity.type != PLASTICITY_NONE;
  return takes && SceneHasCellMeans(c);
}

/* Are particles of the plane strained across it, too: along the ring about an axis, by (88)? */
static inline bool SceneStrainsAcross(const Scene *c)
{
  return CL_DIM == 2 && (c->axisymmetric || SceneHasCellMeans(c));
}

/* First condition that integrators of none of these kinds (BY_...) know, or NULL. */
static inline const Bc *SceneBcUnknown(const Scene *c, unsigned kinds)
{
  for (PetscInt k = 0; k < c->nbc; k++) {
    if (!(BcKnownBy(c->bc[k].type) & kinds))
      return &c->bc[k];
  }
  return NULL;
}

/* Do (381) and (424) act? */
static inline bool SceneReactsWithHeat(const Scene *c)
{
  return c->fields.heat && c->fields.phase[PHASE_G] && SceneReacts(c);
}

/* Is heat carried with the flow (293) where T alternates (440)? */
static inline bool SceneCarriesHeat(const Scene *c)
{
  return c->fields.heat && c->fields.fluid;
}

/* Does (444) act? */
static inline bool SceneHasLongCells(const Scene *c)
{
  return CL_DIM == 2 && c->fields.heat;
}

/* X(what a scene may ask for, as the case says it; kinds of integrators that know it; does this scene c?) */
#define CL_FEATURES(X)                                                                                                 \
  X("geometry: axisymmetric", BY_IMPLICIT, c->axisymmetric)                                                            \
  X("inertia: no", BY_IMPLICIT, !c->inertia)                                                                           \
  X("basis: total", BY_IMPLICIT, c->basis == BASIS_TOTAL)                                                              \
  X("an inflow of gas where a region has Sg: 0", BY_IMPLICIT, SceneLetsGasIn(c))                                       \
  X("stabilisation_donor", BY_IMPLICIT | BY_TURNS, c->stabilisation.donor)                                             \
  X("compression_heat: yes", BY_ALL_BUT_PAPER, c->compression_heat)                                                    \
  X("permeability_ratio below 1", BY_ALL_BUT_PAPER, SceneHasBeds(c))

/* The first that integrators of none of these kinds know, a boundary by its name; NULL if there is none. */
static inline const char *SceneUnknown(const Scene *c, unsigned kinds)
{
  const Bc *b = SceneBcUnknown(c, kinds);
#define CL_FEATURE_UNKNOWN(words, by, asked) : !(kinds & (by)) && (asked) ? (words)

  return b ? b->name CL_FEATURES(CL_FEATURE_UNKNOWN) : NULL;
#undef CL_FEATURE_UNKNOWN
}
