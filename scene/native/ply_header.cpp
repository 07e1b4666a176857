#include "ply_header.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "builder.hpp"
#include "text.hpp"

namespace satcheck::scene {
namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 18> type_names = {{
    {"char", PlyType::int8},     {"int8", PlyType::int8},       {"uchar", PlyType::uint8},   {"uint8", PlyType::uint8},
    {"short", PlyType::int16},   {"int16", PlyType::int16},     {"ushort", PlyType::uint16}, {"uint16", PlyType::uint16},
    {"int", PlyType::int32},     {"int32", PlyType::int32},     {"uint", PlyType::uint32},   {"uint32", PlyType::uint32},
    {"int64", PlyType::int64},   {"uint64", PlyType::uint64},
    {"float", PlyType::float32}, {"float32", PlyType::float32}, {"double", PlyType::float64}, {"float64", PlyType::float64},
}};

class HeaderReader {
 public:
  explicit HeaderReader(std::string_view bytes) : bytes_(bytes), lines_(header_text(bytes)) {}

  PlyHeader read() {
    std::string_view line;
    lines_.next(line);  // the magic word, checked already
    bool ended = false;
    while (!ended && lines_.next(line)) ended = statement(Words(line));
    if (!ended) fail_at_line(code::truncated, "truncated: the header has no end_header", lines_.number());
    if (!has_format_) fail(code::bad_record, "the PLY header has no format line");
    header_.size = lines_.offset();
    header_.line_count = lines_.number();
    check_counts();
    return std::move(header_);
  }

 private:
  // Binary data follows the header, so only the header is searched for lines.
  static std::string_view header_text(std::string_view bytes) {
    const std::string_view first = bytes.substr(0, bytes.find_first_of("\r\n"));
    std::string_view word;
    Words words(first);
    if (first.size() == bytes.size() || !words.next(word) || word != "ply" || !words.none_left()) fail(code::not_this_format, "not a PLY file: it does not start with ply");
    const std::size_t end = bytes.find("end_header");
    if (end == std::string_view::npos) return bytes;
    std::size_t stop = bytes.find_first_of("\r\n", end);
    if (stop == std::string_view::npos) return bytes;
    if (bytes.substr(stop, 2) == "\r\n") ++stop;
    return bytes.substr(0, stop + 1);
  }

  std::string_view required(Words& words, const char* what) {
    std::string_view word;
    if (!words.next(word)) fail_at_line(code::bad_record, std::string("PLY header: missing ") + what, lines_.number());
    return word;
  }

  PlyType type(Words& words) {
    const std::string_view word = required(words, "a type");
    for (const auto& [name, value] : type_names) {
      if (word == name) return value;
    }
    fail_at_line(code::bad_record, "PLY header: unknown type " + quoted(word), lines_.number());
  }

  // Returns true at end_header.
  bool statement(Words words) {
    std::string_view keyword;
    if (!words.next(keyword) || keyword == "comment" || keyword == "obj_info") return false;
    if (keyword == "end_header") return true;
    if (keyword == "format") {
      format(required(words, "a format"));
    } else if (keyword == "element") {
      PlyElement element;
      element.name = required(words, "an element name");
      element.count = parse_integer(required(words, "an element count"), lines_.number(), "an element count");
      refuse_second(element_names_, element.name);
      property_names_.clear();
      header_.elements.push_back(std::move(element));
    } else if (keyword == "property") {
      property(words);
    } else {
      fail_at_line(code::bad_record, "PLY header: unknown statement " + quoted(keyword), lines_.number());
    }
    return false;
  }

  void format(std::string_view name) {
    has_format_ = true;
    header_.ascii = name == "ascii";
    header_.byte_order = name == "binary_big_endian" ? std::endian::big : std::endian::little;
    if (!header_.ascii && name != "binary_big_endian" && name != "binary_little_endian") {
      fail_at_line(code::unsupported_feature, "unknown PLY format " + quoted(name), lines_.number());
    }
  }

  void property(Words& words) {
    if (header_.elements.empty()) {
      fail_at_line(code::bad_record, "PLY header: a property before any element", lines_.number());
    }
    PlyProperty property;
    Words list = words;
    std::string_view word;
    if (list.next(word) && word == "list") {
      words = list;
      property.is_list = true;
      property.length_type = type(words);
    }
    property.type = type(words);
    property.name = required(words, "a property name");
    refuse_second(property_names_, property.name);
    header_.elements.back().properties.push_back(std::move(property));
  }

  void refuse_second(std::set<std::string>& earlier, const std::string& name) const {
    if (!earlier.insert(name).second) fail_at_line(code::bad_record, "PLY header: " + quoted(name) + " occurs twice", lines_.number());
  }

  void check_counts() const {
    const std::int64_t left = static_cast<std::int64_t>(bytes_.size() - header_.size);
    for (const PlyElement& element : header_.elements) {
      // In ASCII a record takes at least one character and a line end for each of its properties.
      const std::int64_t record = header_.ascii ? 2 * static_cast<std::int64_t>(element.properties.size())
                                                : element.smallest_binary_size();
      const std::int64_t last_line_end = header_.ascii ? 1 : 0;
      if (element.count < 0 || element.count > max_vertices ||
          (record > 0 && element.count > (left + last_line_end) / record)) {
        fail(code::count_mismatch, "the header promises " + std::to_string(element.count) + " " + quoted(element.name) +
                                       " records, the file has " + std::to_string(left) + " bytes left for them");
      }
    }
  }

  std::string_view bytes_;
  Lines lines_;
  PlyHeader header_;
  std::set<std::string> element_names_, property_names_;
  bool has_format_ = false;
};

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8: return 1;
    case PlyType::int16:
    case PlyType::uint16: return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32: return 4;
    case PlyType::int64:
    case PlyType::uint64:
    case PlyType::float64: return 8;
  }
  return 0;
}

std::int64_t PlyElement::smallest_binary_size() const {
  std::size_t size = 0;
  for (const PlyProperty& property : properties) size += size_of(property.is_list ? property.length_type : property.type);
  return static_cast<std::int64_t>(size);
}

PlyHeader read_ply_header(std::string_view bytes) { return HeaderReader(bytes).read(); }

}  // namespace satcheck::scene
