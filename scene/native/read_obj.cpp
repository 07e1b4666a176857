// Wavefront OBJ, after "Object Files (.obj)", appendix B1 of the Advanced Visualizer manual.
#include <array>
#include <algorithm>
#include <optional>

#include "builder.hpp"
#include "polygons.hpp"
#include "readers.hpp"
#include "text.hpp"

namespace satcheck::scene {
namespace {

// The meaning of each statement. Any other word is an error, because it could be misspelt geometry.
//   v, f, fo                 vertices and faces: read
//   o                        the faces that follow belong to another object: read
//   g                        no object; whether faces have several groups is noted
//   names and appearance     no geometry: accepted
//   lines, points, curves    no area, so they cannot collide: accepted with a warning
//   surfaces, other files    geometry that is not read: an error
//   a whole number alone     a count that some exporters write: accepted with a warning
constexpr std::array<std::string_view, 18> no_geometry = {
    "vt",     "vn",     "vp",    "vw",       "s",   "t",          "mg",        "usemtl", "mtllib",
    "usemap", "maplib", "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "res"};
constexpr std::array<std::string_view, 18> no_area = {"p",    "l",    "cdc",  "cstype", "deg", "bmat", "step",  "curv",  "curv2", "parm",
                                                      "trim", "hole", "scrv", "sp",     "end", "con",  "ctech", "stech"};
constexpr std::array<std::string_view, 4> surfaces = {"surf", "bsp", "bzp", "cdp"};
constexpr std::array<std::string_view, 2> other_files = {"call", "csh"};
constexpr std::array<std::string_view, 4> shapes = {"v", "f", "fo", "o"};

// More bodies than this are refused later; the last one has the other faces. So names take little memory.
constexpr std::size_t most_objects = 1'000'001;

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

class ObjReader {
 public:
  explicit ObjReader(std::string_view bytes) : bytes_(bytes) {}

  MeshData read() {
    if (const std::size_t zero = bytes_.find('\0'); zero != std::string_view::npos) {
      fail_at_byte(code::not_this_format, "not an OBJ file: binary data", static_cast<std::int64_t>(zero));
    }
    Lines lines(bytes_);
    std::string_view line;
    while (lines.next_joined(line)) statement(line.substr(0, line.find('#')), lines.number(), lines.joined());
    check_forward_references();
    report();
    return std::move(mesh_);
  }

 private:
  struct Reference {
    std::int64_t index;
    std::int64_t line;
  };

  void statement(std::string_view text, std::int64_t line, bool joined) {
    Words words(text);
    std::string_view keyword;
    if (!words.next(keyword)) return;
    if (keyword == "v") {
      vertex(words, line);
    } else if (keyword == "f" || keyword == "fo") {
      face(words, line);
    } else if (keyword == "o") {
      if (joined) check_swallowed(words, line);
      name_ = joined_words(words);
      in_object_ = false;
    } else if (keyword == "g") {
      if (joined) check_swallowed(words, line);
      group_ = joined_words(words);
      in_group_ = false;
    } else if (contains(no_geometry, keyword)) {
      if (joined) check_swallowed(words, line);
    } else if (contains(no_area, keyword)) {
      if (joined && keyword != "parm") check_swallowed(words, line);  // `parm v` is about a direction
      if (without_area_++ == 0) first_without_area_ = quoted(keyword) + " in line " + std::to_string(line);
    } else if (contains(surfaces, keyword)) {
      fail_at_line(code::unsupported_feature, "a free-form surface is not read", line);
    } else if (contains(other_files, keyword)) {
      fail_at_line(code::unsupported_feature, "what another file or a command adds is not read", line);
    } else if (is_whole_number(keyword) && (words.none_left() || is_header(words))) {
      if (counts_++ == 0) first_count_ = quoted(keyword) + " in line " + std::to_string(line);
    } else if (mesh_.vertices.empty() && mesh_.triangles.empty()) {
      fail_at_line(code::not_this_format, "not an OBJ file: unknown statement " + quoted(keyword), line);
    } else {
      fail_at_line(code::bad_record, "unknown statement " + quoted(keyword) + ": it could be geometry", line);
    }
  }

  static bool is_whole_number(std::string_view word) {
    return word.find_first_not_of("0123456789") == std::string_view::npos;
  }

  // Counts of vertices and faces before all statements, `6540 2180`: two numbers make no face.
  bool is_header(Words words) const {
    std::string_view word;
    const bool first = mesh_.vertices.empty() && mesh_.triangles.empty();
    return first && words.next(word) && is_whole_number(word) && words.none_left();
  }

  // A weight or a colour may follow; another word could be the next statement.
  void vertex(Words& words, std::int64_t line) {
    parse_vertex(words, line, mesh_);
    check_numbers(words, line);
  }

  // A name that ends with a backslash, such as a Windows folder, joins the next line to its statement.
  void check_swallowed(Words words, std::int64_t line) const {
    std::string_view word;
    while (words.next(word)) {
      if (!contains(shapes, word)) continue;
      fail_at_line(code::bad_record, "a backslash at the end of the line takes in " + quoted(word) + " from the next", line);
    }
  }

  // The name of an object or a group, which begins with its first face.
  static std::string joined_words(Words& words) {
    std::string name;
    for (std::string_view word; words.next(word);) name.append(name.empty() ? "" : " ").append(word);
    return name;
  }

  void face(Words& words, std::int64_t line) {
    if (!in_object_ && mesh_.objects.size() < most_objects) {
      mesh_.spans.push_back({static_cast<std::uint32_t>(mesh_.objects.size()), mesh_.triangles.size() / 3});
      mesh_.objects.push_back(name_);
    }
    in_object_ = true;
    if (!in_group_) {
      if (!first_group_) first_group_ = group_;
      mesh_.several_groups |= *first_group_ != group_;
    }
    in_group_ = true;
    corners_.clear();
    std::string_view word;
    while (words.next(word)) corners_.push_back(corner(word, line));
    polygons_.add(corners_, line, mesh_);
  }

  // `v`, `v/vt`, `v//vn` or `v/vt/vn`: only the vertex number matters.
  std::uint32_t corner(std::string_view word, std::int64_t line) {
    const std::int64_t count = static_cast<std::int64_t>(mesh_.vertices.size() / 3);
    const std::size_t slash = word.find('/');
    if (slash != std::string_view::npos &&
        word.find_first_not_of("-0123456789/", slash) != std::string_view::npos) {
      fail_at_line(code::bad_record, "expected a face corner, found " + quoted(word), line);
    }
    const std::int64_t number = parse_integer(word.substr(0, slash), line, "a vertex number");
    if (number == 0) {
      fail_at_line(code::index_out_of_range, "face index out of range: 0 (OBJ counts vertices from 1)", line);
    }
    const std::int64_t index = number > 0 ? number - 1 : count + number;
    if (index < 0 || index >= max_vertices) out_of_range(number, line, count);
    if (index >= count) forward_.push_back({index, line});
    return static_cast<std::uint32_t>(index);
  }

  [[noreturn]] void out_of_range(std::int64_t number, std::int64_t line, std::int64_t count) const {
    fail_at_line(code::index_out_of_range,
                 "face index out of range: " + std::to_string(number) + " of " + std::to_string(count) + " vertices",
                 line);
  }

  // A face may name vertices that come later in the file.
  void check_forward_references() const {
    const std::int64_t count = static_cast<std::int64_t>(mesh_.vertices.size() / 3);
    for (const Reference& reference : forward_) {
      if (reference.index >= count) out_of_range(reference.index + 1, reference.line, count);
    }
  }

  void report() {
    polygons_.finish("line", mesh_);
    if (without_area_ > 0) {
      const std::string statements = without_area_ == 1 ? " statement" : " statements";
      mesh_.warnings.push_back({code::ignored_geometry, std::to_string(without_area_) + statements +
                                                            " of lines, points or curves without area ignored (first: " +
                                                            first_without_area_ + ")"});
    }
    if (counts_ > 0) {
      mesh_.warnings.push_back({code::unknown_statement, std::to_string(counts_) + (counts_ == 1 ? " line" : " lines") +
                                                             " of counts ignored (first: " + first_count_ + ")"});
    }
  }

  std::string_view bytes_;
  MeshData mesh_;
  Polygons polygons_;
  std::vector<std::uint32_t> corners_;
  std::vector<Reference> forward_;
  std::int64_t without_area_ = 0, counts_ = 0;
  std::string first_without_area_, first_count_;
  std::string name_, group_;  // of the object, of the group
  std::optional<std::string> first_group_;
  bool in_object_ = false, in_group_ = true;
};

}  // namespace

ReadOutcome read_obj(std::string_view bytes) {
  return run_reader([&] { return ObjReader(bytes).read(); });
}

std::vector<Object> split_objects(const MeshData& mesh) {
  std::vector<Object> objects;
  if (mesh.objects.size() < 2) return objects;
  struct Range {
    std::uint32_t object;
    std::size_t first, last;  // corners
  };
  std::vector<Range> ranges;
  for (std::size_t k = 0; k < mesh.spans.size(); ++k) {
    const std::size_t last = k + 1 < mesh.spans.size() ? 3 * mesh.spans[k + 1].first : mesh.triangles.size();
    if (3 * mesh.spans[k].first < last) ranges.push_back({mesh.spans[k].object, 3 * mesh.spans[k].first, last});
  }
  std::stable_sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) { return a.object < b.object; });
  const std::size_t count = mesh.vertices.size() / 3;
  std::vector<std::uint32_t> place(count), user(count);  // user: the last object that has the vertex, counted from 1
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const auto [object, first, last] = ranges[k];
    if (k == 0 || ranges[k - 1].object != object) objects.push_back({mesh.objects[object], {}});
    MeshData& part = objects.back().mesh;
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t v = mesh.triangles[i];
      if (user[v] != object + 1) {
        user[v] = object + 1;
        place[v] = static_cast<std::uint32_t>(part.vertices.size() / 3);
        part.vertices.insert(part.vertices.end(), &mesh.vertices[3 * std::size_t{v}], &mesh.vertices[3 * std::size_t{v}] + 3);
      }
      part.triangles.push_back(place[v]);
    }
  }
  return objects;
}

}  // namespace satcheck::scene
