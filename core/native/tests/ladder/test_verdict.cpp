// The verdict from what the rungs found, put together by hand: what settles a pair, what is proven, what stays open.

#include <cmath>

#include "ladder/climb.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

constexpr ClimbRequest kRequest{nullptr, nullptr, 0.5, 0.25, 0.125, 0.125, false};

Verdict verdict(const Climb& climb) { return verdict_of(kRequest, climb); }

void boxes_settle_what_is_beyond_the_question() {
  Climb climb;
  climb.box_gap = 1;
  const Verdict far = verdict(climb);
  CHECK(far.relation == Relation::separated && far.settled && far.proven && far.gap == 1);
  climb.box_gap = 0.5;
  const Verdict near = verdict(climb);
  CHECK(near.relation == Relation::separated && !near.settled && near.proven && near.gap == 0.5);
  climb.box_gap = 0;
  const Verdict met = verdict(climb);
  CHECK(met.relation == Relation::penetrating && !met.settled && !met.proven && !met.band);
  climb.boxes = BoxOutcome::apart;
  const Verdict oriented = verdict(climb);
  CHECK(oriented.relation == Relation::separated && oriented.settled && oriented.gap > kRequest.gap_limit);
}

PairResult hulls(Outcome outcome, double lower, double upper) {
  PairResult result;
  result.outcome = outcome;
  result.has_distance = true;
  result.lower = lower;
  result.upper = upper;
  return result;
}

void hulls_say_all_of_convex_bodies_and_separation_of_others() {
  Climb climb;
  climb.hulls = hulls(Outcome::separated, 0.125, 0.25);
  CHECK(verdict(climb).settled && verdict(climb).gap == 0.125 && !signed_distance(climb));
  climb.hulls = hulls(Outcome::penetrating, -1, -1);
  CHECK(!verdict(climb).settled && !verdict(climb).proven);
  climb.both_convex = true;
  CHECK(verdict(climb).settled && verdict(climb).proven && verdict(climb).relation == Relation::penetrating);
  CHECK(verdict(climb).band == BandSide::deeper && signed_distance(climb) == &*climb.hulls);
  climb.hulls = hulls(Outcome::penetrating, -0.25, -0.125);
  CHECK(verdict(climb).band == BandSide::within);
  climb.nesting = Relation::inside;
  CHECK(verdict(climb).relation == Relation::inside);
  climb.nesting = Relation::touching;  // rounding of a pose
  CHECK(verdict(climb).relation == Relation::penetrating);
  climb.hulls = hulls(Outcome::undecided, NAN, NAN);
  CHECK(!verdict(climb).settled && !signed_distance(climb));
}

void triangles_have_the_last_word() {
  Climb climb;
  climb.hulls = hulls(Outcome::penetrating, -1, -1);
  climb.triangles = MeshRelation{};
  CHECK(verdict(climb).relation == Relation::separated && verdict(climb).settled && !verdict(climb).band);
  climb.triangles->relation = Relation::penetrating;
  CHECK(verdict(climb).proven && verdict(climb).band == BandSide::deeper);
  climb.way_within = WayWithin{std::nullopt, 0, BandSide::hidden};
  CHECK(verdict(climb).band == BandSide::hidden);
  climb.triangles->proven = false;  // samples decided
  CHECK(verdict(climb).settled && !verdict(climb).proven && !hole_in_the_way(climb));
  climb.triangles->proven = true;
  climb.triangles->hole = OpenHole{};
  CHECK(!verdict(climb).proven && hole_in_the_way(climb) == &*climb.triangles->hole);
}

}  // namespace

UNIT(verdict) {
  boxes_settle_what_is_beyond_the_question();
  hulls_say_all_of_convex_bodies_and_separation_of_others();
  triangles_have_the_last_word();
}
