/* Where blocks of the tangent go: J2 or the reduced matrix. */
#include "gather.h"

static void Add(Assembly *to, int first, int count)
{
  for (int k = 0; k < count; k++)
    to->out[to->nout++] = first + k;
}

void AssemblyOf(const Model *m, const FieldSet *fs, Assembly *to)
{
  *to = (Assembly){.fs = *fs, .eliminated = fs->fluid && PlaceV(fs, PHASE_W) < 0};
  /* eliminated fluids push the mixture as they are accelerated (173) */
  to->force = m->bc.ambient.on || (to->eliminated && fs->inertia);
  if (fs->solid) {
    Add(to, OUT_P, 4);
    Add(to, OUT_M, 1);
    if (m->c->axisymmetric)
      Add(to, OUT_HOOP, 1);
    if (to->force)
      Add(to, OUT_A, 2);
  }
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    Add(to, OUT_FLUX + 2 * f, 2);
    Add(to, OUT_DM + f, 1);
    if (fs->solid)
      Add(to, OUT_M + 1 + f, 1);
    if (to->eliminated)
      continue;
    Add(to, OUT_G + 2 * f, 2);
    Add(to, OUT_MI + f, 1);
    Add(to, OUT_D + f, 1);
    if (m->fluid)
      Add(to, OUT_ROOT + f, 1);
  }
  if (fs->heat) {
    Add(to, OUT_HEAT, 2);
    Add(to, OUT_C, 2); /* and OUT_Q */
  }
}

/* Into J2: rows and columns scaled, rows of prescribed unknowns empty. */
static PetscErrorCode AddScaled(Model *m, int n, const PetscInt *node, double *block)
{
  const int nf = m->c->fields.n, ld = n * nf;

  PetscFunctionBeginUser;
  for (int row = 0; row < ld; row++) {
    const PetscInt I     = node[row / nf];
    const PetscInt k     = I * nf + row % nf;
    const bool     fixed = (m->mask[I] >> (row % nf)) & 1u;
    const double   scale = fixed ? 0.0 : 1.0 / m->row_scale[k];
    double        *out   = &block[row * ld];

    for (int b = 0; b < n; b++) {
      const double *col = &m->col_scale[node[b] * nf];

      for (int q = 0; q < nf; q++)
        out[b * nf + q] *= scale * col[q];
    }
  }
  PetscCall(MatSetValuesBlockedLocal(m->J2, n, node, n, node, block, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AssemblyAdd(Model *m, const Assembly *to, int n, const PetscInt *node, double *block)
{
  PetscFunctionBeginUser;
  if (to->reduced)
    ReducedAdd(m, n, node, block);
  else
    PetscCall(AddScaled(m, n, node, block));
  PetscFunctionReturn(PETSC_SUCCESS);
}
