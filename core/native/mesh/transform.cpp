#include <stdexcept>
#include <utility>

#include "base/numeric_range.hpp"
#include "exact/predicates.hpp"
#include "mesh/transform.hpp"

namespace satcheck {
Mesh transform(const Mesh& mesh, const std::array<double, 16>& m) {
  for (const double entry : m) {
    if (!std::isfinite(entry)) throw std::overflow_error("the matrix is not finite");
  }
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) {
    throw std::invalid_argument("the matrix is not affine: its last row must be 0 0 0 1");
  }
  const Vec3 row[3] = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}};
  const int handedness = determinant_sign({}, row[0], {}, row[1], {}, row[2]);
  if (handedness == 0) throw std::invalid_argument("the matrix is singular");
  Mesh result{mesh.vertices, mesh.triangles};
  round_affine(row, {m[3], m[7], m[11]}, result.vertices);
  require_in_range(result.vertices, "transformed vertex");
  if (handedness < 0) {
    for (Triangle& t : result.triangles) std::swap(t[1], t[2]);
  }
  return result;
}

Mesh translate(const Mesh& mesh, Vec3 offset) {
  Mesh result{mesh.vertices, mesh.triangles};
  for (Vec3& p : result.vertices) p = p + offset;
  require_in_range(result.vertices, "transformed vertex");
  return result;
}

}  // namespace satcheck
