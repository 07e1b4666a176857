// Box2D v3 on pairs of convex polygons, in the plane. Compiled and called by bench/outline_peers.py.
#include <math.h>
#include <stdlib.h>

#include "box2d/collision.h"

typedef struct {
  b2Polygon shape;
  b2ShapeProxy proxy;
} Polygon;

Polygon* make(const double* xy, const int* starts, int count) {
  Polygon* made = malloc(count * sizeof(Polygon));
  for (int k = 0; k < count; ++k) {
    b2Vec2 corners[B2_MAX_POLYGON_VERTICES];
    const int n = starts[k + 1] - starts[k];
    for (int i = 0; i < n; ++i, xy += 2) corners[i] = (b2Vec2){(float)xy[0], (float)xy[1]};
    const b2Hull hull = b2ComputeHull(corners, n);
    made[k].shape = b2MakePolygon(&hull, 0);
    made[k].proxy = b2MakeProxy(made[k].shape.vertices, made[k].shape.count, 0);
  }
  return made;
}

static double least_separation(const Polygon* a, const Polygon* b) {
  const b2Manifold m = b2CollidePolygons(&a->shape, b2Transform_identity, &b->shape, b2Transform_identity);
  double least = 0;
  for (int k = 0; k < m.pointCount; ++k) least = fmin(least, m.points[k].separation);
  return least;
}

static double distance(const Polygon* a, const Polygon* b) {
  const b2DistanceInput input = {a->proxy, b->proxy, b2Transform_identity, b2Transform_identity, false};
  b2SimplexCache cache = {0};
  return b2ShapeDistance(&input, &cache, NULL, 0).distance;
}

// Pair i is polygons 2 i and 2 i + 1. Queries: 'o' overlap, 1 or 0; 'd' depth; 'g' gap.
void ask(const Polygon* polygons, int pairs, char query, double* figures) {
  for (int i = 0; i < pairs; ++i, polygons += 2) {
    if (query == 'g') {
      figures[i] = distance(polygons, polygons + 1);
    } else {
      const double least = least_separation(polygons, polygons + 1);
      figures[i] = query == 'o' ? least < 0 : -least;
    }
  }
}
