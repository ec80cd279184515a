/* fieldset: which fields a scene needs, as its case names them, or as follows from what is identically zero in it. */
#include "case_private.h"
#include "clathra/skeleton.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define FIELDS_ALLOWED "auto, a list of solid, water, gas, heat, or one of thmc thc hmc hc thm hm th h tm m t"

/* A key as it stands in the case. */
static PetscErrorCode PeekFound(Reader *r, const Case *c, Group g, PetscInt i, const char *key, Found *f)
{
  const Key *k = case_group[g].key;

  PetscFunctionBeginUser;
  while (strcmp(k->name, key))
    k++;
  PetscCall(KeyFind(r, c, g, i, k, f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Its text, NULL if it is not given. */
static PetscErrorCode Peek(Reader *r, const Case *c, Group g, PetscInt i, const char *key, const char **text)
{
  Found f;

  PetscFunctionBeginUser;
  PetscCall(PeekFound(r, c, g, i, key, &f));
  *text = f.text;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets *reacts if the material does; a bare option on the command line is a yes. */
static PetscErrorCode PeekReacts(Reader *r, const Case *c, PetscInt material, bool *reacts)
{
  Found f;
  bool  yes;

  PetscFunctionBeginUser;
  PetscCall(PeekFound(r, c, GROUP_MATERIAL, material, "kinetics_active", &f));
  if (f.text)
    *reacts = *reacts || (YesNoRead(f.text, &yes) && yes);
  else
    *reacts = *reacts || (f.found && !f.from_file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the materials say: some hydrate reacts; every skeleton is rigid. */
static PetscErrorCode PeekMaterials(Reader *r, const Case *c, bool *reacts, bool *rigid)
{
  const char *text;

  PetscFunctionBeginUser;
  *reacts = false;
  *rigid  = c->scene.nmaterial > 0;
  for (PetscInt i = 0; i < c->scene.nmaterial; i++) {
    PetscCall(PeekReacts(r, c, i, reacts));
    PetscCall(Peek(r, c, GROUP_MATERIAL, i, "elasticity_E0", &text));
    *rigid = *rigid && text && !strcasecmp(text, "rigid");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the regions say: some hold gas; all have the same temperature everywhere. */
static PetscErrorCode PeekRegions(Reader *r, const Case *c, bool *gas, bool *uniform)
{
  const char *text, *first = NULL;
  bool        any = false;

  PetscFunctionBeginUser;
  *gas     = false;
  *uniform = true;
  for (PetscInt i = 0; i < c->scene.nregion; i++) {
    const char *sw;

    PetscCall(Peek(r, c, GROUP_REGION, i, "material", &text));
    if (text && !strcasecmp(text, "none"))
      continue; /* without particles */
    PetscCall(Peek(r, c, GROUP_REGION, i, "Sw", &sw));
    PetscCall(Peek(r, c, GROUP_REGION, i, "Sg", &text));
    *gas = *gas || (text ? strtod(text, NULL) != 0.0 : sw != NULL);
    PetscCall(Peek(r, c, GROUP_REGION, i, "temperature", &text));
    if (!any)
      first = text;
    any      = true;
    *uniform = *uniform && (first && text ? !strcmp(first, text) : first == text);
    PetscCall(Peek(r, c, GROUP_REGION, i, "geothermal", &text));
    *uniform = *uniform && !(text && strtod(text, NULL) != 0.0);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a condition prescribe heat? */
static PetscErrorCode PeekHeated(Reader *r, const Case *c, bool *heated)
{
  const char *text;

  PetscFunctionBeginUser;
  *heated = false;
  for (PetscInt i = 0; i < c->scene.nbc; i++) {
    PetscCall(Peek(r, c, GROUP_BC, i, "type", &text));
    for (int k = 0; text && case_bc_type[k]; k++)
      *heated = *heated || (!strcasecmp(text, case_bc_type[k]) && cl_condition[k + 1].has == HAS_HEAT);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a function of time given, in any form (and, unless zero counts, is it not the constant zero)? */
static PetscErrorCode PeekSchedule(Reader *r, const char *instance, const char *key, bool zero, bool *given)
{
  PetscFunctionBeginUser;
  for (int f = 0; case_schedule_form[f]; f++) {
    const char *text;
    char        name[64], option[256];
    bool        found, from_file;

    snprintf(name, sizeof name, "%s%s", key, case_schedule_form[f]);
    KeyOption(option, sizeof option, GROUP_BC, instance, name);
    PetscCall(ReaderFind(r, option, &text, &found, &from_file));
    *given = *given || (text && (f > 0 || zero || strtod(text, NULL) != 0.0));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What crosses the boundary: gas; water or gas with a temperature of its own. */
static PetscErrorCode PeekFlows(Reader *r, const Case *c, bool *gas, bool *heated)
{
  const char *text;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->scene.nbc; i++) {
    PetscCall(Peek(r, c, GROUP_BC, i, "type", &text));
    if (text && !strcasecmp(text, "pressure"))
      PetscCall(PeekSchedule(r, c->scene.bc[i].name, "p_g", false, gas));
    if (!text || strcasecmp(text, "inflow"))
      continue;
    PetscCall(PeekSchedule(r, c->scene.bc[i].name, "gas", false, gas));
    PetscCall(PeekSchedule(r, c->scene.bc[i].name, "temperature", true, heated));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is there hydrate at the start, or may it form? */
static PetscErrorCode PeekHydrate(Reader *r, const Case *c, bool *hydrate)
{
  const char *text;
  bool        rigid;

  PetscFunctionBeginUser;
  PetscCall(PeekMaterials(r, c, hydrate, &rigid));
  for (PetscInt i = 0; i < c->scene.nregion; i++) {
    PetscCall(Peek(r, c, GROUP_REGION, i, "Sh", &text));
    *hydrate = *hydrate || (text && strtod(text, NULL) != 0.0);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FieldsDerive(Reader *r, const Case *c, unsigned *has)
{
  bool reacts, rigid, gas, uniform, heated;

  PetscFunctionBeginUser;
  PetscCall(PeekMaterials(r, c, &reacts, &rigid));
  PetscCall(PeekRegions(r, c, &gas, &uniform));
  PetscCall(PeekHeated(r, c, &heated));
  PetscCall(PeekFlows(r, c, &gas, &heated));
  *has = HAS_ALL;
  if (rigid)
    *has &= ~(unsigned)HAS_SOLID;
  if (!gas && !reacts)
    *has &= ~(unsigned)HAS_GAS;
  if (!reacts && uniform && !heated && !c->scene.compression_heat)
    *has &= ~(unsigned)HAS_HEAT;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static unsigned FieldsParse(Reader *r, const char *text)
{
  unsigned has = FieldSetByName(text);
  List     list;

  if (has)
    return has;
  ListCreate(text, &list);
  for (PetscInt i = 0; i < list.n; i++) {
    unsigned bit = 0;

    for (int k = 0; cl_field_word[k]; k++) {
      if (!strcasecmp(cl_field_word[k], list.item[i]))
        bit = 1u << k;
    }
    if (!bit) {
      ReaderError(r, "fields", list.item[i], "must be %s", FIELDS_ALLOWED);
      has = 0;
      break;
    }
    has |= bit;
  }
  ListDestroy(&list);
  return has;
}

PetscErrorCode CaseFieldSet(Reader *r, Case *c)
{
  const bool derive = !strcasecmp(c->fields_wanted, "auto");
  PetscInt   before = r->nerror;
  unsigned   has    = HAS_ALL;
  bool       hydrate;

  PetscFunctionBeginUser;
  if (derive)
    PetscCall(FieldsDerive(r, c, &has));
  else
    has = FieldsParse(r, c->fields_wanted);
  if (!FieldSetMake(has, c->scene.inertia, &c->scene.fields)) {
    if (r->nerror == before)
      ReaderError(r, "fields", c->fields_wanted, "has gas without water, which no scene here can have; must be %s",
                  FIELDS_ALLOWED);
    FieldSetMake(HAS_ALL, c->scene.inertia, &c->scene.fields); /* so that the rest of the case is read */
  }
  PetscCall(PeekHydrate(r, c, &hydrate));
  c->scene.fields.has |= hydrate ? HAS_HYDRATE : 0u;
  c->fields_wanted[0] = '\0'; /* the resolved case names what was found */
  for (int k = 0; cl_field_word[k]; k++) {
    if (!(c->scene.fields.has & (1u << k)))
      continue;
    PetscCall(PetscStrlcat(c->fields_wanted, c->fields_wanted[0] ? "," : "", sizeof c->fields_wanted));
    PetscCall(PetscStrlcat(c->fields_wanted, cl_field_word[k], sizeof c->fields_wanted));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void FieldsWords(unsigned has, char text[64])
{
  text[0] = '\0';
  for (int k = 0; cl_field_word[k]; k++) {
    if (!(has & (1u << k)))
      continue;
    if (text[0])
      strcat(text, " or ");
    strcat(text, cl_field_word[k]);
  }
  if (has & HAS_HYDRATE)
    strcat(strcat(text, text[0] ? " or " : ""), "hydrate");
}

void CaseFieldSetFinish(Reader *r, Case *c)
{
  const FieldSet *fs = &c->scene.fields;

  for (PetscInt i = 0; i < c->scene.nmaterial && fs->solid; i++)
    c->scene.fields.has |= SkeletonHas(&c->scene.material[i]);
  for (PetscInt i = 0; i < c->scene.nregion && !r->bad[GROUP_REGION]; i++) {
    Region *g = &c->scene.region[i];

    if (fs->phase[PHASE_W] && !fs->phase[PHASE_G] && g->material >= 0 && g->Sw == 0.0 && g->Sg == 0.0)
      g->Sw = 1.0 - g->Sh; /* a lone fluid fills the pores */
  }
}

static void CheckFluids(Reader *r, const Case *c, const Region *g)
{
  const FieldSet *fs = &c->scene.fields;

  if (g->Sg != 0.0 && !fs->phase[PHASE_G])
    FAIL_AT(GROUP_REGION, g->name, "Sg", "is %g but gas is not among the fields of the scene (%s)", g->Sg,
            c->fields_wanted);
  else if (g->Sw != 0.0 && !fs->fluid)
    FAIL_AT(GROUP_REGION, g->name, "Sw", "is %g but water is not among the fields of the scene (%s)", g->Sw,
            c->fields_wanted);
}

void CheckFields(Reader *r, const Case *c)
{
  const FieldSet *fs = &c->scene.fields;
  char            words[64];

  for (PetscInt i = 0; i < c->scene.nregion && !r->bad[GROUP_REGION]; i++) {
    if (c->scene.region[i].material >= 0)
      CheckFluids(r, c, &c->scene.region[i]);
  }
  for (PetscInt i = 0; i < c->scene.nbc && !r->bad[GROUP_BC]; i++) {
    const Condition *kind = &cl_condition[c->scene.bc[i].type];

    FieldsWords(kind->has, words);
    if (!(fs->has & kind->has))
      FAIL_AT(GROUP_BC, c->scene.bc[i].name, "type", "%s needs %s, which is not among the fields of the scene (%s)",
              kind->word, words, c->fields_wanted);
  }
  for (PetscInt i = 0; i < c->scene.nmaterial && !r->bad[GROUP_MATERIAL]; i++) {
    const Material *m = &c->scene.material[i];

    if (m->reacts && !fs->phase[PHASE_G])
      FAIL_AT(GROUP_MATERIAL, m->name, "kinetics_active", "yes needs water and gas among the fields of the scene (%s)",
              c->fields_wanted);
    if (fs->solid && isinf(m->elasticity.E0))
      FAIL_AT(GROUP_MATERIAL, m->name, "elasticity_E0",
              "is rigid but solid is among the fields of the scene (%s): give every material's E0, or leave solid out",
              c->fields_wanted);
  }
}
