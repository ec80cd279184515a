/* flow: keys of the conditions on fluids that must agree with each other and with the fields of the scene. */
#include "case_private.h"

#define FAIL(b, key, ...) FAIL_AT(GROUP_BC, (b)->name, key, __VA_ARGS__)

void CheckField(Reader *r, const Scene *c, const Bc *b, const char *key, unsigned needs, bool given)
{
  char words[64];

  if (!given || (c->fields.has & needs))
    return;
  FieldsWords(needs, words);
  FAIL(b, key, "needs %s, which is not among the fields of the scene (%s)", words, CaseOf(c)->fields_wanted);
}

/* p_w and p_g stand for themselves, and both for a face that is open for both. */
static void CheckPhases(Reader *r, const Scene *c, const Bc *b)
{
  const char *const key[PHASE_COUNT]   = {"p_w", "p_g"};
  const bool        given[PHASE_COUNT] = {b->phase[PHASE_W].n > 0, b->phase[PHASE_G].n > 0};
  const bool        need[PHASE_COUNT]  = {b->open != OPEN_GAS, b->open != OPEN_WATER && c->fields.phase[PHASE_G]};

  if (!given[PHASE_W] && !given[PHASE_G])
    return;
  if (b->value.n || b->initial)
    FAIL(b, given[PHASE_W] ? "p_w" : "p_g", "leaves nothing for %s to say: give the mean, or each fluid's own pressure",
         b->value.n ? "pressure" : "initial");
  if (b->natural)
    FAIL(b, "saturation", "is free, which goes with pressure or initial, not with p_w and p_g");
  for (int ph = 0; ph < PHASE_COUNT; ph++) {
    if (need[ph] && !given[ph])
      FAIL(b, key[ph], "is missing: %s is given, and the face is open for both fluids", key[1 - ph]);
  }
}

/* The word ambient wants a fluid around the body. */
static void CheckAmbient(Reader *r, const Scene *c, const Bc *b)
{
  if (b->value.n == 1 && isinf(b->value.y[0]) && ScheduleIsZero(&c->ambient_pressure) && c->ambient_density == 0.0)
    FAIL(b, "pressure", "is ambient, but the case has neither ambient_pressure nor ambient_density");
}

void CheckFlow(Reader *r, const Scene *c, const Bc *b)
{
  if (b->type == BC_PRESSURE) {
    CheckAmbient(r, c, b);
    CheckField(r, c, b, "p_g", HAS_GAS, b->phase[PHASE_G].n);
    CheckField(r, c, b, "phases", HAS_GAS, b->open == OPEN_GAS);
    CheckPhases(r, c, b);
  } else if (b->type == BC_INFLOW) {
    CheckField(r, c, b, "gas", HAS_GAS, !ScheduleIsZero(&b->phase[PHASE_G]));
    CheckField(r, c, b, "temperature", HAS_HEAT, b->value.n);
  }
}
