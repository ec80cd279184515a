/* key_rows: how a row of the key table is written, and the tables by subject. */
#pragma once

#include "case_private.h"
#include <stddef.h>

/* A default for every axis, and how an example of such a list is written. */
#if CL_DIM == 2
  #define EACH(word) word ", " word
  #define AXES_WORDS "x and y"
  #define PLANE_WORD "plane"
  #define IN_SPACE(...)
#else
  #define EACH(word) word ", " word ", " word
  #define AXES_WORDS "x, y and z"
  #define PLANE_WORD "space"
  #define IN_SPACE(...) __VA_ARGS__
#endif

/* Rows: name, member, [unit, range,] default, meaning, then whatever is special about the key. */
#define ROW(T, name_, kind_, member_, count_, unit_, range_, def_, doc_, ...)                                          \
  {                                                                                                                    \
    .name = name_, .kind = kind_, .offset = offsetof(T, member_), .count = count_, .unit = unit_, .range = range_,     \
    .def = def_, .doc = doc_, ##__VA_ARGS__                                                                            \
  }
#define REALS(T, n, name, member, unit, range, def, doc, ...)                                                          \
  ROW(T, name, KEY_REAL, member, n, unit, range, def, doc, ##__VA_ARGS__)
#define REAL(T, name, member, unit, range, def, doc, ...)                                                              \
  ROW(T, name, KEY_REAL, member, 1, unit, range, def, doc, ##__VA_ARGS__)
#define INTEGERS(T, n, name, member, range, def, doc, ...)                                                             \
  ROW(T, name, KEY_INT, member, n, "", range, def, doc, ##__VA_ARGS__)
#define BOOLEAN(T, name, member, def, doc, ...) ROW(T, name, KEY_BOOL, member, 1, "", "", def, doc, ##__VA_ARGS__)
#define TEXT(T, name, member, def, doc, ...)                                                                           \
  ROW(T, name, KEY_TEXT, member, sizeof(((T *)0)->member), "", "", def, doc, ##__VA_ARGS__)
#define CHOICE(T, name, member, def, words, doc, ...)                                                                  \
  ROW(T, name, KEY_CHOICE, member, 1, "", "", def, doc, .choices = words, ##__VA_ARGS__)
#define NAME(T, name, member, def, group, doc, ...)                                                                    \
  ROW(T, name, KEY_NAME, member, 1, "", "", def, doc, .names = group, ##__VA_ARGS__)
/* read by CaseLike; the member is not used */
#define LIKE(T, group, doc)                                                                                            \
  ROW(T, "like", KEY_NAME, name, 1, "", "", "none", doc, .names = group, .word = "none", .shape = true, .own = true,   \
      .like = true)
#define NAMES(T, name, member, group, doc, ...)                                                                        \
  ROW(T, name, KEY_NAMES, member, 0, "", "", "", doc, .names = group, ##__VA_ARGS__)
#define POINTS(T, name, member, doc, ...) ROW(T, name, KEY_POINTS, member, 0, "m", "", "", doc, ##__VA_ARGS__)
/* a law is set by its function; the member is not used */
#define LAWKEY(name, def, law_, doc, ...)                                                                              \
  ROW(Material, name, KEY_LAW, porosity, 1, "", "", def, doc, .law = &law_, ##__VA_ARGS__)
#define SCHEDULE(name, member, unit, range, def, types_, doc, ...)                                                     \
  ROW(Bc, name, KEY_SCHEDULE, member, 1, unit, range, def, doc, .types = types_, ##__VA_ARGS__)
#define WHEN(condition, words) .needed = condition, .when = words
/* does nothing otherwise; is required besides */
#define ACTS(condition, words) .acts = condition, .idle = words
/* what particles hold means something else with another value, where there are any of these fields */
#define BINDS(fields) .binds = fields
/* known to these kinds of integrators alone */
#define BY(kinds) .by = BY_##kinds
#define OFLAW(condition, words) WHEN(condition, words), ACTS(condition, words)

/* Rows, ended by one without a name. */
extern const Key case_key[], stage_key[];  /* keys_case.c */
extern const Key material_key[];           /* keys_material.c */
extern const Key region_key[];             /* keys_region.c */
extern const Key bc_key[];                 /* keys_bc.c */
extern const Key probe_key[], meter_key[]; /* keys_probe.c */
