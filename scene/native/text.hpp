// Lines, words and numbers of a text format, with line numbers and independent of the locale.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "builder.hpp"

namespace satcheck::scene {

// Iterates over the lines of a text. LF, CR LF and lone CR end a line.
class Lines {
 public:
  explicit Lines(std::string_view text, std::int64_t first_number = 1);

  // The next line without its end, or false at the end of the text.
  bool next(std::string_view& line);
  // As `next`, but skips lines that hold only blanks and, from `comment` on, drops the rest of a line.
  bool next_filled(std::string_view& line, char comment);
  // As `next`; a backslash at the end of a line without a comment joins the following one.
  bool next_joined(std::string_view& line);

  std::int64_t number() const { return number_; }  // of the line last returned (its first physical line)
  std::size_t offset() const { return offset_; }   // of the first byte after it
  bool joined() const { return !joined_.empty(); }  // whether `next_joined` made it of several
  bool at_end() const { return offset_ >= text_.size(); }

 private:
  std::string_view text_;
  std::size_t offset_ = 0;
  std::int64_t number_;
  std::int64_t following_number_;
  char terminator_;
  std::string joined_;
};

// Splits a line into words at blanks.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  bool next(std::string_view& word);
  bool none_left();

 private:
  std::string_view rest_;
};

bool same_word(std::string_view word, std::string_view lower_case);  // ASCII, ignoring case
std::string quoted(std::string_view word);  // for messages: printable ASCII only, shortened

// A finite coordinate; throws bad_record or non_finite at `line`. Its digits are noted in `mesh`.
double parse_coordinate(std::string_view word, std::int64_t line, MeshData& mesh);

// Reads three coordinates and appends them as a vertex.
void parse_vertex(Words& words, std::int64_t line, MeshData& mesh);

// Throws bad_record at `line` unless each word that is left is a number, infinite or nan as it may be.
void check_numbers(Words& words, std::int64_t line);

// The whole `word` as a decimal integer; throws bad_record at `line`.
std::int64_t parse_integer(std::string_view word, std::int64_t line, const char* what);

}  // namespace satcheck::scene
