// The Python face of one mesh: its topology, its inspection, its convex hull. Nothing but conversions.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <cstring>
#include <string>
#include <stdexcept>
#include <utility>

#include "base/large_pages.hpp"
#include "base/parallel.hpp"
#include "bindings/arguments.hpp"
#include "bindings/interrupts.hpp"
#include "bindings/values.hpp"
#include "convex/convex_hull.hpp"
#include "mesh/convexity.hpp"
#include "mesh/hull_points.hpp"
#include "mesh/inspection.hpp"
#include "mesh/mesh_checks.hpp"
#include "mesh/facing.hpp"
#include "mesh/orient.hpp"
#include "mesh/topology.hpp"
#include "mesh/transform.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {
namespace {

using VertexArray = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
template <class Index>
using IndexArray = nb::ndarray<const Index, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using ReleaseGil = nb::call_guard<nb::gil_scoped_release>;

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Triangle) == 3 * sizeof(std::uint32_t));

std::vector<Vec3> copy_vertices(const double* data, std::size_t count) {
  std::vector<Vec3> vertices(count);
  if (count != 0) std::memcpy(static_cast<void*>(vertices.data()), data, count * sizeof(Vec3));
  return vertices;
}

// False if the argument is not such an array.
template <class Index>
bool read_triangles(nb::handle argument, Mesh& mesh) {
  IndexArray<Index> triangles;
  if (!nb::try_cast(argument, triangles, false)) return false;
  mesh.triangles.resize(triangles.shape(0));
  const Index* index = triangles.data();
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      const Index i = *index++;
      if (std::cmp_less(i, 0) || std::cmp_greater_equal(i, mesh.vertices.size())) {
        throw std::invalid_argument("vertex index " + std::to_string(i) + " is out of range");
      }
      v = static_cast<std::uint32_t>(i);
    }
  }
  return true;
}

void construct_mesh(Mesh* self, nb::args args, nb::kwargs kwargs) {
  const Arguments given("Mesh", {"vertices", "triangles"}, args, kwargs);
  VertexArray vertices;
  if (!nb::try_cast(given[0], vertices, false)) given.refuse(0, "a C-contiguous (n, 3) array of float64");
  Mesh mesh;
  mesh.vertices = copy_vertices(vertices.data(), vertices.shape(0));
  if (!read_triangles<std::uint32_t>(given[1], mesh) && !read_triangles<std::int32_t>(given[1], mesh) &&
      !read_triangles<std::int64_t>(given[1], mesh)) {
    given.refuse(1, "a C-contiguous (m, 3) array of int32, int64 or uint32");
  }
  require_valid(mesh);
  new (self) Mesh(std::move(mesh));
}

using Bytes = nb::ndarray<const std::uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

Mesh mesh_from_bytes(const Bytes& vertices, const Bytes& triangles) {
  if (vertices.size() % sizeof(Vec3) != 0 || triangles.size() % sizeof(Triangle) != 0) {
    throw std::invalid_argument("the byte counts are not multiples of 24 and 12");
  }
  Mesh mesh;
  mesh.vertices = with_room<Vec3>(vertices.size() / sizeof(Vec3));
  mesh.triangles = with_room<Triangle>(triangles.size() / sizeof(Triangle));
  mesh.vertices.resize(vertices.size() / sizeof(Vec3));
  mesh.triangles.resize(triangles.size() / sizeof(Triangle));
  if (vertices.size() != 0) std::memcpy(mesh.vertices.data(), vertices.data(), vertices.size());
  if (triangles.size() != 0) std::memcpy(mesh.triangles.data(), triangles.data(), triangles.size());
  require_valid(mesh);
  return mesh;
}

// Whether nobody can write these bytes: bytes, or what the readers hand out. A read-only view may be one of an array that
// somebody writes.
bool is_fixed(nb::handle bytes) {
  if (nb::isinstance<nb::bytes>(bytes)) return true;
  if (!PyMemoryView_Check(bytes.ptr())) return false;
  const nb::object owner = bytes.attr("obj");
  return nb::isinstance<nb::bytes>(owner) || std::string(nb::type_name(owner.type()).c_str()) == "nanobind.nb_ndarray";
}

// Other bytes are copied: indices that were checked must not change.
Inspection inspect_bytes(const nb::object& given_vertices, const nb::object& given_triangles, bool orient) {
  const auto vertices = nb::cast<Bytes>(given_vertices), triangles = nb::cast<Bytes>(given_triangles);
  const bool in_place = is_fixed(given_vertices) && is_fixed(given_triangles);
  const nb::gil_scoped_release release;
  const auto is_aligned = [](const Bytes& bytes) {
    return reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(Vec3) == 0 && bytes.size() > 0;
  };
  const bool is_whole = vertices.size() % sizeof(Vec3) == 0 && triangles.size() % sizeof(Triangle) == 0;
  if (!in_place || !is_whole || !is_aligned(vertices) || !is_aligned(triangles)) return inspect(mesh_from_bytes(vertices, triangles), orient, interrupting());
  const MeshView mesh({reinterpret_cast<const Vec3*>(vertices.data()), vertices.size() / sizeof(Vec3)},
                      {reinterpret_cast<const Triangle*>(triangles.data()), triangles.size() / sizeof(Triangle)});
  require_valid(mesh);
  return inspect(mesh, orient, interrupting());
}

std::pair<nb::bytes, nb::bytes> mesh_to_bytes(const Mesh& mesh) {
  return std::pair(nb::bytes(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3)),
                        nb::bytes(mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle)));
}

// Read-only views that keep `owner` alive.
template <class Scalar, class Row>
auto rows_view(const std::vector<Row>& rows, nb::handle owner) {
  return nb::ndarray<nb::numpy, const Scalar, nb::shape<-1, 3>>(
      reinterpret_cast<const Scalar*>(rows.data()), {rows.size(), 3}, owner);
}

void bind_mesh_class(nb::module_& m) {
  nb::class_<Mesh>(m, "Mesh", R"(Immutable triangle mesh: vertices (n, 3) float64, triangles (m, 3) int32, int64 or uint32, counter-clockwise
seen from outside. ValueError when an index is out of range or a coordinate is not finite, OverflowError
when a coordinate is beyond 1e45 or the mesh is less than 1e-45 across: nothing is proven there.)")
      .def("__init__", &construct_mesh,
           nb::sig("def __init__(self, vertices: numpy.typing.NDArray[numpy.float64], triangles: numpy.typing.NDArray[numpy.integer]) -> None"))
      .def_static("from_bytes", &mesh_from_bytes, "vertices"_a, "triangles"_a, ReleaseGil(),
                  nb::sig("def from_bytes(vertices: bytes | memoryview, triangles: bytes | memoryview) -> Mesh"),
                  "From little-endian float64 x y z ... and uint32 i j k ...; needs no numpy.")
      .def("to_bytes", &mesh_to_bytes, "The inverse of from_bytes.")
      .def_prop_ro("vertex_count", [](const Mesh& mesh) { return mesh.vertices.size(); })
      .def("vertex", [](const Mesh& mesh, std::size_t i) { return to_tuple(mesh.vertices.at(i)); }, "i"_a,
           "One of the vertices; numpy is not needed for it. IndexError beyond the last.")
      .def_prop_ro("triangle_count", [](const Mesh& mesh) { return mesh.triangles.size(); })
      .def_prop_ro("bounds",
                   [](const Mesh& mesh) {
                     if (mesh.vertices.empty()) throw std::invalid_argument("an empty mesh has no bounds");
                     const Aabb box = bounds_of(mesh.vertices);
                     return std::make_tuple(to_tuple(box.min), to_tuple(box.max));
                   })
      .def_prop_ro("largest_coordinate",
                   [](const Mesh& mesh) {
                     double largest = 0;
                     for (const Vec3& p : mesh.vertices) largest = std::fmax(largest, max_abs(p));
                     return largest;
                   },
                   "The largest |coordinate|; 0.0 of an empty mesh.")
      .def_prop_ro("vertices",
                   [](nb::handle self) {
                     return rows_view<double>(nb::cast<const Mesh&>(self).vertices, self);
                   })
      .def_prop_ro("triangles",
                   [](nb::handle self) {
                     return rows_view<std::uint32_t>(nb::cast<const Mesh&>(self).triangles, self);
                   })
      .def(
          "corners",
          [](const Mesh& mesh, std::size_t triangle) {
            if (triangle >= mesh.triangles.size()) throw nb::index_error("no such triangle");
            const auto [i, j, k] = mesh.triangles[triangle];
            const std::vector<Vec3>& p = mesh.vertices;
            return std::make_tuple(to_tuple(p[i]), to_tuple(p[j]), to_tuple(p[k]));
          },
          "triangle"_a, "The three corners of one triangle; needs no numpy.")
      .def("welded", &weld, ReleaseGil(), "Vertices with equal coordinates become one; unreferenced ones are dropped; triangles keep their order.")
      .def("sorted", &sort, ReleaseGil(), "Vertices sorted by coordinates, triangles by corners. The result does not depend on the order in the file.")
      .def("transformed", &transform, "matrix"_a, ReleaseGil(), R"(Placed by a 4x4 matrix, 16 numbers by rows, column vectors. Each coordinate is rounded once; a mirror flips
the winding. ValueError when the matrix is not affine or singular, OverflowError when an entry of it is not finite.)")
      .def("translated",
           [](const Mesh& mesh, const Tuple3& offset) { return translate(mesh, to_vec3(offset)); },
           "offset"_a, ReleaseGil())
      .def("topology",
           [](const Mesh& mesh) {
             Topology topology = measure_topology(mesh);
             Budget budget = Budget::that_stops(kNoEnd, interrupting());
             topology.solid = topology.solid && facing_of(weld(mesh), &budget).doubtful.empty();
             return topology;
           },
           ReleaseGil(), "Counts and properties; edges are counted on the welded mesh.")
      .def("oriented",
           [](const Mesh& mesh) {
             Budget budget = Budget::that_stops(kNoEnd, interrupting());
             return orient(mesh, &budget);
           },
           ReleaseGil(), R"(Welded, with one winding for each component, and the outermost closed shells outward. Copies of a triangle are
dropped if that closes the surface. Nothing is turned if shells that face outward lie within one that faces inward: they may
be solid or cavities.)")
      .def("components", [](const Mesh& mesh, double width) { return split_components(mesh, width, interrupting()); }, "crack_width"_a = 0.0, ReleaseGil(), R"(The edge-connected parts, in order of their
first triangle. The wall of a cavity belongs to the solid around it. crack_width: points this close may be the same point;
edges along such a crack count as shared.)")
      .def("is_flat", [](const Mesh& mesh) { return is_flat(mesh); }, ReleaseGil(), "Whether all vertices lie in one plane, exactly. True if no triangle has an area.")
      .def("far_vertex",
           [](const Mesh& mesh) {
             const FarVertex far = far_vertex(mesh);
             return std::make_tuple(to_tuple(far.at), far.median);
           },
           ReleaseGil(), "The vertex with the largest |coordinate|, and the median of that of all vertices; needs no numpy.")
      .def("convex_hull",
           [](const Mesh& mesh) {
             Budget budget = Budget::that_stops(kNoEnd, interrupting());
             return convex_hull(mesh.vertices, &budget);
           },
           ReleaseGil())
      .def("convexity_defect",
           [](const Mesh& mesh, double limit) {
             Budget budget = Budget::that_stops(kNoEnd, interrupting());
             return convexity_defect(mesh, limit, &budget);
           },
           "limit"_a, ReleaseGil(), R"(A proven upper bound of the distance from any point of the convex hull to the solid; 0.0 only when they are
equal; inf when the mesh is not a solid or the bound exceeds `limit`.)");
}

using Bounds = std::pair<Tuple3, Tuple3>;

std::vector<std::optional<Bounds>> bounds_of_placed(const nb::typed<nb::sequence, Mesh>& given,
                                                    const std::vector<std::array<double, 16>>& matrices,
                                                    unsigned threads) {
  const nb::tuple held(given);
  std::vector<const Mesh*> meshes;
  if (!nb::try_cast(held, meshes)) throw nb::type_error("meshes: a sequence of Mesh expected");
  if (meshes.size() != matrices.size()) throw std::invalid_argument("meshes and matrices differ in number");
  constexpr std::size_t kTogether = 64;  // bodies that one thread takes at a time
  std::vector<std::optional<Bounds>> bounds(meshes.size());
  const nb::gil_scoped_release release;
  parallel_for(meshes.size(), threads, [&](std::size_t i) {
    if (meshes[i]->vertices.empty()) return;
    try {
      const Aabb box = placed_bounds(*meshes[i], matrices[i]);
      bounds[i] = Bounds{to_tuple(box.min), to_tuple(box.max)};
    } catch (const std::invalid_argument&) {  // bounds[i] stays empty
    } catch (const std::overflow_error&) {
    }
  }, kTogether);
  return bounds;
}

void bind_placed_bounds(nb::module_& m) {
  m.def("placed_bounds", &bounds_of_placed, "meshes"_a, "matrices"_a, "threads"_a = 0,
        R"(The bounds of meshes[i].transformed(matrices[i]) for each i, equal to the bit, without placing a mesh; None if that
raises. threads: 0: one for each core. ValueError if the lengths differ.)");
  m.def("largest_stretch", &largest_stretch, "matrix"_a,
        "The largest factor by which the placement, 16 entries by rows, stretches a length: its largest singular value. "
        "OverflowError if it is beyond float64.");
  m.def("largest_placed", &largest_placed, "matrix"_a, "largest"_a,
        "An upper bound, up to rounding, of |world coordinate| for coordinates up to `largest` in the file.");
}

void bind_topology(nb::module_& m) {
  nb::class_<Topology>(m, "Topology",
                       R"(Counts and facts of a mesh. closed: no boundary edge, every edge an even number of triangles. manifold: two
triangles at every edge. oriented: neighbours agree on the winding. volume: signed, 0.0 when not closed.
solid: closed, oriented and of non-zero volume, so that it has an inside, and in no doubt (oriented()).)")
      .def_ro("vertices", &Topology::vertices)
      .def_ro("triangles", &Topology::triangles)
      .def_ro("components", &Topology::components)
      .def_ro("boundary_edges", &Topology::boundary_edges)
      .def_ro("nonmanifold_edges", &Topology::nonmanifold_edges)
      .def_ro("misoriented_edges", &Topology::misoriented_edges)
      .def_ro("degenerate_triangles", &Topology::degenerate_triangles)
      .def_ro("duplicate_triangles", &Topology::duplicate_triangles)
      .def_ro("closed", &Topology::closed)
      .def_ro("manifold", &Topology::manifold)
      .def_ro("oriented", &Topology::oriented)
      .def_ro("volume", &Topology::volume)
      .def_ro("solid", &Topology::solid);
  nb::class_<Inspection>(m, "Inspection", R"(The result of inspect(). mesh: welded, oriented if it is closed, in an order that depends on coordinates alone. turned: orienting
changed the mesh. doubtful: shells of it may be solid or cavities; it is not turned. cracks: the number of closed cracks. topology: before these repairs; repaired: of `mesh`. hole_count: of `mesh`; largest_hole: (centre, diameter), file units, or None.)")
      .def_ro("mesh", &Inspection::mesh)
      .def_ro("turned", &Inspection::turned)
      .def_ro("doubtful", &Inspection::doubtful)
      .def_ro("cracks", &Inspection::cracks)
      .def_prop_ro("hole_count", [](const Inspection& inspection) { return inspection.holes.size(); })
      .def_prop_ro("largest_hole",
                   [](const Inspection& inspection) {
                     using Largest = std::optional<std::tuple<Tuple3, double>>;
                     if (inspection.holes.empty()) return Largest();
                     const Hole& hole = inspection.holes[0];
                     return Largest({to_tuple(hole.centre()), hole.diameter()});
                   })
      .def_ro("topology", &Inspection::topology)
      .def_ro("repaired", &Inspection::repaired);
  m.def("inspect", [](const Mesh& mesh, bool orient) { return inspect(mesh, orient, interrupting()); }, "mesh"_a, "orient"_a, ReleaseGil(),
        "mesh.welded().sorted() and its topology; with `orient` also oriented().");
  m.def("inspect_bytes", &inspect_bytes, "vertices"_a, "triangles"_a, "orient"_a,
        nb::sig("def inspect_bytes(vertices: bytes | memoryview, triangles: bytes | memoryview, orient: bool) -> Inspection"),
        "inspect(Mesh.from_bytes(vertices, triangles), orient), but faster than both calls.");
  m.def("with_cracks_closed",
        [](const Inspection& inspection, bool orient, double width) { return with_cracks_closed(inspection, orient, width, interrupting()); },
        "inspection"_a, "orient"_a, "width"_a, ReleaseGil(),
        R"(The inspection with cracks closed: gaps between neighbouring faces that are at most `width` wide, file units.
Triangles are added; none is changed.)");
}

void bind_polytope(nb::module_& m) {
  nb::class_<Polytope>(m, "Polytope", "Convex hull with its features; vertices are extreme points.")
      .def_ro("dimension", &Polytope::dimension)
      .def_prop_ro("vertices",
                   [](nb::handle self) {
                     return rows_view<double>(nb::cast<const Polytope&>(self).vertices, self);
                   })
      .def_prop_ro("triangles",
                   [](nb::handle self) {
                     return rows_view<std::uint32_t>(nb::cast<const Polytope&>(self).triangles, self);
                   })
      .def_prop_ro("vertex_count", [](const Polytope& p) { return p.vertices.size(); })
      .def("to_mesh", [](const Polytope& p) { return Mesh{p.vertices, p.triangles}; });
}

}  // namespace

void bind_mesh(nb::module_& m) {
  bind_topology(m);
  bind_polytope(m);
  bind_mesh_class(m);
  bind_placed_bounds(m);
}

}  // namespace satcheck
