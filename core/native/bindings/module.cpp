// The Python face of the narrow phase: `satcheck.core._native`. Arguments are checked here for shape
// and type, in C++ for meaning; results are read-only.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>

#include "base/large_pages.hpp"
#include "convex/sat_polygon.hpp"
#include "convex/shape.hpp"
#include "mesh/hull_points.hpp"
#include "scene/words.hpp"

namespace nb = nanobind;
using namespace satcheck;

namespace satcheck {
void bind_broad_phase(nb::module_& m);
void bind_climb(nb::module_& m);
void bind_resolve(nb::module_& m);
void bind_surface(nb::module_& m);
void bind_contacts(nb::module_& m);
void bind_depth(nb::module_& m);
void bind_mesh(nb::module_& m);
void bind_motion(nb::module_& m);
void bind_pairs(nb::module_& m);
}

namespace {

using Points = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Points2 = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Triple = std::array<double, 3>;

Vec3 to_vec(const Triple& t) { return {t[0], t[1], t[2]}; }

std::vector<Vec3> to_points(const Points& points) {
  std::vector<Vec3> out(points.shape(0));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double* p = points.data() + 3 * i;
    out[i] = {p[0], p[1], p[2]};
  }
  return out;
}

std::vector<Vec2> to_points(const Points2& points) {
  std::vector<Vec2> out(points.shape(0));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = {points.data()[2 * i], points.data()[2 * i + 1]};
  for (Vec2 p : out) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) throw std::invalid_argument("a corner is not finite");
  }
  return out;
}

// One Python class a kind, all with the layout of Shape.
struct HullShape : Shape {};
struct BoxShape : Shape {};
struct SphereShape : Shape {};
struct CapsuleShape : Shape {};
struct CylinderShape : Shape {};
struct ConeShape : Shape {};
struct EllipsoidShape : Shape {};

void bind_hull_points(nb::module_& m) {
  nb::class_<HullPoints>(m, "HullPoints",
                         R"(The vertices of a mesh that can be corners of its convex hull wherever an affine map puts it.)")
      .def(nb::new_([](const Mesh& mesh) { return find_hull_points(mesh); }), nb::arg("mesh"),
           nb::call_guard<nb::gil_scoped_release>())
      .def_prop_ro("count", [](const HullPoints& h) { return h.points.size(); })
      .def(
          "placed",
          [](const HullPoints& h, const std::array<double, 16>& matrix) -> std::optional<HullShape> {
            auto shape = placed_hull(h, matrix);
            if (!shape) return std::nullopt;
            return HullShape{std::move(*shape)};
          },
          nb::arg("matrix"), nb::call_guard<nb::gil_scoped_release>(),
          R"(The hull of the mesh placed by a 4x4 matrix, 16 numbers by rows, as a shape: what Mesh.transformed and then
convex_hull give, without sorting anything. None where rounding may have brought further vertices to its
surface. Raises what Mesh.transformed does.)");
}

void bind_shapes(nb::module_& m) {
  nb::class_<Shape>(m, "Shape", "A convex shape in its own frame. Immutable.")
      .def_prop_ro("vertex_count", [](const Shape& s) { return s.polytope.vertices.size(); })
      .def_prop_ro("dimension", [](const Shape& s) { return s.is_polytope() ? s.polytope.dimension : 3; });
  nb::class_<HullShape, Shape>(m, "Hull",
                              R"(Convex hull of points, an (n, 3) float64 array or a sequence of (x, y, z), n >= 1, or of a
Polytope. Computed exactly; may be flat, a segment or a point. ValueError when a coordinate is not finite, OverflowError when one is
beyond 1e45 or the points are less than 1e-45 across: nothing is proven there.)")
      .def(
          "__init__", [](HullShape* self, const Points& points) { new (self) HullShape{make_hull(to_points(points))}; },
          nb::arg("points").noconvert())
      .def(
          "__init__",
          [](HullShape* self, const std::vector<Triple>& points) {
            std::vector<Vec3> vectors;
            for (const Triple& p : points) vectors.push_back(to_vec(p));
            new (self) HullShape{make_hull(vectors)};
          },
          nb::arg("points"))
      .def(
          "__init__", [](HullShape* self, const Polytope& polytope) { new (self) HullShape{make_hull(polytope)}; },
          nb::arg("polytope"));
  bind_hull_points(m);
  nb::class_<BoxShape, Shape>(m, "Box", "Box around the origin; half_extents (x, y, z) > 0.").def(
      "__init__", [](BoxShape* self, const Triple& half) { new (self) BoxShape{make_box(to_vec(half))}; },
      nb::arg("half_extents"));
  nb::class_<SphereShape, Shape>(m, "Sphere", "Sphere around the origin.")
      .def("__init__", [](SphereShape* self, double radius) { new (self) SphereShape{make_sphere(radius)}; },
           nb::arg("radius"));
  nb::class_<CapsuleShape, Shape>(m, "Capsule", "Segment from -half_height to half_height on z, grown by radius.")
      .def("__init__", [](CapsuleShape* self, double r, double h) { new (self) CapsuleShape{make_capsule(r, h)}; },
           nb::arg("radius"), nb::arg("half_height"));
  nb::class_<CylinderShape, Shape>(m, "Cylinder", "Cylinder about z, from -half_height to half_height.")
      .def("__init__", [](CylinderShape* self, double r, double h) { new (self) CylinderShape{make_cylinder(r, h)}; },
           nb::arg("radius"), nb::arg("half_height"));
  nb::class_<ConeShape, Shape>(m, "Cone", "Cone about z: base at -half_height, apex at +half_height.")
      .def("__init__", [](ConeShape* self, double r, double h) { new (self) ConeShape{make_cone(r, h)}; },
           nb::arg("radius"), nb::arg("half_height"));
  nb::class_<EllipsoidShape, Shape>(m, "Ellipsoid", "Ellipsoid around the origin; radii along x, y, z.")
      .def("__init__",
           [](EllipsoidShape* self, const Triple& radii) { new (self) EllipsoidShape{make_ellipsoid(to_vec(radii))}; },
           nb::arg("radii"));
}

void bind_polygons(nb::module_& m) {
  nb::class_<PolygonResult>(m, "PolygonResult",
                            R"(outcome: exact. penetration: > 0 the least overlap; < 0 minus the widest gap along an edge normal, a
lower bound of the distance. normal: unit, A to B; edge_a or edge_b: the edge it belongs to, else -1.)")
      .def_prop_ro("outcome", [](const PolygonResult& r) { return name_of(r.outcome); })
      .def_ro("penetration", &PolygonResult::penetration)
      .def_prop_ro("normal", [](const PolygonResult& r) { return nb::make_tuple(r.normal.x, r.normal.y); })
      .def_ro("edge_a", &PolygonResult::edge_a)
      .def_ro("edge_b", &PolygonResult::edge_b);
  m.def("sat_polygons",
        [](const Points2& a, const Points2& b) { return sat_polygons(to_points(a), to_points(b)); }, 
        nb::arg("a").noconvert(), nb::arg("b").noconvert(),
        R"(Planar SAT of two convex polygons, (n, 2) and (m, 2) float64, counter-clockwise. ValueError otherwise.)");
}

}  // namespace

NB_MODULE(_native, m) {
  // Shapes held by a module that lives until the interpreter ends are no leak, and no news for stderr.
  nb::set_leak_warnings(false);
  bind_mesh(m);
  bind_surface(m);
  bind_broad_phase(m);
  bind_resolve(m);
  bind_contacts(m);
  bind_depth(m);
  bind_motion(m);
  bind_shapes(m);
  bind_pairs(m);
  bind_polygons(m);
  bind_climb(m);
  m.def("keep_freed_memory", &keep_freed_memory, R"(For a process that answers one question and ends: memory that is freed is kept for what comes next, where the
allocator can do that.)");
}
