// The pairs of the peer harness as placed shapes of satcheck.
#pragma once
#include "convex/shape.hpp"
#define Shape FileShape
#define Pose FilePose
#include "bench.hpp"
#undef Shape
#undef Pose

struct PlacedPair {
  const satcheck::Shape *a, *b;
  satcheck::Pose pose_a, pose_b;
};

inline satcheck::Shape shape_from(const FileShape& s) {
  if (s.kind == 0) return satcheck::make_box({s.half[0], s.half[1], s.half[2]});
  std::vector<satcheck::Vec3> points;
  for (int i = 0; i < s.nv(); ++i) points.push_back({s.v[3 * i], s.v[3 * i + 1], s.v[3 * i + 2]});
  return satcheck::make_hull(points);
}

// As the Python binding reads a pose: the quaternion may have any length.
inline satcheck::Pose pose_from(const FilePose& p) {
  double x = p.q[0], y = p.q[1], z = p.q[2], w = p.q[3];
  const double inverse = 1 / std::sqrt(x * x + y * y + z * z + w * w);
  x *= inverse, y *= inverse, z *= inverse, w *= inverse;
  satcheck::Pose pose;
  pose.rotation = {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                    {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                    {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
  pose.translation = {p.t[0], p.t[1], p.t[2]};
  return pose;
}

inline void copy(satcheck::Vec3 v, double* to) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

class PlacedPairs {
 public:
  void load(const PairFile& file) {
    for (const FileShape& s : file.shapes) shapes_.push_back(shape_from(s));
    for (const auto& p : file.pairs) {
      pairs_.push_back({&shapes_[p.a], &shapes_[p.b], pose_from(p.A), pose_from(p.B)});
    }
  }
  const PlacedPair& operator[](int i) const { return pairs_[static_cast<std::size_t>(i)]; }

 private:
  std::vector<satcheck::Shape> shapes_;
  std::vector<PlacedPair> pairs_;
};
