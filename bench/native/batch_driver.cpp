// check_pairs() from C++, for bench/batch.py: the pairs of a CVXPAIR1 file (bench/convex_pairs.py says what
// that is), asked once for every line `QUERY THREADS` of standard input. Answers with a line of wall
// and CPU nanoseconds and the sum of the outcomes. The poses are matrices already. The query `arithmetic` leaves
// the pairs alone: it is what the threads of this machine could give at best.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iostream>
#include <iterator>
#include <numeric>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "convex/batch.hpp"

using namespace satcheck;

namespace {

class Bytes {
 public:
  explicit Bytes(const char* path) {
    std::ifstream file(path, std::ios::binary);
    data_.assign(std::istreambuf_iterator<char>(file), {});
  }
  template <class T>
  T take() {
    T value;
    std::memcpy(&value, data_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  void skip(std::size_t count) { at_ += count; }

 private:
  std::string data_;
  std::size_t at_ = 0;
};

Shape take_shape(Bytes& bytes) {
  const auto kind = bytes.take<std::uint32_t>(), vertices = bytes.take<std::uint32_t>();
  const auto faces = bytes.take<std::uint32_t>(), indices = bytes.take<std::uint32_t>();
  const Vec3 half = bytes.take<Vec3>();
  std::vector<Vec3> points;
  for (std::uint32_t i = 0; i < vertices; ++i) points.push_back(bytes.take<Vec3>());
  bytes.skip(sizeof(std::uint32_t) * (faces + 1 + indices));
  return kind == 0 ? make_box(half) : make_hull(points);
}

Pose take_pose(Bytes& bytes) {
  Pose pose;
  pose.translation = bytes.take<Vec3>();
  const double x = bytes.take<double>(), y = bytes.take<double>(), z = bytes.take<double>(), w = bytes.take<double>();
  const double k = 2 / (x * x + y * y + z * z + w * w);
  pose.rotation = {{{1 - k * (y * y + z * z), k * (x * y - z * w), k * (x * z + y * w)},
                    {k * (x * y + z * w), 1 - k * (x * x + z * z), k * (y * z - x * w)},
                    {k * (x * z - y * w), k * (y * z + x * w), 1 - k * (x * x + y * y)}}};
  return pose;
}

// What threads can give on this machine at this moment: float64 arithmetic in registers, shared out like the pairs.
// Returns how many shares there were.
long arithmetic(unsigned threads) {
  constexpr std::size_t kShares = 64;
  constexpr int kRounds = 400000, kChains = 8;
  std::vector<double> found(kShares);
  parallel_for(kShares, threads, [&](std::size_t share) {
    double chains[kChains];
    for (int k = 0; k < kChains; ++k) chains[k] = static_cast<double>(share + k);
    for (int round = 0; round < kRounds; ++round) {
      for (double& x : chains) x = x * 0.5 + 1;
    }
    found[share] = std::accumulate(chains, chains + kChains, 0.0);
  });
  return std::count_if(found.begin(), found.end(), [](double sum) { return sum > 0; });
}

long sum_of_outcomes(const std::vector<PairRequest>& requests, Query query, unsigned threads) {
  const auto request = [&](std::size_t i) { return requests[i]; };
  const PairResults results = check_pairs(requests.size(), request, query, MethodChoice::automatic, threads);
  const Outcome* outcomes = results.array<&PairResult::outcome>();
  return std::accumulate(outcomes, outcomes + results.size(), 0L,
                         [](long sum, Outcome outcome) { return sum + static_cast<long>(outcome); });
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  Bytes bytes(arguments[1]);
  bytes.skip(8);
  const auto shape_count = bytes.take<std::uint32_t>(), pair_count = bytes.take<std::uint32_t>();
  bytes.skip(8);
  std::vector<Shape> shapes;
  for (std::uint32_t i = 0; i < shape_count; ++i) shapes.push_back(take_shape(bytes));
  std::vector<PairRequest> requests;
  for (std::uint32_t i = 0; i < pair_count; ++i) {
    const Shape &a = shapes[bytes.take<std::uint32_t>()], &b = shapes[bytes.take<std::uint32_t>()];
    const Pose pose_a = take_pose(bytes), pose_b = take_pose(bytes);
    requests.push_back({&a, &b, pose_a, pose_b});
  }
  std::string name;
  unsigned threads = 1;
  while (std::cin >> name >> threads) {
    const Query query = name == "overlap" ? Query::overlap : name == "depth" ? Query::depth : Query::distance;
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t worked = std::clock();
    const long sum = name == "arithmetic" ? arithmetic(threads) : sum_of_outcomes(requests, query, threads);
    const std::chrono::nanoseconds wall = std::chrono::steady_clock::now() - start;
    const double cpu = 1e9 * static_cast<double>(std::clock() - worked) / CLOCKS_PER_SEC;
    std::printf("%lld %.0f %ld\n", static_cast<long long>(wall.count()), cpu, sum);
    std::fflush(stdout);
  }
}
