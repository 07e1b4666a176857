// The result of a reader: the mesh as the file states it, or the first error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace satcheck::scene {

// How the file stores coordinates. The default tolerance follows from it.
enum class NumberFormat { written_digits, float32, float64 };

struct Warning {
  std::string code;
  std::string message;
};

// The triangles from number `first` on, up to the next span, belong to an object.
struct Span {
  std::uint32_t object;
  std::size_t first;
};

struct MeshData {
  std::vector<double> vertices;          // x, y, z of vertex 0, of vertex 1, ...: file units, all finite
  std::vector<std::uint32_t> triangles;  // three vertex numbers each, all below vertices.size() / 3
  NumberFormat number_format = NumberFormat::written_digits;
  int decimals = 0;     // most digits after the point in a coordinate written without exponent
  int significant = 0;  // most significant digits in a coordinate written with an exponent
  double rounding = 0;  // how far a coordinate may be off that is stored as an integer
  std::vector<Warning> warnings;
  std::vector<std::string> objects;  // of an OBJ file: the names of those with faces
  std::vector<Span> spans;           // of these objects; all triangles
  bool several_groups = false;       // faces belong to groups (`g`) of OBJ with different names, or to several solids of STL
};

constexpr std::int64_t nowhere = -1;

// The reader stopped here. `line` counts from 1 and `offset` from 0; `nowhere` when the place says nothing.
struct ReadError {
  std::string code;
  std::string message;
  std::int64_t line = nowhere;
  std::int64_t offset = nowhere;
};

using ReadOutcome = std::variant<MeshData, ReadError>;

// Stable codes; scene/issue.py explains each in one sentence.
namespace code {
inline constexpr const char* not_this_format = "not-this-format";
inline constexpr const char* truncated = "truncated";
inline constexpr const char* trailing_data = "trailing-data";
inline constexpr const char* count_mismatch = "count-mismatch";
inline constexpr const char* bad_record = "bad-record";
inline constexpr const char* non_finite = "non-finite";
inline constexpr const char* index_out_of_range = "index-out-of-range";
inline constexpr const char* unsupported_feature = "unsupported-feature";
inline constexpr const char* too_large = "too-large";
inline constexpr const char* short_face = "short-face";
inline constexpr const char* unread = "unread";
inline constexpr const char* unknown_statement = "unknown-statement";
inline constexpr const char* ignored_geometry = "ignored-geometry";
}  // namespace code

}  // namespace satcheck::scene
