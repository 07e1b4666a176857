// The Python face of the broad phase, of the ladder, and of the bodies that climb it. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <future>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "bindings/interrupts.hpp"
#include "bindings/values.hpp"
#include "ladder/broad_phase.hpp"
#include "ladder/climb.hpp"
#include "ladder/touch_proof.hpp"
#include "mesh/bvh.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {
namespace {

using ReleaseGil = nb::call_guard<nb::gil_scoped_release>;
using PairTuple = std::tuple<PlacedGeometry*, PlacedGeometry*, double, double, double, double, bool>;
using Question = nb::typed<nb::tuple, PlacedGeometry, PlacedGeometry, double, double, double, double, bool>;

Rung rung_from(const std::string& name) {
  constexpr const char* names[] = {"aabb", "obb", "hull", "triangles"};
  for (int rung = 0; rung < 4; ++rung) {
    if (name == names[rung]) return static_cast<Rung>(rung);
  }
  throw std::invalid_argument("a rung is \"aabb\", \"obb\", \"hull\" or \"triangles\", not \"" + name + "\"");
}

ClimbRequest request_from(const PairTuple& pair, MethodChoice method, bool alone, std::uint64_t steps) {
  const auto& [a, b, gap_limit, tolerance, depth_a, depth_b, wants_distance] = pair;
  if (!a || !b) throw std::invalid_argument("a pair lacks a body");
  return {a, b, gap_limit, tolerance, depth_a, depth_b, wants_distance, alone, method, steps};
}

// A method that makes a hull.
template <class Body, class Made>
auto interruptible(Made (Body::*make)(Budget*)) {
  return [make](Body& body) {
    Budget budget = Budget::that_stops(kNoEnd, interrupting());
    return (body.*make)(&budget);
  };
}

void bind_geometry(nb::module_& m) {
  nb::class_<Geometry>(m, "Geometry", R"(The data that all bodies with one mesh share, in file coordinates, made on demand. solid: the mesh is closed and
consistently wound; if that is false, surfaces raise ValueError. plain: the mesh of an Inspection whose topology is a
plain solid, which is not proven again. sheets: open parts of the mesh have no inside; else every hole has some fill.)")
      .def("__init__",
           [](Geometry* self, std::shared_ptr<Mesh> mesh, bool solid, bool plain, bool sheets) {
             new (self) Geometry(std::move(mesh), solid, plain, sheets ? OpenParts::sheets : OpenParts::filled);
           },
           "mesh"_a, "solid"_a, "plain"_a = false, "sheets"_a = false)
      .def_prop_ro("convex", &Geometry::convex, ReleaseGil(), R"(Closed, consistently outward, and exactly convex. An affine map keeps a mesh convex up to the rounding of each
world coordinate, so the body in the world is the hull of its world vertices.)")
      .def_prop_ro("known_convex", &Geometry::known_convex, ReleaseGil(), "None until a pair needs it.")
      .def("surface", &Geometry::surface, ReleaseGil())
      .def("hull", interruptible(&Geometry::hull), ReleaseGil())
      .def("hull_shape", interruptible(&Geometry::hull_shape), ReleaseGil())
      .def_prop_ro("hierarchies", &Geometry::hierarchies, "Number of trees built for these bodies.")
      .def_prop_ro("refits", &Geometry::refits, "Number of trees fitted again to placed vertices.");
  nb::class_<PlacedGeometry>(m, "PlacedGeometry", R"(A body in the world: its mesh, and data that are made on demand.

transform: 4x4, 16 numbers by rows, affine and not singular; None: the identity. bounds: those of the shape that
the mesh lies in, in the world; its use raises ValueError if the mesh does not. None: those of the mesh. resolution: the
precision of its coordinates, world units.)")
      .def("__init__",
           [](PlacedGeometry* self, std::shared_ptr<Geometry> shared, const std::optional<Matrix>& transform,
              const std::optional<Box>& bounds, double resolution) {
             std::optional<Aabb> around;
             if (bounds) around = Aabb{to_vec(bounds->first), to_vec(bounds->second)};
             new (self) PlacedGeometry(std::move(shared), transform, around, resolution);
           },
           "shared"_a, "transform"_a.none(), "bounds"_a.none(), "resolution"_a)
      .def_prop_ro("mesh", &PlacedGeometry::mesh, ReleaseGil(), "The mesh in the world; each coordinate rounded once. Raises what Mesh.transformed raises.")
      .def("surface", &PlacedGeometry::surface, ReleaseGil())
      .def("hull", interruptible(&PlacedGeometry::hull), ReleaseGil(), "The hull of all vertices, with its faces.")
      .def("hull_shape", interruptible(&PlacedGeometry::hull_shape), ReleaseGil(), "The hull as a shape, usually without faces.")
      .def("release", &PlacedGeometry::release, ReleaseGil(), "Releases the data; they are made again on demand.");
}

const char* name_of(BoxOutcome outcome) {
  constexpr const char* names[] = {"", "sheared", "unturned", "apart", "meet"};
  return names[static_cast<int>(outcome)];
}

template <class T>
const T* if_known(const std::optional<T>& value) {
  return value ? &*value : nullptr;
}

std::tuple<const char*, int, int, int> box_axis(const Climb& climb) {
  const SeparatingAxis& axis = climb.box_axis;
  return {name_of(axis.feature), axis.axis_a, axis.axis_b, axis.tested};
}

std::optional<const char*> band_word(const std::optional<BandSide>& band) {
  constexpr const char* names[] = {"open", "within", "deeper", "hidden"};
  return band ? std::optional(names[static_cast<int>(*band)]) : std::nullopt;
}

std::optional<Tuple3> corner(const std::optional<Vec3>& point) {
  return point ? std::optional(to_tuple(*point)) : std::nullopt;
}

std::optional<std::pair<std::uint32_t, std::uint32_t>> crossing_of(const Climb& climb) {
  if (!climb.triangles) return {};
  const std::uint32_t a = climb.triangles->triangle_a, b = climb.triangles->triangle_b;
  if (a == kNoIndex || b == kNoIndex) return {};
  return std::pair(a, b);
}

double deepest(const Climb& climb) {
  return std::fmax(climb.least_depth.value_or(0), climb.way_within ? climb.way_within->deepest : 0);
}

void bind_result(nb::module_& m) {
  nb::class_<Climb>(m, "Climb", R"(The verdict of the ladder on a pair, and the results of its rungs; None for rungs that the climb did not reach.

relation      of the bodies, without a touch band; "indeterminate" if `hole` leaves it open, or if it is not `decided`.
decided       False: deciding takes more steps than the climb may.
steps         that the climb took. too_few_steps: it may take no more, which leaves the relation open, or only the band or
              the gap.
settled       a rung decided the pair. Else a higher rung may decide more: the bodies are apart by gap_lower, but not
              by more than gap_limit, or they may overlap.
proven        the relation is proven. gap_lower: a proven lower bound of the distance; 0.0: none is known.
signed_distance  of two convex bodies, by their hulls; it decides everything about them.
crossing      indices of one triangle of each body that meet. point: a common point, rounded.
band          whether a settled overlap is within the touch band: "within" or "deeper", both proven; "hidden": only
              rounding leaves it open; "open". The last two need a search.
thick         whether a point of a deeper overlap of solids is known that lies deeper in both than depth_a and depth_b.
least_depth   a proven lower bound of the depth of an overlap that triangles decided, unless it is thick or the band is 0.
deepest       the greatest such bound. way_out: a translation of A within the band that frees it.
gap           of separate surfaces. gap_of_holes: the fill of a hole may be this near, nearer than gap.
box_gap       a proven lower bound of the gap of the world boxes; 0.0 if they meet.
boxes         oriented boxes: "apart" by more than gap_limit, "meet", the reason why they prove no more than the world
              boxes ("sheared", "unturned"), or "".
box_axis      the axis that separates them: "face-a", "face-b" or "edge-edge", the axes of A and of B (-1: none), and
              how many of 15 axes were tested.
hulls         the depth of two convex bodies (both_convex); else the distance of separate hulls, or the overlap.
nesting       the relation of two convex bodies that overlap and whose boxes nest.
triangles     the relation of the meshes.
nanoseconds   the time of each rung: boxes, oriented boxes, hulls, nesting, triangles; band_nanoseconds: of the touch
              band or the gap.)")
      .def_prop_ro("relation",
                   [](const Climb& c) { return hole_in_the_way(c) || !c.decided ? "indeterminate" : name_of(c.verdict.relation); },
                   nb::sig("def relation(self) -> typing.Literal['separated', 'touching', 'penetrating', 'contains', 'inside', "
                           "'coincident', 'indeterminate']"))
      .def_ro("decided", &Climb::decided)
      .def_ro("steps", &Climb::steps)
      .def_ro("too_few_steps", &Climb::too_few_steps)
      .def_prop_ro("settled", [](const Climb& c) { return c.verdict.settled; })
      .def_prop_ro("proven", [](const Climb& c) { return c.verdict.proven; })
      .def_prop_ro("gap_lower", [](const Climb& c) { return c.verdict.gap; })
      .def_prop_ro("signed_distance", &signed_distance, nb::rv_policy::reference_internal,
                   nb::sig("def signed_distance(self) -> PairResult | None"))
      .def_prop_ro("crossing", &crossing_of)
      .def_prop_ro("point", [](const Climb& c) { return c.triangles ? corner(c.triangles->point) : std::nullopt; })
      .def_prop_ro("hole", &hole_in_the_way, nb::rv_policy::reference_internal, nb::sig("def hole(self) -> OpenHole | None"))
      .def_prop_ro("band", [](const Climb& c) { return band_word(c.verdict.band); },
                   nb::sig("def band(self) -> typing.Literal['open', 'within', 'deeper', 'hidden'] | None"))
      .def_ro("thick", &Climb::thick)
      .def_ro("least_depth", &Climb::least_depth)
      .def_prop_ro("deepest", &deepest)
      .def_prop_ro("way_out", [](const Climb& c) { return c.way_within ? corner(c.way_within->move) : std::nullopt; })
      .def_prop_ro("gap", [](const Climb& c) { return if_known(c.gap); }, nb::rv_policy::reference_internal,
                   nb::sig("def gap(self) -> MeshDistance | None"))
      .def_ro("gap_of_holes", &Climb::gap_of_holes)
      .def_ro("box_gap", &Climb::box_gap)
      .def_prop_ro("boxes", [](const Climb& c) { return name_of(c.boxes); },
                   nb::sig("def boxes(self) -> typing.Literal['', 'sheared', 'unturned', 'apart', 'meet']"))
      .def_prop_ro("box_axis", &box_axis)
      .def_ro("both_convex", &Climb::both_convex)
      .def_prop_ro("nesting",
                   [](const Climb& c) { return c.nesting ? std::optional(name_of(*c.nesting)) : std::nullopt; })
      .def_prop_ro("hulls", [](const Climb& c) { return if_known(c.hulls); }, nb::rv_policy::reference_internal,
                   nb::sig("def hulls(self) -> PairResult | None"))
      .def_prop_ro("triangles", [](const Climb& c) { return if_known(c.triangles); }, nb::rv_policy::reference_internal,
                   nb::sig("def triangles(self) -> MeshRelation | None"))
      .def_ro("nanoseconds", &Climb::nanoseconds)
      .def_prop_ro("band_nanoseconds", [](const Climb& c) { return c.nanoseconds[kBand]; });
}

// A batch on its way up, in threads of its own; on one thread it climbs when its result is taken.
class Climbing {
 public:
  Climbing(const nb::typed<nb::list, Question>& pairs, const std::string& last, unsigned threads, const std::string& method, std::uint64_t steps) {
    const MethodChoice choice = method_from(method);
    std::vector<ClimbRequest> requests;
    requests.reserve(pairs.size());
    for (const nb::handle pair : pairs) {
      pairs_.push_back(nb::tuple(pair));
      requests.push_back(request_from(nb::cast<PairTuple>(pairs_.back()), choice, false, steps));
    }
    // Deferred climbs run in the thread that takes the results, where signals arrive.
    const auto poll = [this, deferred = threads == 1](const SearchState&) {
      if (stopped_ || (deferred && signalled())) throw ClimbsStopped();
    };
    const auto climb = [requests = std::move(requests), rung = rung_from(last), threads, poll] {
      return climb_all(requests, rung, threads, poll);
    };
    // Deferred too where the system grants no thread.
    const auto when = threads == 1 ? std::launch::deferred : std::launch::async | std::launch::deferred;
    results_ = std::async(when, climb);
  }
  Climbing(const Climbing&) = delete;
  Climbing& operator=(const Climbing&) = delete;

  // Nobody takes the results: the threads still have to end, and Python goes on meanwhile.
  ~Climbing() {
    const nb::gil_scoped_release release;
    stopped_ = true;
    results_ = {};
  }

  nb::typed<nb::list, std::optional<Climb>> results() {
    if (!results_.valid()) throw std::invalid_argument("the results have been taken");
    std::vector<std::optional<Climb>> results;
    try {
      const nb::gil_scoped_release release;
      while (!stopped_ && results_.wait_for(kBetweenSignals) == std::future_status::timeout) stopped_ = signalled();
      results = results_.get();
    } catch (const ClimbsStopped&) {
      stopped_ = true;
    }
    if (stopped_) throw nb::python_error();
    nb::typed<nb::list, std::optional<Climb>> climbs;
    for (std::optional<Climb>& climb : results) climbs.append(climb ? nb::cast(std::move(*climb)) : nb::none());
    return climbs;
  }

 private:
  static constexpr std::chrono::milliseconds kBetweenSignals{50};

  std::atomic<bool> stopped_ = false;
  std::vector<nb::tuple> pairs_;  // keeps the bodies, whatever the caller does with the list
  std::future<std::vector<std::optional<Climb>>> results_;
};

using Pair = std::pair<std::uint32_t, std::uint32_t>;

ClosePairs close_pairs(const std::vector<Box>& boxes, std::vector<double> reach, std::vector<std::uint32_t> kinds,
                       std::vector<IndexPair> exempt_kinds, std::vector<IndexPair> exempt) {
  if (reach.size() != boxes.size() || kinds.size() != boxes.size()) {
    throw std::invalid_argument("boxes, reach and kinds differ in length");
  }
  const nb::gil_scoped_release release;
  CloseQuery query{{}, std::move(reach), std::move(kinds), std::move(exempt_kinds), std::move(exempt)};
  query.boxes.reserve(boxes.size());
  for (const Box& box : boxes) query.boxes.push_back(to_aabb(box));
  return ClosePairs(std::move(query));
}

// Keeps the GIL: two threads would take from one place.
std::vector<Pair> take(ClosePairs& close, std::size_t most) {
  std::vector<Pair> pairs;  // tuples in Python, where arrays would be lists
  for (const auto [i, j] : close.take(most)) pairs.emplace_back(i, j);
  return pairs;
}

}  // namespace

void bind_climb(nb::module_& m) {
  bind_geometry(m);
  bind_result(m);
  nb::class_<Climbing>(m, "Climbing", R"(Climbs with many pairs in threads, while the caller can do other work.

A pair is (a, b, gap_limit, tolerance, depth_a, depth_b, wants_distance). A climb ends at a rung that proves a gap
beyond gap_limit, or at the rung `last`: "aabb", "obb", "hull" or "triangles". tolerance: half width of the touch band.
depth_a, depth_b: a point deeper than that in A and in B shows an overlap that no tolerance of the surfaces explains.
wants_distance: measure every gap. threads: 0: one a core; on one thread the pairs climb when the results are taken.
method: between convex hulls, as in check_pairs. steps: the most of each pair.)")
      .def(nb::init<const nb::typed<nb::list, Question>&, const std::string&, unsigned, const std::string&, std::uint64_t>(), "pairs"_a,
           "last"_a = "triangles", "threads"_a = 0, "method"_a = "auto", "steps"_a = kNoEnd)
      .def("results", &Climbing::results,
           R"(Waits, then returns the results, only once: a Climb for each pair, the same for any number of threads; None: the climb
failed, and climb() raises for this pair.)");
  m.def("climb",
        [](const Question& pair, const std::string& first, const std::string& last, const std::string& method, std::uint64_t steps, bool alone) {
          const ClimbRequest request = request_from(nb::cast<PairTuple>(pair), method_from(method), alone, steps);
          const Rung from = rung_from(first), to = rung_from(last);
          const nb::gil_scoped_release release;
          return climb(request, from, to, interrupting());
        },
        "pair"_a, "first"_a = "aabb", "last"_a = "triangles", "method"_a = "auto", "steps"_a = kNoEnd, "alone"_a = false,
        "One pair of Climbing, from the rung `first` on. alone: no other pair needs its bodies.");
  m.def("hull_depth", [](PlacedGeometry& a, PlacedGeometry& b, bool alone) {
          return hull_depth(a, b, alone, Budget::that_stops(kNoEnd, interrupting()));
        },
        "a"_a, "b"_a, "alone"_a = false, ReleaseGil(),
        "The depth of the hulls of two bodies. alone: no other pair needs them, and large hulls are not made.");
  m.def("crossing_depth",
        [](const Surface& a, const Surface& b, std::size_t triangle_a, std::size_t triangle_b) {
          if (triangle_a >= a.mesh.triangles.size() || triangle_b >= b.mesh.triangles.size()) {
            throw std::out_of_range("no such triangle");
          }
          return crossing_depth(a, b, static_cast<std::uint32_t>(triangle_a), static_cast<std::uint32_t>(triangle_b));
        },
        "a"_a, "b"_a, "triangle_a"_a, "triangle_b"_a, ReleaseGil(),
        R"(A proven lower bound of the depth of two surfaces from one pair of triangles that cross; 0.0 unless both triangles are
completely boundary.)");
  m.def("nested_depth",
        [](PlacedGeometry& a, PlacedGeometry& b) { return nested_depth(a, b, interrupting()); },
        "a"_a, "b"_a, ReleaseGil(),
        "A proven lower bound of the depth of nested bodies: the inner one stays inside until the surfaces meet.");
}

void bind_broad_phase(nb::module_& m) {
  m.def("box_gap", [](const Box& a, const Box& b) { return box_gap(to_aabb(a), to_aabb(b)); }, "a"_a, "b"_a,
        "A proven lower bound of the distance of two closed boxes ((x, y, z), (x, y, z)): 0.0 exactly when they meet.");
  m.def("order_along_curve",
        [](const std::vector<Box>& boxes) {
          std::vector<Aabb> aabbs;
          for (const Box& box : boxes) aabbs.push_back(to_aabb(box));
          return order_along_curve(aabbs);
        },
        "boxes"_a, nb::call_guard<nb::gil_scoped_release>(), "The numbers of the boxes along a curve on which neighbours are close: that of Morton, through their centres.");
  nb::class_<ClosePairs>(
      m, "ClosePairs",
      R"(Pairs (i, j), i < j, sorted, of boxes that are close: box_gap(boxes[i], boxes[j]) <= reach[i] + reach[j].

No close pair is missed but those left out on purpose: pairs of boxes whose kinds are in `exempt_kinds`, and
those in `exempt`; in both the lower number comes first. Time near n log n for n boxes of any sizes, where few
are close. Pairs are found as they are taken. ValueError when the lengths differ.)")
      .def(nb::new_(&close_pairs), "boxes"_a, "reach"_a, "kinds"_a, "exempt_kinds"_a = std::vector<IndexPair>{},
           "exempt"_a = std::vector<IndexPair>{})
      .def("take", &take, "most"_a = SIZE_MAX, "The next pairs, at most `most`; fewer only at the end.")
      .def("count", &ClosePairs::count, nb::call_guard<nb::gil_scoped_release>(),
           "The number of all close pairs, taken or not.");
}

}  // namespace satcheck
