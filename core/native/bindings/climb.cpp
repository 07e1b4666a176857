// The Python face of the ladder and of the bodies that climb it. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <future>
#include <stdexcept>
#include <string>
#include <tuple>
#include <unordered_map>

#include "scene/climb.hpp"
#include "scene/rung_words.hpp"
#include "scene/touch_proof.hpp"
#include "scene/words.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {
namespace {

using ReleaseGil = nb::call_guard<nb::gil_scoped_release>;
using Corner = std::array<double, 3>;
using Box = std::pair<Corner, Corner>;
using PairTuple = std::tuple<PlacedGeometry*, PlacedGeometry*, double, double, bool>;

Aabb to_aabb(const Box& box) {
  const auto& [low, high] = box;
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

Rung rung_from(const std::string& name) {
  constexpr const char* names[] = {"aabb", "obb", "hull", "triangles"};
  for (int rung = 0; rung < 4; ++rung) {
    if (name == names[rung]) return static_cast<Rung>(rung);
  }
  throw std::invalid_argument("a rung is \"aabb\", \"obb\", \"hull\" or \"triangles\", not \"" + name + "\"");
}

ClimbRequest request_from(const PairTuple& pair, bool alone = false) {
  const auto& [a, b, asked_gap, tolerance, wants_distance] = pair;
  if (!a || !b) throw std::invalid_argument("a pair lacks a body");
  return {a, b, asked_gap, tolerance, wants_distance, alone};
}

void bind_geometry(nb::module_& m) {
  nb::class_<Geometry>(m, "Geometry", R"(What all bodies of one mesh share, in file coordinates, made when needed. solid: the mesh is closed and
consistently wound; surfaces raise ValueError where it is not. plain: the mesh is that of an Inspection whose topology
is a plain solid; that is not proven again. sheets: where the mesh is open, it has no inside; else every hole is
filled somehow.)")
      .def("__init__",
           [](Geometry* self, std::shared_ptr<Mesh> mesh, bool solid, bool plain, bool sheets) {
             new (self) Geometry(std::move(mesh), solid, plain, sheets ? OpenParts::sheets : OpenParts::filled);
           },
           "mesh"_a, "solid"_a, "plain"_a = false, "sheets"_a = false)
      .def_prop_ro("convex", &Geometry::convex, ReleaseGil(), R"(Closed, consistently outward, and exactly convex. An affine map keeps that, up to the one rounding of each
world coordinate: the body is then taken as the hull of its world vertices.)")
      .def_prop_ro("known_convex", &Geometry::known_convex, "None until a pair needs it.")
      .def("surface", &Geometry::surface, ReleaseGil())
      .def("hull", &Geometry::hull, ReleaseGil())
      .def("hull_shape", &Geometry::hull_shape, ReleaseGil())
      .def_prop_ro("hierarchies", &Geometry::hierarchies, "How many trees were built for these bodies.")
      .def_prop_ro("refits", &Geometry::refits, "How many were fitted again to placed vertices.");
  nb::class_<PlacedGeometry>(m, "PlacedGeometry", R"(A body in the world: its mesh and what is made of it when needed.

transform: 4x4, 16 numbers by rows, affine and not singular; None: as in the file. bounds: of the body in the world.
resolution: how finely its coordinates are known, world units.)")
      .def("__init__",
           [](PlacedGeometry* self, std::shared_ptr<Geometry> shared, const std::optional<Matrix>& transform,
              const Box& bounds, double resolution) {
             new (self) PlacedGeometry(std::move(shared), transform, to_aabb(bounds), resolution);
           },
           "shared"_a, "transform"_a.none(), "bounds"_a, "resolution"_a)
      .def_prop_ro("mesh", &PlacedGeometry::mesh, ReleaseGil(), "Each coordinate rounded once. ValueError, OverflowError as Mesh.transformed.")
      .def("surface", &PlacedGeometry::surface, ReleaseGil())
      .def("hull", &PlacedGeometry::hull, ReleaseGil(), "Of all its vertices, with its faces.")
      .def("hull_shape", &PlacedGeometry::hull_shape, ReleaseGil(), "The same as a shape, usually without faces.")
      .def("release", &PlacedGeometry::release, "Forget what was made; it is made again should somebody ask.");
}

const char* name_of(BoxOutcome outcome) {
  constexpr const char* names[] = {"", "sheared", "unturned", "apart", "meet"};
  return names[static_cast<int>(outcome)];
}

template <class T>
const T* if_known(const std::optional<T>& value) {
  return value ? &*value : nullptr;
}

template <class T>
std::optional<const char*> word(const std::optional<T>& value) {
  return value ? std::optional(name_of(*value)) : std::nullopt;
}

// The Python text of a word that is written in the source: one for all uses.
PyObject* known_word(const char* word) {
  static auto* const known = new std::unordered_map<const void*, PyObject*>;
  PyObject*& text = (*known)[word];
  if (text == nullptr) text = PyUnicode_InternFromString(word);
  return text;
}

nb::list stages(const Climb& climb, nb::handle make) {
  nb::list made;
  for (const RungWords& words : words_of(climb)) {
    const nb::object cost = nb::float_(static_cast<double>(words.nanoseconds) / 1000.0);
    const nb::object detail = nb::steal(PyUnicode_FromStringAndSize(words.detail.data(), words.detail.size()));
    PyObject* const given[] = {known_word(words.rung), known_word(words.result), cost.ptr(), detail.ptr()};
    const nb::object stage = nb::steal(PyObject_Vectorcall(make.ptr(), given, 4, nullptr));
    if (!stage.is_valid()) throw nb::python_error();
    made.append(stage);
  }
  return made;
}

void bind_found(nb::module_& m) {
  nb::class_<WayWithin>(m, "WayWithin", R"(Whether an overlap is within the touch band.

side: "within" or "deeper", proven; "hidden" where rounding alone leaves it open; "open". move: a translation of A within
it, seen to free it; None: none was found. deepest: a proven lower bound of the depth, by the triangles in the way.)")
      .def_prop_ro("move",
                   [](const WayWithin& w) {
                     return w.move ? std::optional(Corner{w.move->x, w.move->y, w.move->z}) : std::nullopt;
                   })
      .def_prop_ro("side",
                   [](const WayWithin& w) {
                     switch (w.side) {
                       case BandSide::within: return "within";
                       case BandSide::deeper: return "deeper";
                       case BandSide::hidden: return "hidden";
                       default: return "open";
                     }
                   })
      .def_ro("deepest", &WayWithin::deepest);
  nb::class_<Climb>(m, "Climb", R"(What each rung of the ladder found about a pair; None where the climb did not get so far.

box_gap       a proven lower bound of the gap of the world boxes, 0.0 where they meet.
boxes         oriented boxes: "apart" by more than was asked about, "meet", why they say no more than the world boxes
              ("sheared", "unturned"), or "". box_feature: "face-a", "face-b" or "edge-edge" where they are apart.
both_convex   and then hulls is the depth of the pair; else the distance where hulls are apart, or the overlap.
nesting       the relation of two convex bodies that overlap and whose world boxes nest.
triangles     the relation of the meshes.
least_depth   of an overlap that triangles decided, where the touch band is not 0: a proven lower bound of its depth.
way_within    out of the touch band, of such an overlap that least_depth leaves open.
proven_gap    a proven lower bound of the distance by boxes and hulls, 0.0 where they know none.
gap           of surfaces apart. gap_of_holes: what fills a hole may be as near as this, and nearer than gap.
band_nanoseconds  what the touch band or the gap took. stages() says what the rungs did.)")
      .def_ro("box_gap", &Climb::box_gap)
      .def_prop_ro("boxes", [](const Climb& c) { return name_of(c.boxes); })
      .def_prop_ro("box_feature", [](const Climb& c) { return name_of(c.box_feature); })
      .def_ro("both_convex", &Climb::both_convex)
      .def_prop_ro("hulls", [](const Climb& c) { return if_known(c.hulls); }, nb::rv_policy::reference_internal)
      .def_prop_ro("nesting", [](const Climb& c) { return word(c.nesting); })
      .def_prop_ro("triangles", [](const Climb& c) { return if_known(c.triangles); },
                   nb::rv_policy::reference_internal)
      .def_ro("least_depth", &Climb::least_depth)
      .def_prop_ro("way_within", [](const Climb& c) { return if_known(c.way_within); }, nb::rv_policy::reference_internal)
      .def_prop_ro("gap", [](const Climb& c) { return if_known(c.gap); }, nb::rv_policy::reference_internal)
      .def_ro("gap_of_holes", &Climb::gap_of_holes)
      .def_prop_ro("proven_gap", &proven_gap)
      .def("stages", &stages, "make"_a, R"(What the rungs that ran found, in words: make(rung, result, microseconds, detail) of each.)")
      .def_prop_ro("band_nanoseconds", [](const Climb& c) { return c.nanoseconds[kBand]; });
}

// A batch on its way up, in threads of its own; on one thread it climbs when its result is taken.
class Climbing {
 public:
  Climbing(nb::list pairs, const std::string& last, unsigned threads, bool alone) : pairs_(std::move(pairs)) {
    std::vector<ClimbRequest> requests;
    requests.reserve(pairs_.size());
    for (const nb::handle pair : pairs_) requests.push_back(request_from(nb::cast<PairTuple>(pair), alone));
    const auto climb = [requests = std::move(requests), rung = rung_from(last), threads] {
      return climb_all(requests, rung, threads);
    };
    // Deferred too where the system grants no thread.
    const auto when = threads == 1 ? std::launch::deferred : std::launch::async | std::launch::deferred;
    found_ = std::async(when, climb);
  }

  nb::list found() {
    if (!found_.valid()) throw std::invalid_argument("what was found has been taken");
    std::vector<std::optional<Climb>> found;
    {
      const nb::gil_scoped_release release;
      found = found_.get();
    }
    nb::list climbs;
    for (std::optional<Climb>& one : found) climbs.append(one ? nb::cast(std::move(*one)) : nb::none());
    return climbs;
  }

 private:
  nb::list pairs_;  // keeps the bodies
  std::future<std::vector<std::optional<Climb>>> found_;
};

}  // namespace

void bind_climb(nb::module_& m) {
  bind_geometry(m);
  bind_found(m);
  nb::class_<Climbing>(m, "Climbing", "Pairs on their way up the ladder; while they climb, the caller can do something else.")
      .def(nb::init<nb::list, const std::string&, unsigned, bool>(), "pairs"_a, "last"_a = "triangles", "threads"_a = 0,
           "alone"_a = false, "As climb_all; on one thread a batch climbs when its result is taken.")
      .def("found", &Climbing::found, "Waits, and hands over once.");
  m.def("climb_all",
        [](nb::list pairs, const std::string& last, unsigned threads, bool alone) {
          return Climbing(std::move(pairs), last, threads, alone).found();
        },
        "pairs"_a, "last"_a = "triangles", "threads"_a = 0, "alone"_a = false,
        R"(Each pair (a, b, asked_gap, tolerance, wants_distance) up the ladder, on `threads` threads (0: one a core).

A rung that proves the bodies apart by more than asked_gap ends the climb, and so does the rung `last`: "aabb", "obb",
"hull" or "triangles". A Climb a pair; None where its climb failed: asked alone it raises. The same at any thread
count. tolerance: half width of the touch band. wants_distance: of bodies apart, however far. alone: of one pair, that
no other will ask for anything of its bodies.)");
  m.def("climb",
        [](const PairTuple& pair, const std::string& first, const std::string& last) {
          const ClimbRequest request = request_from(pair);
          const Rung from = rung_from(first), to = rung_from(last);
          const nb::gil_scoped_release release;
          return climb(request, from, to);
        },
        "pair"_a, "first"_a = "aabb", "last"_a = "triangles", "One pair of climb_all, from the rung `first` on.");
  m.def("crossing_depth",
        [](const Surface& a, const Surface& b, std::size_t triangle_a, std::size_t triangle_b) {
          if (triangle_a >= a.mesh.triangles.size() || triangle_b >= b.mesh.triangles.size()) {
            throw std::out_of_range("no such triangle");
          }
          return crossing_depth(a, b, static_cast<std::uint32_t>(triangle_a), static_cast<std::uint32_t>(triangle_b));
        },
        "a"_a, "b"_a, "triangle_a"_a, "triangle_b"_a, ReleaseGil(),
        R"(A proven lower bound of the depth of two surfaces from one pair of triangles that cross; 0.0 where the bodies do
not end on all of both.)");
  m.def("find_way_within",
        [](PlacedGeometry& a, PlacedGeometry& b, double tolerance,
           const std::optional<std::pair<std::size_t, std::size_t>>& crossing) {
          std::optional<ContactPair> start;
          if (crossing) {
            const auto& [of_a, of_b] = *crossing;
            if (of_a >= a.shared().mesh()->triangles.size() || of_b >= b.shared().mesh()->triangles.size()) {
              throw std::out_of_range("no such triangle");
            }
            start = {static_cast<std::uint32_t>(of_a), static_cast<std::uint32_t>(of_b)};
          }
          return find_way_within(a, b, tolerance, start);
        },
        "a"_a, "b"_a, "tolerance"_a, "crossing"_a.none(), ReleaseGil(),
        R"(A way out of an overlap that is no longer than the tolerance: that of the hulls, or one off the triangles of
`crossing`, a pair that meets, and off those that are then in the way, by a third of the tolerance at a time.)");
  m.def("nested_depth", &nested_depth, "a"_a, "b"_a, ReleaseGil(),
        "A proven lower bound of the depth of nested bodies: the inner one stays inside until the surfaces meet.");
}

}  // namespace satcheck
