/* solver_words: what -newton_preconditioner and -newton_operator may say, in the order of the solver's enumerations;
   NULL at the end. */
#pragma once

extern const char *const solver_preconditioner[], *const solver_operator[];
