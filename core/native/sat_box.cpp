// Boxes: 3 + 3 face axes and 9 edge pairs. Deviation from the customary code: no constant is added
// to |R| and no face is preferred beyond rounding, so that the least overlap is the least overlap.

#include "sat.hpp"
#include "tolerances.hpp"

namespace satcheck {

SatResult sat_boxes(const MinkowskiDifference& m, SatGoal goal) {
  const Mat3& r = m.b_in_a.rotation;
  const Vec3 t = m.b_in_a.translation, ha = m.a.size, hb = m.b.size;
  const double noise = m.support_error(), tie = kVisible * m.scale;
  double abs_r[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) abs_r[i][j] = std::fabs(r.row[i][j]);
  }
  SatResult best;
  const auto separates = [&] { return goal == SatGoal::any_separating_axis && best.penetration < -noise; };

  for (int i = 0; i < 3; ++i) {  // face normals of A
    const double reach = ha[i] + (abs_r[i][0] * hb.x + abs_r[i][1] * hb.y + abs_r[i][2] * hb.z);
    const double overlap = reach - std::fabs(t[i]);
    ++best.axes_tested;
    if (overlap < best.penetration) {
      const double sign = t[i] < 0 ? -1 : 1;
      best.penetration = overlap;
      best.axis = {i == 0 ? sign : 0, i == 1 ? sign : 0, i == 2 ? sign : 0};
      best.feature = Feature::face_a;
      best.index_a = static_cast<std::uint32_t>(i);
      if (separates()) return best;
    }
  }
  for (int j = 0; j < 3; ++j) {  // face normals of B
    const Vec3 axis{r.row[0][j], r.row[1][j], r.row[2][j]};
    const double along = dot(t, axis);
    const double reach = hb[j] + (abs_r[0][j] * ha.x + abs_r[1][j] * ha.y + abs_r[2][j] * ha.z);
    const double overlap = reach - std::fabs(along);
    ++best.axes_tested;
    if (overlap < best.penetration - tie) {
      best.penetration = overlap;
      best.axis = along < 0 ? -axis : axis;
      best.feature = Feature::face_b;
      best.index_a = Shape::kNoIndex;
      best.index_b = static_cast<std::uint32_t>(j);
      if (separates()) return best;
    }
  }
  for (int i = 0; i < 3; ++i) {  // edge of A x edge of B
    for (int j = 0; j < 3; ++j) {
      const Vec3 edge_a{i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
      const Vec3 cross_axis = cross(edge_a, {r.row[0][j], r.row[1][j], r.row[2][j]});
      const double length_squared = norm_squared(cross_axis);
      ++best.axes_tested;
      if (length_squared < kParallelSquared) continue;
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double along = dot(t, cross_axis);
      const double reach = (ha[i1] * abs_r[i2][j] + ha[i2] * abs_r[i1][j]) +
                           (hb[j1] * abs_r[i][j2] + hb[j2] * abs_r[i][j1]);
      const double overlap = (reach - std::fabs(along)) / std::sqrt(length_squared);
      if (overlap < best.penetration - tie) {
        best.penetration = overlap;
        best.axis = cross_axis * ((along < 0 ? -1 : 1) / std::sqrt(length_squared));
        best.feature = Feature::edge_edge;
        best.index_a = static_cast<std::uint32_t>(i);
        best.index_b = static_cast<std::uint32_t>(j);
        if (separates()) return best;
      }
    }
  }
  return best;
}

}  // namespace satcheck
