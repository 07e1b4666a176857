// The Python face of moving bodies. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>

#include <stdexcept>

#include "motion/moving_mixed.hpp"
#include "motion/moving_shapes.hpp"
#include "motion/moving_surfaces.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {
namespace {

using Triple = std::array<double, 3>;

Vec3 finite(const Triple& t) {
  const Vec3 v{t[0], t[1], t[2]};
  if (!is_finite(v)) throw std::invalid_argument("a number of a moving body is not finite");
  return v;
}

void construct_moving(Moving* self, const std::array<Triple, 3>& rotation, const Triple& translation,
                      const Triple& centre, const Triple& velocity, const Triple& spin) {
  const Mat3 rows{{finite(rotation[0]), finite(rotation[1]), finite(rotation[2])}};
  new (self) Moving{{rows, finite(translation)}, finite(centre), finite(velocity), finite(spin)};
}

void require_lengths(double first, double second, double pad, double slack) {
  for (const double x : {first, second, pad, slack}) {
    if (!std::isfinite(x)) throw std::invalid_argument("a bound of a motion is not finite");
  }
  if (!(second >= 0 && pad >= 0 && slack >= 0)) throw std::invalid_argument("a bound of a motion is negative");
}

MotionAnswer surfaces_time(const Surface& a, const Moving& moving_a, const Surface& b, const Moving& moving_b,
                           double level, double limit, double pad, double slack, std::uint64_t work) {
  require_lengths(level, limit, pad, slack);
  return ask_motion(a, moving_a, b, moving_b, MotionQuestion::time(level, limit), {pad, slack}, work);
}

MotionAnswer surfaces_gap(const Surface& a, const Moving& moving_a, const Surface& b, const Moving& moving_b,
                          double window, double floor, double pad, double slack, std::uint64_t work) {
  require_lengths(floor, window, pad, slack);
  return ask_motion(a, moving_a, b, moving_b, MotionQuestion::gap(window, floor), {pad, slack}, work);
}

MotionAnswer shapes_time(const Shape& a, const Moving& moving_a, const Shape& b, const Moving& moving_b, double level,
                         double limit, double pad, double slack) {
  require_lengths(level, limit, pad, slack);
  return ask_motion(a, moving_a, b, moving_b, MotionQuestion::time(level, limit), {pad, slack});
}

MotionAnswer shapes_gap(const Shape& a, const Moving& moving_a, const Shape& b, const Moving& moving_b, double window,
                        double pad, double slack) {
  require_lengths(0, window, pad, slack);
  return ask_motion(a, moving_a, b, moving_b, MotionQuestion::gap(window), {pad, slack});
}

MotionAnswer mixed_time(const Shape& a, const Moving& moving_a, const Surface& b, const Moving& moving_b, double level,
                        double limit, double pad, double slack, std::uint64_t work) {
  require_lengths(level, limit, pad, slack);
  return ask_motion(a, moving_a, b, moving_b, MotionQuestion::time(level, limit), {pad, slack}, work);
}

MotionAnswer mixed_gap(const Shape& a, const Moving& moving_a, const Surface& b, const Moving& moving_b, double window,
                       double floor, double pad, double slack, std::uint64_t work) {
  require_lengths(floor, window, pad, slack);
  return ask_motion(a, moving_a, b, moving_b, MotionQuestion::gap(window, floor), {pad, slack}, work);
}

std::int64_t index_or_minus_one(std::uint32_t triangle) { return triangle == kNoTriangle ? -1 : std::int64_t{triangle}; }

}  // namespace

void bind_motion(nb::module_& m) {
  nb::class_<Moving>(m, "Moving", R"(A moving rigid body, world frame: p_world = rotation * p + translation now, rotation as three rows. It turns about the
axis through `centre` with `spin`, a unit axis times radians per unit of time, while the centre moves with `velocity`.
ValueError on a number that is not finite.)")
      .def("__init__", &construct_moving, "rotation"_a, "translation"_a, "centre"_a, "velocity"_a, "spin"_a);
  nb::class_<MotionAnswer>(m, "MotionAnswer", R"(value: a proven lower bound of the requested time or gap. upper: of the signed distance now, without rounding;
infinite if there is no obstacle. triangle_a, triangle_b: the nearest obstacle; -1: none.)")
      .def_ro("value", &MotionAnswer::value)
      .def_ro("upper", &MotionAnswer::upper)
      .def_ro("visits", &MotionAnswer::visits)
      .def_prop_ro("triangle_a", [](const MotionAnswer& r) { return index_or_minus_one(r.triangle_a); })
      .def_prop_ro("triangle_b", [](const MotionAnswer& r) { return index_or_minus_one(r.triangle_b); });
  const nb::call_guard<nb::gil_scoped_release> unlocked;
  constexpr const char* time_doc = R"(The time, up to `limit`, for which the gap of two moving bodies stays above `level`. For two shapes it is the signed
distance, else the gap of the surfaces. pad, slack: the rounding of a gap, and of the rate at which it closes. work:
boxes and triangles.)";
  constexpr const char* gap_doc = R"(The least gap, or signed distance, from `window` before now to `window` after. For surfaces: minus infinity if it may
be below `floor`.)";
  m.def("safe_time", &surfaces_time, "a"_a, "moving_a"_a, "b"_a, "moving_b"_a, nb::kw_only(), "level"_a, "limit"_a,
        "pad"_a, "slack"_a, "work"_a, unlocked, time_doc);
  m.def("safe_time", &mixed_time, "a"_a, "moving_a"_a, "b"_a, "moving_b"_a, nb::kw_only(), "level"_a, "limit"_a,
        "pad"_a, "slack"_a, "work"_a, unlocked);
  m.def("safe_time", &shapes_time, "a"_a, "moving_a"_a, "b"_a, "moving_b"_a, nb::kw_only(), "level"_a, "limit"_a,
        "pad"_a, "slack"_a, unlocked);
  m.def("least_gap", &surfaces_gap, "a"_a, "moving_a"_a, "b"_a, "moving_b"_a, nb::kw_only(), "window"_a, "floor"_a,
        "pad"_a, "slack"_a, "work"_a, unlocked, gap_doc);
  m.def("least_gap", &mixed_gap, "a"_a, "moving_a"_a, "b"_a, "moving_b"_a, nb::kw_only(), "window"_a, "floor"_a,
        "pad"_a, "slack"_a, "work"_a, unlocked);
  m.def("least_gap", &shapes_gap, "a"_a, "moving_a"_a, "b"_a, "moving_b"_a, nb::kw_only(), "window"_a, "pad"_a,
        "slack"_a, unlocked);
}

}  // namespace satcheck
