/* conditions: the kinds of boundary conditions, declared once, and what a case says of each condition. */
#pragma once

#include "clathra/base.h"
#include "clathra/fields.h"
#include "clathra/schedule.h"

/* left right bottom top, in space then back front */
typedef enum { SIDE_XMIN = 0, SIDE_XMAX, SIDE_YMIN, SIDE_YMAX, SIDE_COUNT = 2 * CL_DIM } Side;

/* Axis and sign of a side's outward normal. */
static inline int SideAxis(int side)
{
  return side / 2;
}
/* -1 or 1, dimensionless: where the normal points along its axis. */
static inline double SideSign(int side)
{
  return side % 2 ? 1.0 : -1.0;
}

typedef struct {
  PetscInt n;
  double  *x; /* n x 2, m */
} Points;

/* Kinds of integrators: implicit; without a matrix; the paper's bare form of the latter; implicit in turn with hybrid.
   What only some know names their kinds; an integrator of none of them refuses it by name. */
enum { BY_IMPLICIT = 1, BY_EXPLICIT = 2, BY_PAPER = 4, BY_TURNS = 8 };
enum { BY_ALL_BUT_PAPER = BY_IMPLICIT | BY_EXPLICIT, BY_STABLE_STEPS = BY_EXPLICIT | BY_PAPER };
enum { BY_ALL = BY_ALL_BUT_PAPER | BY_PAPER };

/* On faces, which move with the body; a well and a heat source have some without area inside.
   X(kind, word, fields any of which it needs, integrators, its terms in src/boundary/terms.c or well.c, what it
   prescribes) */
#define CL_FACE_CONDITIONS(X)                                                                                          \
  X(TRACTION, "traction", HAS_SOLID, BY_ALL, FaceTraction, "total normal (compression-positive) and shear stress, Pa") \
  X(PRESSURE, "pressure", HAS_WATER, BY_ALL, FacePressures, "mean pore pressure, or p_w and p_g, Pa, or the initial")  \
  X(HEAT_FLUX, "heat_flux", HAS_HEAT, BY_ALL, FaceHeatFlux, "into the body, W/m^2")                                    \
  X(CONVECTION, "convection", HAS_HEAT, BY_ALL, FaceConvection, "alpha (T_a - T), W/m^2")                              \
  X(FACE_TEMPERATURE, "face_temperature", HAS_HEAT, BY_ALL, FaceTemperature, "T, degC")                                \
  X(INFLOW, "inflow", HAS_WATER, BY_ALL, FaceInflows, "volume of water and gas into the body, m/s")                    \
  X(PLATE, "plate", HAS_SOLID, BY_ALL, NULL, "a rigid plate: velocity, displacement or force (plates.c)")              \
  X(WELL, "well", HAS_WATER, BY_ALL_BUT_PAPER, FaceWell,                                                               \
    "a line normal to the plane, in space along an axis: its pressure, Pa, or rates, kg/s (well.c)")                   \
  X(HEAT_SOURCE, "heat_source", HAS_HEAT, BY_ALL, FaceHeatSource,                                                      \
    "in a region's particles, W/m^3 of their volume at the start")

enum { ON_FACES = 1, ON_PLANE, IN_REGION };
/* On nodes: of a grid plane, or in the initial shape of a region.  X(kind, word, fields, integrators, its values in
   src/boundary/conditions.c, ON_..., what it prescribes); a motion without fluids or fluids without motion are held. */
#define CL_NODE_CONDITIONS(X)                                                                                          \
  X(ROLLER, "roller", HAS_SOLID | HAS_WATER, BY_ALL, NodeRoller, ON_PLANE, "normal velocity of all phases is zero")    \
  X(FIXED, "fixed", HAS_SOLID | HAS_WATER, BY_ALL, NodeFixed, ON_PLANE, "all velocities are zero")                     \
  X(TEMPERATURE, "temperature", HAS_HEAT, BY_ALL, NodeTemperature, ON_PLANE, "T, degC")                                \
  X(REGION_TEMPERATURE, "region_temperature", HAS_HEAT, BY_ALL, NodeTemperature, IN_REGION, "T, degC")
/* Kinds that the reader makes of others, whose word they share; the last column tells them apart.  A plate without a
   side is a grid plane with a velocity, for small motions. */
#define CL_NODE_FORMS(X) X(PLATE_LINE, "plate", HAS_SOLID, BY_IMPLICIT, NodeRoller, ON_PLANE, "without a side")

#define CL_CONDITION_ID(kind, ...) BC_##kind,
typedef enum {
  BC_NONE = 0,
  CL_FACE_CONDITIONS(CL_CONDITION_ID) BC_FACE_END_,
  BC_FACE_LAST_ = BC_FACE_END_ - 1,
  CL_NODE_CONDITIONS(CL_CONDITION_ID) BC_WORDS, /* the kinds before this have words of their own */
  CL_NODE_FORMS(CL_CONDITION_ID) BC_COUNT
} BcType;
enum { BC_FACES = BC_FACE_END_ }; /* kinds from BC_NONE + 1 to before this act on faces */
/* Of these, bits 1 << BcType of those that act on particles inside the body. */
enum { BC_INSIDE = 1u << BC_WELL | 1u << BC_HEAT_SOURCE };
/* Those that count on a grid that stands still: not with BASIS_TOTAL. */
enum { BC_CURRENT = 1u << BC_PLATE | 1u << BC_PLATE_LINE };
#undef CL_CONDITION_ID

#define CL_CONDITION_BY(kind, word, has, by, ...) [BC_##kind] = (by),
/* Kinds of integrators that know a condition. */
static inline unsigned BcKnownBy(BcType type)
{
  static const unsigned by[BC_COUNT] = {BY_ALL, CL_FACE_CONDITIONS(CL_CONDITION_BY) CL_NODE_CONDITIONS(CL_CONDITION_BY)
                                                    CL_NODE_FORMS(CL_CONDITION_BY)};

  return by[type];
}
#undef CL_CONDITION_BY

/* For which fluids a pressure opens a face; it stays closed for the other. */
typedef enum { OPEN_BOTH = 0, OPEN_WATER, OPEN_GAS } OpenPhases;

typedef struct {
  char     name[64];
  BcType   type;
  PetscInt number;   /* its place in the list of the case, whatever acts in a stage */
  bool     of_stage; /* times of the functions below count from the begin of the stage, not of the run */
  double   zero;     /* s: where they count from */
  /* faces: a side of a region (all regions when region = -1), optionally only the part inside [from,to] along it, or
     those on a line (side = SIDE_COUNT) */
  Side     side;
  PetscInt region;
  double   from, to; /* m, along the side; -inf, +inf by default */
  Points   along;
  /* planes: nodes with coordinate `axis` equal to `position` */
  PetscInt axis;
  double   position;
  /* functions of time */
  Schedule   value; /* normal stress | p (mean) | heat flux | T_a | T (also of inflow) | plate velocity (along +axis) */
  Schedule   displacement, force; /* plate: along +axis since the start, m; on the body, compression-positive, N */
  Schedule   shear;               /* traction: shear stress along the side's tangent (n rotated by +90 degrees), Pa */
  Schedule   phase[PHASE_COUNT];  /* pressure: p_w, p_g, Pa; inflow: volume flux of water, gas, m/s */
  bool       initial;             /* pressure: hold each face at its particle's initial p_w, p_g */
  bool       natural; /* pressure: the particle's own capillary pressure instead of the face's initial one (31) */
  OpenPhases open;    /* pressure */
  bool       drained; /* roller, fixed, plate: holds the skeleton alone, fluids cross the plane */
  bool       rough, separates;  /* plate: holds the tangential displacement; takes no tension */
  double     stiffness;         /* plate: of its springs, in units of the constrained modulus over a cell */
  double     alpha;             /* convection coefficient, W/(m^2 K) */
  double     with_depth, datum; /* of a temperature (425): K/m; m, where it is `value`; infinite: top of the body */
  /* well: initial position, m; radius, m; skin; mass of water and gas into the body, kg/s; T of what enters, degC */
  double   at[CL_DIM], end[CL_DIM], radius, skin; /* end: in space */
  double   index;                                 /* C of (369), for this grid; 0 without a bottom pressure */
  Schedule rate[PHASE_COUNT], heated;
} Bc;

#define CL_CONDITIONS 256 /* at most */

/* Is the condition's value a temperature, of the body or of what touches or enters it, degC? */
static inline bool BcPrescribesT(const Bc *b)
{
  return b->type == BC_CONVECTION || b->type == BC_FACE_TEMPERATURE || b->type == BC_INFLOW ||
         b->type == BC_TEMPERATURE || b->type == BC_REGION_TEMPERATURE;
}
