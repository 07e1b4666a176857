// Chipmunk on pairs of convex polygons, in the plane, by the library in pymunk, which has no headers. Compiled and called
// by bench/outline_peers.py. Chipmunk gives no distance of shapes that are apart.
#include <math.h>
#include <stdlib.h>

typedef struct { double x, y; } cpVect;
typedef struct { double a, b, c, d, tx, ty; } cpTransform;
typedef struct {
  int count;
  cpVect normal;
  struct { cpVect a, b; double distance; } points[2];
} cpContactPointSet;
typedef struct cpShape cpShape;
typedef struct cpBody cpBody;
typedef struct { double l, b, r, t; } cpBB;

cpBody* cpBodyNewStatic(void);
cpShape* cpPolyShapeNew(cpBody*, int count, const cpVect* corners, cpTransform, double radius);
cpBB cpShapeCacheBB(cpShape*);
cpContactPointSet cpShapesCollide(const cpShape*, const cpShape*);

cpShape** make(const double* xy, const int* starts, int count) {
  cpShape** made = malloc(count * sizeof(cpShape*));
  for (int k = 0; k < count; ++k) {
    const cpVect* corners = (const cpVect*)xy + starts[k];
    const cpTransform here = {1, 0, 0, 1, 0, 0};
    made[k] = cpPolyShapeNew(cpBodyNewStatic(), starts[k + 1] - starts[k], corners, here, 0);
    cpShapeCacheBB(made[k]);
  }
  return made;
}

// Pair i is polygons 2 i and 2 i + 1. Queries: 'o' overlap, 1 or 0; 'd' depth.
void ask(cpShape* const* polygons, int pairs, char query, double* figures) {
  for (int i = 0; i < pairs; ++i) {
    const cpContactPointSet set = cpShapesCollide(polygons[2 * i], polygons[2 * i + 1]);
    double least = 0;
    for (int k = 0; k < set.count; ++k) least = fmin(least, set.points[k].distance);
    figures[i] = query == 'o' ? least < 0 : -least;
  }
}
