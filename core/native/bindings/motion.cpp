// The Python face of moving bodies. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/variant.h>

#include <stdexcept>

#include "motion/motion_search.hpp"

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

std::int64_t index_or_minus_one(std::uint32_t triangle) { return triangle == kNoTriangle ? -1 : std::int64_t{triangle}; }

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

}  // namespace satcheck
