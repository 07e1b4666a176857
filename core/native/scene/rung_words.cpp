#include "scene/rung_words.hpp"

#include <charconv>

#include "scene/words.hpp"

namespace satcheck {
namespace {

// Of a length, for people: six significant digits, with a point in every locale.
std::string at_least(const char* what, double length) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, length, std::chars_format::general, 6).ptr;
  return std::string(what) + " apart by at least " + std::string(digits, end);
}

RungWords of_boxes(double gap, std::int64_t cost) {
  if (gap > 0) return {"aabb", "separated", at_least("world boxes", gap), cost};
  return {"aabb", "meet", "world boxes meet", cost};
}

RungWords of_oriented_boxes(const Climb& climb, std::int64_t cost) {
  switch (climb.boxes) {
    case BoxOutcome::apart: return {"obb", "separated", name_of(climb.box_feature), cost};
    case BoxOutcome::sheared: return {"obb", "skipped", "a transform shears: the carried box is no box", cost};
    case BoxOutcome::unturned:
      return {"obb", "skipped", "neither body is turned: its oriented box is its world box", cost};
    default: return {"obb", "meet", "", cost};
  }
}

RungWords of_convex_bodies(const PairResult& found, std::int64_t cost) {
  return {"hull", name_of(found.outcome), std::string("both convex: ") + name_of(found.method) + " " + name_of(found.feature),
          cost};
}

RungWords of_hulls(const Climb& climb, std::int64_t cost) {
  const PairResult& found = *climb.hulls;
  if (found.outcome == Outcome::separated) {
    return {"hull", "separated", at_least("hulls", gap_of_hulls(climb)), cost};
  }
  const char* result = found.outcome == Outcome::undecided ? "undecided" : "meet";
  return {"hull", result, "not both convex: hulls prove only separation", cost};
}

RungWords of_triangles(const MeshRelation& found, std::int64_t cost) {
  std::string detail = std::to_string(found.box_tests) + " box tests, " + std::to_string(found.triangle_tests) + " triangle tests";
  if (found.triangle_a != kNoTriangle && found.triangle_b != kNoTriangle) {
    detail += ", triangles " + std::to_string(found.triangle_a) + " and " + std::to_string(found.triangle_b) + " meet";
  }
  if (!found.proven) detail += ", sampled in a degenerate contact";
  return {"triangles", name_of(found.relation), std::move(detail), cost};
}

}  // namespace

std::vector<RungWords> words_of(const Climb& climb) {
  const auto& cost = climb.nanoseconds;
  std::vector<RungWords> words;
  words.reserve(cost.size());
  const bool began_above = climb.boxes == BoxOutcome::not_asked && (climb.hulls || climb.triangles);
  if (!began_above) words.push_back(of_boxes(climb.box_gap, cost[kBoxes]));
  if (climb.boxes != BoxOutcome::not_asked) words.push_back(of_oriented_boxes(climb, cost[kOriented]));
  if (climb.hulls) {
    words.push_back(climb.both_convex ? of_convex_bodies(*climb.hulls, cost[kHulls]) : of_hulls(climb, cost[kHulls]));
  }
  if (climb.nesting) words.push_back({"containment", name_of(*climb.nesting), "one world box holds the other", cost[kNesting]});
  if (climb.triangles) words.push_back(of_triangles(*climb.triangles, cost[kTriangles]));
  return words;
}

}  // namespace satcheck
