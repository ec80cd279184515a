/* Calls of the loops made for each set of fields. */
#include "lanes.h"

void ForRuns(Explicit *e, const LoopTable table, double dt)
{
  const Loop      loop   = table[e->set.solid][e->set.fluids][e->set.heat];
  const Scene    *c      = e->m->c;
  const PetscInt *region = e->m->P.i[PI_REGION];

  for (PetscInt p = 0; p < e->m->P.n;) {
    const PetscInt material = c->region[region[p]].material;
    int            n        = 1;

    while (n < BLOCK && p + n < e->m->P.n && c->region[region[p + n]].material == material)
      n++;
    loop(e, (Run){p, n, &c->material[material]}, dt);
    p += n;
  }
}

void ForNodes(Explicit *e, const LoopTable table, double dt)
{
  table[e->set.solid][e->set.fluids][e->set.heat](e, (Run){0, (int)e->map.n_owned, NULL}, dt);
}
