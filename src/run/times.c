/* The times at which a run writes.  Steps end exactly on them, so t is one of them or is not. */
#include "run_private.h"
#include "clathra/words.h"

double NextMultiple(const Case *c, double every, double t)
{
  const double at = t - c->scene.t_begin + 4.0 * PETSC_MACHINE_EPSILON * fabs(t);

  return every > 0.0 ? c->scene.t_begin + every * (floor(at / every * (1.0 + 1e-12) + 1e-9) + 1.0) : INFINITY;
}

double NextSnapshot(const Case *c, double t)
{
  double next = NextMultiple(c, c->every, t);

  for (PetscInt k = 0; k < c->ntimes; k++) {
    if (c->times[k] > t + SceneTimeSlack(&c->scene, t))
      next = fmin(next, c->times[k]);
  }
  return next;
}

static bool IsTime(const Case *c, double event, double t)
{
  return fabs(event - t) <= 1e-9 * fabs(t - c->scene.t_begin) + SceneTimeSlack(&c->scene, t);
}

bool AtMultiple(const Case *c, double every, double t)
{
  return every > 0.0 && IsTime(c, c->scene.t_begin + every * round((t - c->scene.t_begin) / every), t);
}

bool AtSnapshot(const Case *c, double t)
{
  bool at = AtMultiple(c, c->every, t);

  for (PetscInt k = 0; k < c->ntimes; k++)
    at = at || IsTime(c, c->times[k], t);
  return at;
}
