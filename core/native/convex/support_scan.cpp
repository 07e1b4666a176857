#include "convex/support_scan.hpp"

namespace satcheck {

VertexLanes::VertexLanes(const std::vector<Vec3>& points) {
  if (points.empty()) return;
  const std::size_t count = (points.size() + kLanes - 1) / kLanes * kLanes;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = points[i < points.size() ? i : 0];
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
}

}  // namespace satcheck
