// What every reader promises, whatever the bytes are. A broken promise ends the fuzzer as a crash does.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <variant>

#include "read_result.hpp"

namespace satcheck::scene {

inline void require(bool promise) {
  if (!promise) std::abort();
}

inline bool is_one_plain_line(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

inline void check(const ReadError& error) { require(!error.code.empty() && is_one_plain_line(error.message)); }

inline void check(const MeshData& mesh) {
  require(mesh.vertices.size() % 3 == 0 && mesh.triangles.size() % 3 == 0);
  for (const double c : mesh.vertices) require(std::isfinite(c));
  for (const std::uint32_t corner : mesh.triangles) require(corner < mesh.vertices.size() / 3);
  for (const Warning& warning : mesh.warnings) require(!warning.code.empty() && is_one_plain_line(warning.message));
}

inline void check(const ReadOutcome& outcome) {
  std::visit([](const auto& value) { check(value); }, outcome);
}

}  // namespace satcheck::scene
