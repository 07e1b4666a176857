#include "ladder/rung_words.hpp"

#include <charconv>

#include "ladder/words.hpp"

namespace satcheck {
namespace {

// A length as text: six significant digits, with a decimal point in every locale.
std::string at_least(const char* what, double length) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, length, std::chars_format::general, 6).ptr;
  return std::string(what) + " apart by at least " + std::string(digits, end);
}

RungWords words_of_boxes(double gap, std::int64_t cost) {
  if (gap > 0) return {"aabb", "separated", at_least("world boxes", gap), cost};
  return {"aabb", "meet", "world boxes meet", cost};
}

RungWords words_of_oriented_boxes(const Climb& climb, std::int64_t cost) {
  switch (climb.boxes) {
    case BoxOutcome::apart: return {"obb", "separated", name_of(climb.box_feature), cost};
    case BoxOutcome::sheared: return {"obb", "skipped", "a transform shears: the carried box is no box", cost};
    case BoxOutcome::unturned:
      return {"obb", "skipped", "neither body is turned: its oriented box is its world box", cost};
    default: return {"obb", "meet", "", cost};
  }
}

RungWords words_of_convex_bodies(const PairResult& result, std::int64_t cost) {
  std::string detail = std::string("both convex: ") + name_of(result.method) + " " + name_of(result.feature);
  return {"hull", name_of(result.outcome), std::move(detail), cost};
}

RungWords words_of_hulls(const Climb& climb, std::int64_t cost) {
  const PairResult& result = *climb.hulls;
  if (result.outcome == Outcome::separated) {
    return {"hull", "separated", at_least("hulls", gap_of_hulls(climb)), cost};
  }
  const char* outcome = result.outcome == Outcome::undecided ? "undecided" : "meet";
  return {"hull", outcome, "not both convex: hulls prove only separation", cost};
}

RungWords words_of_triangles(const MeshRelation& r, std::int64_t cost) {
  std::string detail = std::to_string(r.box_tests) + " box tests, ";
  detail += std::to_string(r.triangle_tests) + " triangle tests";
  if (r.edge_tests) detail = std::to_string(*r.edge_tests) + " tests of edges of the outlines";
  if (r.triangle_a != kNoTriangle && r.triangle_b != kNoTriangle) {
    detail += ", triangles " + std::to_string(r.triangle_a) + " and " + std::to_string(r.triangle_b) + " meet";
  }
  if (!r.decided) return {"triangles", "undecided", "too many steps", cost};
  if (!r.proven) detail += ", sampled in a degenerate contact";
  return {"triangles", name_of(r.relation), std::move(detail), cost};
}

}  // namespace

std::vector<RungWords> words_of(const Climb& climb) {
  const auto& cost = climb.nanoseconds;
  std::vector<RungWords> words;
  words.reserve(cost.size());
  const bool began_above = climb.boxes == BoxOutcome::not_asked && (climb.hulls || climb.triangles);
  if (!began_above) words.push_back(words_of_boxes(climb.box_gap, cost[kBoxes]));
  if (climb.boxes != BoxOutcome::not_asked) words.push_back(words_of_oriented_boxes(climb, cost[kOriented]));
  if (climb.hulls) {
    words.push_back(climb.both_convex ? words_of_convex_bodies(*climb.hulls, cost[kHulls])
                                      : words_of_hulls(climb, cost[kHulls]));
  }
  if (climb.nesting) words.push_back({"containment", name_of(*climb.nesting), "one world box holds the other", cost[kNesting]});
  if (climb.triangles) words.push_back(words_of_triangles(*climb.triangles, cost[kTriangles]));
  return words;
}

}  // namespace satcheck
