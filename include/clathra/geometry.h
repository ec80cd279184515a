/* geometry: points, segments and polygons of the plane; pure functions.  A list of n points is x0 y0 x1 y1 ...
   Units: m. */
#pragma once

#include "clathra/base.h"

/* Is x inside the closed polygon of n points?  Of two polygons that share an edge, exactly one holds a point on it. */
bool PolygonHolds(PetscInt n, const double *point, const double x[]);
/* Is x under the line through n points that ascend in x?  Not left or right of its ends.  On the line it decides as
   PolygonHolds does. */
bool LineCovers(PetscInt n, const double *point, const double x[]);
/* Does the closed polygon touch or cross itself?  pair: the first points of two sides that do. */
bool PolygonCrosses(PetscInt n, const double *point, PetscInt pair[2]);
/* Do the segments ab and cd meet (ends count, parallel ones never do)?  *t: where on ab, 0 at a, 1 at b. */
bool SegmentsMeet(const double a[], const double b[], const double c[], const double d[], double *t);
