// One convex pair in, one result out: the dispatch between SAT, portals, GJK, EPA and the exact stage.
#pragma once

#include "convex/sat.hpp"

namespace satcheck {

enum class Outcome : std::uint8_t { separated, touching, penetrating, undecided };
enum class Reason : std::uint8_t { none, bounds_not_closed };
enum class Method : std::uint8_t { none, sat, gjk, epa, exact, portal };
enum class Query : std::uint8_t { overlap, depth, distance };
enum class MethodChoice : std::uint8_t { automatic, sat, gjk };

struct PairResult {
  Outcome outcome = Outcome::undecided;
  Reason reason = Reason::none;
  Method method = Method::none;  // the stage that decided
  Feature feature = Feature::none;
  std::uint32_t index_a = Shape::kNoIndex, index_b = Shape::kNoIndex;
  // Signed distance, > 0 a gap, < 0 a penetration, with bounds. NaN when the query does not need it.
  bool has_distance = false;
  double distance = NAN, lower = NAN, upper = NAN;
  Vec3 normal{NAN, NAN, NAN};  // unit, from A to B, world
  Vec3 witness_a{NAN, NAN, NAN};  // world; distance * normal = witness_b - witness_a
  Vec3 witness_b{NAN, NAN, NAN};
  int portal_rounds = 0, gjk_iterations = 0, epa_iterations = 0, axes_tested = 0;
};

// Up to this many vertices on the larger of two polytopes, SAT over faces and arcs would be faster than
// portals, for overlap, and GJK + EPA. Measured by bench/crossover.py: already at 4 vertices a side (the
// smallest solid) SAT takes 3 times as long for overlap and 2 times for depth, at 12 vertices 26 and 12 times. So 3: only
// boxes, whose 15 axes need no arcs, take SAT; `MethodChoice::sat` asks for it by name.
inline constexpr std::size_t kSatVertexLimit = 3;

// Poses are rigid. Query overlap gives the outcome only and stops at the first proof.
PairResult check_pair(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Query query,
                      MethodChoice method = MethodChoice::automatic);

}  // namespace satcheck
