// The Python face of surfaces: one with its tree, and two of them: relation, distance, gap, deviation.
// Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>

#include "bindings/interrupts.hpp"
#include "bindings/values.hpp"
#include "mesh/boundary.hpp"
#include "mesh/surface.hpp"
#include "mesh/transform.hpp"
#include "mesh/winding.hpp"
#include "mesh_pair/boundary_contact.hpp"
#include "mesh_pair/mesh_distance.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "mesh_pair/moved_surface.hpp"
#include "mesh_pair/reach.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {
namespace {

using ReleaseGil = nb::call_guard<nb::gil_scoped_release>;

// Queries take the first box of a tree.
const Mesh& with_triangles(const Mesh& mesh) {
  if (mesh.triangles.empty()) throw std::invalid_argument("a mesh without triangles has no surface");
  return mesh;
}

void bind_one_surface(nb::module_& m) {
  nb::class_<Surface>(m, "Surface", "A mesh with its tree: built once, immutable, shared by threads.")
      .def("__init__",
           [](Surface* self, const Mesh& mesh, bool solid, bool sheets) {
             new (self) Surface(make_surface(with_triangles(mesh), solid, sheets ? OpenParts::sheets : OpenParts::filled));
           },
           "mesh"_a, "solid"_a, "sheets"_a = false, ReleaseGil(), R"(solid: the mesh is closed; ValueError if it is not. sheets: parts with a rim have no inside; other holes have some
fill.)")
      .def_prop_ro("mesh", [](const Surface& s) -> const Mesh& { return s.mesh; },
                   nb::rv_policy::reference_internal)
      .def_ro("solid", &Surface::solid)
      .def_ro("refitted", &Surface::refitted, "Whether the tree has the structure of another surface's tree.")
      .def("closed",
           [](const Surface& s) {
             if (s.solid) return std::make_tuple(s, std::vector<Surface>{});
             const auto closing = closing_of(s, OpenParts::filled);
             return std::make_tuple(*closing->surface, closing->hulls);
           },
           ReleaseGil(), R"((surface, hulls): the closed surface, and for each hole a surface that encloses every fill of it. Outside of these
hulls the winding numbers do not depend on the fill.)")
      .def("rims",
           [](const Surface& s) {
             std::vector<std::vector<BoundaryLoop>> rims;
             if (s.solid) return rims;
             for (const Hole& hole : closing_of(s, OpenParts::filled)->holes) rims.push_back(hole.loops);
             return rims;
           },
           ReleaseGil(), "For each hole, the largest first, its loops: the numbers of their vertices, each once.")
      .def("sheets_around",
           [](const Surface& s, const Tuple3& point) {
             return generalized_winding_number(s.mesh, s.sheets, finite_point(point));
           },
           "point"_a, ReleaseGil(), R"(The winding number of the sheets of an open surface about a point on none of them: their signed solid angle over
4 pi, in float64. 0 without sheets.)")
      .def("refit", [](const Surface& like, const Mesh& mesh) { return refitted_surface(like, with_triangles(mesh)); }, "mesh"_a, ReleaseGil(), R"(The surface of `mesh`, which is this mesh with moved vertices: the tree is fitted again in linear time. It is built
anew if the triangles differ, or if rounding has merged two vertices.)")
      .def("translated", [](const Surface& s, const Tuple3& offset) { return translated_surface(s, to_vec3(offset)); }, "offset"_a, ReleaseGil(),
           "Each coordinate is rounded once. ValueError for a solid that is none after that, because points are merged.")
      .def("winding_number",
           [](const Surface& s, const Tuple3& point) {
             if (!s.solid) throw std::invalid_argument("the surface is not a solid");
             return winding_number(s, finite_point(point));
           },
           "point"_a, ReleaseGil())
      .def("is_boundary",
           [](const Surface& s, std::size_t triangle) {
             if (triangle >= s.mesh.triangles.size()) throw nb::index_error("no such triangle");
             return is_plain_boundary(s, static_cast<std::uint32_t>(triangle));
           },
           "triangle"_a, ReleaseGil(), R"(Whether the whole triangle is boundary of the closed body: it is not a face inside the material, and meets other
triangles of the surface only at shared corners and edges.)")
      .def("nearest",
           [](const Surface& s, const Tuple3& point) {
             const NearestPoint nearest = nearest_point(s, finite_point(point));
             return std::make_tuple(nearest.distance, to_tuple(nearest.point));
           },
           "point"_a, ReleaseGil())
      .def("line_distances",
           [](const Surface& s, const Tuple3& u, const Tuple3& v, const std::vector<std::pair<double, double>>& points) {
             Budget budget = Budget::that_stops(kNoEnd, interrupting());
             std::vector<double> distances;
             for (const auto& [x, y] : points) distances.push_back(line_distance(s, finite_point(u), finite_point(v), x, y, &budget));
             return distances;
           },
           "u"_a, "v"_a, "points"_a, ReleaseGil(), R"(The distances of the surface from parallel lines: u and v are unit vectors, perpendicular to the lines and to each
other, and a line is given by its coordinates along both.)");
}

std::int64_t triangle_number(std::uint32_t triangle) {
  return triangle == kNoIndex ? -1 : static_cast<std::int64_t>(triangle);
}

void bind_mesh_relation(nb::module_& m) {
  nb::class_<OpenHole>(m, "OpenHole", R"(A hole that leaves a relation open, world units. of_a: whether the first body has it; number: from 0 on, the
largest hole of the body first; count: of its holes. doubtful: it is a shell that may be solid or the wall of a cavity.)")
      .def_ro("of_a", &OpenHole::of_a)
      .def_ro("number", &OpenHole::number)
      .def_ro("count", &OpenHole::count)
      .def_prop_ro("centre", [](const OpenHole& hole) { return to_tuple(hole.centre); })
      .def_ro("diameter", &OpenHole::diameter)
      .def_ro("doubtful", &OpenHole::doubtful);
  nb::class_<MeshRelation>(m, "MeshRelation", R"(proven: False if samples decided a degenerate contact, or if `hole` leaves the relation open; the relation is then
that of the surfaces without fills. decided: False if that takes more steps than a pair may; the relation is then
"indeterminate".)")
      .def_prop_ro("relation", [](const MeshRelation& r) { return r.decided ? name_of(r.relation) : "indeterminate"; })
      .def_ro("proven", &MeshRelation::proven)
      .def_ro("decided", &MeshRelation::decided)
      .def_prop_ro("hole", [](const MeshRelation& r) { return r.hole ? &*r.hole : nullptr; }, nb::rv_policy::reference_internal,
                   nb::sig("def hole(self) -> OpenHole | None"))
      .def_prop_ro("triangle_a", [](const MeshRelation& r) { return triangle_number(r.triangle_a); })
      .def_prop_ro("triangle_b", [](const MeshRelation& r) { return triangle_number(r.triangle_b); })
      .def_prop_ro("point",
                   [](const MeshRelation& r) {
                     return r.point ? std::optional(to_tuple(*r.point)) : std::nullopt;
                   })
      .def_ro("box_tests", &MeshRelation::box_tests)
      .def_ro("triangle_tests", &MeshRelation::triangle_tests)
      .def_ro("steps", &MeshRelation::steps)
      .def_ro("edge_tests", &MeshRelation::edge_tests, "Of the outlines of prisms; None for other bodies.");
  m.def("mesh_relation",
        [](const Surface& a, const Surface& b, std::uint64_t steps) { return mesh_relation(a, b, interrupting(), steps); },
        "a"_a, "b"_a, nb::kw_only(), "steps"_a = kNoEnd, ReleaseGil(),
        R"(How two placed meshes relate, decided by exact predicates on their float64 coordinates: "separated",
"touching", "penetrating" (interiors overlap, or a surface crosses a sheet), "contains" (b strictly inside a),
"inside" (a strictly inside b), "coincident" (the same body, however triangulated). A body is the points of winding
number other than 0, and its sheets: walls of no thickness, in which nothing can be, and which nothing can cross. Not
decided within so many steps, or those that any pair may take, the relation says nothing.)");
}

void bind_mesh_distance(nb::module_& m) {
  nb::class_<MeshDistance>(m, "MeshDistance",
                           "distance: inf when beyond the limit; witness points on a and b, triangle indices.")
      .def_ro("distance", &MeshDistance::distance)
      .def_prop_ro("witness_a", [](const MeshDistance& d) { return to_tuple(d.witness_a); })
      .def_prop_ro("witness_b", [](const MeshDistance& d) { return to_tuple(d.witness_b); })
      .def_prop_ro("triangle_a", [](const MeshDistance& d) { return triangle_number(d.triangle_a); })
      .def_prop_ro("triangle_b", [](const MeshDistance& d) { return triangle_number(d.triangle_b); });
  m.def("mesh_distance", [](const Surface& a, const Surface& b, double limit) {
          Budget budget = Budget::that_stops(kNoEnd, interrupting());
          return mesh_distance(a, b, limit, {}, &budget);
        },
        "a"_a, "b"_a, "limit"_a = INFINITY, ReleaseGil(),
        R"(The least distance of two surfaces in float64, with witness points; inf if it exceeds `limit`. A body inside
another also has a distance from its surface, so call mesh_relation first.)");
  m.def("compare_gap",
        [](const Surface& a, const Surface& b, double length) {
          if (!(length >= 0)) throw std::invalid_argument("the length must not be negative");
          return compare_gap(a, b, length, interrupting());
        },
        "a"_a, "b"_a, "length"_a, ReleaseGil(),
        nb::sig("def compare_gap(a: Surface, b: Surface, length: float) -> typing.Literal[-1, 0, 1]"),
        R"(-1, 0 or 1: the distance of two surfaces without a common point is smaller than, equal to, or larger than the
length. Decided exactly. Raises TooManySteps.)");
  m.def("moves_within",
        [](const Mesh& mesh, const Tuple3& move, double length) {
          return moves_within(mesh.vertices, finite_point(move), length);
        },
        "mesh"_a, "move"_a, "length"_a, ReleaseGil(),
        R"(Whether a translation, added with one rounding of each coordinate, moves no vertex farther than `length`. The answer
is exact if nothing is rounded.)");
  m.def("deviation",
        [](const Mesh& surface_of, const std::vector<const Surface*>& solids, double tolerance, double ratio, std::uint64_t steps) {
          Budget budget(steps, interrupting());
          const Deviation d = deviation(surface_of, solids, tolerance, ratio, budget);
          return std::make_tuple(d.lower, d.upper, to_tuple(d.point), d.narrow);
        },
        "surface_of"_a, "solids"_a, "tolerance"_a, "ratio"_a = 0.0, "steps"_a = kNoEnd, ReleaseGil(),
        R"((lower, upper, point, narrow): bounds of the largest distance of a point of the surface from the union of the solids,
which is 0 inside; surfaces that are not closed have no inside. point: of the surface, at least `lower` away. narrow: the
bounds are at most `tolerance`, or that share of the lower one, apart; else so many steps, each about a nanosecond, do not
suffice. Branch and bound over triangles: the distance is 1-Lipschitz.)");
  m.def("reaches_deeper",
        [](const Mesh& surface_of, const Surface& solid, double length, std::uint64_t work) {
          if (!solid.solid) throw std::invalid_argument("the surface is not a solid");
          if (!(length > 0)) throw std::invalid_argument("the length must be positive");
          Budget budget = Budget::that_stops(work, interrupting());
          return reaches_deeper(surface_of, solid, length, budget);
        },
        "surface_of"_a, "solid"_a, "length"_a, "work"_a, ReleaseGil(),
        R"(Whether a point of the triangles lies inside the solid, farther than `length` from its surface, to rounding. None:
`work` steps, each about a nanosecond, do not decide that.)");
}

}  // namespace

void bind_surface(nb::module_& m) {
  bind_one_surface(m);
  bind_mesh_relation(m);
  bind_mesh_distance(m);
}

}  // namespace satcheck
