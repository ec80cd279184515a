/* program: values of the options that are the program's own and no case file holds. */
#include "case_private.h"
#include "clathra/solver_words.h"
#include <math.h>
#include <stdio.h>
#include <strings.h>

static const char *const logical[] = {"yes", "no", "true", "false", "on", "off", "1", "0", NULL}; /* of PETSc */

static const struct {
  const char        *name;
  const char *const *words;
} program_word[] = {
    {"-newton_preconditioner", solver_preconditioner},
    {"-newton_operator", solver_operator},
    {"-case_keys", logical},
    {"-case_check", logical},
    {"-case_curves", logical},
    {"-quiet", logical},
    {"-overwrite", logical},
};

static const struct {
  const char *name, *unit, *range;
  bool        whole;
} program_number[] = {
    {"-time_limit", "s", "(0,inf)", false},       {"-checkpoint_wall", "s", "[0,inf)", false},
    {"-progress", "s", "[0,inf)", false},         {"-stepper_max_steps", "", "[0,1e9]", true},
    {"-newton_refactor", "", "[0,1e9]", true},    {"-newton_keep_jacobian", "", "[0,inf)", false},
    {"-newton_tol_residual", "", "(0,1)", false}, {"-newton_tol_update", "", "(0,1)", false},
    {"-newton_drop", "", "[0,1)", false},
};

/* May an option say this?  A bare logical one says yes. */
static bool WordAllowed(const char *text, const char *const *words)
{
  const char *const *word = words;

  while (*word && strcasecmp(*word, text))
    word++;
  return *word || (!*text && words == logical);
}

static PetscErrorCode WordsCheck(Reader *r)
{
  PetscFunctionBeginUser;
  for (size_t k = 0; k < sizeof program_word / sizeof *program_word; k++) {
    char      text[96];
    PetscBool given;

    PetscCall(PetscOptionsGetString(NULL, NULL, program_word[k].name, text, sizeof text, &given));
    if (given && !WordAllowed(text, program_word[k].words))
      WordError(r, program_word[k].name, text, program_word[k].words);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CaseKeysAsked(PetscBool *asked)
{
  char      text[96];
  PetscBool given;

  PetscFunctionBeginUser;
  *asked = PETSC_FALSE;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-case_keys", text, sizeof text, &given));
  if (given && WordAllowed(text, logical))
    PetscCall(PetscOptionsGetBool(NULL, NULL, "-case_keys", asked, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProgramRead(Reader *r)
{
  PetscFunctionBeginUser;
  PetscCall(WordsCheck(r));
  for (size_t k = 0; k < sizeof program_number / sizeof *program_number; k++) {
    const char *name = program_number[k].name, *unit = program_number[k].unit, *end;
    char        text[96], full[128];
    double      value;
    PetscBool   given;

    PetscCall(PetscOptionsGetString(NULL, NULL, name, text, sizeof text, &given));
    if (!given)
      continue;
    const bool plain = NumberParse(text, &value, &end) && !*end;
    snprintf(full, sizeof full, "%s%s%s", text, plain && *unit ? " " : "", plain ? unit : "");
    if (!RealRead(r, name, full, unit, program_number[k].range, &value))
      continue;
    if (program_number[k].whole && value != floor(value))
      ReaderError(r, name, text, "must be a whole number");
    snprintf(full, sizeof full, "%.17g", value);
    PetscCall(PetscOptionsSetValue(NULL, name, full));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
