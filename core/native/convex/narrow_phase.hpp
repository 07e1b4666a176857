// One convex pair in, one result out: the dispatch between SAT, portals, GJK, EPA and the exact stage.
#pragma once

#include <string>

#include "convex/sat.hpp"

namespace satcheck {

enum class Outcome : std::uint8_t { separated, touching, penetrating, undecided };
enum class Reason : std::uint8_t { none, bounds_not_closed };
enum class Method : std::uint8_t { none, sat, gjk, epa, exact, portal };
enum class Query : std::uint8_t { overlap, depth, distance };
// automatic: SAT for two boxes, else portals for overlap and GJK + EPA for figures. Two boxes have 15 axes. Other
// polytopes have an axis for each pair of edges whose arcs cross, and bench/crossover.py finds no number of vertices at
// which SAT is faster: with 4 vertices each, the fewest of a solid, it takes 2.6 times as long for overlap and 2.4
// times for depth; with 12 vertices 29 and 14 times. sat: for two solid polytopes. gjk: portals, GJK and EPA for all.
enum class MethodChoice : std::uint8_t { automatic, sat, gjk };

// "auto", "sat" or "gjk"; std::invalid_argument for another name.
MethodChoice method_from(const std::string& name);

struct PairResult {
  Outcome outcome = Outcome::undecided;
  Reason reason = Reason::none;
  Method method = Method::none;  // the stage that decided
  Feature feature = Feature::none;
  std::uint32_t index_a = kNoIndex, index_b = kNoIndex;
  // Signed distance, > 0 a gap, < 0 a penetration, with bounds. NaN when the query does not need it.
  bool has_distance = false;
  double distance = NAN, lower = NAN, upper = NAN;
  Vec3 normal{NAN, NAN, NAN};  // unit, from A to B, world
  Vec3 witness_a{NAN, NAN, NAN};  // world; distance * normal = witness_b - witness_a
  Vec3 witness_b{NAN, NAN, NAN};
  int portal_rounds = 0, gjk_iterations = 0, epa_iterations = 0, axes_tested = 0;
};

// Poses are rigid. Query overlap gives the outcome only and stops at the first proof. A pair that is proven to be
// deeper than `enough` may have no figures.
PairResult check_pair(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Query query,
                      MethodChoice method = MethodChoice::automatic, double enough = INFINITY);

}  // namespace satcheck
