// The Python face of the narrow phase: `satcheck._native.core`. Arguments are checked here for shape
// and type, in C++ for meaning; results are read-only.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>

#include "base/budget.hpp"
#include "base/large_pages.hpp"
#include "bindings/arguments.hpp"
#include "bindings/values.hpp"
#include "convex/shape.hpp"

namespace nb = nanobind;
using namespace satcheck;

namespace satcheck {
void bind_broad_phase(nb::module_& m);
void bind_climb(nb::module_& m);
void bind_surface(nb::module_& m);
void bind_contacts(nb::module_& m);
void bind_depth(nb::module_& m);
void bind_overlap(nb::module_& m);
void bind_thickness(nb::module_& m);
void bind_mesh(nb::module_& m);
void bind_motion(nb::module_& m);
void bind_pairs(nb::module_& m);
void bind_poses(nb::module_& m);
void bind_core(nb::module_& m);
}

namespace {

using Points = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Triple = std::array<double, 3>;

std::vector<Vec3> to_points(const Points& points) {
  std::vector<Vec3> out(points.shape(0));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double* p = points.data() + 3 * i;
    out[i] = {p[0], p[1], p[2]};
  }
  return out;
}

// One Python class for each kind, all with the layout of Shape.
struct HullShape : Shape {};
struct BoxShape : Shape {};
struct SphereShape : Shape {};
struct CapsuleShape : Shape {};
struct CylinderShape : Shape {};
struct ConeShape : Shape {};
struct EllipsoidShape : Shape {};

template <class Kind, class Make>
void def_init(nb::class_<Kind, Shape>& shape, const char* signature, Make make) {
  shape.def(
      "__init__", [make](Kind* self, nb::args args, nb::kwargs kwargs) { new (self) Kind{make(args, kwargs)}; },
      nb::sig(signature));
}

Shape unlocked_hull(const std::vector<Vec3>& points) {
  const nb::gil_scoped_release release;
  return make_hull(points);
}

Shape hull_of(const nb::args& args, const nb::kwargs& kwargs) {
  const Arguments given("Hull", {"points"}, args, kwargs);
  if (nb::isinstance<Polytope>(given[0])) return make_hull(nb::cast<const Polytope&>(given[0]));
  Points array;
  if (nb::try_cast(given[0], array, false)) return unlocked_hull(to_points(array));
  std::vector<Triple> rows;
  if (!nb::try_cast(given[0], rows)) given.refuse(0, "an (n, 3) array of float64, rows of three numbers or a Polytope");
  std::vector<Vec3> points;
  for (const Triple& row : rows) points.push_back(to_vec(row));
  return unlocked_hull(points);
}

constexpr const char* kRound = "def __init__(self, radius: float, half_height: float) -> None";

auto round_shape(const char* name, Shape (*make)(double, double)) {
  return [=](const nb::args& args, const nb::kwargs& kwargs) {
    const Arguments given(name, {"radius", "half_height"}, args, kwargs);
    return make(given.number(0), given.number(1));
  };
}

void bind_shapes(nb::module_& m) {
  nb::class_<Shape>(m, "Shape", "A convex shape in its own frame. Immutable.")
      .def_prop_ro("vertex_count", [](const Shape& s) { return s.polytope.vertices.size(); })
      .def_prop_ro("dimension", [](const Shape& s) { return s.is_polytope() ? s.polytope.dimension : 3; });
  nb::class_<HullShape, Shape> hull(m, "Hull", R"(Convex hull of points, an (n, 3) float64 array or a sequence of (x, y, z), n >= 1, or of a
Polytope. Computed exactly; may be flat, a segment or a point. ValueError when a coordinate is not finite, OverflowError when one is
beyond 1e45 or the points are less than 1e-45 across: nothing is proven there.)");
  def_init(hull, "def __init__(self, points: numpy.typing.ArrayLike | Polytope) -> None", hull_of);
  nb::class_<BoxShape, Shape> box(m, "Box", "Box around the origin; half_extents (x, y, z) > 0.");
  def_init(box, "def __init__(self, half_extents: Sequence[float]) -> None", [](const nb::args& args, const nb::kwargs& kwargs) {
    return make_box(Arguments("Box", {"half_extents"}, args, kwargs).three_numbers(0));
  });
  nb::class_<SphereShape, Shape> sphere(m, "Sphere", "Sphere around the origin.");
  def_init(sphere, "def __init__(self, radius: float) -> None", [](const nb::args& args, const nb::kwargs& kwargs) {
    return make_sphere(Arguments("Sphere", {"radius"}, args, kwargs).number(0));
  });
  nb::class_<CapsuleShape, Shape> capsule(m, "Capsule", "Segment from -half_height to half_height on z, grown by radius.");
  def_init(capsule, kRound, round_shape("Capsule", make_capsule));
  nb::class_<CylinderShape, Shape> cylinder(m, "Cylinder", "Cylinder about z, from -half_height to half_height.");
  def_init(cylinder, kRound, round_shape("Cylinder", make_cylinder));
  nb::class_<ConeShape, Shape> cone(m, "Cone", "Cone about z: base at -half_height, apex at +half_height.");
  def_init(cone, kRound, round_shape("Cone", make_cone));
  nb::class_<EllipsoidShape, Shape> ellipsoid(m, "Ellipsoid", "Ellipsoid around the origin; radii along x, y, z.");
  def_init(ellipsoid, "def __init__(self, radii: Sequence[float]) -> None", [](const nb::args& args, const nb::kwargs& kwargs) {
    return make_ellipsoid(Arguments("Ellipsoid", {"radii"}, args, kwargs).three_numbers(0));
  });
}

}  // namespace

void satcheck::bind_core(nb::module_& m) {
  nb::exception<BudgetSpent>(m, "TooManySteps", PyExc_RuntimeError);
  bind_mesh(m);
  bind_surface(m);
  bind_broad_phase(m);
  bind_contacts(m);
  bind_depth(m);
  bind_overlap(m);
  bind_thickness(m);
  bind_motion(m);
  bind_shapes(m);
  bind_pairs(m);
  bind_climb(m);
  bind_poses(m);
  m.def("keep_freed_memory", &keep_freed_memory, R"(For a process that answers one query and ends: freed memory is kept for later allocations, if the allocator can do
that.)");
}
