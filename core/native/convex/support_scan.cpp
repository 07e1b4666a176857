#include "convex/support_scan.hpp"

namespace satcheck {

VertexLanes::VertexLanes(const std::vector<Vec3>& points) {
  if (points.empty()) return;
  const std::size_t count = (points.size() + kLanes - 1) / kLanes * kLanes;
  x.resize(count, points[0].x);
  y.resize(count, points[0].y);
  z.resize(count, points[0].z);
  for (std::size_t i = 0; i < points.size(); ++i) {
    x[i] = points[i].x;
    y[i] = points[i].y;
    z[i] = points[i].z;
  }
}

}  // namespace satcheck
