/* case_private: the inside of the case reader.  One declared key table (keys_*.c) from which reading, checking, the
   resolved case, the printed key list and the nearest-key search follow. */
#pragma once

#include "clathra/boundary.h"
#include "clathra/case.h"
#include "clathra/finding.h"
#include <string.h>

/* ---------------------------------------------------------------- units.c */
enum { UNIT_KG = 0, UNIT_M, UNIT_S, UNIT_K, UNIT_MOL, UNIT_DEG, UNIT_DIMS };
typedef struct {
  int    dim[UNIT_DIMS]; /* exponents of kg, m, s, K, mol, deg */
  int    pow10;          /* SI value = number * factor / divisor * 10^pow10 */
  double factor, divisor;
  bool   celsius; /* the unit is degC alone: an absolute temperature, not a difference */
} Unit;
#define CASE_WHY 256 /* length of a reason */
/* Parses a unit such as "mol/(m^2 Pa s)"; the empty text is dimensionless. */
bool UnitParse(const char *text, Unit *unit, char why[CASE_WHY]);
/* Parses a finite number followed by a unit of the dimension of `si` ("degC" stands for an absolute temperature, which
   is returned in degC); on failure `why` says what is wrong and what is allowed. */
bool        QuantityParse(const char *text, const char *si, double *value, char why[CASE_WHY]);
bool        NumberParse(const char *text, double *value, const char **end); /* decimal, finite; no nan, inf or hex */
const char *QuantityName(const char *si);                                   /* "a pressure" for "Pa" */

/* ---------------------------------------------------------------- document.c, reader.c, load.c */
typedef struct {
  char    *name, *value; /* option name without the dash; NULL value = empty */
  PetscInt line;
  bool     map; /* no value: other keys stand below it */
  bool     used;
} Entry; /* a key of the file */

typedef enum {
  GROUP_CASE = 0,
  GROUP_MATERIAL,
  GROUP_REGION,
  GROUP_BC,
  GROUP_PROBE,
  GROUP_METER,
  GROUP_STAGE,
  GROUP_COUNT
} Group;

#define CASE_ERRORS 20 /* errors shown */
typedef struct {
  MPI_Comm    comm;
  PetscMPIInt rank;
  char        file[PETSC_MAX_PATH_LEN];
  PetscInt    nentry;
  Entry      *entry;
  PetscInt    nerror;
  char       *error[CASE_ERRORS];
  bool        bad[GROUP_COUNT];  /* some key of the group could not be read */
  bool        misshapen;         /* bad[GROUP_REGION] is so for a shape alone */
  PetscInt   *like[GROUP_COUNT]; /* of each instance: whose keys hold where its own are not given, -1: nobody's */
} Reader;

/* Adds one error: "file:line: key = value: message"; `key` and `value` may be NULL. */
void ReaderError(Reader *r, const char *key, const char *value, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* Says a finding, the place that of `key`. */
void ReaderWarn(const Reader *r, FindingId id, const char *key, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* Reads the file on rank 0, shares it, and fills the entries; errors go to the reader. */
PetscErrorCode ReaderLoad(Reader *r, const char *path);
PetscErrorCode ReaderDestroy(Reader *r);
/* Finds the value of a key: the command line wins over the file.  *from_file tells which. */
PetscErrorCode ReaderFind(Reader *r, const char *name, const char **value, bool *found, bool *from_file);
/* A whole file, read on rank 0, on all ranks; free it.  NULL and a reason if it cannot be read as text. */
PetscErrorCode ReaderText(Reader *r, const char *path, char **text, char why[CASE_WHY]);
/* The file of a case that may be given as a folder. */
void CaseFile(const char *given, char *file, size_t size);
/* The text as YAML into entries; false: one error was added. */
bool ReaderParse(Reader *r, const char *text);

/* ---------------------------------------------------------------- keys.c, keys_*.c by subject */
typedef enum {
  KEY_REAL,
  KEY_INT,
  KEY_BOOL,
  KEY_TEXT,
  KEY_CHOICE,
  KEY_LAW,
  KEY_NAME,
  KEY_SCHEDULE,
  KEY_REALS,
  KEY_POINTS,
  KEY_NAMES
} KeyKind;

typedef struct {
  const char *const *(*types)(void);
  bool (*set)(Material *, const char *);
  const char *(*get)(const Material *);
} Law;

typedef struct {
  const char *name; /* below the prefix of its group */
  KeyKind     kind;
  size_t      offset; /* of the member in the struct of its group */
  int         count;  /* values; bytes for text */
  const char *unit;   /* SI; "" = a plain number; degC = absolute temperature */
  const char *range;  /* interval in SI, "" = any */
  /* default as text, NULL = required; "0.05 @name" = that multiple of a key above it in the same group */
  const char *def;
  const char *when;             /* name of the condition under which it is required all the same */
  bool (*needed)(const void *); /* ... and the condition, of the instance */
  const char *const *choices;   /* KEY_CHOICE, KEY_TEXT; for KEY_BOOL the two words of false and true */
  int                first;     /* KEY_CHOICE: enumerator of the first word */
  const Law         *law;       /* KEY_LAW */
  Group              names;     /* KEY_NAME, KEY_NAMES: whose names */
  /* KEY_REAL: word that stands for infinity, "-word" for minus infinity; KEY_NAME: word that stands for -1 */
  const char *word;           /* KEY_INT: word that stands for 0 */
  bool        shape;          /* GROUP_REGION: also of a region without particles */
  unsigned    types;          /* GROUP_BC: bit mask of 1 << BcType; 0 = every type */
  unsigned    has;            /* fields (HAS_...) any of which needs the key; 0 = always needed */
  unsigned    also;           /* ... and any of these */
  bool (*acts)(const void *); /* does it anything in this instance?  NULL = always */
  const char *idle;           /* when, in words */
  bool        felt;           /* acts even where it is not needed */
  unsigned    by;             /* kinds of integrators (BY_...) that know it; 0: all */
  bool        plain;          /* a number without unit on the command line is in SI */
  bool        kept;           /* not given, what is there stays; `def` says in words what that is */
  bool        own;            /* never that of the instance which this one is like */
  bool        like;           /* names that instance: read before the others (CaseLike), and no part of the scene */
  /* with any of these fields particles hold masses that mean something else with another value: no stage can change
     it, and the state of one case begins another only where it is the same */
  unsigned    binds;
  bool        history; /* the same of what their skeleton remembers, which a stage may change */
  bool        made;    /* GROUP_STAGE: what it says is in the scene of the stage, or in when the next one begins */
  const char *doc;
} Key;

typedef struct {
  const char *prefix, *list, *noun, *doc;
  size_t      size;           /* of one instance, whose first member is its name */
  size_t      count, pointer; /* offsets in Case */
  bool        required;       /* at least one */
  const Key  *key;
} GroupInfo;

extern const GroupInfo   case_group[GROUP_COUNT];
extern const char *const case_schedule_form[]; /* suffixes of a schedule key; the first, "", is a constant */
extern const char *const case_bc_type[];       /* by BcType - 1; behind the NULL what forms resolve to */
static inline PetscInt  *GroupCount(const Case *c, Group g)
{
  return (PetscInt *)((char *)c + case_group[g].count);
}
static inline char *GroupInstance(const Case *c, Group g, PetscInt i) /* also its name */
{
  if (g == GROUP_CASE)
    return (char *)c;
  return *(char **)((char *)c + case_group[g].pointer) + (size_t)i * case_group[g].size;
}
bool KeyApplies(const Key *k, Group g, const void *instance); /* to the boundary's type, to a region that is empty */
void KeyOption(char *option, size_t size, Group g, const char *instance, const char *key);
bool RangeHolds(const char *range, double value);
/* Nearest option name to `name` among all keys of the case; false if none is near. */
bool KeyNearest(const Case *c, const char *name, char *nearest, size_t size);
/* Does this option of the command line belong to the case: a prefix of its own, or a near miss of a key? */
bool KeyOwned(const Case *c, const char *name);
/* Is it a key of a material, region, ... that the list of names does not hold? */
bool KeyUnlisted(const Case *c, const char *name, Group *group, char *instance, size_t size);
bool WordNearest(const char *word, const char *const *list, char *nearest, size_t size);
int  EditDistance(const char *a, const char *b);

/* Adds an error at a key of an instance; needs the reader r. */
#define FAIL_AT(g, instance, key, ...)                                                                                 \
  do {                                                                                                                 \
    char option_[256];                                                                                                 \
    KeyOption(option_, sizeof option_, g, instance, key);                                                              \
    ReaderError(r, option_, NULL, __VA_ARGS__);                                                                        \
  } while (0)

/* Says a finding that names where the key of an instance is given; needs the reader r. */
#define WARN_AT(id, g, instance, key, ...)                                                                             \
  do {                                                                                                                 \
    char option_[256];                                                                                                 \
    KeyOption(option_, sizeof option_, g, instance, key);                                                              \
    ReaderWarn(r, id, option_, __VA_ARGS__);                                                                           \
  } while (0)

/* ---------------------------------------------------------------- words.c, value.c, forms.c, check.c */
/* The words that a key may have, NULL: none are listed; an error that names them, and the nearest. */
const char *const *KeyWords(const Key *k);
void               WordError(Reader *r, const char *shown, const char *text, const char *const *words);
/* program.c: words and numbers of the program's own options; numbers with or without a unit, the options then hold them
   in SI. */
PetscErrorCode ProgramRead(Reader *r);
/* like.c: who is like whom; after the lists of names are read, before any other key.  A circle is refused. */
PetscErrorCode CaseLike(Reader *r, const Case *c);
PetscErrorCode LikeDestroy(Reader *r);
/* Finds the value of a key of instance i, or of the first it is like that has one; `shown` is how messages name the key
   where it was found, *own: it is the instance's. */
typedef struct {
  const char *text; /* NULL: empty */
  char        shown[257];
  bool        found, from_file, own;
} Found;
PetscErrorCode KeyFind(Reader *r, const Case *c, Group g, PetscInt i, const Key *k, Found *f);
PetscErrorCode KeyRead(Reader *r, Case *c, Group g, PetscInt i, const Key *k);
bool           YesNoRead(const char *text, bool *value); /* yes, no, true, ...; false for another word */
void           KeyMissing(Reader *r, const char *option, const Key *k);
bool RealRead(Reader *r, const char *shown, const char *text, const char *unit, const char *range, double *value);
/* csv.c: points of the function of time that a column of a file is; `text` is "FILE" or "FILE, COLUMN". */
PetscErrorCode ScheduleCsv(Reader *r, const char *shown, const char *text, const Key *k, Schedule *s, bool *ok);
static inline const char *ScheduleDifference(const Key *k) /* unit of a difference of its values */
{
  return strcmp(k->unit, "degC") ? k->unit : "K";
}
PetscErrorCode ScheduleRead(Reader *r, const char *option, const Key *k, const void *instance, Schedule *s);
/* One of the names of group k->names as its index; the word for all or none as -1; false: one error was added. */
bool KeyName(Reader *r, const Case *c, const char *shown, const char *text, const Key *k, PetscInt *value);
/* lists.c */
PetscErrorCode KeyNames(Reader *r, const Case *c, const char *shown, const char *text, const Key *k, Names *names);
PetscErrorCode KeyPoints(Reader *r, const char *shown, const char *text, const Key *k, Points *points);
/* Copies a comma list into items that share one allocation; free(list->text). */
typedef struct {
  PetscInt n;
  char    *text, **item;
} List;
void ListCreate(const char *text, List *list);
void ListDestroy(List *list);
/* forms.c: "{ramp: [...]}" in one word, as the command line gives it: its place in case_schedule_form, and its values
   in `inner`, as long as the text; -1: it is none. */
int FormInBraces(const char *text, char *inner);
/* derive.c: what follows from the keys of each group; then what follows from where regions and wells are.  Both before
   stages copy the scene. */
PetscErrorCode CaseDerive(Reader *r, Case *c);
PetscErrorCode CaseDerivePlaces(Reader *r, Case *c);
void           CaseCheck(Reader *r, const Case *c); /* no check fills a field of the case */
/* plates.c: a plate without a side is one on a grid line; what its keys must agree in. */
PetscErrorCode PlateForm(Reader *r, Bc *b);
void           CheckPlate(Reader *r, const Case *c, const Bc *b);
void           CheckPlasticity(Reader *r, const Case *c, const Material *m); /* plastic.c */
void           CheckReduction(Reader *r, const Case *c);                     /* strength_factor */
/* flow.c: pressure and inflow; a key that needs any of these fields */
void CheckFlow(Reader *r, const Scene *c, const Bc *b);
void CheckField(Reader *r, const Scene *c, const Bc *b, const char *key, unsigned needs, bool given);
/* wells.c: its place, its radius, what drives it; can an index be found of one that is wide as this in its cells? */
void CheckWell(Reader *r, const Case *c, const Bc *b);
bool WellFits(const Bc *b, const Well *w);
bool WellRuns(const Scene *c, const Bc *b); /* along one axis in space; in the plane, not about an axis */
void CheckInitial(Reader *r, const Scene *c, const Region *g); /* initial.c: states in balance with gravity */
/* regions.c: shapes, faces named by a side or a line, probes */
void           RegionsFinish(Scene *c);              /* once all keys are read */
bool           ShapesGood(Reader *r, const Case *c); /* else an error is said */
PetscErrorCode RegionsCut(const Reader *r,
                          Case         *c); /* of good shapes: where two lie over each other, the earlier one */
bool           RegionsFilled(Reader *r, const Case *c);                     /* with particles; else an error is said */
bool           FacesShared(const Scene *c, const Meter *a, const Meter *b); /* has the body any that both name? */
void           CheckFaces(Reader *r, const Scene *c, Group g, const char *name, const Meter *m);
void           CheckSource(Reader *r, const Scene *c, const Bc *b);
void           CheckHeld(Reader *r, const Scene *c, const Bc *b);
void           CheckProbe(Reader *r, const Scene *c, const Probe *p);
/* resolve.c: the value of a key as the resolved case gives it; keys that say nothing when they are empty */
void               KeyWrite(FILE *f, const Case *c, const Key *k, const char *instance);
bool               KeyEmpty(const Key *k, const char *instance);
static inline bool KeyNeeded(const Key *k, const Case *c)
{
  return (!k->has || (c->scene.fields.has & k->has)) && (!k->also || (c->scene.fields.has & k->also));
}
/* ... and does it act in this instance? */
static inline bool KeyActs(const Key *k, const Case *c, const void *instance)
{
  return k->felt || (KeyNeeded(k, c) && (!k->acts || k->acts(instance)));
}
void IntegratorsWords(unsigned by, char text[64]); /* of these kinds: "sdirk2, euler, auto" */
/* idle.c: ... and is it known to the case's integrator, or to that of one of its stages? */
bool KeyKnown(const Key *k, Group g, const Case *c, const void *instance);
/* fingerprint.c: may a restart change it?  How to run the scene, and the numerics of the model. */
bool KeyMayChange(const Key *k, Group g);
/* Adds what the key says of an instance to a hash. */
uint64_t KeyHash(uint64_t h, const Key *k, const char *instance);
/* idle.c: keys that are given and do nothing are named on rank 0; of a good case. */
PetscErrorCode CaseIdle(Reader *r, const Case *c);

/* ---------------------------------------------------------------- stages.c */
/* When the stages end, and with the last of them the run; before the keys of the case are read. */
PetscErrorCode CaseStageEnds(Reader *r, Case *c);
/* The case as it holds in each stage; after the case is read and derived. */
PetscErrorCode CaseStages(Reader *r, Case *c);
void           CheckTimes(Reader *r, const Case *c); /* ends, integrators and steps, of stages or of a case without */
/* ---------------------------------------------------------------- spacing.c */
/* The lines and numbers of cells that the grid's spacing makes, once the keys of the case are read. */
PetscErrorCode CaseSpacing(Reader *r, Scene *c);
PetscErrorCode CaseStagesDestroy(Case *c);

/* ---------------------------------------------------------------- fieldset.c */
void FieldsWords(unsigned has, char text[64]); /* "water or gas" */
/* Fills Case.fields from fields_wanted, or derives it from the file; before materials and regions are read. */
PetscErrorCode CaseFieldSet(Reader *r, Case *c);
/* Which quantities probes write; after CaseFieldSetFinish. */
void CaseQuantities(Reader *r, Case *c);
/* What the set leaves open in the regions, after all is read; whether the case asks for more than it holds. */
void CaseFieldSetFinish(Reader *r, Case *c);
void CheckFields(Reader *r, const Case *c);
