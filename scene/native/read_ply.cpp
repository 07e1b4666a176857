// PLY 1.0, after Greg Turk, "The PLY Polygon File Format" (1994). Elements and properties that carry no geometry
// are stepped over.
#include "builder.hpp"
#include "bytes.hpp"
#include "ply_header.hpp"
#include "readers.hpp"
#include "text.hpp"

namespace satcheck::scene {
namespace {

// The values of one record after another. `number` is a property's value or a list's length or item.
class AsciiRecords {
 public:
  AsciiRecords(std::string_view body, std::int64_t first_line) : lines_(body, first_line), words_({}) {}

  void begin(const PlyElement& element) {
    std::string_view line;
    do {
      if (!lines_.next(line)) {
        fail_at_line(code::truncated, "truncated: the file ends inside the " + quoted(element.name) + " records",
                     lines_.number());
      }
    } while (Words(line).none_left() && !element.properties.empty());
    words_ = Words(line);
  }
  void end() {
    if (!words_.none_left()) fail_at_line(code::bad_record, "more values than the header promises", place());
  }
  double coordinate(PlyType, MeshData& mesh) { return parse_coordinate(word(), place(), mesh); }
  std::int64_t integer(PlyType) { return parse_integer(word(), place(), "a whole number"); }
  void skip(PlyType) { word(); }
  void check_end() {
    std::string_view line;
    while (lines_.next(line)) {
      if (!Words(line).none_left()) {
        fail_at_line(code::trailing_data, "more lines than the header promises", place());
      }
    }
  }
  std::int64_t place() const { return lines_.number(); }
  [[noreturn]] void stop(const char* code, std::string message) const {
    fail_at_line(code, std::move(message), place());
  }
  static constexpr const char* unit = "line";

 private:
  std::string_view word() {
    std::string_view word;
    if (!words_.next(word)) fail_at_line(code::bad_record, "fewer values than the header promises", place());
    return word;
  }

  Lines lines_;
  Words words_;
};

class BinaryRecords {
 public:
  BinaryRecords(std::string_view bytes, std::size_t offset, std::endian order)
      : bytes_(bytes), offset_(offset), order_(order) {}

  void begin(const PlyElement& element) { element_ = &element; }
  void end() {}
  double coordinate(PlyType type, MeshData&) {
    const std::int64_t at = place();
    const double value = is_float(type) ? real(type) : static_cast<double>(integer(type));
    if (!std::isfinite(value)) fail_at_byte(code::non_finite, "non-finite coordinate", at);
    return value;
  }
  std::int64_t integer(PlyType type) {
    const char* from = take(type);
    switch (type) {
      case PlyType::int8: return load<std::int8_t>(from, order_);
      case PlyType::uint8: return load<std::uint8_t>(from, order_);
      case PlyType::int16: return load<std::int16_t>(from, order_);
      case PlyType::uint16: return load<std::uint16_t>(from, order_);
      case PlyType::int32: return load<std::int32_t>(from, order_);
      case PlyType::uint32: return load<std::uint32_t>(from, order_);
      default: fail(code::unsupported_feature, "vertex numbers written as floats");
    }
  }
  void skip(PlyType type) { take(type); }
  void check_end() const {
    if (offset_ < bytes_.size()) {
      fail_at_byte(code::trailing_data, std::to_string(bytes_.size() - offset_) + " bytes more than the header promises",
                   place());
    }
  }
  std::int64_t place() const { return static_cast<std::int64_t>(offset_); }
  [[noreturn]] void stop(const char* code, std::string message) const {
    fail_at_byte(code, std::move(message), place());
  }
  static constexpr const char* unit = "before byte";

 private:
  const char* take(PlyType type) {
    const std::size_t size = size_of(type);
    if (bytes_.size() - offset_ < size) {
      fail_at_byte(code::truncated, "truncated: the file ends inside the " + quoted(element_->name) + " records",
                   place());
    }
    offset_ += size;
    return bytes_.data() + offset_ - size;
  }
  double real(PlyType type) {
    const char* from = take(type);
    return type == PlyType::float32 ? load<float>(from, order_) : load<double>(from, order_);
  }

  std::string_view bytes_;
  std::size_t offset_;
  std::endian order_;
  const PlyElement* element_ = nullptr;
};

template <class Records>
void skip_property(Records& records, const PlyProperty& property) {
  const std::int64_t length = property.is_list ? records.integer(property.length_type) : 1;
  for (std::int64_t i = 0; i < length; ++i) records.skip(property.type);
}

int axis_of(const PlyProperty& property) {
  if (property.is_list || property.name.size() != 1 || property.name[0] < 'x' || property.name[0] > 'z') return -1;
  return property.name[0] - 'x';
}

template <class Records>
void read_vertices(Records& records, const PlyElement& element, MeshData& mesh) {
  int axes_found = 0;
  for (const PlyProperty& property : element.properties) axes_found |= axis_of(property) < 0 ? 0 : 1 << axis_of(property);
  if (axes_found != 0b111) fail(code::bad_record, "the PLY header gives vertices no x, y and z");
  for (std::int64_t i = 0; i < element.count; ++i) {
    records.begin(element);
    double position[3] = {0, 0, 0};
    for (const PlyProperty& property : element.properties) {
      if (const int axis = axis_of(property); axis >= 0) {
        position[axis] = records.coordinate(property.type, mesh);
      } else {
        skip_property(records, property);
      }
    }
    records.end();
    mesh.vertices.insert(mesh.vertices.end(), position, position + 3);
  }
}

bool is_corner_list(const PlyProperty& property) {
  return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
}

template <class Records>
void read_faces(Records& records, const PlyElement& element, std::int64_t vertex_count, MeshData& mesh) {
  Polygons polygons;
  std::vector<std::uint32_t> corners;
  for (std::int64_t face = 0; face < element.count; ++face) {
    records.begin(element);
    for (const PlyProperty& property : element.properties) {
      if (!is_corner_list(property)) {
        skip_property(records, property);
        continue;
      }
      corners.clear();
      const std::int64_t sides = records.integer(property.length_type);
      if (sides < 0) records.stop(code::bad_record, "bad face record: negative number of corners");
      for (std::int64_t i = 0; i < sides; ++i) {
        const std::int64_t index = records.integer(property.type);
        if (index < 0 || index >= vertex_count) {
          records.stop(code::index_out_of_range, "face index out of range: " + std::to_string(index) + " of " +
                                                     std::to_string(vertex_count) + " vertices");
        }
        corners.push_back(static_cast<std::uint32_t>(index));
      }
      polygons.add(corners, records.place(), mesh);
    }
    records.end();
  }
  polygons.report(Records::unit, mesh);
}

std::int64_t vertex_count_of(const PlyHeader& header) {
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") return element.count;
  }
  return 0;
}

Precision precision_of(const PlyHeader& header) {
  if (header.ascii) return Precision::written_digits;
  Precision precision = Precision::float64;
  for (const PlyElement& element : header.elements) {
    for (const PlyProperty& property : element.properties) {
      const bool coarse = element.name == "vertex" && axis_of(property) >= 0 && property.type == PlyType::float32;
      if (coarse) precision = Precision::float32;
    }
  }
  return precision;
}

template <class Records>
MeshData read_body(Records records, const PlyHeader& header) {
  MeshData mesh;
  mesh.precision = precision_of(header);
  for (const PlyElement& element : header.elements) {
    if (element.name == "tristrips") fail(code::unsupported_feature, "PLY triangle strips are not read");
    if (element.name == "vertex") {
      read_vertices(records, element, mesh);
    } else if (element.name == "face") {
      read_faces(records, element, vertex_count_of(header), mesh);
    } else {
      for (std::int64_t i = 0; i < element.count; ++i) {
        records.begin(element);
        for (const PlyProperty& property : element.properties) skip_property(records, property);
        records.end();
      }
    }
  }
  records.check_end();
  require_triangles(mesh);
  return mesh;
}

}  // namespace

ReadOutcome read_ply(std::string_view bytes) {
  return run_reader([&] {
    const PlyHeader header = read_ply_header(bytes);
    if (!header.ascii) return read_body(BinaryRecords(bytes, header.size, header.byte_order), header);
    return read_body(AsciiRecords(bytes.substr(header.size), header.line_count + 1), header);
  });
}

}  // namespace satcheck::scene
