/* fields: the six fields of the model, their nine nodal unknowns in the plane, and their equations. */
#pragma once

enum { F_VSX = 0, F_VSY, F_VWX, F_VWY, F_VGX, F_VGY, F_PW, F_PG, F_T, F_COUNT };
enum { PHASE_W = 0, PHASE_G = 1, PHASE_COUNT };

typedef struct {
  const char *name, *unit, *equation;
} FieldInfo;

extern const FieldInfo cl_field[F_COUNT];
