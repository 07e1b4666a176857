// Wavefront OBJ, after "Object Files (.obj)", appendix B1 of the Advanced Visualizer manual.
#include <array>
#include <algorithm>

#include "builder.hpp"
#include "readers.hpp"
#include "text.hpp"

namespace satcheck::scene {
namespace {

constexpr std::array<std::string_view, 19> not_geometry = {
    "vt", "vn", "vp", "o",        "g",         "s",     "mg",       "usemtl",   "mtllib",  "usemap",
    "maplib", "l", "p",  "shadow_obj", "trace_obj", "lod", "bevel", "c_interp", "d_interp"};
// Of curves, which are no surface.
constexpr std::array<std::string_view, 15> free_form = {"cstype", "deg",  "bmat", "step", "curv", "curv2", "parm", "trim",
                                                        "hole",   "scrv", "sp",   "end",  "con",  "ctech", "stech"};

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Statements that were passed over, reported once a kind.
struct Skipped {
  std::int64_t count = 0;
  std::int64_t first_line = 0;
  std::string first_word;

  void add(std::string_view word, std::int64_t line) {
    if (count++ > 0) return;
    first_line = line;
    first_word = quoted(word);
  }
  std::string text(const char* what) const {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s") + " ignored (first: " + first_word + " in line " +
           std::to_string(first_line) + ")";
  }
};

class ObjReader {
 public:
  explicit ObjReader(std::string_view bytes) : bytes_(bytes) {}

  MeshData read() {
    if (const std::size_t zero = bytes_.find('\0'); zero != std::string_view::npos) {
      fail_at_byte(code::not_this_format, "not an OBJ file: binary data", static_cast<std::int64_t>(zero));
    }
    Lines lines(bytes_);
    std::string_view line;
    while (lines.next_joined(line)) statement(line.substr(0, line.find('#')), lines.number());
    check_forward_references();
    report();
    return std::move(mesh_);
  }

 private:
  struct Reference {
    std::int64_t index;
    std::int64_t line;
  };

  void statement(std::string_view text, std::int64_t line) {
    Words words(text);
    std::string_view keyword;
    if (!words.next(keyword)) return;
    if (keyword == "v") {
      parse_vertex(words, line, mesh_);  // what follows is a weight or a colour
    } else if (keyword == "f" || keyword == "fo") {
      face(words, line);
    } else if (keyword == "surf") {
      fail_at_line(code::unsupported_feature, "a free-form surface is not read", line);
    } else if (keyword == "call") {
      fail_at_line(code::unsupported_feature, "what another file holds is not read", line);
    } else if (contains(free_form, keyword)) {
      free_form_.add(keyword, line);
    } else if (!contains(not_geometry, keyword)) {
      unknown_.add(keyword, line);
    }
  }

  void face(Words& words, std::int64_t line) {
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

  // A face may name vertices that the file only writes later.
  void check_forward_references() const {
    const std::int64_t count = static_cast<std::int64_t>(mesh_.vertices.size() / 3);
    for (const Reference& reference : forward_) {
      if (reference.index >= count) out_of_range(reference.index + 1, reference.line, count);
    }
  }

  void report() {
    if (mesh_.vertices.empty() && mesh_.triangles.empty() && unknown_.count > 0) {
      fail_at_line(code::not_this_format, "not an OBJ file: no vertices, and unknown statement " + unknown_.first_word,
                   unknown_.first_line);
    }
    polygons_.report("line", mesh_);
    if (free_form_.count > 0) {
      mesh_.warnings.push_back({code::ignored_geometry, free_form_.text("free-form curve statement")});
    }
    if (unknown_.count > 0) {
      mesh_.warnings.push_back({code::unknown_statement, unknown_.text("unknown statement")});
    }
    require_triangles(mesh_);
  }

  std::string_view bytes_;
  MeshData mesh_;
  Polygons polygons_;
  std::vector<std::uint32_t> corners_;
  std::vector<Reference> forward_;
  Skipped unknown_, free_form_;
};

}  // namespace

ReadOutcome read_obj(std::string_view bytes) {
  return run_reader([&] { return ObjReader(bytes).read(); });
}

}  // namespace satcheck::scene
