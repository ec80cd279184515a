/* Every key of every group with values that it cannot have, or only just: by the key table, so that a new key is tried
   by itself.  A case is refused with a sentence that names the key, or read; nothing crashes, nothing is passed over.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <glob.h>
#include <cmocka.h>
#include "../../src/case/case_private.h"
#include "ranks.h"

#define GOOD(call) assert_int_equal((call), 0)
#define LONG 1048576

/* As they stand in a file.  NULL: LONG characters. */
static const char *const value[] = {"",
                                    "''",
                                    "\"\"",
                                    "'  '",
                                    "~",
                                    "null",
                                    "[]",
                                    "{}",
                                    "[[]]",
                                    "[a, b]",
                                    "[1, 2, 3, 4, 5, 6, 7]",
                                    "[, ]",
                                    "{a: b}",
                                    "{a: {b: c}}",
                                    "{table: []}",
                                    "{ramp: [1]}",
                                    "1e308",
                                    "-1e308",
                                    "1e309",
                                    "1e308 Pa",
                                    "1e308 1/s",
                                    "nan",
                                    "-inf",
                                    "0x1p3",
                                    "1_000",
                                    "yes",
                                    "-",
                                    "--1",
                                    "'-'",
                                    "1 \xc2\xb5m",
                                    "\xe6\x97\xa5\xe6\x9c\xac",
                                    "\"a\\nb\"",
                                    "\"\\t\"",
                                    "'%s%n'",
                                    "\"\\\"\"",
                                    "1 m/(",
                                    "1 ^^",
                                    "2147483648",
                                    "-2147483649",
                                    "99999999999999999999",
                                    NULL};
/* ... of which an empty one must not pass for the key's default. */
/* Of the keys one in so many is tried, another one on each rank: the sanitizers read a hundred times slower. */
#ifdef __SANITIZE_ADDRESS__
  #define SHARE 12
#else
  #define SHARE 1
#endif

static const char *const nothing[] = {"", "''", "\"\"", "~", "null", "[]", "{}"};

static char folder[] = "/tmp/clathra_values_XXXXXX", said[1 << 16];
static int  tried, refused;
static char cases[PETSC_MAX_PATH_LEN], bp2[PETSC_MAX_PATH_LEN], stages[PETSC_MAX_PATH_LEN]; /* of this tree */

static bool IsNothing(const char *v)
{
  for (size_t i = 0; v && i < sizeof nothing / sizeof *nothing; i++)
    if (!strcmp(v, nothing[i]))
      return true;
  return false;
}

/* Reads a case with what it says kept in `said`. */
static bool Read(const char *path, Case *c)
{
  char log[64];
  bool ok   = false;
  int  copy = dup(2);

  snprintf(log, sizeof log, "%s/log", folder);
  fflush(stderr);
  assert_non_null(freopen(log, "w", stderr));
  const PetscErrorCode ierr = CaseRead(PETSC_COMM_SELF, path, c, &ok);
  fflush(stderr);
  dup2(copy, 2);
  close(copy);
  FILE *f                                  = fopen(log, "r");
  said[fread(said, 1, sizeof said - 1, f)] = 0;
  fclose(f);
  if (ierr)
    fail_msg("an error of PETSc instead of a sentence: %s", said);
  return ok;
}

/* The resolved case with one key of one instance replaced, or added. */
static void WriteWith(const char *path, const char *resolved, Group g, const char *instance, const Key *k,
                      const char *v)
{
  static char filler[LONG + 1];
  char        line[256], inside[80] = "";
  const char *indent = g == GROUP_CASE ? "" : "    ";
  bool        here = g == GROUP_CASE, done = false;
  FILE       *f = fopen(path, "w");

  memset(filler, 'x', LONG);
  filler[LONG] = 0;
  assert_non_null(f);
  snprintf(line, sizeof line, "%s%s:", indent, k->name);
  for (const char *p = resolved, *end; *p; p = end + 1) {
    end = strchr(p, '\n');
    if (!strncmp(p, "  ", 2) && p[2] != ' ')
      snprintf(inside, sizeof inside, "%.*s", (int)(end - p - 3), p + 2);
    const bool group = g != GROUP_CASE && !strncmp(p, case_group[g].prefix, strlen(case_group[g].prefix) - 1) &&
                       p[strlen(case_group[g].prefix) - 1] == ':';
    if (group)
      here = true;
    else if (g != GROUP_CASE && *p != ' ')
      here = false;
    if (here && (g == GROUP_CASE || !strcmp(inside, instance)) && !strncmp(p, line, strlen(line))) {
      fprintf(f, "%s %s\n", line, v ? v : filler);
      done = true;
    } else
      fprintf(f, "%.*s\n", (int)(end - p), p);
    if (here && !done && g != GROUP_CASE && !strncmp(p, "  ", 2) && p[2] != ' ' && !strcmp(inside, instance) &&
        !strstr(resolved, line)) {
      fprintf(f, "%s %s\n", line, v ? v : filler);
      done = true;
    }
  }
  if (!done && g == GROUP_CASE)
    fprintf(f, "%s %s\n", line, v ? v : filler);
  fclose(f);
}

static void Try(const char *resolved, Group g, const char *instance, const Key *k, const char *v)
{
  char path[64], option[256];
  Case c;

  snprintf(path, sizeof path, "%s/case.yaml", folder);
  WriteWith(path, resolved, g, instance, k, v);
  KeyOption(option, sizeof option, g, instance, k->name);
  tried++;
  if (Read(path, &c)) {
    if (IsNothing(v) && (!k->def || *k->def) && KeyNeeded(k, &c))
      fail_msg("%s: '%s' passes for its default", option, v);
    GOOD(CaseDestroy(&c));
    return;
  }
  refused++;
  if (!strstr(said, option) && !strstr(said, "case.yaml:"))
    fail_msg("%s = %s: the message names neither key nor line: %s", option, v ? v : "(long)", said);
}

/* Is it a case in space, which the other program reads? */
static bool InSpace(const char *path)
{
  Case       c;
  const bool reads = Read(path, &c);

  if (reads)
    GOOD(CaseDestroy(&c));
  return !reads && strstr(said, "three axes are clathra3d's");
}

static char *Resolve(const char *path)
{
  Case   c;
  char  *text;
  size_t size;
  FILE  *f = open_memstream(&text, &size);

  if (!Read(path, &c))
    fail_msg("%s", said);
  GOOD(CaseWriteResolved(&c, f));
  fclose(f);
  GOOD(CaseDestroy(&c));
  return text;
}

/* Each key once for each kind of instance that there is in the cases of the tree. */
static void EveryKeyWithEveryValue(void **state)
{
  char   tried_already[64][256] = {{0}}; /* by group or type of boundary, and key */
  glob_t found;
  int    turn = 0, rank, size; /* ranks share the keys */
  char   pattern[PETSC_MAX_PATH_LEN + 16];

  GOOD(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  GOOD(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  snprintf(pattern, sizeof pattern, "%s/*/case.yaml", cases);
  GOOD(glob(pattern, 0, NULL, &found));
  for (size_t n = 0; n < found.gl_pathc; n++) {
    if (InSpace(found.gl_pathv[n]))
      continue;
    char *resolved = Resolve(found.gl_pathv[n]);
    Case  c;

    assert_true(Read(found.gl_pathv[n], &c));
    for (Group g = GROUP_CASE; g < GROUP_COUNT; g++) {
      for (PetscInt i = 0; i < (g == GROUP_CASE ? 1 : *GroupCount(&c, g)); i++) {
        const char *instance = GroupInstance(&c, g, i);
        const int   row      = (int)g + (g == GROUP_BC ? 16 + (int)c.scene.bc[i].type : 0);

        for (int j = 0; case_group[g].key[j].name; j++) {
          const Key *k = &case_group[g].key[j];

          if (tried_already[row][j] || !KeyApplies(k, g, instance) || !KeyNeeded(k, &c))
            continue;
          tried_already[row][j] = 1;
          if (turn++ % (size * SHARE) != rank)
            continue;
          for (size_t v = 0; v < sizeof value / sizeof *value; v++)
            if (IsNothing(value[v]) || (v + (size_t)j) % 3 == 0) /* of the others a third, another one for each key */
              Try(resolved, g, g == GROUP_CASE ? "" : instance, k, value[v]);
        }
      }
    }
    GOOD(CaseDestroy(&c));
    free(resolved);
  }
  globfree(&found);
  print_message("%d cases, %d refused\n", tried, refused);
  assert_true(tried > 2000 / (size * SHARE) && refused > tried / 2);
}

/* The same on the command line, where a value may be missing. */
static void EveryKeyOnTheCommandLine(void **state)
{
  static const char *const given[] = {NULL, "", " ", ",", "1e308", "nan", "a,b,c", "\xc2\xb5"};
  Case                     c, d;
  int                      turn = 0;

  (void)state;
  assert_true(Read(bp2, &c));
  for (Group g = GROUP_CASE; g < GROUP_COUNT; g++) {
    for (PetscInt i = 0; i < PetscMin(1, g == GROUP_CASE ? 1 : *GroupCount(&c, g)); i++) {
      for (const Key *k = case_group[g].key; k->name; k++) {
        char option[256], name[257];

        if (turn++ % SHARE != 0)
          continue;
        KeyOption(option, sizeof option, g, g == GROUP_CASE ? "" : GroupInstance(&c, g, i), k->name);
        snprintf(name, sizeof name, "-%s", option);
        for (size_t v = 0; v < sizeof given / sizeof *given; v++) {
          GOOD(PetscOptionsSetValue(NULL, name, given[v]));
          if (Read(bp2, &d))
            GOOD(CaseDestroy(&d));
          else if (!strstr(said, option))
            fail_msg("%s = %s: the message does not name it: %s", name, given[v] ? given[v] : "(nothing)", said);
          GOOD(PetscOptionsClearValue(NULL, name));
        }
      }
    }
  }
  GOOD(CaseDestroy(&c));
}

/* Another value of a key; false: it has none here. */
static bool Change(const Key *k, char *instance)
{
  char *place = instance + k->offset;

  switch (k->kind) {
  case KEY_REAL:
    *(double *)place = isfinite(*(double *)place) ? *(double *)place + 1 : 1;
    return true;
  case KEY_INT:
  case KEY_NAME:
    ++*(PetscInt *)place;
    return true;
  case KEY_CHOICE:
    ++*(int *)place;
    return true;
  case KEY_BOOL:
    *(bool *)place = !*(bool *)place;
    return true;
  case KEY_TEXT:
    *place = 'x';
    return true;
  case KEY_LAW: {
    const char *const *type = k->law->types(), *now = k->law->get((Material *)instance);

    return k->law->set((Material *)instance, type[!strcmp(now, type[0])]);
  }
  case KEY_SCHEDULE:
    if (!((Schedule *)place)->n)
      *(Schedule *)place = (Schedule){.n = 1, .t = calloc(1, sizeof(double)), .y = calloc(1, sizeof(double))};
    ((Schedule *)place)->y[0] = 12345;
    return true;
  case KEY_POINTS: {
    Points *points = (Points *)place;

    if (!points->n)
      GOOD(PetscCalloc1(2, &points->x));
    points->n = PetscMax(points->n, 1);
    points->x[0] += 1;
    return true;
  }
  case KEY_NAMES: {
    Names *names = (Names *)place;

    if (!names->n)
      GOOD(PetscCalloc1(1, &names->i));
    names->n = PetscMax(names->n, 1);
    ++names->i[0];
    return true;
  }
  case KEY_REALS:
    return false;
  }
  return false;
}

/* A checkpoint is refused when any key was changed, but those that a restart may change. */
static void EveryKeyIsInTheFingerprint(void **state)
{
  Case c;
  int  changed = 0;

  for (Group g = GROUP_CASE; g < GROUP_COUNT; g++) {
    for (const Key *k = case_group[g].key; k->name; k++) {
      bool mine = g != GROUP_PROBE && !k->like && !KeyMayChange(k, g); /* the values that like stands for are */

      assert_true(Read(bp2, &c));
      mine = mine && (g == GROUP_CASE || !*GroupCount(&c, g) || KeyActs(k, &c, GroupInstance(&c, g, 0)));
      const uint64_t before = CaseFingerprint(&c);

      if ((g == GROUP_CASE || *GroupCount(&c, g)) && Change(k, GroupInstance(&c, g, 0))) {
        if ((before != CaseFingerprint(&c)) != mine)
          fail_msg("%s%s: %s", case_group[g].prefix, k->name, mine ? "a restart would pass over it" : "it may change");
        changed++;
      }
      GOOD(CaseDestroy(&c));
    }
  }
  assert_true(changed > 80);
}

/* ... also what a stage changes of the scene, however it is said. */
static void EveryStageIsInTheFingerprint(void **state)
{
  static const struct {
    const char *option, *value;
    bool        mine;
  } change[] = {{"-stage_settle_end", "50 a", true},
                {"-stage_strike_end", "3155760000.2 s", false},
                {"-stage_settle_reset_displacement", "yes", true},
                {"-stage_settle_inertia", "yes", true},
                {"-stage_strike_kinetics_active", "no", true},
                {"-stage_strike_gravity", "0 m/s^2,-1 m/s^2", true},
                {"-stage_strike_gravity_ramp", "1 ms", true},
                {"-gravity", "0 m/s^2,-1 m/s^2", true},
                {"-ambient_density", "1000 kg/m^3", true},
                {"-bc_blow_clock", "run", true},
                {"-bc_blow_normal", "1 Pa", true},
                {"-stage_strike_boundaries", "base,left,right,wall", true},
                {"-stage_strike_boundaries_off", "base", true},
                {"-stage_strike_boundaries", "blow,wall,right,left,base", false},
                {"-stage_strike_materials", "column,soft", true},
                {"-stage_strike_materials", "column,soil", false},
                {"-mat_soil_porosity", "0.41", true},
                {"-stage_strike_stepper_type", "sdirk2", false},
                {"-stage_strike_stepper_damping", "0.1", false},
                {"-stage_strike_output_probe_every", "1 ms", false},
                {"-stage_strike_checkpoint_every", "1 ms", false}};
  Case c, d;

  (void)state;
  assert_true(Read(stages, &c));
  assert_true(CaseFingerprint(&c) == CaseFingerprint(CaseInStage(&c, 0)));
  for (size_t i = 0; i < sizeof change / sizeof *change; i++) {
    GOOD(PetscOptionsSetValue(NULL, change[i].option, change[i].value));
    if (!Read(stages, &d))
      fail_msg("%s %s: %s", change[i].option, change[i].value, said);
    if ((CaseFingerprint(&c) != CaseFingerprint(&d)) != change[i].mine)
      fail_msg("%s %s: %s", change[i].option, change[i].value,
               change[i].mine ? "a restart would pass over it" : "it may change");
    GOOD(CaseDestroy(&d));
    GOOD(PetscOptionsClearValue(NULL, change[i].option));
  }
  GOOD(CaseDestroy(&c));
}

static int MakeFolder(void **state)
{
  (void)state;
  return !mkdtemp(folder);
}

static int RemoveFolder(void **state)
{
  char command[128];

  (void)state;
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  return system(command);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(EveryKeyWithEveryValue), cmocka_unit_test(EveryKeyOnTheCommandLine),
      cmocka_unit_test(EveryKeyIsInTheFingerprint), cmocka_unit_test(EveryStageIsInTheFingerprint)};
  const char *up = strstr(__FILE__, "tests/unit");

  snprintf(cases, sizeof cases, "%.*scases", (int)(up - __FILE__), __FILE__);
  snprintf(bp2, sizeof bp2, "%.*scases/bp2/case.yaml", (int)(up - __FILE__), __FILE__);
  snprintf(stages, sizeof stages, "%.*stests/integration/cases/stages.yaml", (int)(up - __FILE__), __FILE__);
  return RunTests(argc, argv, tests, MakeFolder, RemoveFolder);
}
