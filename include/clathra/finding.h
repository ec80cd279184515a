/* finding: what a run says beside its progress: a row of the table for each, and one function that says them. */
#pragma once

#include "clathra/base.h"

/* When src/findings looks for it: at every start; at one that is no restart; at one whose particles are new; after a
   step; when the run gives up; for the summary; at the end.  SIGHT: said by whoever comes upon it. */
typedef enum {
  FINDING_AT_SIGHT,
  FINDING_AT_START,
  FINDING_AT_SEEDING,
  FINDING_AT_BEGIN,
  FINDING_AT_STEP,
  FINDING_AT_GIVING_UP,
  FINDING_AT_SUMMARY,
  FINDING_AT_END
} FindingWhen;
/* Notes and warnings are said on stderr, behind a place in the case or the program's name; all else on stdout. */
typedef enum { FINDING_AS_NOTE, FINDING_AS_WARNING, FINDING_AS_END, FINDING_AS_CAUSE, FINDING_AS_LINE } FindingKind;

#define CL_TRY_CELLS "finer cells there, about as high as wide at the end of a heater; a ramp instead of a jump"
#define CL_TRY_AMBIENT "ambient: {pressure: ...} for what pores and tractions share, and tractions beyond it"
#define CL_TRY_REST "-restart_as_initial of a run that came to rest"
/* X(finding, when, kind, who looks for it in src/findings, what to try where that is always the same) */
#define CL_FINDINGS(X)                                                                                                 \
  /* of the case */                                                                                                    \
  X(IDLE_KEYS, SIGHT, NOTE, FindingsFindNone, "")                                                                      \
  X(REGIONS_OVERLAP, SIGHT, NOTE, FindingsFindNone, "")                                                                \
  X(DILATION_ABOVE_FRICTION, SIGHT, WARNING, FindingsFindNone, "")                                                     \
  X(STRENGTH_BY_GRID, SIGHT, WARNING, FindingsFindNone, "")                                                            \
  X(RATE_NOT_MEASURED, SIGHT, WARNING, FindingsFindNone,                                                               \
    "K0 of 3.6e4 with dE of 78 to 81 kJ/mol; without dE K0 is K_d itself")                                             \
  /* of the files */                                                                                                   \
  X(FOLDER_NOT_LOCKED, SIGHT, WARNING, FindingsFindNone, "")                                                           \
  X(TABLE_MISSING, SIGHT, WARNING, FindingsFindNone, "")                                                               \
  X(TABLE_COLUMNS, SIGHT, WARNING, FindingsFindNone, "")                                                               \
  X(TABLE_DAMAGED, SIGHT, WARNING, FindingsFindNone, "")                                                               \
  X(TABLE_ROWS, SIGHT, WARNING, FindingsFindNone, "")                                                                  \
  X(SNAPSHOT_MISSING, SIGHT, WARNING, FindingsFindNone, "")                                                            \
  X(SNAPSHOT_DAMAGED, SIGHT, WARNING, FindingsFindNone, "")                                                            \
  /* of the start */                                                                                                   \
  X(PAPER_LAYERS, START, WARNING, FindingsFindPaperLayers, "stepper_type: hybrid or sdirk2, without that error")       \
  X(LATE_OUTPUT, START, NOTE, FindingsFindLateOutput, "")                                                              \
  X(CLOSED_FACES, START, WARNING, FindingsFindClosedFaces, "")                                                         \
  X(FREE_SIDES, SEEDING, WARNING, FindingsFindFreeSides, "")                                                           \
  X(TORN_PORES, SEEDING, WARNING, FindingsFindTornPores, CL_TRY_AMBIENT)                                               \
  X(CAPILLARY_JUMP, SEEDING, WARNING, FindingsFindCapillaryJump, "")                                                   \
  X(TRAPPED_GAS, SEEDING, WARNING, FindingsFindTrappedGas,                                                             \
    "more Sg or a smaller Sgr, for gas that water has not trapped; Sg: 0, without gas")                                \
  X(UNSTRESSED, SEEDING, WARNING, FindingsFindUnstressed,                                                              \
    "stress: {geostatic: K0}; gravity_ramp; -restart_as_initial of a body that has settled")                           \
  X(START_TENSION, SEEDING, WARNING, FindingsFindStartTension, "")                                                     \
  X(FAR_PRESSURE, BEGIN, WARNING, FindingsFindFarPressure, "hydrostatic: yes with one datum; " CL_TRY_REST)            \
  X(RISING_GAS, BEGIN, WARNING, FindingsFindRisingGas,                                                                 \
    "less gas, with no relative permeability; layers with the more gas the higher they lie; " CL_TRY_REST)             \
  X(UNSTABLE_HYDRATE, BEGIN, WARNING, FindingsFindUnstableHydrate,                                                     \
    "more pressure; a lower temperature; a first stage with kinetics_active: no")                                      \
  X(FORMING, BEGIN, WARNING, FindingsFindForming,                                                                      \
    "Sg: 0; less pressure; a higher temperature; a first stage with kinetics_active: no")                              \
  X(FORMING_BESIDE, BEGIN, NOTE, FindingsFindForming, "Sg: 0; a place below the stability zone")                       \
  /* on the way */                                                                                                     \
  X(SLOW, STEP, NOTE, FindingsFindSlow, "")                                                                            \
  X(TEMPERATURE_NOW, STEP, WARNING, FindingsFindTemperature, CL_TRY_CELLS)                                             \
  X(ICE, STEP, WARNING, FindingsFindIce, "")                                                                           \
  X(STILL, STEP, NOTE, FindingsFindStill, "")                                                                          \
  X(GIVEN_UP, SIGHT, END, FindingsFindNone, "")                                                                        \
  X(CAUSE_TORN_PORES, GIVING_UP, CAUSE, FindingsFindTornPores, CL_TRY_AMBIENT)                                         \
  X(CAUSE_CAPILLARY_JUMP, GIVING_UP, CAUSE, FindingsFindCapillaryJump, "")                                             \
  /* in the summary */                                                                                                 \
  X(RUN, SIGHT, LINE, FindingsFindNone, "")                                                                            \
  X(STABLE_STEP, SUMMARY, LINE, FindingsFindStableStep, "")                                                            \
  X(HYDRATE, SUMMARY, LINE, FindingsFindHydrate, "")                                                                   \
  X(NEWTON_LEFT, SUMMARY, LINE, FindingsFindNewtonLeft, "")                                                            \
  X(RANGES, SUMMARY, LINE, FindingsFindRanges, "")                                                                     \
  X(YIELDING, SUMMARY, LINE, FindingsFindYielding, "")                                                                 \
  X(GONE, SUMMARY, LINE, FindingsFindGone, "")                                                                         \
  X(ERRORS, SUMMARY, LINE, FindingsFindErrors, "")                                                                     \
  X(UNEVEN, SUMMARY, LINE, FindingsFindUneven, "")                                                                     \
  X(LONG_PARTICLES, SUMMARY, LINE, FindingsFindLongParticles, "")                                                      \
  X(ICE_SO_FAR, SUMMARY, LINE, FindingsFindIceSoFar, "")                                                               \
  X(RANKS, SUMMARY, LINE, FindingsFindRanks, "")                                                                       \
  X(RESULTS, SIGHT, LINE, FindingsFindNone, "")                                                                        \
  /* at the end */                                                                                                     \
  X(TEMPERATURE, END, WARNING, FindingsFindTemperature, CL_TRY_CELLS)                                                  \
  X(PRESSURE, END, NOTE, FindingsFindPressure, "")                                                                     \
  X(TENSION, END, WARNING, FindingsFindTension,                                                                        \
    "finer cells, shorter steps there (-stepper_tol); a higher pressure at the start, if it was given over that of "   \
    "the air")                                                                                                         \
  X(DOUBTFUL_STEPS, END, WARNING, FindingsFindDoubtfulSteps, "")                                                       \
  X(BORDER, END, NOTE, FindingsFindBorder, "")                                                                         \
  X(UNUSED_OPTIONS, END, WARNING, FindingsFindUnusedOptions, "")

typedef enum {
#define CL_FINDING_ID(id, ...) FINDING_##id,
  CL_FINDINGS(CL_FINDING_ID)
#undef CL_FINDING_ID
      FINDING_COUNT
} FindingId;

/* Says a finding on the first rank of comm and keeps it for the summary.  What was said before in this run, word by
   word, is not said again.  place: in the case, "case.yaml:12" (NULL: none); what_to_try: where the state decides on it
   (NULL: what the table says). */
PetscErrorCode FindingSayOf(MPI_Comm comm, FindingId id, const char *place, const char *what_to_try, const char *format,
                            ...) __attribute__((format(printf, 5, 6)));
#define FindingSay(comm, id, ...) FindingSayOf(comm, id, NULL, NULL, __VA_ARGS__)
int FindingTimes(FindingId id); /* how often it was said in this run */
/* All that was said, the lines of the summary first; free it. */
PetscErrorCode FindingSummary(char **text);
void           FindingForget(void); /* a new run has said nothing */
