// Prints what the core computes of two mesh files, each float64 as hexadecimal digits: on every machine the same bytes.
#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <variant>

#include "convex/narrow_phase.hpp"
#include "depth/depth_search.hpp"
#include "mesh/convexity.hpp"
#include "mesh/inspection.hpp"
#include "mesh/transform.hpp"
#include "mesh_pair/mesh_distance.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "readers.hpp"

using namespace satcheck;

namespace {

constexpr std::uint64_t kDepthWork = 20'000'000;  // steps, so that an emulator ends within seconds
constexpr int kPlaces = 3;

scene::ReadOutcome read_mesh(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (path.ends_with(".obj")) return scene::read_obj(bytes);
  if (path.ends_with(".stl")) return scene::read_stl(bytes);
  if (path.ends_with(".ply")) return scene::read_ply(bytes);
  return scene::read_off(bytes);
}

Mesh as_mesh(const scene::MeshData& data) {
  Mesh mesh;
  for (std::size_t i = 0; i < data.vertices.size(); i += 3) {
    mesh.vertices.push_back({data.vertices[i], data.vertices[i + 1], data.vertices[i + 2]});
  }
  for (std::size_t i = 0; i < data.triangles.size(); i += 3) {
    mesh.triangles.push_back({data.triangles[i], data.triangles[i + 1], data.triangles[i + 2]});
  }
  return mesh;
}

void print(const char* name, double value) { std::printf("  %s %a\n", name, value); }
void print(const char* name, Vec3 v) { std::printf("  %s %a %a %a\n", name, v.x, v.y, v.z); }
void print(const char* name, std::uint64_t value) { std::printf("  %s %llu\n", name, static_cast<unsigned long long>(value)); }

Aabb bounds(const Mesh& mesh) {
  Aabb box;
  for (const Vec3 p : mesh.vertices) box.include(p);
  return box;
}

// The shortest translation along an axis after which the boxes of two meshes have no common interior.
double way_out_of_boxes(const Mesh& a, const Mesh& b) {
  const Aabb p = bounds(a), q = bounds(b);
  return std::min({p.max.x - q.min.x, q.max.x - p.min.x, p.max.y - q.min.y, q.max.y - p.min.y, p.max.z - q.min.z,
                   q.max.z - p.min.z});
}

void dump_hulls(const Mesh& a, const Mesh& b) {
  const PairResult hulls = check_pair(make_hull(a.vertices), {}, make_hull(b.vertices), {}, Query::depth);
  std::printf(" hulls: outcome %d method %d feature %d\n", static_cast<int>(hulls.outcome), static_cast<int>(hulls.method),
              static_cast<int>(hulls.feature));
  print("distance", hulls.distance);
  print("lower", hulls.lower);
  print("upper", hulls.upper);
  print("normal", hulls.normal);
  print("witness_a", hulls.witness_a);
  print("witness_b", hulls.witness_b);
  print("gjk_iterations", static_cast<std::uint64_t>(hulls.gjk_iterations));
  print("epa_iterations", static_cast<std::uint64_t>(hulls.epa_iterations));
}

void dump_depth(const Surface& a, const Surface& b) {
  const DepthInterval depth = search_depth(a, b, {.upper = way_out_of_boxes(a.mesh, b.mesh), .work = kDepthWork});
  std::printf(" depth: stop %d\n", static_cast<int>(depth.stop));
  print("lower", depth.lower);
  print("upper", depth.upper);
  print("bound", depth.bound);
  if (depth.has_way_out) print("way_out", depth.way_out);
  print("work", depth.work);
  print("sets", std::uint64_t{depth.sets});
}

void dump_surfaces(const Inspection& a, const Inspection& b) {
  const Surface surface_a = make_surface(a.mesh, a.repaired.solid), surface_b = make_surface(b.mesh, b.repaired.solid);
  const MeshRelation found = mesh_relation(surface_a, surface_b);
  std::printf(" relation %d proven %d\n", static_cast<int>(found.relation), found.proven);
  print("triangle_a", std::uint64_t{found.triangle_a});
  print("triangle_b", std::uint64_t{found.triangle_b});
  if (found.point) print("point", *found.point);
  const MeshDistance gap = mesh_distance(surface_a, surface_b, INFINITY);
  print("distance", gap.distance);
  print("witness_a", gap.witness_a);
  print("witness_b", gap.witness_b);
  const bool overlaps = found.relation != Relation::separated && found.relation != Relation::touching;
  if (overlaps && a.repaired.solid && b.repaired.solid) dump_depth(surface_a, surface_b);
}

Inspection dump_body(const char* name, const Mesh& mesh) {
  Inspection body = inspect(mesh, true);
  std::printf(" %s: solid %d turned %d holes %zu\n", name, body.repaired.solid, body.turned, body.holes.size());
  print("triangles", std::uint64_t{body.mesh.triangles.size()});
  print("volume", body.repaired.volume);
  print("convexity_defect", convexity_defect(body.mesh, INFINITY));
  return body;
}

// In the file, and turned about an axis through its origin: by 3/5 and 4/5, which no coordinate holds exactly.
Mesh placed(const Mesh& mesh, int place) {
  if (place == 0) return mesh;
  if (place == 1) return transform(mesh, {0.6, -0.8, 0, 0.1, 0.8, 0.6, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  return transform(mesh, {1, 0, 0, 0, 0, 0.6, -0.8, 0, 0, 0.8, 0.6, 0.1, 0, 0, 0, 1});
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return std::fprintf(stderr, "usage: pair_dump A B\n"), 2;
  const scene::ReadOutcome a = read_mesh(arguments[1]), b = read_mesh(arguments[2]);
  for (const scene::ReadOutcome* outcome : {&a, &b}) {
    if (const auto* error = std::get_if<scene::ReadError>(outcome)) {
      return std::fprintf(stderr, "%s\n", error->message.c_str()), 2;
    }
  }
  const Inspection body_a = dump_body("a", as_mesh(std::get<scene::MeshData>(a)));
  for (int place = 0; place < kPlaces; ++place) {
    std::printf("place of b: %d\n", place);
    const Inspection body_b = dump_body("b", placed(as_mesh(std::get<scene::MeshData>(b)), place));
    dump_hulls(body_a.mesh, body_b.mesh);
    dump_surfaces(body_a, body_b);
  }
  return 0;
}
