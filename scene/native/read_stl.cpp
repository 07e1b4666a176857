// Stereolithography files: "StereoLithography Interface Specification", 3D Systems, 1989. Facet normals and
// attribute bytes are ignored: the corners carry the orientation.
#include <algorithm>
#include <array>
#include <vector>

#include "base/large_pages.hpp"
#include "builder.hpp"
#include "corners.hpp"
#include "readers.hpp"
#include "text.hpp"

namespace satcheck::scene {
namespace {

constexpr std::size_t header_size = 84;  // 80 bytes of text, then the facet count
constexpr std::size_t facet_size = 50;   // normal, three corners, two attribute bytes
constexpr std::size_t normal_size = 12;
constexpr std::size_t count_offset = 80;

// The number of facets read ahead, so that the lookups of corners do not wait for memory.
constexpr std::size_t ahead = 16;

using Facet = std::array<Corners<float>::Point, 3>;

// Tests all exponents at once. The exponent of an infinite number or nan has all bits set.
bool is_finite(const Facet& facet) {
  constexpr std::uint32_t kExponent = 0x7F800000;
  bool finite = true;
  for (const auto& point : facet) {
    for (const float c : point) finite &= (std::bit_cast<std::uint32_t>(c) & kExponent) != kExponent;
  }
  return finite;
}

[[noreturn]] void fail_at_coordinate(const Facet& facet, std::size_t number, std::size_t offset) {
  std::size_t i = 0;
  while (std::isfinite(facet[i / 3][i % 3])) ++i;
  fail_at_byte(code::non_finite, "non-finite coordinate in facet " + std::to_string(number + 1),
               static_cast<std::int64_t>(offset + i * sizeof(float)));
}

// Reads facets one after another.
class BinaryReader {
 public:
  explicit BinaryReader(std::size_t count) : corners_(vertices_of(count)) {
    mesh_.number_format = NumberFormat::float32;
    mesh_.vertices = with_room<double>(vertices_of(count) * 3);
    mesh_.triangles = with_room<std::uint32_t>(count * 3);
    mesh_.triangles.resize(count * 3);
    triangles_ = mesh_.triangles.data();
  }

  MeshData read(std::string_view facets) {
    const std::size_t count = facets.size() / facet_size;
    const char* from = facets.data() + normal_size;
    for (std::size_t i = 0; i < count; ++i, from += facet_size) {
      if (i >= ahead) number(waiting_[i % ahead]);
      auto& [facet, hash] = waiting_[i % ahead];
      std::memcpy(&facet, from, sizeof facet);
      if (!is_finite(facet)) fail_at_coordinate(facet, i, header_size + i * facet_size + normal_size);
      for (std::size_t k = 0; k < 3; ++k) corners_.fetch(hash[k] = corners_.hash(from + k * sizeof facet[k]));
    }
    for (std::size_t i = count - std::min(count, ahead); i < count; ++i) number(waiting_[i % ahead]);
    return std::move(mesh_);
  }

 private:
  struct Waiting {
    Facet facet;
    std::array<std::uint64_t, 3> hash;
  };

  static std::size_t vertices_of(std::size_t count) {
    if (count > static_cast<std::size_t>(max_vertices) / 3) {
      fail(code::too_large, std::to_string(count) + " facets are more than 32-bit vertex numbers can hold: split the file");
    }
    return count / 2;  // for a closed surface with few handles
  }

  void number(const Waiting& next) {
    for (std::size_t k = 0; k < 3; ++k) *triangles_++ = corners_.number(next.facet[k], next.hash[k], mesh_.vertices);
  }

  MeshData mesh_;
  Corners<float> corners_;
  std::array<Waiting, ahead> waiting_;
  std::uint32_t* triangles_;  // the next vertex number
};

// Words across line ends. ASCII STL is free-form except for the names after `solid` and `endsolid`.
class StlWords {
 public:
  explicit StlWords(std::string_view text) : lines_(text), words_({}) {}

  bool next(std::string_view& word) {
    while (!words_.next(word)) {
      std::string_view line;
      if (!lines_.next(line)) return false;
      words_ = Words(line);
    }
    return true;
  }
  // The next word of the same line.
  bool next_in_line(std::string_view& word) { return words_.next(word); }
  bool peek_in_line(std::string_view& word) const { return Words(words_).next(word); }
  std::int64_t line() const { return lines_.number(); }

 private:
  Lines lines_;
  Words words_;
};

class AsciiStlReader {
 public:
  explicit AsciiStlReader(std::string_view text) : words_(text) {}

  MeshData read() {
    std::string_view word;
    bool open = false;
    std::size_t start = 0;  // of a solid
    while (words_.next(word)) {
      if (!open && same_word(word, "solid")) {
        open = true;
        start = mesh_.triangles.size();
        if (name_ends_in_facet()) facet_after_normal();
      } else if (open && ends(word, "endsolid")) {
        open = false;
        mesh_.several_groups |= 0 < start && start < mesh_.triangles.size();
        if (name_ends_in_facet()) fail_at_line(code::trailing_data, "a facet after endsolid", words_.line());
      } else if (open && same_word(word, "facet")) {
        expect("normal");
        facet_after_normal();
      } else {
        fail_at_line(open ? code::bad_record : code::trailing_data,
                     std::string("expected ") + (open ? "facet or endsolid" : "solid or the end of the file") +
                         ", found " + quoted(word),
                     words_.line());
      }
    }
    if (open) fail_at_line(code::truncated, "truncated: the file ends without endsolid", words_.line());
    return std::move(mesh_);
  }

 private:
  // Takes a name up to the end of its line, or up to `facet normal` there: then true.
  bool name_ends_in_facet() {
    std::string_view word;
    for (bool facet = false; words_.next_in_line(word); facet = same_word(word, "facet")) {
      if (facet && same_word(word, "normal")) return true;
    }
    return false;
  }

  // Whether `word`, just read, is the keyword, as `endloop`, or its first half, as some exporters write `end loop`.
  bool ends(std::string_view word, std::string_view keyword) {
    constexpr std::string_view end = "end";
    return same_word(word, keyword) || (same_word(word, end) && same_word(any(keyword), keyword.substr(end.size())));
  }

  void expect_end(std::string_view keyword) {
    const std::string_view word = any(keyword);
    if (!ends(word, keyword)) expected(std::string(keyword), word);
  }

  void expect(std::string_view keyword) {
    const std::string_view word = any(keyword);
    if (!same_word(word, keyword)) expected(std::string(keyword), word);
  }

  [[noreturn]] void expected(const std::string& what, std::string_view word) const {
    fail_at_line(code::bad_record, "expected " + what + ", found " + quoted(word), words_.line());
  }

  // The next word, of any kind.
  std::string_view any(std::string_view expected) {
    std::string_view word;
    if (!words_.next(word)) {
      fail_at_line(code::truncated, "truncated: the file ends where " + std::string(expected) + " should follow",
                   words_.line());
    }
    return word;
  }

  void facet_after_normal() {
    for (int i = 0; i < 3; ++i) any("a normal");
    expect("outer");
    expect("loop");
    if (static_cast<std::int64_t>(mesh_.vertices.size() / 3) > max_vertices - 3) {
      fail(code::too_large, "more facets than 32-bit vertex numbers can hold: split the file");
    }
    for (int corner = 0; corner < 3; ++corner) {
      expect("vertex");
      Corners<double>::Point point;
      for (double& coordinate : point) {
        const std::string_view word = any("a coordinate");
        coordinate = parse_coordinate(word, words_.line(), mesh_);
      }
      mesh_.triangles.push_back(corners_.number(point, corners_.hash(&point), mesh_.vertices));
    }
    expect_end("endloop");
    skip_remark();
    expect_end("endfacet");
    skip_remark();
  }

  // Skips remarks that some exporters write after the end of a loop or facet, such as a number or a colour: up to the
  // end of the line, or up to a keyword.
  void skip_remark() {
    static constexpr std::array<std::string_view, 9> keywords = {"facet", "outer",   "loop",     "vertex",  "solid",
                                                          "end",   "endloop", "endfacet", "endsolid"};
    const auto is_keyword = [](std::string_view word) {
      return std::any_of(keywords.begin(), keywords.end(), [&](std::string_view known) { return same_word(word, known); });
    };
    std::string_view word;
    while (words_.peek_in_line(word) && !is_keyword(word)) words_.next_in_line(word);
  }

  StlWords words_;
  MeshData mesh_;
  Corners<double> corners_{0};
};

bool looks_like_ascii(std::string_view bytes) {
  std::string_view word;
  const bool starts_as_solid = StlWords(bytes).next(word) && same_word(word, "solid");
  return starts_as_solid && bytes.find('\0') == std::string_view::npos;
}

// The number of facets by the binary header, if the file is long enough for one, and by the size of the file.
struct Promise {
  explicit Promise(std::string_view bytes) {
    if (bytes.size() < header_size) return;
    count = load<std::uint32_t>(bytes.data() + count_offset);
    body = bytes.size() - header_size;
    // The size decides, not the first word: exporters write binary files whose header starts with "solid".
    is_kept = body % facet_size == 0 && body / facet_size == count;
  }

  [[noreturn]] void fail_unkept() const {
    const std::string promise = "the header promises " + std::to_string(count) + " facets, the file has room for " +
                                std::to_string(body / facet_size);
    if (body / facet_size < count) {
      fail_at_byte(code::truncated, "truncated, or not an STL file: " + promise, static_cast<std::int64_t>(header_size + body));
    }
    fail_at_byte(code::trailing_data, "trailing bytes, or not an STL file: " + promise,
                 static_cast<std::int64_t>(header_size + count * facet_size));
  }

  std::size_t count = 0, body = 0;
  bool is_kept = false;
};

MeshData read(std::string_view bytes) {
  const Promise promise(bytes);
  if (promise.is_kept) return BinaryReader(promise.count).read(bytes.substr(header_size));
  if (looks_like_ascii(bytes)) return AsciiStlReader(bytes).read();
  if (bytes.size() < header_size) {
    fail(code::not_this_format, "not an STL file: " + std::to_string(bytes.size()) +
                                    " bytes are too few for a binary header, and it does not start with solid");
  }
  promise.fail_unkept();
}

}  // namespace

ReadOutcome read_stl(std::string_view bytes) {
  return run_reader([&] { return read(bytes); });
}

}  // namespace satcheck::scene
