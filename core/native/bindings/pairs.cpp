// Pairs of convex shapes in Python: one by one, and many at once.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <stdexcept>

#include "base/numeric_range.hpp"
#include "bindings/values.hpp"
#include "convex/batch.hpp"
#include "convex/exact_depth.hpp"

namespace nb = nanobind;
using namespace satcheck;

namespace {

using Poses = nb::ndarray<const double, nb::shape<-1, 7>, nb::c_contig, nb::device::cpu>;
using Indices = nb::ndarray<const std::uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

// Reads what another thread may change, so that the value that is checked is the value that is used.
template <class T>
T read_once(const T& value) {
  return static_cast<const volatile T&>(value);
}

// Translation, then a quaternion x y z w of any non-zero length.
Pose pose_from(const double* numbers) {
  double p[7];
  for (int i = 0; i < 7; ++i) p[i] = read_once(numbers[i]);
  for (int i = 0; i < 7; ++i) {
    if (!std::isfinite(p[i])) throw std::invalid_argument("a pose has a coordinate that is not finite");
    if (i < 3 && !in_range(p[i])) throw std::overflow_error("a pose has a translation that is out of range");
  }
  double x = p[3], y = p[4], z = p[5], w = p[6], norm_squared = x * x + y * y + z * z + w * w;
  if (!(norm_squared > 0x1p-400 && norm_squared < 0x1p400)) {  // the squares may be beyond float64
    const double largest = larger(larger(std::fabs(x), std::fabs(y)), larger(std::fabs(z), std::fabs(w)));
    if (largest == 0) throw std::invalid_argument("a pose has a quaternion of length 0");
    const int exponent = -std::ilogb(largest);
    for (double* c : {&x, &y, &z, &w}) *c = std::scalbn(*c, exponent);
    norm_squared = x * x + y * y + z * z + w * w;
  }
  const double k = 2 / norm_squared;
  Pose pose;
  pose.rotation = {{{1 - k * (y * y + z * z), k * (x * y - z * w), k * (x * z + y * w)},
                    {k * (x * y + z * w), 1 - k * (x * x + z * z), k * (y * z - x * w)},
                    {k * (x * z - y * w), k * (y * z + x * w), 1 - k * (x * x + y * y)}}};
  pose.translation = {p[0], p[1], p[2]};
  return pose;
}

Pose pose_from(const std::optional<std::vector<double>>& values) {
  if (!values) return {};
  if (values->size() == 3) {
    const double p[7] = {(*values)[0], (*values)[1], (*values)[2], 0, 0, 0, 1};
    return pose_from(p);
  }
  if (values->size() != 7) throw std::invalid_argument("a pose is (tx, ty, tz) or (tx, ty, tz, qx, qy, qz, qw)");
  return pose_from(values->data());
}

Query query_from(const std::string& name) {
  if (name == "overlap") return Query::overlap;
  if (name == "depth") return Query::depth;
  if (name == "distance") return Query::distance;
  throw std::invalid_argument("query is \"overlap\", \"depth\" or \"distance\", not \"" + name + "\"");
}

const char* name_of(Reason reason) { return reason == Reason::none ? "" : "bounds-not-closed"; }

std::optional<double> known(const PairResult& r, double value) {
  return r.has_distance ? std::optional(value) : std::nullopt;
}
std::optional<Tuple3> known(const PairResult& r, Vec3 v) {
  return r.has_distance ? std::optional(to_tuple(v)) : std::nullopt;
}
std::int64_t index_or_minus_one(std::uint32_t index) {
  return index == kNoIndex ? -1 : static_cast<std::int64_t>(index);
}

constexpr const char* kPairResultDoc = R"(The result of one convex pair. World frame, units of the shapes.

outcome      "separated", "touching", "penetrating" or "undecided" (then `reason` says why), the same for every
             query, and for B against A. For hulls, boxes, spheres and capsules touching is exact for the vertices,
             centres and axes after the poses have rounded them. For cylinders, cones and ellipsoids touching means
             that 0 lies between the proven bounds lower and upper.
distance     signed: > 0 the gap, < 0 minus the penetration depth. None for query "overlap".
lower, upper proven bounds of the signed distance, rounding included.
normal       unit, from A to B. witness_a, witness_b: points on A and B with
             witness_b - witness_a = distance * normal. Moving A by distance * normal separates an overlap.
method       the stage that decided: "portal", "sat", "gjk", "epa" or "exact".
feature      the feature that decides: "face-a", "face-b", "edge-edge" (with index_a, index_b of the face or edge;
             of two boxes, of their axes; -1: none), "vertices" or "curved".)";

void bind_pair_result(nb::module_& m) {
  nb::class_<PairResult>(m, "PairResult", kPairResultDoc)
      .def_prop_ro("outcome", [](const PairResult& r) { return name_of(r.outcome); },
                   nb::sig("def outcome(self) -> typing.Literal['separated', 'touching', 'penetrating', 'undecided']"))
      .def_prop_ro("reason", [](const PairResult& r) { return name_of(r.reason); })
      .def_prop_ro("method", [](const PairResult& r) { return name_of(r.method); },
                   nb::sig("def method(self) -> typing.Literal['none', 'sat', 'gjk', 'epa', 'exact', 'portal']"))
      .def_prop_ro("feature", [](const PairResult& r) { return name_of(r.feature); })
      .def_prop_ro("index_a", [](const PairResult& r) { return index_or_minus_one(r.index_a); })
      .def_prop_ro("index_b", [](const PairResult& r) { return index_or_minus_one(r.index_b); })
      .def_prop_ro("distance", [](const PairResult& r) { return known(r, r.distance); })
      .def_prop_ro("lower", [](const PairResult& r) { return known(r, r.lower); })
      .def_prop_ro("upper", [](const PairResult& r) { return known(r, r.upper); })
      .def_prop_ro("normal", [](const PairResult& r) { return known(r, r.normal); })
      .def_prop_ro("witness_a", [](const PairResult& r) { return known(r, r.witness_a); })
      .def_prop_ro("witness_b", [](const PairResult& r) { return known(r, r.witness_b); })
      .def_ro("portal_rounds", &PairResult::portal_rounds)
      .def_ro("gjk_iterations", &PairResult::gjk_iterations)
      .def_ro("epa_iterations", &PairResult::epa_iterations)
      .def_ro("axes_tested", &PairResult::axes_tested)
      .def("__repr__", [](const PairResult& r) {
        return std::string("<PairResult ") + name_of(r.outcome) +
               (r.has_distance ? ", distance " + std::to_string(r.distance) : "") + " by " + name_of(r.method) + ">";
      });
}

// A view of one field of all results, without a copy. If the query does not compute the field, one row is repeated.
template <auto Member, class T, std::size_t Width>
auto array(nb::handle self) {
  using Shape = std::conditional_t<Width == 1, nb::shape<-1>, nb::shape<-1, static_cast<nb::ssize_t>(Width)>>;
  static_assert(sizeof(Field<Member>) == Width * sizeof(T));
  static const PairResult nothing{};
  const auto& results = nb::cast<const PairResults&>(self);
  const Field<Member>* rows = results.array<Member>();
  const Field<Member>& first = rows != nullptr ? *rows : nothing.*Member;
  const std::size_t shape[2] = {results.size(), Width};
  const std::int64_t strides[2] = {rows != nullptr ? static_cast<std::int64_t>(Width) : 0, 1};
  const T* numbers = reinterpret_cast<const T*>(&first);
  return nb::ndarray<nb::numpy, const T, Shape>(numbers, Width == 1 ? 1 : 2, shape, self, strides);
}

void bind_pair_results(nb::module_& m) {
  nb::class_<PairResults>(m, "PairResults",
                          R"(The results of check_pairs: indexing gives a PairResult, the attributes are read-only
numpy arrays of shape (n,) or (n, 3), without a copy. Outcomes are 0 separated, 1 touching, 2 penetrating, 3 undecided;
methods 0 none, 1 sat, 2 gjk, 3 epa, 4 exact, 5 portal. Distances and vectors are NaN for query "overlap".)")
      .def("__len__", &PairResults::size)
      .def(
          "__getitem__",
          [](const PairResults& r, std::size_t i) {
            if (i >= r.size()) throw nb::index_error();
            return r[i];
          },
          nb::arg("index"))
      .def_prop_ro("outcome", &array<&PairResult::outcome, std::uint8_t, 1>)
      .def_prop_ro("method", &array<&PairResult::method, std::uint8_t, 1>)
      .def_prop_ro("distance", &array<&PairResult::distance, double, 1>)
      .def_prop_ro("lower", &array<&PairResult::lower, double, 1>)
      .def_prop_ro("upper", &array<&PairResult::upper, double, 1>)
      .def_prop_ro("normal", &array<&PairResult::normal, double, 3>)
      .def_prop_ro("witness_a", &array<&PairResult::witness_a, double, 3>)
      .def_prop_ro("witness_b", &array<&PairResult::witness_b, double, 3>)
      .def_prop_ro("portal_rounds", &array<&PairResult::portal_rounds, int, 1>)
      .def_prop_ro("gjk_iterations", &array<&PairResult::gjk_iterations, int, 1>)
      .def_prop_ro("epa_iterations", &array<&PairResult::epa_iterations, int, 1>)
      .def_prop_ro("axes_tested", &array<&PairResult::axes_tested, int, 1>);
}

PairResults check_many(const nb::typed<nb::sequence, Shape>& given, const Indices& index_a, const Indices& index_b,
                       const Poses& poses_a, const Poses& poses_b, const std::string& query, const std::string& method,
                       unsigned threads) {
  const std::size_t count = index_a.shape(0);
  if (index_b.shape(0) != count || poses_a.shape(0) != count || poses_b.shape(0) != count) {
    throw std::invalid_argument("index_a, index_b, poses_a and poses_b differ in length");
  }
  const nb::tuple held(given);
  std::vector<const Shape*> shapes;
  if (!nb::try_cast(held, shapes)) throw nb::type_error("shapes: a sequence of convex shapes expected");
  const auto request = [&](std::size_t i) -> PairRequest {
    const std::uint32_t a = read_once(index_a.data()[i]), b = read_once(index_b.data()[i]);
    if (a >= shapes.size() || b >= shapes.size()) throw std::invalid_argument("a shape index is out of range");
    return {shapes[a], shapes[b], pose_from(poses_a.data() + 7 * i), pose_from(poses_b.data() + 7 * i)};
  };
  const Query goal = query_from(query);
  const MethodChoice choice = method_from(method);
  nb::gil_scoped_release release;
  return check_pairs(count, request, goal, choice, threads);
}

}  // namespace

namespace satcheck {

// core/pairs.py documents these functions.
void bind_pairs(nb::module_& m) {
  bind_pair_result(m);
  bind_pair_results(m);
  m.def(
      "check_pair",
      [](const Shape& a, const Shape& b, const std::optional<std::vector<double>>& pose_a,
         const std::optional<std::vector<double>>& pose_b, const std::string& query, const std::string& method,
         double enough) {
        const Pose pa = pose_from(pose_a), pb = pose_from(pose_b);
        const Query goal = query_from(query);
        const MethodChoice choice = method_from(method);
        nb::gil_scoped_release release;
        return check_pair(a, pa, b, pb, goal, choice, enough);
      },
      nb::arg("a"), nb::arg("b"), nb::arg("pose_a") = nb::none(), nb::arg("pose_b") = nb::none(),
      nb::arg("query") = "depth", nb::arg("method") = "auto", nb::arg("enough") = INFINITY);
  m.def(
      "compare_signed_distance",
      [](const Shape& a, const Shape& b, double length, const std::optional<std::vector<double>>& pose_a,
         const std::optional<std::vector<double>>& pose_b) {
        if (!std::isfinite(length)) throw std::invalid_argument("the length is not finite");
        const Pose pa = pose_from(pose_a), pb = pose_from(pose_b);
        nb::gil_scoped_release release;
        return compare_signed_distance(a, pa, b, pb, length);
      },
      nb::arg("a"), nb::arg("b"), nb::arg("length"), nb::arg("pose_a") = nb::none(), nb::arg("pose_b") = nb::none(),
      nb::sig("def compare_signed_distance(a: Shape, b: Shape, length: float, pose_a: Sequence[float] | None = None, "
              "pose_b: Sequence[float] | None = None) -> typing.Literal[-1, 0, 1] | None"));
  m.def("check_pairs", &check_many, nb::arg("shapes"), nb::arg("index_a").noconvert(),
        nb::arg("index_b").noconvert(), nb::arg("poses_a").noconvert(),
        nb::arg("poses_b").noconvert(), nb::kw_only(), nb::arg("query") = "depth", nb::arg("method") = "auto",
        nb::arg("threads") = 0);
}

}  // namespace satcheck
