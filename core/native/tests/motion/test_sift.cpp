// The sort of the pairs of many poses, against the narrow phase and against all vertices and edges.
#include "motion/sift.hpp"

#include "convex/convex_hull.hpp"
#include "convex/narrow_phase.hpp"
#include "mesh/transform.hpp"
#include "mesh_pair/mesh_distance.hpp"
#include "tests/boxes.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

std::array<double, 12> rows(const Pose& pose) {
  std::array<double, 12> m;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m[static_cast<std::size_t>(4 * i + j)] = pose.rotation.row[i][j];
    m[static_cast<std::size_t>(4 * i + 3)] = pose.translation[i];
  }
  return m;
}

std::array<double, 16> matrix_of(const Pose& pose) {
  std::array<double, 16> m{};
  const std::array<double, 12> top = rows(pose);
  std::copy(top.begin(), top.end(), m.begin());
  m[15] = 1;
  return m;
}

bool overlaps(Relation r) { return r != Relation::separated && r != Relation::touching; }

struct Body {
  Mesh mesh;
  bool convex;
  std::unique_ptr<PosedBody> posed;
};

Body body_of(const Mesh& mesh, bool convex) {
  const auto kept = std::make_shared<Mesh>(mesh);
  return {mesh, convex, std::make_unique<PosedBody>(std::make_shared<Geometry>(kept, true))};
}

std::vector<Body> some_bodies(std::mt19937& generator, Source& source) {
  std::vector<Body> bodies;
  for (int k = 0; k < 3; ++k) {
    const Polytope hull = convex_hull(source.sphere_points(8 + 12 * k));
    bodies.push_back(body_of({hull.vertices, hull.triangles}, true));
    Mesh boxes = mesh_of(random_boxes(generator, 2, 3));
    for (Vec3& v : boxes.vertices) v = v * 0.75;
    bodies.push_back(body_of(boxes, false));
  }
  return bodies;
}

// One pair in one pose is what the bodies in the world say.
void check_pair(const SiftedPair& pair, Sifted answer, double margin, const std::vector<Body>& bodies, const Pose& pose_a,
                const Pose& pose_b) {
  const Body &a = bodies[pair.a], &b = bodies[pair.b];
  const Surface in_a = make_surface(transform(a.mesh, matrix_of(pose_a)), true);
  const Surface in_b = make_surface(transform(b.mesh, matrix_of(pose_b)), true);
  if (answer == Sifted::apart) {
    CHECK(mesh_relation(in_a, in_b).relation == Relation::separated);
    CHECK(mesh_distance(in_a, in_b, INFINITY).distance > pair.gap_limit + margin);
  }
  if (answer != Sifted::deep) return;
  CHECK(overlaps(overlap_relation(in_a, in_b).relation));
  if (!a.convex || !b.convex) return;
  const Shape hull_a = make_hull(in_a.mesh.vertices), hull_b = make_hull(in_b.mesh.vertices);
  const double depth = -satcheck::check_pair(hull_a, {}, hull_b, {}, Query::depth).lower;
  // A ball of that radius lies in both, or no shorter translation ends the overlap.
  CHECK(depth >= std::min(2 * pair.depth, pair.crossing));
}

void poses_of_solids() {
  std::mt19937 generator(3);
  Source source(4);
  int of_kind[4] = {}, in_all = 0;
  for (int round = 0; round < rounds(40); ++round) {
    const std::vector<Body> bodies = some_bodies(generator, source);
    std::vector<PosedBody*> posed;
    for (const Body& body : bodies) posed.push_back(body.posed.get());
    std::vector<SiftedPair> pairs;
    for (std::uint32_t a = 0; a < bodies.size(); ++a)
      for (std::uint32_t b = a + 1; b < bodies.size(); ++b) {
        pairs.push_back({a, b, (a + b) % 2 == 0 ? 0 : 0.25, a % 2 == 0 ? 0 : 0.1, b % 3 == 0 ? INFINITY : 0.05});
      }
    // More poses than a thread takes at a time.
    const std::size_t count = 70;
    std::vector<Pose> poses;
    std::vector<double> matrices, margins;
    for (std::size_t k = 0; k < count * bodies.size(); ++k) {
      poses.push_back(source.pose(2.5));
      const auto m = rows(poses.back());
      matrices.insert(matrices.end(), m.begin(), m.end());
    }
    for (std::size_t k = 0; k < count * pairs.size(); ++k) margins.push_back(k % 7 == 0 ? NAN : k % 7 == 1 ? 0.125 : 0);
    const std::vector<Sifted> found = sift(posed, pairs, matrices.data(), margins.data(), count, 1);
    CHECK(found == sift(posed, pairs, matrices.data(), margins.data(), count, 4));
    for (std::size_t pose = 0; pose < count; ++pose)
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        const std::size_t at = pose * pairs.size() + k;
        const double margin = margins[at];
        ++of_kind[static_cast<int>(found[at])];
        ++in_all;
        CHECK(!std::isnan(margin) || found[at] == Sifted::open);
        CHECK(found[at] != Sifted::undecided);  // no hole
        const std::size_t first = pose * bodies.size();
        if (!std::isnan(margin)) check_pair(pairs[k], found[at], margin, bodies, poses[first + pairs[k].a], poses[first + pairs[k].b]);
      }
  }
  std::printf("sorted poses: %d open, %d apart, %d deep of %d\n", of_kind[0], of_kind[1], of_kind[2], in_all);
  CHECK(of_kind[1] > 0 && of_kind[2] > 0 && of_kind[0] < in_all / 2);
}

// A sheet with a hole around a small box: only its fill could meet the box.
void a_hole() {
  Mesh open = box({0, 0, 0}, {4, 4, 4});
  open.triangles.erase(open.triangles.begin() + 2, open.triangles.begin() + 4);
  const auto kept = std::make_shared<Mesh>(open);
  PosedBody cup(std::make_shared<Geometry>(kept, false));
  const Body ball = body_of(box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), true);
  std::vector<PosedBody*> bodies{&cup, ball.posed.get()};
  std::vector<double> matrices;
  const Vec3 places[] = {{2, 2, 9}, {2, 2, 2}, {0, 2, 2}};
  for (const Vec3 place : places) {
    for (const Pose& pose : {Pose{}, Pose{{}, place}}) {
      const auto m = rows(pose);
      matrices.insert(matrices.end(), m.begin(), m.end());
    }
  }
  const std::vector<Sifted> found = sift(bodies, {{0, 1, 0, 0, 0}}, matrices.data(), nullptr, 3, 1);
  CHECK(found[0] == Sifted::apart);
  CHECK(found[1] != Sifted::apart && found[2] != Sifted::apart);
  CHECK(found[2] != Sifted::undecided);  // the surfaces cross, whatever the fill
}

}  // namespace

UNIT(sift) {
  poses_of_solids();
  a_hole();
}
