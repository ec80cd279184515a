/* Loops over blocks of particles of one material. */
#include "lanes.h"

void ForRuns(Explicit *e, const LoopTable table, double dt)
{
  const Loop      loop   = table[e->set.solid][e->set.fluids][e->set.heat];
  const Case     *c      = e->m->c;
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
