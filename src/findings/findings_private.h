/* findings_private: shared by the files of src/findings. */
#pragma once

#include "clathra/findings.h"

/* Looks for what the row `id` of the table is about, and says it.  Collective. */
typedef PetscErrorCode FindingsFind(Findings *f, FindingId id);
#define DECLARE(id, when, kind, find, what_to_try) FindingsFind find;
CL_FINDINGS(DECLARE)
#undef DECLARE

/* Says it, in a function that looks for it; with what to try where the state decides on that. */
#define SAY(...) PetscCall(FindingSay(f->comm, id, __VA_ARGS__))
#define SAY_TRY(what_to_try, ...) PetscCall(FindingSayOf(f->comm, id, NULL, what_to_try, __VA_ARGS__))
/* Is far more left than was forecast, in steps or s of the wall, after far more than was forecast? */
bool FindingsIsSlow(const Slow *slow, const Forecast *f, const Pace *pace);
