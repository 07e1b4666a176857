#include "depth/forbidden_union.hpp"

#include <algorithm>
#include <cmath>

namespace satcheck {
namespace {

// Measured steps of one plane of a set.
constexpr std::uint64_t kPlaneWork = 2;
// A set is kept without the facets that a box does not reach if at most this share is left, one in so many.
constexpr std::size_t kFewer = 2;
// At most this many facets of a set may cut a box whose rest is covered by other sets.
constexpr std::size_t kMostCuts = 4;
// At most this many times a point is moved out of a set within its box.
constexpr std::size_t kSetsLeft = 24;
// How far a point is moved beyond a set, in half sizes of the box.
constexpr double kIntoTheOpen = 1.0 / 16;

// The first box is larger than necessary by an odd factor, so that its halves do not end exactly at facets.
constexpr double kRootSize = 1.0309;
constexpr int kShortDigits = 20;

std::uint64_t work_of(const ForbiddenSet& set) { return kPlaneWork * set.normal.size(); }

}  // namespace

Vec3 TranslationBox::nearest_to_origin() const {
  const auto clamp = [](double c, double h) { return c - h > 0 ? c - h : c + h < 0 ? c + h : 0.0; };
  return {clamp(centre.x, half.x), clamp(centre.y, half.y), clamp(centre.z, half.z)};
}

bool TranslationBox::contains(Vec3 t) const {
  const Vec3 d = t - centre;
  return std::fabs(d.x) <= half.x && std::fabs(d.y) <= half.y && std::fabs(d.z) <= half.z;
}

Vec3 in_plane(Vec3 t, int across) {
  switch (across) {
    case 0: return {0, t.y, t.z};
    case 1: return {t.x, 0, t.z};
    case 2: return {t.x, t.y, 0};
    default: return t;
  }
}

double root_half(double length) {
  int exponent = 0;
  const double fraction = std::frexp(kRootSize * length, &exponent);
  return std::ldexp(std::ceil(std::ldexp(fraction, kShortDigits)), exponent - kShortDigits);
}

double ForbiddenUnion::covered_by_one(TranslationBox& box, double least, double most) const {
  const Aabb bounds = box.bounds();
  for (; box.seen < sets_.size(); ++box.seen) {
    if (meet(sets_[box.seen]->box, bounds)) box.sets.push_back(sets_[box.seen]);
  }
  double farthest = -INFINITY;
  std::size_t kept = 0;
  for (std::shared_ptr<const ForbiddenSet>& set : box.sets) {
    budget_.spend(work_of(*set));
    const ForbiddenSet::Reach reach = set->reach(box.centre, box.half);
    if (reach.length > farthest) {
      farthest = reach.length;
      box.held_by = set->number;
    }
    if (farthest >= most) break;
    if (!reach.meets) continue;
    if (reach.facets <= set->normal.size() / kFewer) set = std::make_shared<const ForbiddenSet>(set->within(box.centre, box.half));
    std::swap(box.sets[kept++], set);
  }
  if (farthest >= least) return farthest;
  box.sets.resize(kept);
  return -INFINITY;
}

double ForbiddenUnion::covered_by_several(const TranslationBox& box, double least) {
  if (box.sets.size() < 2) return -INFINITY;
  for (const auto& set : box.sets) {
    const double length = covered_with(*set, box, least);
    if (length >= least) return length;
  }
  return -INFINITY;
}

double ForbiddenUnion::covered_with(const ForbiddenSet& set, const TranslationBox& box, double least) {
  budget_.spend(work_of(set));
  cuts_.clear();
  double length = INFINITY;
  for (std::size_t k = 0; k < set.normal.size(); ++k) {
    const Vec3 n = set.normal[k];
    const double middle = dot(n, box.centre), at = set.offset[k];
    if (middle + reach_along(n, box.half) < at) continue;
    if (at >= least) {
      length = std::fmin(length, at);
    } else if (middle >= at || cuts_.size() == kMostCuts) {
      return -INFINITY;
    } else {
      cuts_.push_back({n, at});
    }
  }
  for (const Wall& cut : cuts_) {
    double beyond = -INFINITY;
    for (std::size_t j = 0; j < box.sets.size() && beyond < least; ++j) {
      if (box.sets[j].get() == &set) continue;
      beyond = std::fmax(beyond, box.sets[j]->reach_beyond(box.centre, box.half, cut.normal, cut.offset, least, budget_));
    }
    length = std::fmin(length, beyond);
    if (length < least) return -INFINITY;
  }
  return length;
}

bool ForbiddenUnion::is_open(const TranslationBox& box, Vec3 t, double most) const {
  return norm(t) < most && std::none_of(box.sets.begin(), box.sets.end(), [&](const auto& set) {
    budget_.spend(work_of(*set));
    return set->exit(t).depth > 0;
  });
}

std::optional<Vec3> ForbiddenUnion::nearest_open(const TranslationBox& box, Vec3 t, double most) const {
  const Vec3 start = t;
  const double beyond = kIntoTheOpen * max_abs(box.half);
  std::vector<Wall> walls;
  while (norm(t) < most) {
    ForbiddenSet::Exit deepest;
    for (const auto& set : box.sets) {
      budget_.spend(work_of(*set));
      const ForbiddenSet::Exit exit = set->exit(t);
      if (exit.depth > deepest.depth) deepest = exit;
    }
    if (!(deepest.depth > 0)) return box.contains(t) ? std::optional(t) : std::nullopt;
    if (walls.size() >= kSetsLeft) return std::nullopt;
    walls.push_back({deepest.normal, dot(deepest.normal, t - start) + deepest.depth + beyond});
    const std::optional<Vec3> next = nearest_beyond(walls);
    if (!next) return std::nullopt;
    t = in_plane(start + *next, across_);
  }
  return std::nullopt;
}

Vec3 ForbiddenUnion::on_facets(const TranslationBox& box) const {
  Vec3 t = box.nearest_to_origin();
  for (const auto& set : box.sets) {
    for (std::size_t k = 0; k < set->normal.size(); ++k) {
      const Vec3 n = set->normal[k];
      const double facet = set->facet[k];
      if (std::fabs(facet - dot(n, box.centre)) <= reach_along(n, box.half)) t = t + n * (facet - dot(n, t));
    }
  }
  return in_plane(t, across_);
}

bool ForbiddenUnion::holds(Vec3 t) const {
  const Aabb point{t, t};
  return std::any_of(sets_.begin(), sets_.end(), [&](const auto& set) { return meet(set->box, point) && set->holds(t); });
}

ForbiddenSet::Exit ForbiddenUnion::deepest_exit(Vec3 t) const {
  ForbiddenSet::Exit deepest;
  const Aabb point{t, t};
  for (const auto& set : sets_) {
    if (!meet(set->box, point)) continue;
    budget_.spend(work_of(*set));
    const ForbiddenSet::Exit exit = set->exit(t);
    if (exit.depth > deepest.depth) deepest = exit;
  }
  return deepest;
}

}  // namespace satcheck
