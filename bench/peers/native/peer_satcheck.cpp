// satcheck as a peer of the peer harness (bench/README.md): the convex narrow phase at C++ level.
//  satcheck   check_pair: overlap, depth, distance; verdicts proven
#include "convex/narrow_phase.hpp"
#include "placed_pairs.hpp"

namespace {

class Satcheck : public Peer {
 public:
  int caps() const override { return CAP_BOOL | CAP_PEN | CAP_DIST; }
  void load(const PairFile& file) override { pairs_.load(file); }
  int overlap(int i) override {
    const satcheck::PairResult r = ask(i, satcheck::Query::overlap);
    return r.outcome == satcheck::Outcome::undecided ? -1 : r.outcome == satcheck::Outcome::penetrating;
  }
  bool pen(int i, Out& out) override { return write(ask(i, satcheck::Query::depth), out); }
  bool dist(int i, Out& out) override { return write(ask(i, satcheck::Query::distance), out); }

 private:
  satcheck::PairResult ask(int i, satcheck::Query query) const {
    const PlacedPair& p = pairs_[i];
    return satcheck::check_pair(*p.a, p.pose_a, *p.b, p.pose_b, query);
  }
  static bool write(const satcheck::PairResult& r, Out& out) {
    if (!r.has_distance) return false;
    out.sd = r.distance;
    copy(r.normal, out.n);
    copy(r.witness_a, out.pa);
    copy(r.witness_b, out.pb);
    return true;
  }

  PlacedPairs pairs_;
};

}  // namespace

int main(int argc, char** argv) {
  return bench_main(argc, argv, {{"satcheck", [] { return std::unique_ptr<Peer>(new Satcheck); }}});
}
