// Segments joined by number: chains end at branches, loops never pass a node twice.
#include "mesh/chains.hpp"

#include <algorithm>
#include <stdexcept>

#include "tests/check.hpp"

using namespace satcheck;

namespace {

using Nodes = std::vector<std::uint32_t>;

void open_chain() {
  const auto chains = join_chains({{3, 1}, {0, 2}, {1, 0}}, 4);
  CHECK(chains.size() == 1);
  CHECK(!chains[0].closed);
  CHECK((chains[0].nodes == Nodes{2, 0, 1, 3}));
}

void closed_chain_and_spur() {
  // A triangle 0 1 2 with a tail 2 3: the branch at 2 ends the tail, and the loop starts there.
  const auto chains = join_chains({{0, 1}, {1, 2}, {2, 0}, {2, 3}}, 4);
  CHECK(chains.size() == 2);
  CHECK((chains[0].closed && chains[0].nodes == Nodes{2, 1, 0}));
  CHECK((!chains[1].closed && chains[1].nodes == Nodes{2, 3}));
}

void branches_divide() {
  const auto chains = join_chains({{0, 1}, {0, 2}, {0, 3}, {3, 4}}, 5);
  CHECK(chains.size() == 3);
  CHECK(std::none_of(chains.begin(), chains.end(), [](const Chain& c) { return c.closed; }));
  std::size_t segments = 0;
  for (const Chain& c : chains) segments += c.nodes.size() - 1;
  CHECK(segments == 4);
}

void loops_that_share_a_node() {
  // Two triangles that touch in node 2.
  const auto loops = join_loops({{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 2}, {2, 0}});
  CHECK(loops.size() == 2);
  for (const Nodes& loop : loops) CHECK(loop.size() == 3);
}

void loops_must_close() {
  bool refused = false;
  try {
    join_loops({{0, 1}, {1, 2}});
  } catch (const std::logic_error&) {
    refused = true;
  }
  CHECK(refused);
}

}  // namespace

UNIT(chains) {
  open_chain();
  closed_chain_and_spur();
  branches_divide();
  loops_that_share_a_node();
  loops_must_close();
}
