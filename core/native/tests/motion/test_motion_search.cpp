// What is promised about moving surfaces and shapes, against sampled poses.
#include "motion/motion_search.hpp"

#include <random>

#include "convex/narrow_phase.hpp"
#include "mesh_pair/mesh_distance.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

std::mt19937 generator(7);

double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator); }
Vec3 random_vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }

// The rotation about an axis by its length in radians, after Rodrigues.
Mat3 rotation_by(Vec3 turn) {
  const double angle = norm(turn);
  if (angle == 0) return {};
  const Vec3 k = turn * (1 / angle);
  const double c = std::cos(angle), s = std::sin(angle), v = 1 - c;
  return {{{c + v * k.x * k.x, v * k.x * k.y - s * k.z, v * k.x * k.z + s * k.y},
           {v * k.x * k.y + s * k.z, c + v * k.y * k.y, v * k.y * k.z - s * k.x},
           {v * k.x * k.z - s * k.y, v * k.y * k.z + s * k.x, c + v * k.z * k.z}}};
}

Moving random_moving(double spread) {
  return {{rotation_by(random_vector(3)), random_vector(spread)}, random_vector(2), random_vector(3), random_vector(4)};
}

// Two bodies: both on the move, or one that stands while the other only turns.
struct Two {
  Moving a, b;
};

Two random_two(double spread, int i) {
  Two two{random_moving(spread), random_moving(spread)};
  if (i % 3 == 0) return two;
  Moving &still = i % 3 == 1 ? two.a : two.b, &turning = i % 3 == 1 ? two.b : two.a;
  still.velocity = still.spin = turning.velocity = {};
  return two;
}

// The vertices of a body as it is at a time from now.
std::vector<Vec3> moved(const std::vector<Vec3>& points, const Moving& moving, double time) {
  const Mat3 turn = rotation_by(moving.spin * time);
  std::vector<Vec3> result;
  for (const Vec3& p : points) {
    result.push_back(turn * (moving.pose * p - moving.centre) + moving.centre + moving.velocity * time);
  }
  return result;
}

Surface at(const Surface& surface, const Moving& moving, double time) {
  return make_surface({moved(surface.mesh.vertices, moving, time), surface.mesh.triangles}, false);
}

double distance(const Surface& a, const Moving& ma, const Surface& b, const Moving& mb, double time) {
  return mesh_distance(at(a, ma, time), at(b, mb, time), INFINITY).distance;
}

constexpr double kRounding = 1e-12;  // of sampled distances: a thousand roundoffs of coordinates up to 10
constexpr std::uint64_t kNoLimit = 1u << 30;

template <class A, class B>
MotionAnswer ask(const A& a, const Moving& moving_a, const B& b, const Moving& moving_b, const MotionQuestion& question,
                 const MotionRounding& rounding, std::uint64_t work = kNoLimit) {
  return ask_motion(&a, moving_a, &b, moving_b, question, rounding, work);
}

void promises_hold() {
  const Surface a = make_surface(uv_sphere(3), true), b = make_surface(box({-1, -0.5, -0.2}, {1, 0.5, 0.2}), true);
  int useful = 0, moments = 0;
  for (int i = 0; i < testing::rounds(200); ++i) {
    const Two two = random_two(4, i);
    const Moving &ma = two.a, &mb = two.b;
    const double now = distance(a, ma, b, mb, 0);
    if (now == 0) continue;
    const double level = uniform(0, 0.5) * now;
    const MotionAnswer time = ask(a, ma, b, mb, MotionQuestion::time(level, 1), {}, kNoLimit);
    CHECK(time.value >= 0 && time.value <= 1);
    for (int k = 0; k <= 20; ++k) CHECK(distance(a, ma, b, mb, time.value * k / 20) >= level - kRounding);
    // No worse than what the speeds alone say, without any direction.
    const auto speed = [&](const Moving& m, const Surface& s) {
      double reach = 0;
      for (const Vec3& p : s.mesh.vertices) reach = std::fmax(reach, norm(m.pose * p - m.centre));
      return norm(m.velocity) + norm(m.spin) * reach;
    };
    const double undirected = std::fmin((now - level) / (speed(ma, a) + speed(mb, b)), 1);
    CHECK(time.value >= undirected * (1 - 1e-9));
    ++moments;
    useful += time.value > 1.5 * undirected;

    const double window = uniform(0, 0.1);
    const MotionAnswer gap = ask(a, ma, b, mb, MotionQuestion::gap(window), {}, kNoLimit);
    CHECK(gap.upper >= now - kRounding);
    for (int k = -10; k <= 10; ++k) CHECK(distance(a, ma, b, mb, window * k / 10) >= gap.value - kRounding);
    const MotionAnswer instant = ask(a, ma, b, mb, MotionQuestion::gap(0), {}, kNoLimit);
    CHECK(std::fabs(instant.value - now) <= kRounding);
    CHECK(std::fabs(instant.upper - now) <= kRounding);
  }
  CHECK(moments > testing::rounds(100));
  CHECK(useful > moments / 4);
}

// A body on an arm with two joints, each of which turns: its velocities at first, and bounds of what they become.
void two_joints_are_bounded() {
  const Surface a = make_surface(box({-1, -0.5, -0.2}, {1, 0.5, 0.2}), true), b = make_surface(uv_sphere(3), true);
  int stopped = 0;
  for (int i = 0; i < testing::rounds(100); ++i) {
    // The elbow is at `fore` from the shoulder, which is the origin; the body's own origin is at `tip` from the elbow.
    const Vec3 shoulder = random_vector(2), elbow = random_vector(2), fore = random_vector(2), tip = random_vector(2);
    const auto pose = [&](double time) {
      const Pose upper{rotation_by(shoulder * time), {}}, lower{rotation_by(elbow * time), {}};
      return [=](Vec3 v) { return upper * (fore + lower * (tip + v)); };
    };
    const double reach = norm(tip) + std::sqrt(1.29), own = norm(elbow) * reach, whole = norm(shoulder) * (norm(fore) + reach);
    const Moving ma{{{}, fore + tip}, fore, cross(shoulder, fore), shoulder + elbow, own + whole,
                    norm(elbow) * own + norm(shoulder) * (whole + 2 * own)};
    const Moving mb{{{}, random_vector(5)}, {}, {}, {}};
    const auto at_time = [&](double time) {
      const auto placed = pose(time);
      std::vector<Vec3> points;
      for (const Vec3& v : a.mesh.vertices) points.push_back(placed(v));
      return mesh_distance(make_surface({points, a.mesh.triangles}, false), at(b, mb, 0), INFINITY).distance;
    };
    if (at_time(0) == 0) continue;
    const double time = ask(a, ma, b, mb, MotionQuestion::time(0, 1), {}).value, window = uniform(0, 0.2);
    const double gap = ask(a, ma, b, mb, MotionQuestion::gap(window), {}).value;
    stopped += time < 1;
    for (int k = 0; k < 20; ++k) CHECK(at_time(time * k / 20) > 0);
    for (int k = -10; k <= 10; ++k) CHECK(at_time(window * k / 10) >= gap - kRounding);
  }
  CHECK(stopped > testing::rounds(20));
}

void cut_short_is_less() {
  const Surface a = make_surface(uv_sphere(12), true);
  const Moving here{}, there{{{}, {5, 0.1, 0.2}}, {}, {-1, 0, 0}, {}};
  const double full = ask(a, here, a, there, MotionQuestion::time(0, 9), {}, kNoLimit).value;
  CHECK(full > 2.9 && full < 3.2);
  for (const std::uint64_t work : {0u, 10u, 100u, 1000u}) {
    const MotionAnswer cut = ask(a, here, a, there, MotionQuestion::time(0, 9), {}, work);
    CHECK(cut.value <= full);
    CHECK(cut.visits <= work + 40);  // the pair of nodes that was being looked at
  }
}

void sliding_is_not_slowed_down() {
  const Surface table = make_surface(box({-9, -9, -1}, {9, 9, 0}), true);
  const Surface brick = make_surface(box({0, 0, 0.001}, {1, 1, 1}), true);
  const Moving slides{{}, {}, {3, 2, 0}, {}}, spins{{}, {}, {}, {0, 0, 5}}, sinks{{}, {}, {3, 2, -0.01}, {}};
  const auto time = [&](const Moving& m) { return ask(brick, m, table, {}, MotionQuestion::time(0, 1), {}, kNoLimit).value; };
  CHECK(time(slides) == 1);
  CHECK(time(spins) == 1);
  CHECK(std::fabs(time(sinks) - 0.1) < 1e-12);
}

// Long edges that cross at a gap of 1e-9, while one slides along the other. The nearest points are rounded by 1e-15, so
// that the axis between them is off by more than the gap at the ends of the edges.
void a_small_gap_between_edges_is_kept() {
  for (int i = 0; i < testing::rounds(300); ++i) {
    const Vec3 e = random_vector(9), f = random_vector(9), at = random_vector(9), n = unit_along(cross(e, f));
    const Vec3 above = at + n * 1e-9;
    const Surface a = make_surface({{at - e, at + e, at - n * 3 + random_vector(2)}, {{0, 1, 2}}}, false);
    const Surface b = make_surface({{above - f, above + f, above + n * 3 + random_vector(2)}, {{0, 1, 2}}}, false);
    const Moving slides{{}, {}, f * 0.1, {}};
    CHECK(ask(a, slides, b, {}, MotionQuestion::time(0, 1), {}, kNoLimit).value == 1);
  }
}

// A door of which the far side sinks below the sill that it lies on: seen from the world its face gets in the
// way of itself, seen from the door the sill goes away.
void an_opening_door_is_not_held() {
  const Surface sill = make_surface(box({1, -1, 0}, {2, -0.001, 1}), true);
  const Surface door = make_surface(box({-3, 0, 0}, {3, 1, 1}), true);
  const Moving opens{{}, {}, {}, {0, 0, 1}}, shuts{{}, {}, {}, {0, 0, -1}};
  const auto time = [&](const Moving& a, const Surface& s, const Moving& b, const Surface& t) {
    return ask(s, a, t, b, MotionQuestion::time(0, 1), {}, kNoLimit).value;
  };
  CHECK(time(opens, door, {}, sill) > 0.1);
  CHECK(time({}, sill, opens, door) > 0.1);
  CHECK(time(shuts, door, {}, sill) < 0.001);
}

// The heights of a turning point, sampled: below the height until then, and at it then.
void a_turning_point_stays_below() {
  int never = 0, later = 0;
  for (int i = 0; i < testing::rounds(2000); ++i) {
    const Moving turning{{}, random_vector(2), {}, random_vector(4)};
    const Vec3 p = i % 5 ? random_vector(2) : turning.centre + turning.spin, n = unit_along(random_vector(1));
    const double height = dot(n, p) + uniform(0, 2), limit = uniform(0, 5);
    const auto height_at = [&](double time) { return dot(n, moved({p}, turning, time)[0]); };
    const double time = time_below(p, turning, n, height, limit);
    CHECK(time >= 0 && time <= limit);
    for (int k = 0; k <= 50; ++k) CHECK(height_at(time * k / 50) <= height + kRounding);
    if (time < limit) CHECK(std::fabs(height_at(time) - height) <= kRounding);
    never += time == limit;
    later += time > 0 && time < limit;
  }
  CHECK(never > testing::rounds(500) && later > testing::rounds(300));
  // Where sine or cosine vanish: points of a lattice about a coordinate axis, seen along another.
  for (int i = 0; i < 27 * 4; ++i) {
    const Vec3 p{i % 3 - 1.0, i / 3 % 3 - 1.0, i / 9 % 3 - 1.0}, along = i / 27 % 2 ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    const Moving turning{{}, {}, {}, {0, 0, i / 54 % 2 ? 3.0 : -3.0}};
    for (const Vec3 n : {along, -along}) {
      for (const double height : {0.0, 0.5, 1.0}) {
        if (!(dot(n, p) < height)) continue;
        const double time = time_below(p, turning, n, height, 1);
        for (int k = 0; k <= 50; ++k) CHECK(dot(n, moved({p}, turning, time * k / 50)[0]) <= height + kRounding);
      }
    }
  }
  // At the height already; and on the axis, where nothing moves.
  const Moving turning{{}, {}, {}, {0, 0, 1}};
  CHECK(time_below({1, 0, 0}, turning, {0, 1, 0}, 0, 1) == 0);
  CHECK(time_below({0, 0, 3}, turning, {0, 1, 0}, 1e-9, 1) == 1);
  // After a million turns the rounding of the spin moves a point by more than 1e-10, but by less than 1e-6.
  const Moving fast{{}, {}, {}, {0, 0, 6e6}};
  CHECK(time_below({1, 0, 0}, fast, {1, 0, 0}, 1 + 1e-10, 1) == 0);
  CHECK(time_below({1, 0, 0}, fast, {1, 0, 0}, 1 + 1e-6, 1) == 1);
}

// A door that is flush with its frame along the axis touches it all the way and goes no deeper.
void a_flush_hinge_does_not_hold_a_door() {
  const Mesh frame = box({-1, -1, 0}, {0, 0, 9}), door = box({0, -1, 0}, {9, 0, 9});
  const Moving opens{{}, {}, {}, {0, 0, 1.5}};
  for (const double band : {1e-6, 1e-9}) {
    const MotionQuestion question = MotionQuestion::time(-band, 1);
    CHECK(ask(make_hull(door.vertices), opens, make_hull(frame.vertices), {}, question, {}).value == 1);
    const Surface moved_off = make_surface(box({band, -1, 0}, {9, 0, 9}), true), wall = make_surface(frame, true);
    CHECK(ask(moved_off, opens, wall, {}, MotionQuestion::time(0, 1), {}, kNoLimit).value == 1);
    CHECK(ask(wall, {}, moved_off, opens, MotionQuestion::time(0, 1), {}, kNoLimit).value == 1);
  }
}

void shapes_keep_their_promises() {
  const Shape ball = make_sphere(0.5), cone = make_cone(0.7, 1.0);
  const Shape hull = make_hull(std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}});
  int overlapping = 0;
  for (int i = 0; i < testing::rounds(300); ++i) {
    const Shape& a = i % 2 ? hull : ball;
    const Shape& b = i % 3 ? hull : cone;
    const Two two = random_two(1.5, i / 6);
    const Moving &ma = two.a, &mb = two.b;
    const auto signed_distance = [&](double time) {
      const auto pose = [&](const Moving& m) {
        const Mat3 turn = rotation_by(m.spin * time);
        Pose p;
        for (int r = 0; r < 3; ++r) p.rotation.row[r] = transpose_times(m.pose.rotation, turn.row[r]);
        p.translation = turn * (m.pose.translation - m.centre) + m.centre + m.velocity * time;
        return p;
      };
      return check_pair(a, pose(ma), b, pose(mb), Query::depth).upper;
    };
    const double window = uniform(0, 0.2);
    const MotionAnswer gap = ask(a, ma, b, mb, MotionQuestion::gap(window), {});
    CHECK(std::isfinite(gap.value) && gap.value <= gap.upper);
    overlapping += gap.upper < 0;
    for (int k = -10; k <= 10; ++k) CHECK(signed_distance(window * k / 10) >= gap.value - kRounding);
    const double level = gap.value - uniform(0, 1);
    const MotionAnswer time = ask(a, ma, b, mb, MotionQuestion::time(level, 1), {});
    CHECK(time.value >= window * (1 - 1e-9));
    for (int k = 0; k <= 20; ++k) CHECK(signed_distance(time.value * k / 20) >= level - kRounding);
  }
  CHECK(overlapping > testing::rounds(20));
}

// A ball, and the hull of a box, against a surface: as the distance of the surfaces.
void a_shape_and_a_surface_keep_theirs() {
  const Mesh ball_mesh = box({-0.3, -0.4, -0.5}, {0.3, 0.4, 0.5});
  const Shape shape = make_hull(ball_mesh.vertices);
  const Surface a = make_surface(ball_mesh, true), b = make_surface(uv_sphere(4), true);
  int moments = 0;
  for (int i = 0; i < testing::rounds(200); ++i) {
    const Two two = random_two(3, i);
    const double now = distance(a, two.a, b, two.b, 0);
    if (now == 0 || check_pair(shape, two.a.pose, make_hull(b.mesh.vertices), two.b.pose, Query::overlap).outcome !=
                        Outcome::separated) {
      continue;
    }
    ++moments;
    const double level = uniform(0, 0.5) * now, window = uniform(0, 0.1);
    const MotionAnswer time = ask(shape, two.a, b, two.b, MotionQuestion::time(level, 1), {}, kNoLimit);
    const MotionAnswer gap = ask(shape, two.a, b, two.b, MotionQuestion::gap(window), {}, kNoLimit);
    CHECK(time.value > 0);
    const MotionAnswer mirrored = ask(b, two.b, shape, two.a, MotionQuestion::time(level, 1), {}, kNoLimit);
    CHECK(mirrored.value == time.value && mirrored.triangle_a == time.triangle_b && mirrored.triangle_b == kNoIndex);
    for (int k = 0; k <= 20; ++k) CHECK(distance(a, two.a, b, two.b, time.value * k / 20) >= level - kRounding);
    for (int k = -10; k <= 10; ++k) CHECK(distance(a, two.a, b, two.b, window * k / 10) >= gap.value - kRounding);
    const MotionAnswer instant = ask(shape, two.a, b, two.b, MotionQuestion::gap(0), {}, kNoLimit);
    CHECK(std::fabs(instant.value - now) <= kRounding);
    CHECK(std::fabs(instant.upper - now) <= kRounding);
  }
  CHECK(moments > testing::rounds(50));
}

}  // namespace

UNIT(motion_search) {
  promises_hold();
  cut_short_is_less();
  sliding_is_not_slowed_down();
  a_small_gap_between_edges_is_kept();
  an_opening_door_is_not_held();
  a_turning_point_stays_below();
  a_flush_hinge_does_not_hold_a_door();
  shapes_keep_their_promises();
  a_shape_and_a_surface_keep_theirs();
  two_joints_are_bounded();
}
