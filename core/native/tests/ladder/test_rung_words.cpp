// Each rung that ran has its words, in the order of the ladder, and no other.
#include "ladder/rung_words.hpp"

#include "tests/check.hpp"

using namespace satcheck;

namespace {

std::string told(const Climb& climb) {
  std::string all;
  for (const RungWords& words : words_of(climb)) {
    all += std::string(words.rung) + " " + words.result + " (" + words.detail + ") " + std::to_string(words.nanoseconds) + "\n";
  }
  return all;
}

Climb met() {
  Climb climb;
  climb.boxes = BoxOutcome::meet;
  climb.nanoseconds = {1, 2, 3, 4, 5, 6};
  return climb;
}

PairResult hulls(Outcome outcome) {
  PairResult found;
  found.outcome = outcome;
  found.method = Method::gjk;
  found.feature = Feature::face_a;
  return found;
}

void boxes() {
  Climb climb;
  climb.box_gap = 0.1234567;
  CHECK(told(climb) == "aabb separated (world boxes apart by at least 0.123457) 0\n");
  climb = met();
  climb.boxes = BoxOutcome::apart;
  climb.box_feature = Feature::edge_edge;
  CHECK(told(climb) == "aabb meet (world boxes meet) 1\nobb separated (edge-edge) 2\n");
  climb.boxes = BoxOutcome::unturned;
  CHECK(words_of(climb)[1].result == std::string("skipped"));
}

void hulls_of_both() {
  Climb climb = met();
  climb.hulls = hulls(Outcome::separated);
  climb.hulls->has_distance = true;
  climb.hulls->lower = 2.5;
  CHECK(words_of(climb)[2].detail == "hulls apart by at least 2.5");
  climb.box_gap = 3;
  CHECK(words_of(climb)[2].detail == "hulls apart by at least 3" && gap_of_hulls(climb) == 3);
  climb.hulls = hulls(Outcome::penetrating);
  CHECK(words_of(climb)[2].result == std::string("meet") && words_of(climb).size() == 3);
  climb.both_convex = true;
  climb.nesting = Relation::contains;
  CHECK(words_of(climb)[2].detail == "both convex: gjk face-a");
  CHECK(words_of(climb)[3].rung == std::string("containment") && words_of(climb)[3].nanoseconds == 4);
}

void surfaces() {
  Climb climb;  // from the hulls on
  climb.hulls = hulls(Outcome::undecided);
  climb.triangles.emplace();
  climb.triangles->relation = Relation::penetrating;
  climb.triangles->box_tests = 7;
  climb.triangles->triangle_tests = 2;
  CHECK(told(climb) ==
        "hull undecided (not both convex: hulls prove only separation) 0\n"
        "triangles penetrating (7 box tests, 2 triangle tests) 0\n");
  climb.triangles->triangle_a = 3;
  climb.triangles->triangle_b = 4;
  climb.triangles->proven = false;
  CHECK(words_of(climb)[1].detail ==
        "7 box tests, 2 triangle tests, triangles 3 and 4 meet, sampled in a degenerate contact");
}

}  // namespace

UNIT(rung_words) {
  boxes();
  hulls_of_both();
  surfaces();
}
