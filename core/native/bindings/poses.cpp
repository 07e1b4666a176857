// The Python face of pairs in many poses. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>
#include <tuple>
#include <utility>

#include "bindings/tuples.hpp"
#include "motion/sift.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {
namespace {

using Corner = std::array<double, 3>;
using Matrices = nb::ndarray<const double, nb::shape<-1, -1, 12>, nb::c_contig, nb::device::cpu>;
using Margins = nb::ndarray<const double, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;
using Matrix12 = nb::ndarray<const double, nb::shape<12>, nb::c_contig, nb::device::cpu>;
using PairTuple = std::tuple<std::uint32_t, std::uint32_t, double, double, double>;
using Sifting = std::vector<Sifted>;

nb::object sift_all(const nb::typed<nb::sequence, PosedBody>& given, const std::vector<PairTuple>& pairs,
                    const Matrices& matrices, unsigned threads, const std::optional<Margins>& margins) {
  const nb::tuple held(given);
  std::vector<PosedBody*> bodies;
  if (!nb::try_cast(held, bodies)) throw nb::type_error("bodies: a sequence of PosedBody expected");
  if (matrices.shape(1) != bodies.size()) throw std::invalid_argument("a pose needs a matrix for each body");
  if (margins && (margins->shape(0) != matrices.shape(0) || margins->shape(1) != pairs.size())) {
    throw std::invalid_argument("a pair needs a margin in each pose");
  }
  std::vector<SiftedPair> sifted;
  for (const auto& [a, b, gap_limit, depth, crossing] : pairs) {
    if (a >= bodies.size() || b >= bodies.size()) throw std::invalid_argument("the number of a body is out of range");
    sifted.push_back({a, b, gap_limit, depth, crossing});
  }
  Sifting results;
  {
    const nb::gil_scoped_release release;
    results = sift(bodies, sifted, matrices.data(), margins ? margins->data() : nullptr, matrices.shape(0), threads);
  }
  auto kept = std::make_unique<Sifting>(std::move(results));
  const nb::capsule owner(kept.get(), [](void* p) noexcept { delete static_cast<Sifting*>(p); });
  const auto* values = reinterpret_cast<const std::uint8_t*>(kept.release()->data());
  return nb::cast(nb::ndarray<nb::numpy, const std::uint8_t>(values, {matrices.shape(0), pairs.size()}, owner));
}

void bind_listed(nb::module_& m) {
  m.def(
      "neither_holds",
      [](PosedBody& a, const Matrix12& at_a, PosedBody& b, const Matrix12& at_b, double margin) {
        return neither_holds(a, at_a.data(), b, at_b.data(), margin);
      },
      "a"_a, "matrix_a"_a.noconvert(), "b"_a, "matrix_b"_a.noconvert(), "margin"_a,
      "Whether each of two bodies in a pose is proven to reach out of the other one by more than the margin.");
  m.def(
      "open_hole",
      [](PosedBody& a, const Matrix12& at_a, PosedBody& b, const Matrix12& at_b) {
        return open_hole(a, at_a.data(), b, at_b.data());
      },
      "a"_a, "matrix_a"_a.noconvert(), "b"_a, "matrix_b"_a.noconvert(),
      "The hole that leaves a pair open in a pose in which `sift` returns 3. None: a climb has to find it.");
}

}  // namespace

void bind_poses(nb::module_& m) {
  nb::class_<PosedBody>(m, "PosedBody", R"(A body that takes many poses, in the coordinates of its file: PosedBody(geometry) for one with a mesh.

PosedBody(corners, margin, around, within) for a curved one: it lies in the hull of the corners, grown by the margin, and
in the closed mesh of the geometry `around`; the closed mesh of `within` lies in it.)")
      .def(nb::init<std::shared_ptr<Geometry>>(), "geometry"_a, nb::call_guard<nb::gil_scoped_release>())
      .def("__init__",
           [](PosedBody* self, const std::vector<Corner>& corners, double margin,
              std::shared_ptr<Geometry> around, std::shared_ptr<Geometry> within) {
             if (corners.empty()) throw std::invalid_argument("a body needs a corner");
             if (!around->solid() || !within->solid()) throw std::invalid_argument("the meshes have to be closed");
             std::vector<Vec3> points;
             for (const Corner& c : corners) points.push_back(to_vec(c));
             new (self) PosedBody(points, margin, std::move(around), std::move(within));
           },
           "corners"_a, "margin"_a, "around"_a, "within"_a, nb::call_guard<nb::gil_scoped_release>())
      .def_prop_ro("around", [](const PosedBody& self) { return std::make_pair(to_tuple(self.around().centre), self.around().radius); },
                   "A ball that holds the body: its centre and its radius.");
  bind_listed(m);
  m.def("sift", &sift_all, "bodies"_a, "pairs"_a, "matrices"_a.noconvert(), "threads"_a = 0, "margins"_a = nb::none(),
        R"(Sorts pairs of bodies in many poses. Returns uint8 of shape (poses, pairs): 1: the bodies are apart by more than the
gap limit of the pair; 2: a point lies deeper in both than its depth, or no translation up to `crossing` ends the overlap;
3: the fill of a hole decides whether they overlap; 0: none of this is proven.

pairs: (i, j, gap_limit, depth, crossing) each, of the numbers of two bodies. matrices: float64 of shape (poses, bodies, 12), the
upper three rows of each placement. margins: float64 of shape (poses, pairs), added to the gap limits; NaN: the pair is
left at 0 in that pose. The arrays must not change during the call. The proofs hold for the vertices in the world, each coordinate rounded once. The
result does not depend on the number of threads (0: one a core).)");
}

}  // namespace satcheck
