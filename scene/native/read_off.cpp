// Object File Format (Geomview), ASCII, three-dimensional. Each vertex and each face begins a line.
#include "builder.hpp"
#include "polygons.hpp"
#include "readers.hpp"
#include "text.hpp"

namespace satcheck::scene {
namespace {

constexpr char comment = '#';

class OffReader {
 public:
  explicit OffReader(std::string_view bytes) : bytes_(bytes), lines_(bytes) {}

  MeshData read() {
    if (bytes_.find('\0') != std::string_view::npos) {
      fail(code::unsupported_feature, "binary data: only ASCII OFF files are read");
    }
    header();
    for (std::int64_t i = 0; i < vertex_count_; ++i) vertex(i);
    for (std::int64_t i = 0; i < face_count_; ++i) face(i);
    std::string_view line;
    if (lines_.next_filled(line, comment)) {
      fail_at_line(code::trailing_data, "more lines than the header promises", lines_.number());
    }
    polygons_.finish("line", mesh_);
    return std::move(mesh_);
  }

 private:
  // `OFF`, with letters in front of it for what follows each position (texture coordinates ST, colour C, normal N); it may
  // be left out. The counts follow in the same line, even without a blank, or in the next. Of spaces of other dimensions
  // (4OFF, nOFF) those of 3 are read.
  void header() {
    std::string_view line = required_line("the header");
    Words words(line);
    std::string_view word;
    words.next(word);
    std::string_view kind = word;
    while (!kind.starts_with("OFF")) {
      const std::size_t length = kind.starts_with("ST") ? 2 : 1;
      if (length == 1 && (kind.empty() || std::string_view("CNn4").find(kind[0]) == std::string_view::npos)) break;
      any_dimension_ = any_dimension_ || kind[0] == 'n';
      if (kind[0] == '4') other_dimension("homogeneous coordinates: only three-dimensional OFF files are read");
      kind.remove_prefix(length);
    }
    if (kind.starts_with("OFF")) {
      kind.remove_prefix(3);
      words = Words(line.substr(static_cast<std::size_t>(kind.data() - line.data())));
    } else if (is_count(word)) {
      words = Words(line);
    } else {
      fail_at_line(code::not_this_format, "not an OFF file: it starts with " + quoted(word), lines_.number());
    }
    counts(words);
  }

  void counts(Words words) {
    const auto on_a_line = [&](const char* what) {
      if (words.none_left()) words = Words(required_line(what));
    };
    on_a_line("the counts");
    if (any_dimension_) {
      if (count(words, "a dimension") != 3) other_dimension("only three-dimensional OFF files are read");
      on_a_line("the counts");
    }
    vertex_count_ = count(words, "a vertex count");
    face_count_ = count(words, "a face count");
    std::string_view edges;
    if (words.next(edges)) parse_integer(edges, lines_.number(), "an edge count");
    if (!words.none_left()) fail_at_line(code::bad_record, "more than three counts", lines_.number());
  }

  [[noreturn]] void other_dimension(const char* message) const {
    fail_at_line(code::unsupported_feature, message, lines_.number());
  }

  static bool is_count(std::string_view word) { return word.find_first_not_of("0123456789") == std::string_view::npos; }

  std::int64_t count(Words& words, const char* what) {
    std::string_view word;
    if (!words.next(word)) fail_at_line(code::bad_record, std::string("missing ") + what, lines_.number());
    const std::int64_t value = parse_integer(word, lines_.number(), what);
    if (value < 0 || value > max_vertices || value > static_cast<std::int64_t>(bytes_.size())) {
      fail_at_line(code::count_mismatch, std::string(what) + " of " + std::to_string(value) +
                                             " does not fit into a file of " + std::to_string(bytes_.size()) + " bytes",
                   lines_.number());
    }
    return value;
  }

  std::string_view required_line(const std::string& what) {
    std::string_view line;
    if (!lines_.next_filled(line, comment)) {
      fail_at_line(code::truncated, "truncated: the file ends before " + what, lines_.number());
    }
    return line;
  }

  // The words of one record. It may continue in the next lines; it then ends at the end of a line.
  class Record {
   public:
    Record(OffReader& reader, std::string what)
        : reader_(reader), what_(std::move(what)), words_(reader.required_line(what_)), line_(reader.lines_.number()) {}

    std::string_view next() {
      std::string_view word;
      while (!words_.next(word)) {
        words_ = Words(reader_.required_line("the end of " + what_));
        goes_on_ = true;
      }
      return word;
    }
    // Colours and similar data may follow a record of one line.
    void end() {
      if (goes_on_ && !words_.none_left()) {
        fail_at_line(code::bad_record, "bad record: " + what_ + " ends within a line", reader_.lines_.number());
      }
      check_numbers(words_, line_);
    }
    std::int64_t line() const { return line_; }

   private:
    OffReader& reader_;
    std::string what_;
    Words words_;
    std::int64_t line_;
    bool goes_on_ = false;
  };

  void vertex(std::int64_t i) {
    Record record(*this, "vertex " + std::to_string(i + 1) + " of " + std::to_string(vertex_count_));
    for (int axis = 0; axis < 3; ++axis) mesh_.vertices.push_back(parse_coordinate(record.next(), lines_.number(), mesh_));
    record.end();
  }

  void face(std::int64_t i) {
    Record record(*this, "face " + std::to_string(i + 1) + " of " + std::to_string(face_count_));
    const std::int64_t sides = parse_integer(record.next(), record.line(), "the number of corners");
    if (sides < 0) fail_at_line(code::bad_record, "bad face record: negative number of corners", record.line());
    corners_.clear();
    for (std::int64_t corner = 0; corner < sides; ++corner) {
      const std::int64_t index = parse_integer(record.next(), lines_.number(), "a vertex number");
      if (index < 0 || index >= vertex_count_) {
        fail_at_line(code::index_out_of_range, "face index out of range: " + std::to_string(index) + " of " +
                                                   std::to_string(vertex_count_) + " vertices",
                     lines_.number());
      }
      corners_.push_back(static_cast<std::uint32_t>(index));
    }
    record.end();
    polygons_.add(corners_, record.line(), mesh_);
  }

  std::string_view bytes_;
  Lines lines_;
  MeshData mesh_;
  Polygons polygons_;
  bool any_dimension_ = false;
  std::int64_t vertex_count_ = 0, face_count_ = 0;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

ReadOutcome read_off(std::string_view bytes) {
  return run_reader([&] { return OffReader(bytes).read(); });
}

}  // namespace satcheck::scene
