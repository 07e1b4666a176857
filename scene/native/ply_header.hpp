// The header of a PLY file: which elements follow, how many, and with which properties.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace satcheck::scene {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

std::size_t size_of(PlyType type);
inline bool is_float(PlyType type) { return type == PlyType::float32 || type == PlyType::float64; }

struct PlyProperty {
  std::string name;
  PlyType type;                         // of the value, or of each item of the list
  bool is_list = false;
  PlyType length_type = PlyType::uint8;  // of the list's length
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyProperty> properties;

  std::int64_t smallest_binary_size() const;  // of one record: its lists empty
};

struct PlyHeader {
  bool ascii = false;
  std::endian byte_order = std::endian::little;
  std::vector<PlyElement> elements;
  std::size_t size = 0;         // bytes up to and with the line of end_header
  std::int64_t line_count = 0;  // lines up to and with end_header
};

// Throws ReadError, also if the stated counts cannot fit into the rest of the file.
PlyHeader read_ply_header(std::string_view bytes);

}  // namespace satcheck::scene
