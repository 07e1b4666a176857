#include "mesh_pair/traversal.hpp"

#include <optional>
#include <utility>

#include "exact/triangle_pair.hpp"
#include "mesh_pair/common_triangles.hpp"

namespace satcheck {
namespace {

double half_area(const Aabb& box) {
  const Vec3 e = box.size();
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

// Measured steps of a pair of boxes, of a pair of triangles, and of a pair that meets.
constexpr std::uint64_t kBoxWork = 10, kTriangleWork = 20, kContactWork = 150;

// A triangle of a surface meets about a dozen others at its corners.
constexpr std::size_t kContactsOfCommon = 16;

class Traversal {
 public:
  Traversal(const Surface& a, const Surface& b, AtCrossing at_crossing, Budget* budget, std::size_t many)
      : a_(a), b_(b), at_crossing_(at_crossing), budget_(budget), many_(many) {}

  SurfaceContacts run() {
    if (a_.bvh.nodes.empty() || b_.bvh.nodes.empty()) return {};
    walk();
    if (!ended() && is_many() && at_crossing_ != AtCrossing::stop_at_many) {
      common_.emplace(a_, b_, budget_);
      if (kContactsOfCommon * common_->count() < contacts_.contacts.size()) common_.reset();
      many_ = SIZE_MAX;
      contacts_ = {};
      walk();
    }
    if (common_) {
      contacts_.common = common_->regions();
      for (const ContactPair& c : common_->irregular()) contacts_.contacts.push_back(c);
    }
    return std::move(contacts_);
  }

 private:
  bool ended() const { return contacts_.crossing && at_crossing_ != AtCrossing::go_on; }
  bool is_many() const { return contacts_.contacts.size() > many_; }

  void walk() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
    while (!stack.empty() && !ended() && !is_many()) {
      const auto [i, j] = stack.back();
      stack.pop_back();
      const BvhNode &m = a_.bvh.nodes[i], &n = b_.bvh.nodes[j];
      ++contacts_.box_tests;
      spend(budget_, kBoxWork);
      if (!meet(m.box, n.box)) continue;
      if (m.is_leaf() && n.is_leaf()) {
        test_leaves(m, n);
      } else if (n.is_leaf() || (!m.is_leaf() && half_area(m.box) >= half_area(n.box))) {
        stack.emplace_back(m.first + 1, j);
        stack.emplace_back(m.first, j);
      } else {
        stack.emplace_back(i, n.first + 1);
        stack.emplace_back(i, n.first);
      }
    }
  }

  // As box_at(), but without copying the box.
  static bool meets(const Surface& s, std::uint32_t place, const Aabb& box) {
    return place < s.bvh.boxes.size() ? meet(s.bvh.boxes[place], box) : meet(box_at(s.bvh, s.mesh, place), box);
  }

  void test_leaves(const BvhNode& m, const BvhNode& n) {
    for (std::uint32_t k = m.first; k < m.first + m.count; ++k) {
      if (!meets(a_, k, n.box)) continue;
      const Aabb box = box_at(a_.bvh, a_.mesh, k);
      const std::uint32_t ta = a_.bvh.order[k];
      const Corners ca = corners(a_.mesh, ta);
      const TrianglePlane plane(ca[0], ca[1], ca[2]);
      for (std::uint32_t l = n.first; l < n.first + n.count; ++l) {
        if (!meets(b_, l, box)) continue;
        const std::uint32_t tb = b_.bvh.order[l];
        ++contacts_.triangle_tests;
        spend(budget_, kTriangleWork);
        if (common_ && common_->note(ta, tb)) continue;
        const TriangleContact contact = classify(plane, corners(b_.mesh, tb), budget_);
        if (contact == TriangleContact::disjoint) continue;
        if (contact == TriangleContact::crossing && !contacts_.crossing) contacts_.crossing = ContactPair{ta, tb};
        if (ended()) return;
        spend(budget_, kContactWork);
        contacts_.contacts.push_back({ta, tb});
      }
    }
  }

  const Surface& a_;
  const Surface& b_;
  AtCrossing at_crossing_;
  Budget* budget_;
  std::size_t many_;
  std::optional<CommonTriangles> common_;
  SurfaceContacts contacts_;
};

}  // namespace

SurfaceContacts find_contacts(const Surface& a, const Surface& b, AtCrossing at_crossing, Budget* budget, std::size_t many) {
  return Traversal(a, b, at_crossing, budget, many).run();
}

}  // namespace satcheck
