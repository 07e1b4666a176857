// The Python face of the solver for least motions. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>
#include <tuple>
#include <utility>

#include "ladder/least_motion.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {
namespace {

using Point = std::tuple<double, double, double>;
using Pair = std::pair<std::uint32_t, std::uint32_t>;
using Answer = std::pair<std::vector<Point>, std::vector<double>>;

Answer find_least_motion(const std::vector<bool>& movable, const std::vector<Pair>& bodies,
                         const std::vector<std::array<double, 3>>& normals, const std::vector<double>& least,
                         std::vector<double> multipliers) {
  if (normals.size() != bodies.size() || least.size() != bodies.size() || multipliers.size() != bodies.size()) {
    throw std::invalid_argument("bodies, normals, least and multipliers differ in length");
  }
  const nb::gil_scoped_release release;
  std::vector<PairWall> walls;
  walls.reserve(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const auto [a, b] = bodies[k];
    if (a >= movable.size() || b >= movable.size()) throw std::invalid_argument("a wall names a body that does not exist");
    if (!movable[a] && !movable[b]) throw std::invalid_argument("both bodies of a wall stay");
    const auto& n = normals[k];
    walls.push_back({a, b, {n[0], n[1], n[2]}, least[k]});
  }
  LeastMotion motion = least_motion(movable, walls, std::move(multipliers));
  Answer answer{{}, std::move(motion.multipliers)};
  for (const Vec3& t : motion.translations) answer.first.emplace_back(t.x, t.y, t.z);
  return answer;
}

}  // namespace

void bind_resolve(nb::module_& m) {
  m.def("least_motion", &find_least_motion, "movable"_a, "bodies"_a, "normals"_a, "least"_a, "multipliers"_a,
        R"(The translations t with the least sum of squares that keep the walls normal . (t[a] - t[b]) >= least.

movable: of each body; bodies: (a, b) of each wall, one of them movable; normals: unit; multipliers: those of an
earlier result for similar walls, or zeros. Returns the translations, (0, 0, 0) for a body that is not movable, and
the multipliers: each >= 0, how far a wall pushes its bodies. If walls contradict each other, some are broken. All
others are kept to about 1e-6 of the largest `least` at worst, and usually to rounding. ValueError for lists
that do not fit.)");
}

}  // namespace satcheck
