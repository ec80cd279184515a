#include "clathra/eigen.h"
#include <math.h>

/* LAPACK */
void dsyev_(const char *job, const char *triangle, const int *n, double *a, const int *stride, double *value,
            double *work, const int *size, int *info);

bool Eigen(EigenValues *e)
{
  enum { WORK = 24 };
  const int n = 3, size     = WORK;
  double    work[WORK], sum = 0.0;
  int       info;

  for (int k = 0; k < 9; k++)
    sum += e->Q[k / 3][k % 3];
  if (!isfinite(sum))
    return false;
  dsyev_("V", "U", &n, &e->Q[0][0], &n, e->y, work, &size, &info);
  for (int i = 0; i < 3; i++) { /* LAPACK's columns are rows here */
    for (int j = 0; j < i; j++) {
      const double upper = e->Q[j][i];

      e->Q[j][i] = e->Q[i][j];
      e->Q[i][j] = upper;
    }
  }
  return info == 0;
}
