// The Python face of the narrow phase: `satcheck.core._native`. Arguments are checked here for shape
// and type, in C++ for meaning; results are read-only.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>

#include "base/numeric_range.hpp"
#include "base/sha256.hpp"
#include "convex/batch.hpp"
#include "convex/sat_polygon.hpp"
#include "mesh/hull_points.hpp"
#include "scene/words.hpp"

namespace nb = nanobind;
using namespace satcheck;

namespace satcheck {
void bind_broad_phase(nb::module_& m);
void bind_climb(nb::module_& m);
void bind_resolve(nb::module_& m);
void bind_contacts(nb::module_& m);
void bind_depth(nb::module_& m);
void bind_frozen(nb::module_& m);
void bind_mesh(nb::module_& m);
void bind_motion(nb::module_& m);
}

namespace {

using Points = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Points2 = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Poses = nb::ndarray<const double, nb::shape<-1, 7>, nb::c_contig, nb::device::cpu>;
using Indices = nb::ndarray<const std::uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Triple = std::array<double, 3>;

nb::tuple to_tuple(Vec3 v) { return nb::make_tuple(v.x, v.y, v.z); }
Vec3 to_vec(const Triple& t) { return {t[0], t[1], t[2]}; }

// Translation, then a quaternion x y z w of any non-zero length.
Pose pose_from(const double* p) {
  const double x = p[3], y = p[4], z = p[5], w = p[6];
  const double norm_squared = x * x + y * y + z * z + w * w;
  for (int i = 0; i < 7; ++i) {
    if (!std::isfinite(p[i])) throw std::invalid_argument("a pose has a coordinate that is not finite");
    if (i < 3 && !in_range(p[i])) throw std::overflow_error("a pose has a translation that is out of range");
  }
  if (!(norm_squared > 0)) throw std::invalid_argument("a pose has a quaternion of length 0");
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

MethodChoice method_from(const std::string& name) {
  if (name == "auto") return MethodChoice::automatic;
  if (name == "sat") return MethodChoice::sat;
  if (name == "gjk") return MethodChoice::gjk;
  throw std::invalid_argument("method is \"auto\", \"sat\" or \"gjk\", not \"" + name + "\"");
}

const char* name_of(Reason reason) { return reason == Reason::none ? "" : "bounds-not-closed"; }

nb::object optional_number(const PairResult& r, double value) {
  return r.has_distance ? nb::object(nb::float_(value)) : nb::none();
}
nb::object optional_vector(const PairResult& r, Vec3 v) {
  return r.has_distance ? nb::object(to_tuple(v)) : nb::none();
}
std::int64_t index_or_minus_one(std::uint32_t index) {
  return index == Shape::kNoIndex ? -1 : static_cast<std::int64_t>(index);
}

constexpr const char* kPairResultDoc = R"(What was found about one convex pair. World frame, units of the shapes.

outcome      "separated", "touching", "penetrating" or "undecided" (then `reason` says why), the same for every
             query, and for B against A. On hulls, boxes, spheres and capsules touching is decided exactly,
             for the vertices, centres and axes where the poses round them to; where a cylinder, cone or
             ellipsoid takes part it means that 0 lies between the proven bounds lower and upper.
distance     signed: > 0 the gap, < 0 minus the penetration depth. None for query "overlap".
lower, upper proven bounds of the signed distance, rounding included.
normal       unit, from A to B. witness_a, witness_b: points on A and B with
             witness_b - witness_a = distance * normal. Moving A by distance * normal separates an overlap.
method       the stage that decided: "sat", "gjk", "epa" or "exact".
feature      what carries the answer: "face-a", "face-b", "edge-edge" (with index_a, index_b of the face
             or edge, -1 where none), "vertices" or "curved".)";

void bind_pair_result(nb::module_& m) {
  nb::class_<PairResult>(m, "PairResult", kPairResultDoc)
      .def_prop_ro("outcome", [](const PairResult& r) { return name_of(r.outcome); })
      .def_prop_ro("reason", [](const PairResult& r) { return name_of(r.reason); })
      .def_prop_ro("method", [](const PairResult& r) { return name_of(r.method); })
      .def_prop_ro("feature", [](const PairResult& r) { return name_of(r.feature); })
      .def_prop_ro("index_a", [](const PairResult& r) { return index_or_minus_one(r.index_a); })
      .def_prop_ro("index_b", [](const PairResult& r) { return index_or_minus_one(r.index_b); })
      .def_prop_ro("distance", [](const PairResult& r) { return optional_number(r, r.distance); })
      .def_prop_ro("lower", [](const PairResult& r) { return optional_number(r, r.lower); })
      .def_prop_ro("upper", [](const PairResult& r) { return optional_number(r, r.upper); })
      .def_prop_ro("normal", [](const PairResult& r) { return optional_vector(r, r.normal); })
      .def_prop_ro("witness_a", [](const PairResult& r) { return optional_vector(r, r.witness_a); })
      .def_prop_ro("witness_b", [](const PairResult& r) { return optional_vector(r, r.witness_b); })
      .def_ro("gjk_iterations", &PairResult::gjk_iterations)
      .def_ro("epa_iterations", &PairResult::epa_iterations)
      .def_ro("axes_tested", &PairResult::axes_tested)
      .def("__repr__", [](const PairResult& r) {
        return std::string("<PairResult ") + name_of(r.outcome) +
               (r.has_distance ? ", distance " + std::to_string(r.distance) : "") + " by " + name_of(r.method) + ">";
      });
}

// Arrays over the results, without a copy: a field of every record, one record apart.
struct PairResults {
  std::vector<PairResult> records;
};

template <class T>
nb::object field(nb::handle self, const T* first, std::size_t count, std::size_t width) {
  static_assert(sizeof(PairResult) % sizeof(T) == 0);
  const std::size_t shape[2] = {count, width};
  const std::int64_t strides[2] = {static_cast<std::int64_t>(sizeof(PairResult) / sizeof(T)), 1};
  return nb::cast(nb::ndarray<nb::numpy, const T>(first, width == 1 ? 1 : 2, shape, self, strides));
}

template <auto Member, class T, std::size_t Width>
nb::object column(nb::handle self) {
  const auto& records = nb::cast<const PairResults&>(self).records;
  static const PairResult nothing{};
  const PairResult& first = records.empty() ? nothing : records.front();
  return field(self, reinterpret_cast<const T*>(&(first.*Member)), records.size(), Width);
}

void bind_pair_results(nb::module_& m) {
  nb::class_<PairResults>(m, "PairResults",
                          R"(The results of check_pairs: indexing gives a PairResult, the attributes are read-only
numpy views of shape (n,) or (n, 3). Outcomes are 0 separated, 1 touching, 2 penetrating, 3 undecided;
methods 0 none, 1 sat, 2 gjk, 3 epa, 4 exact. Distances and vectors are 0 for query "overlap".)")
      .def("__len__", [](const PairResults& r) { return r.records.size(); })
      .def(
          "__getitem__",
          [](const PairResults& r, std::size_t i) {
            if (i >= r.records.size()) throw nb::index_error();
            return r.records[i];
          },
          nb::arg("index"))
      .def_prop_ro("outcome", &column<&PairResult::outcome, std::uint8_t, 1>)
      .def_prop_ro("method", &column<&PairResult::method, std::uint8_t, 1>)
      .def_prop_ro("distance", &column<&PairResult::distance, double, 1>)
      .def_prop_ro("lower", &column<&PairResult::lower, double, 1>)
      .def_prop_ro("upper", &column<&PairResult::upper, double, 1>)
      .def_prop_ro("normal", &column<&PairResult::normal, double, 3>)
      .def_prop_ro("witness_a", &column<&PairResult::witness_a, double, 3>)
      .def_prop_ro("witness_b", &column<&PairResult::witness_b, double, 3>)
      .def_prop_ro("gjk_iterations", &column<&PairResult::gjk_iterations, int, 1>)
      .def_prop_ro("epa_iterations", &column<&PairResult::epa_iterations, int, 1>)
      .def_prop_ro("axes_tested", &column<&PairResult::axes_tested, int, 1>);
}

PairResults check_many(const std::vector<const Shape*>& shapes, Indices index_a, Indices index_b, Poses poses_a,
                       Poses poses_b, const std::string& query, const std::string& method, unsigned threads) {
  const std::size_t count = index_a.shape(0);
  if (index_b.shape(0) != count || poses_a.shape(0) != count || poses_b.shape(0) != count) {
    throw std::invalid_argument("index_a, index_b, poses_a and poses_b differ in length");
  }
  const auto request = [&](std::size_t i) -> PairRequest {
    const std::uint32_t a = index_a.data()[i], b = index_b.data()[i];
    if (a >= shapes.size() || b >= shapes.size()) throw std::invalid_argument("a shape index is out of range");
    return {shapes[a], shapes[b], pose_from(poses_a.data() + 7 * i), pose_from(poses_b.data() + 7 * i)};
  };
  const Query asked = query_from(query);
  const MethodChoice choice = method_from(method);
  nb::gil_scoped_release release;
  return {check_pairs(count, request, asked, choice, threads)};
}

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
Polytope. Computed exactly; may be flat, a segment or a point. ValueError when a coordinate is not finite, OverflowError when one other than 0 lies
outside 1e-80 .. 1e45, beyond which nothing is proven.)")
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
  bind_frozen(m);
  bind_mesh(m);
  bind_broad_phase(m);
  bind_resolve(m);
  bind_contacts(m);
  bind_depth(m);
  bind_motion(m);
  bind_shapes(m);
  bind_pair_result(m);
  bind_pair_results(m);
  bind_polygons(m);
  bind_climb(m);
  m.def(
      "sha256",
      [](const nb::bytes& data) {
        const std::string_view bytes(data.c_str(), data.size());
        const nb::gil_scoped_release release;
        return sha256(bytes);
      },
      nb::arg("data"), "SHA-256 of the bytes, in hexadecimal digits. hashlib takes longer to import than a check to hash.");
  m.def(
      "check_pair",
      [](const Shape& a, const Shape& b, const std::optional<std::vector<double>>& pose_a,
         const std::optional<std::vector<double>>& pose_b, const std::string& query, const std::string& method) {
        const Pose pa = pose_from(pose_a), pb = pose_from(pose_b);
        const Query asked = query_from(query);
        const MethodChoice choice = method_from(method);
        nb::gil_scoped_release release;
        return check_pair(a, pa, b, pb, asked, choice);
      },
      nb::arg("a"), nb::arg("b"), nb::arg("pose_a") = nb::none(), nb::arg("pose_b") = nb::none(), nb::kw_only(),
      nb::arg("query") = "depth", nb::arg("method") = "auto",
      R"(Check two placed convex shapes.

pose_a, pose_b  None, (tx, ty, tz) or (tx, ty, tz, qx, qy, qz, qw): rotate by the quaternion (any length
                but 0), then translate.
query           "overlap" gives the outcome only and stops at the first proof; "depth" and "distance" give
                the signed distance, normal and witness points.
method          "auto", or "sat" / "gjk" to take that one where it applies.
Raises ValueError for a pose that is not finite or an unknown query or method, OverflowError for a
translation out of range.

SAT (Gottschalk, Lin, Manocha 1996; Gregorius 2013), GJK (Gilbert, Johnson, Keerthi 1988), EPA on signed
face distances (after van den Bergen 2001), exact signs (Shewchuk 1997) where float64 cannot tell.)");
  m.def("check_pairs", &check_many, nb::arg("shapes"), nb::arg("index_a").noconvert(),
        nb::arg("index_b").noconvert(), nb::arg("poses_a").noconvert(),
        nb::arg("poses_b").noconvert(), nb::kw_only(), nb::arg("query") = "depth", nb::arg("method") = "auto",
        nb::arg("threads") = 0,
        R"(check_pair over many pairs at once, on `threads` threads (0: one a core), without the GIL.

Pair i is shapes[index_a[i]] at poses_a[i] against shapes[index_b[i]] at poses_b[i]; indices uint32 (n,),
poses float64 (n, 7). The results are the same bits at any thread count. ValueError when lengths differ, an
index is out of range or a pose is not finite.)");
}
