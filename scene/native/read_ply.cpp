// PLY 1.0, after Greg Turk, "The PLY Polygon File Format" (1994). Elements and properties without geometry are skipped.
#include <algorithm>
#include <cmath>
#include <limits>

#include "builder.hpp"
#include "ply_header.hpp"
#include "polygons.hpp"
#include "readers.hpp"
#include "text.hpp"

namespace satcheck::scene {
namespace {

constexpr std::uint64_t largest_integer = std::numeric_limits<std::int64_t>::max();

// A length or a vertex number that the file stores as a float.
template <class Records>
std::int64_t whole_number(double value, const Records& records) {
  constexpr double largest = 1LL << 53;  // float64 holds all integers up to this
  if (!(std::abs(value) <= largest) || value != std::floor(value)) {
    records.stop(code::bad_record, "expected a whole number, found " + std::to_string(value));
  }
  return static_cast<std::int64_t>(value);
}

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
  std::int64_t integer(PlyType type) {
    if (is_float(type)) return whole_number(parse_coordinate(word(), place(), unused_), *this);
    return parse_integer(word(), place(), "a whole number");
  }
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
  static constexpr bool has_empty_lines = true;  // for records without properties

 private:
  std::string_view word() {
    std::string_view word;
    if (!words_.next(word)) fail_at_line(code::bad_record, "fewer values than the header promises", place());
    return word;
  }

  Lines lines_;
  Words words_;
  MeshData unused_;  // other numbers do not affect the precision of coordinates
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
    if (is_float(type)) return whole_number(real(type), *this);
    const char* from = take(type);
    switch (type) {
      case PlyType::int8: return load<std::int8_t>(from, order_);
      case PlyType::uint8: return load<std::uint8_t>(from, order_);
      case PlyType::int16: return load<std::int16_t>(from, order_);
      case PlyType::uint16: return load<std::uint16_t>(from, order_);
      case PlyType::int32: return load<std::int32_t>(from, order_);
      case PlyType::uint32: return load<std::uint32_t>(from, order_);
      case PlyType::int64: return load<std::int64_t>(from, order_);
      case PlyType::uint64: return static_cast<std::int64_t>(std::min(load<std::uint64_t>(from, order_), largest_integer));
      default: return 0;  // floats: see above
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
  static constexpr bool has_empty_lines = false;

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
std::int64_t list_length(Records& records, const PlyProperty& property) {
  const std::int64_t length = records.integer(property.length_type);
  if (length < 0) records.stop(code::bad_record, "a list of negative length");
  return length;
}

template <class Records>
void skip_property(Records& records, const PlyProperty& property) {
  const std::int64_t length = property.is_list ? list_length(records, property) : 1;
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

bool has_corners(const PlyElement& element) {
  return std::any_of(element.properties.begin(), element.properties.end(), is_corner_list);
}

bool is_among(const std::string& name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Lists of data beside the corners of a face, or beside a vertex.
bool is_harmless_list(const std::string& name) {
  return is_among(name, {"texcoord", "texcoords", "texture_coordinates", "colors", "color", "normals", "flags", "edge_flags"});
}

// Elements that have no surface, whatever their properties.
bool is_harmless_element(const std::string& name) {
  return is_among(name, {"edge", "material", "camera", "obj_info", "range_grid", "texture", "multi_texture_face"});
}

// What may hold triangles, or the size of what is at a vertex, under other names.
void note_unread(const PlyElement& element, MeshData& mesh) {
  if (element.count == 0 || is_harmless_element(element.name)) return;
  const bool known = element.name == "vertex" || element.name == "face" || element.name == "tristrips";
  std::string unread;
  bool splats = false;
  for (const PlyProperty& property : element.properties) {
    const bool is_list = property.is_list && !is_corner_list(property) && !is_harmless_list(property.name);
    const bool is_index = !known && !is_float(property.type) && property.name.starts_with("v");
    splats = splats || property.name == "scale_0";
    if (is_list || is_index) unread += (unread.empty() ? "" : ", ") + quoted(property.name);
  }
  if (!unread.empty()) {
    mesh.warnings.push_back({code::unread, "element " + quoted(element.name) + ": " + unread + " is not read; it may be faces"});
  } else if (element.name == "vertex" && splats) {
    mesh.warnings.push_back({code::unread, "vertices have a size of their own, which is not read"});
  }
}

// Calls `take` with the list of vertex numbers of each record of the element.
template <class Records, class Take>
void read_corners(Records& records, const PlyElement& element, std::int64_t vertex_count, std::int64_t lowest, Take take) {
  if (element.count > 0 && std::count_if(element.properties.begin(), element.properties.end(), is_corner_list) != 1) {
    fail(code::bad_record, "the PLY header gives " + quoted(element.name) + " no list vertex_indices, or two");
  }
  std::vector<std::int64_t> corners;
  for (std::int64_t record = 0; record < element.count; ++record) {
    records.begin(element);
    for (const PlyProperty& property : element.properties) {
      if (!is_corner_list(property)) {
        skip_property(records, property);
        continue;
      }
      corners.clear();
      const std::int64_t length = list_length(records, property);
      for (std::int64_t i = 0; i < length; ++i) {
        const std::int64_t index = records.integer(property.type);
        if (index < lowest || index >= vertex_count) {
          records.stop(code::index_out_of_range, "face index out of range: " + std::to_string(index) + " of " +
                                                     std::to_string(vertex_count) + " vertices");
        }
        corners.push_back(index);
      }
      take(corners);
    }
    records.end();
  }
}

template <class Records>
void read_faces(Records& records, const PlyElement& element, std::int64_t vertex_count, Polygons& polygons, MeshData& mesh) {
  std::vector<std::uint32_t> face;
  read_corners(records, element, vertex_count, 0, [&](const std::vector<std::int64_t>& corners) {
    face.assign(corners.begin(), corners.end());
    polygons.add(face, records.place(), mesh);
  });
}

// A strip of triangles: each corner forms a triangle with the two before it, and every other triangle is turned over.
// strip_end starts a new strip. A repeated corner forms no triangle.
template <class Records>
void read_strips(Records& records, const PlyElement& element, std::int64_t vertex_count, MeshData& mesh) {
  constexpr std::int64_t strip_end = -1;
  read_corners(records, element, vertex_count, strip_end, [&](const std::vector<std::int64_t>& corners) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (corners[i] == strip_end) begin = i + 1;
      if (corners[i] == strip_end || i < begin + 2) continue;
      const bool turned = (i - begin) % 2 == 1;
      const std::int64_t a = corners[i - (turned ? 1 : 2)], b = corners[i - (turned ? 2 : 1)], c = corners[i];
      if (a == b || b == c || c == a) continue;
      for (const std::int64_t corner : {a, b, c}) mesh.triangles.push_back(static_cast<std::uint32_t>(corner));
    }
  });
}

template <class Records>
void skip_records(Records& records, const PlyElement& element) {
  if (element.properties.empty() && !Records::has_empty_lines) return;
  for (std::int64_t i = 0; i < element.count; ++i) {
    records.begin(element);
    for (const PlyProperty& property : element.properties) skip_property(records, property);
    records.end();
  }
}

std::int64_t vertex_count_of(const PlyHeader& header) {
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") return element.count;
  }
  return 0;
}

// The precision of the coordinates: that of the coarsest type.
void set_precision(MeshData& mesh, const PlyHeader& header) {
  mesh.number_format = header.ascii ? NumberFormat::written_digits : NumberFormat::float64;
  for (const PlyElement& element : header.elements) {
    if (element.name != "vertex") continue;
    for (const PlyProperty& property : element.properties) {
      if (axis_of(property) < 0) continue;
      if (!is_float(property.type)) mesh.rounding = 0.5;
      if (!header.ascii && property.type == PlyType::float32) mesh.number_format = NumberFormat::float32;
    }
  }
}

template <class Records>
MeshData read_body(Records records, const PlyHeader& header) {
  MeshData mesh;
  Polygons polygons;
  set_precision(mesh, header);
  for (const PlyElement& element : header.elements) {
    note_unread(element, mesh);
    if (element.name == "vertex") {
      read_vertices(records, element, mesh);
    } else if (element.name == "face") {
      read_faces(records, element, vertex_count_of(header), polygons, mesh);
    } else if (element.name == "tristrips") {
      read_strips(records, element, vertex_count_of(header), mesh);
    } else if (element.count > 0 && has_corners(element)) {
      fail(code::unsupported_feature, "the PLY element " + quoted(element.name) + " has vertex numbers: it could be geometry");
    } else {
      if (element.name == "edge" && element.count > 0) {
        mesh.warnings.push_back({code::ignored_geometry, std::to_string(element.count) + " edges without area ignored"});
      }
      skip_records(records, element);
    }
  }
  records.check_end();
  polygons.finish(Records::unit, mesh);  // faces may stand before the vertices
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
