#include "overlap/passing.hpp"

#include <utility>

namespace satcheck {
namespace {

enum class Shared { of_none, of_both };

class Pieces {
 public:
  Pieces(const SpaceCells& cells, const std::vector<std::uint32_t>& component, Shared shared)
      : cells_(cells), component_(component), shared_(shared), pieces_(2 * cells.faces().size()) {
    for (const Wedge& w : cells.wedges()) {
      const std::uint32_t here = component_[w.side];
      if (here == kNoComponent || is_within(w.side) || is_within(w.other)) continue;
      for (const int mesh : {0, 1}) {
        if (!belongs(w.side, mesh)) continue;
        const std::uint32_t own = piece(w.side, mesh), theirs = piece(w.other, 1 - mesh);
        if (belongs(w.other, mesh)) pieces_.unite(own, piece(w.other, mesh));
        if (belongs(w.other, 1 - mesh)) contacts_.push_back({here, mesh == 0 ? own : theirs, mesh == 0 ? theirs : own});
      }
    }
  }

  // Whether a piece of `mesh` joins pieces of the other one, by component.
  std::map<std::uint32_t, bool> joins(int mesh) {
    std::map<std::uint32_t, bool> result;
    std::map<std::uint32_t, std::uint32_t> meets;  // of each piece: one that it meets
    for (const auto& [here, of_a, of_b] : contacts_) {
      const std::uint32_t own = pieces_.find(mesh == 0 ? of_a : of_b), other = pieces_.find(mesh == 0 ? of_b : of_a);
      bool& joins = result[here];
      joins = meets.emplace(own, other).first->second != other || joins;
    }
    return result;
  }

 private:
  struct Contact {
    std::uint32_t component, of_a, of_b;
  };

  bool is_within(std::uint32_t side) const { return component_[side] == component_[side ^ 1]; }
  bool belongs(std::uint32_t side, int mesh) const {
    const CellFace& face = cells_.faces()[side / 2];
    return face.shared ? shared_ == Shared::of_both : face.mesh == mesh;
  }
  // Pieces are sets of faces. A face that belongs to both surfaces counts twice.
  static std::uint32_t piece(std::uint32_t side, int mesh) { return 2 * (side / 2) + static_cast<std::uint32_t>(mesh); }

  const SpaceCells& cells_;
  const std::vector<std::uint32_t>& component_;
  Shared shared_;
  DisjointSets pieces_;
  std::vector<Contact> contacts_;
};

std::optional<bool> agreed(const std::map<std::uint32_t, bool>& some, const std::map<std::uint32_t, bool>& others,
                           std::uint32_t component) {
  const auto value = [&](const std::map<std::uint32_t, bool>& of) {
    const auto known = of.find(component);
    return known != of.end() && known->second;
  };
  return value(some) == value(others) ? std::optional(value(some)) : std::nullopt;
}

}  // namespace

std::map<std::uint32_t, Passing> find_passing(const SpaceCells& cells, const std::vector<std::uint32_t>& component) {
  Pieces of_none(cells, component, Shared::of_none), of_both(cells, component, Shared::of_both);
  const auto a_without = of_none.joins(0), b_without = of_none.joins(1);
  const auto a_with = of_both.joins(0), b_with = of_both.joins(1);
  std::map<std::uint32_t, Passing> result;
  for (const auto& pairs : {a_without, a_with}) {
    for (const auto& [here, _] : pairs) {
      result[here] = {agreed(a_without, a_with, here), agreed(b_without, b_with, here)};
    }
  }
  // A face within a body may separate parts that belong together.
  for (std::uint32_t s = 0; s < component.size(); s += 2) {
    if (component[s] != kNoComponent && component[s] == component[s + 1]) result[component[s]] = {};
  }
  return result;
}

}  // namespace satcheck
