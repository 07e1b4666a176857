// Stereolithography files: "StereoLithography Interface Specification", 3D Systems, 1989. Facet normals and
// attribute bytes are ignored: the corners carry the orientation.
#include "base/large_pages.hpp"
#include "builder.hpp"
#include "bytes.hpp"
#include "corners.hpp"
#include "readers.hpp"
#include "text.hpp"

namespace satcheck::scene {
namespace {

constexpr std::size_t header_size = 84;  // 80 bytes of text, then the facet count
constexpr std::size_t facet_size = 50;   // normal, three corners, two attribute bytes
constexpr std::size_t normal_size = 12;
constexpr std::size_t count_offset = 80;

// Facets that are read before the corners of the first are looked up, which then need not wait for memory.
constexpr std::size_t ahead = 16;

using Facet = std::array<Corners<float>::Point, 3>;

// All exponents at once: that of what is infinite or no number has every bit set.
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

MeshData read_binary(std::string_view bytes, std::size_t count) {
  if (count > static_cast<std::size_t>(max_vertices) / 3) {
    fail(code::too_large, std::to_string(count) + " facets are more than 32-bit vertex numbers can hold");
  }
  MeshData mesh;
  mesh.precision = Precision::float32;
  const std::size_t expected = count / 2;  // vertices: of a closed surface of few handles
  mesh.vertices = with_room<double>(expected * 3);
  mesh.triangles = with_room<std::uint32_t>(count * 3);
  Corners<float> corners(expected);
  struct Waiting {
    Facet facet;
    std::array<std::uint64_t, 3> hash;
  };
  std::array<Waiting, ahead> waiting;
  for (std::size_t i = 0; i < count + ahead; ++i) {
    auto& [facet, hash] = waiting[i % ahead];
    if (i >= ahead) {
      for (std::size_t k = 0; k < 3; ++k) mesh.triangles.push_back(corners.number(facet[k], hash[k], mesh.vertices));
    }
    if (i < count) {
      const std::size_t offset = header_size + i * facet_size + normal_size;
      const char* from = bytes.data() + offset;
      std::memcpy(&facet, from, sizeof facet);
      if (!is_finite(facet)) fail_at_coordinate(facet, i, offset);
      for (std::size_t k = 0; k < 3; ++k) corners.fetch(hash[k] = corners.hash(from + k * sizeof facet[k]));
    }
  }
  return mesh;
}

// Words over line ends, as ASCII STL is free-form but for the names behind `solid` and `endsolid`.
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
  void skip_line() { words_ = Words({}); }
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
    while (words_.next(word)) {
      if (!open && same_word(word, "solid")) {
        open = true;
        words_.skip_line();
      } else if (open && same_word(word, "endsolid")) {
        open = false;
        words_.skip_line();
      } else if (open && same_word(word, "facet")) {
        facet();
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
  void expect(std::string_view keyword) {
    const std::string_view word = any(keyword);
    if (!same_word(word, keyword)) {
      fail_at_line(code::bad_record, "expected " + std::string(keyword) + ", found " + quoted(word), words_.line());
    }
  }

  std::string_view any(std::string_view expected) {
    std::string_view word;
    if (!words_.next(word)) {
      fail_at_line(code::truncated, "truncated: the file ends where " + std::string(expected) + " should follow",
                   words_.line());
    }
    return word;
  }

  void facet() {
    expect("normal");
    for (int i = 0; i < 3; ++i) any("a normal");
    expect("outer");
    expect("loop");
    if (static_cast<std::int64_t>(mesh_.vertices.size() / 3) > max_vertices - 3) {
      fail(code::too_large, "more facets than 32-bit vertex numbers can hold");
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
    expect("endloop");
    expect("endfacet");
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

std::string promise(std::size_t count, std::size_t body) {
  return "the header promises " + std::to_string(count) + " facets, the file has room for " +
         std::to_string(body / facet_size);
}

MeshData read(std::string_view bytes) {
  std::size_t count = 0, body = 0;
  if (bytes.size() >= header_size) {
    count = load<std::uint32_t>(bytes.data() + count_offset);
    body = bytes.size() - header_size;
    // The size decides, not the first word: exporters write binary files whose header starts with "solid".
    if (body % facet_size == 0 && body / facet_size == count) return read_binary(bytes, count);
  }
  if (looks_like_ascii(bytes)) return AsciiStlReader(bytes).read();
  if (bytes.size() < header_size) {
    fail(code::not_this_format, "not an STL file: " + std::to_string(bytes.size()) +
                                    " bytes are too few for a binary header, and it does not start with solid");
  }
  if (body / facet_size < count) {
    fail_at_byte(code::truncated, "truncated, or not an STL file: " + promise(count, body),
                 static_cast<std::int64_t>(bytes.size()));
  }
  fail_at_byte(code::trailing_data, "trailing bytes, or not an STL file: " + promise(count, body),
               static_cast<std::int64_t>(header_size + count * facet_size));
}

}  // namespace

ReadOutcome read_stl(std::string_view bytes) {
  return run_reader([&] {
    MeshData mesh = read(bytes);
    require_triangles(mesh);
    return mesh;
  });
}

}  // namespace satcheck::scene
