// The Python face of moving bodies and of pairs in many poses. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>
#include <tuple>
#include <utility>

#include "bindings/values.hpp"
#include "motion/motion_search.hpp"
#include "motion/sift.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {
namespace {

Vec3 finite(const Triple& t) {
  const Vec3 v{t[0], t[1], t[2]};
  if (!is_finite(v)) throw std::invalid_argument("a number of a moving body is not finite");
  return v;
}

void require_bound(double x) {
  if (!(std::isfinite(x) && x >= 0)) throw std::invalid_argument("a bound of a motion is negative or not finite");
}

void construct_moving(Moving* self, const std::array<Triple, 3>& rotation, const Triple& translation,
                      const Triple& centre, const Triple& velocity, const Triple& spin, double speed,
                      double acceleration) {
  const Mat3 rows{{finite(rotation[0]), finite(rotation[1]), finite(rotation[2])}};
  for (const double x : {speed, acceleration}) require_bound(x);
  new (self) Moving{{rows, finite(translation)}, finite(centre), finite(velocity), finite(spin), speed, acceleration};
}

MotionAnswer ask(const MovingBody& a, const Moving& moving_a, const MovingBody& b, const Moving& moving_b,
                 const MotionQuestion& question, double pad, double slack, std::uint64_t work) {
  for (const double x : {question.extent(), pad, slack}) require_bound(x);
  return ask_motion(a, moving_a, b, moving_b, question, {pad, slack}, work);
}

std::int64_t index_or_minus_one(std::uint32_t triangle) { return triangle == kNoIndex ? -1 : std::int64_t{triangle}; }

using Matrices = nb::ndarray<const double, nb::shape<-1, -1, 12>, nb::c_contig, nb::device::cpu>;
using Margins = nb::ndarray<const double, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;
using SiftedTuple = std::tuple<std::uint32_t, std::uint32_t, double, double, double>;
using DeepTuple = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, double>;
using Sifting = std::vector<Sifted>;
using Codes = nb::ndarray<nb::numpy, const std::uint8_t, nb::shape<-1, -1>>;

std::vector<PosedBody*> bodies_of(const nb::tuple& held, const Matrices& matrices) {
  std::vector<PosedBody*> bodies;
  if (!nb::try_cast(held, bodies)) throw nb::type_error("bodies: a sequence of PosedBody expected");
  if (matrices.shape(1) != bodies.size()) throw std::invalid_argument("a pose needs a matrix for each body");
  return bodies;
}

std::pair<Codes, std::uint64_t> sift_all(const nb::typed<nb::sequence, PosedBody>& given,
                                         const std::vector<SiftedTuple>& pairs, const Matrices& matrices,
                                         unsigned threads, const std::optional<Margins>& margins,
                                         std::uint64_t steps) {
  const nb::tuple held(given);
  const std::vector<PosedBody*> bodies = bodies_of(held, matrices);
  if (margins && (margins->shape(0) != matrices.shape(0) || margins->shape(1) != pairs.size())) {
    throw std::invalid_argument("a pair needs a margin in each pose");
  }
  std::vector<SiftedPair> sifted;
  for (const auto& [a, b, gap_limit, depth, crossing] : pairs) {
    if (a >= bodies.size() || b >= bodies.size()) throw std::invalid_argument("the number of a body is out of range");
    sifted.push_back({a, b, gap_limit, depth, crossing});
  }
  Sifting results;
  Budget budget(steps);
  {
    const nb::gil_scoped_release release;
    results = sift(bodies, sifted, matrices.data(), margins ? margins->data() : nullptr, matrices.shape(0), threads, &budget);
  }
  auto kept = std::make_unique<Sifting>(std::move(results));
  const nb::capsule owner(kept.get(), [](void* p) noexcept { delete static_cast<Sifting*>(p); });
  const auto* values = reinterpret_cast<const std::uint8_t*>(kept.release()->data());
  return {Codes(values, {matrices.shape(0), pairs.size()}, owner), budget.spent()};
}

std::vector<bool> neither_holds_in(const nb::typed<nb::sequence, PosedBody>& given, const std::vector<DeepTuple>& pairs,
                                   const Matrices& matrices) {
  const nb::tuple held(given);
  const std::vector<PosedBody*> bodies = bodies_of(held, matrices);
  std::vector<DeepPair> deep;
  for (const auto& [pose, a, b, margin] : pairs) {
    if (pose >= matrices.shape(0)) throw std::invalid_argument("the number of a pose is out of range");
    if (a >= bodies.size() || b >= bodies.size()) throw std::invalid_argument("the number of a body is out of range");
    deep.push_back({pose, a, b, margin});
  }
  const nb::gil_scoped_release release;
  return neither_holds(bodies, deep, matrices.data());
}

}  // namespace

void bind_motion(nb::module_& m) {
  nb::class_<Moving>(m, "Moving", R"(A moving rigid body, world frame: p_world = rotation * p + translation now, rotation as three rows. It turns about the
axis through `centre` with `spin`, a unit axis times radians per unit of time, while the centre moves with `velocity`.
speed, acceleration: 0 if it goes on like that; else bounds for all its points as long as a query asks. ValueError on a number that is not finite.)")
      .def("__init__", &construct_moving, "rotation"_a, "translation"_a, "centre"_a, "velocity"_a, "spin"_a,
           "speed"_a = 0.0, "acceleration"_a = 0.0);
  nb::class_<MotionAnswer>(m, "MotionAnswer", R"(value: a proven lower bound of the requested time or gap. upper: of the signed distance now, without rounding;
infinite if there is no obstacle. triangle_a, triangle_b: the nearest obstacle; -1: none.)")
      .def_ro("value", &MotionAnswer::value)
      .def_ro("upper", &MotionAnswer::upper)
      .def_ro("visits", &MotionAnswer::visits)
      .def_prop_ro("triangle_a", [](const MotionAnswer& r) { return index_or_minus_one(r.triangle_a); })
      .def_prop_ro("triangle_b", [](const MotionAnswer& r) { return index_or_minus_one(r.triangle_b); });
  constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();
  const nb::call_guard<nb::gil_scoped_release> unlocked;
  m.def("safe_time", [](const MovingBody& a, const Moving& moving_a, const MovingBody& b, const Moving& moving_b,
                        double level, double limit, double pad, double slack, std::uint64_t work) {
          if (!std::isfinite(level)) throw std::invalid_argument("a bound of a motion is not finite");
          return ask(a, moving_a, b, moving_b, MotionQuestion::time(level, limit), pad, slack, work);
        },
        "a"_a, "moving_a"_a, "b"_a, "moving_b"_a, nb::kw_only(), "level"_a, "limit"_a, "pad"_a, "slack"_a,
        "work"_a = unlimited, unlocked,
        R"(The time, up to `limit`, for which the gap of two moving bodies stays above `level`. For two shapes it is the signed
distance, else the gap of the surfaces. pad, slack: the rounding of a gap, and of the rate at which it closes. work:
boxes and triangles.)");
  m.def("least_gap", [](const MovingBody& a, const Moving& moving_a, const MovingBody& b, const Moving& moving_b,
                        double window, double floor, double pad, double slack, std::uint64_t work) {
          if (!std::isfinite(floor)) throw std::invalid_argument("a bound of a motion is not finite");
          return ask(a, moving_a, b, moving_b, MotionQuestion::gap(window, floor), pad, slack, work);
        },
        "a"_a, "moving_a"_a, "b"_a, "moving_b"_a, nb::kw_only(), "window"_a, "floor"_a = 0.0, "pad"_a, "slack"_a,
        "work"_a = unlimited, unlocked,
        R"(The least gap, or signed distance, from `window` before now to `window` after. For surfaces: minus infinity if it may
be below `floor`.)");
}

void bind_poses(nb::module_& m) {
  nb::class_<PosedBody>(m, "PosedBody", R"(A body that takes many poses, in the coordinates of its file: PosedBody(geometry) for one with a mesh.

PosedBody(corners, margin, around, within) for a curved one: it lies in the hull of the corners, grown by the margin, and
in the closed mesh of the geometry `around`; the closed mesh of `within` lies in it.)")
      .def(nb::init<std::shared_ptr<Geometry>>(), "geometry"_a, nb::call_guard<nb::gil_scoped_release>())
      .def("__init__",
           [](PosedBody* self, const std::vector<Triple>& corners, double margin,
              std::shared_ptr<Geometry> around, std::shared_ptr<Geometry> within) {
             if (corners.empty()) throw std::invalid_argument("a body needs a corner");
             if (!around->solid() || !within->solid()) throw std::invalid_argument("the meshes have to be closed");
             std::vector<Vec3> points;
             for (const Triple& c : corners) points.push_back(to_vec(c));
             new (self) PosedBody(points, margin, std::move(around), std::move(within));
           },
           "corners"_a, "margin"_a, "around"_a, "within"_a, nb::call_guard<nb::gil_scoped_release>())
      .def_prop_ro("around", [](const PosedBody& self) { return std::make_pair(to_tuple(self.around().centre), self.around().radius); },
                   "A ball that holds the body: its centre and its radius.");
  m.def("neither_holds", &neither_holds_in, "bodies"_a, "pairs"_a, "matrices"_a.noconvert(),
        R"(Whether each of two bodies in a pose is proven to reach out of the other one by more than a margin.

pairs: (pose, i, j, margin) each, of the numbers of a pose and of two bodies. bodies, matrices: as in `sift`.)");
  m.def("sift", &sift_all, "bodies"_a, "pairs"_a, "matrices"_a.noconvert(), "threads"_a = 0, "margins"_a = nb::none(),
        "steps"_a = kNoEnd,
        R"(Sorts pairs of bodies in many poses. Returns uint8 of shape (poses, pairs), and the steps that it took. 1: the bodies are apart by more than the
gap limit of the pair; 2: a point lies deeper in both than its depth, or no translation up to `crossing` ends the overlap;
3: the fill of a hole decides whether they overlap; 0: none of this is proven.

pairs: (i, j, gap_limit, depth, crossing) each, of the numbers of two bodies. matrices: float64 of shape (poses, bodies, 12), the
upper three rows of each placement. margins: float64 of shape (poses, pairs), added to the gap limits; NaN: the pair is
left at 0 in that pose. steps: the most, shared evenly by blocks of poses; a pair is left at 0 where its block has none
left. The arrays must not change during the call. The proofs hold for the vertices in the world, each coordinate rounded once. The
result does not depend on the number of threads (0: one a core).)");
}

}  // namespace satcheck
