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
/* How it is said: "clathra: note: ..." and "clathra: warning: ..." go to stderr; "Given up at t = ...", "A likely
   cause:
   ..." and the lines of the summary to stdout. */
typedef enum { FINDING_AS_NOTE, FINDING_AS_WARNING, FINDING_AS_END, FINDING_AS_CAUSE, FINDING_AS_LINE } FindingKind;

#define CL_TRY_CELLS "finer cells there, about as high as wide at the end of a heater; a ramp instead of a jump"
/* X(finding, when, kind, who looks for it in src/findings, what to try where that is always the same) */
#define CL_FINDINGS(X)                                                                                                 \
  /* of the case */                                                                                                    \
  X(IDLE_KEYS, SIGHT, NOTE, FindingsFindNone, "")                                                                      \
  X(REGIONS_OVERLAP, SIGHT, NOTE, FindingsFindNone, "")                                                                \
  X(DILATION_ABOVE_FRICTION, SIGHT, WARNING, FindingsFindNone, "")                                                     \
  X(STRENGTH_BY_GRID, SIGHT, WARNING, FindingsFindNone, "")                                                            \
  X(RATE_NOT_MEASURED, SIGHT, WARNING, FindingsFindNone, "")                                                           \
  /* of the files */                                                                                                   \
  X(FOLDER_NOT_LOCKED, SIGHT, WARNING, FindingsFindNone, "")                                                           \
  X(TABLE_MISSING, SIGHT, WARNING, FindingsFindNone, "")                                                               \
  X(TABLE_COLUMNS, SIGHT, WARNING, FindingsFindNone, "")                                                               \
  X(TABLE_DAMAGED, SIGHT, WARNING, FindingsFindNone, "")                                                               \
  X(TABLE_ROWS, SIGHT, WARNING, FindingsFindNone, "")                                                                  \
  X(SNAPSHOT_MISSING, SIGHT, WARNING, FindingsFindNone, "")                                                            \
  X(SNAPSHOT_DAMAGED, SIGHT, WARNING, FindingsFindNone, "")                                                            \
  /* of the start */                                                                                                   \
  X(PAPER_LAYERS, START, WARNING, FindingsFindPaperLayers, "")                                                         \
  X(LATE_OUTPUT, START, NOTE, FindingsFindLateOutput, "")                                                              \
  X(CLOSED_FACES, START, WARNING, FindingsFindClosedFaces, "")                                                         \
  X(FREE_SIDES, SEEDING, WARNING, FindingsFindFreeSides, "")                                                           \
  X(TORN_PORES, SEEDING, WARNING, FindingsFindTornPores, "")                                                           \
  X(CAPILLARY_JUMP, SEEDING, WARNING, FindingsFindCapillaryJump, "")                                                   \
  X(TRAPPED_GAS, SEEDING, WARNING, FindingsFindTrappedGas, "")                                                         \
  X(UNSTRESSED, SEEDING, WARNING, FindingsFindUnstressed, "")                                                          \
  X(START_TENSION, SEEDING, WARNING, FindingsFindStartTension, "")                                                     \
  X(FAR_PRESSURE, BEGIN, WARNING, FindingsFindFarPressure, "")                                                         \
  X(RISING_GAS, BEGIN, WARNING, FindingsFindRisingGas, "")                                                             \
  X(UNSTABLE_HYDRATE, BEGIN, WARNING, FindingsFindUnstableHydrate, "")                                                 \
  X(FORMING, BEGIN, WARNING, FindingsFindForming, "")                                                                  \
  X(FORMING_BESIDE, BEGIN, NOTE, FindingsFindForming, "")                                                              \
  /* on the way */                                                                                                     \
  X(SLOW, STEP, NOTE, FindingsFindSlow, "")                                                                            \
  X(TEMPERATURE_NOW, STEP, WARNING, FindingsFindTemperature, CL_TRY_CELLS)                                             \
  X(ICE, STEP, WARNING, FindingsFindIce, "")                                                                           \
  X(STILL, STEP, NOTE, FindingsFindStill, "")                                                                          \
  X(GIVEN_UP, SIGHT, END, FindingsFindNone, "")                                                                        \
  X(CAUSE_TORN_PORES, GIVING_UP, CAUSE, FindingsFindTornPores, "")                                                     \
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
