#include "text.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <version>

#include "readers.hpp"

#if !defined(__cpp_lib_to_chars)
#include <locale>
#include <sstream>
#endif

namespace satcheck::scene {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// A number as written: its grammar and precision, and whether it overflows or underflows.
struct Written {
  bool valid = false;
  bool has_exponent = false;
  int decimals = 0;            // digits after the point
  int significant = 0;         // digits from the first non-zero one on
  std::int64_t magnitude = 0;  // power of ten of the first non-zero digit, exponent included
};

constexpr std::int64_t exponent_cap = 1000000;  // far beyond float64, far below overflow of the sum

Written scan_number(std::string_view word) {
  Written written;
  std::size_t i = 0;
  int digits = 0, whole = 0, leading_zeros = 0;
  bool point = false, nonzero = false;
  if (i < word.size() && (word[i] == '-' || word[i] == '+')) ++i;
  for (; i < word.size() && (is_digit(word[i]) || (word[i] == '.' && !point)); ++i) {
    if (word[i] == '.') {
      point = true;
      continue;
    }
    ++digits;
    nonzero = nonzero || word[i] != '0';
    if (nonzero) ++written.significant;
    if (!nonzero) ++leading_zeros;
    if (point) ++written.decimals;
    if (!point) ++whole;
  }
  if (digits == 0) return written;
  std::int64_t exponent = 0;
  if (i < word.size() && (word[i] == 'e' || word[i] == 'E')) {
    written.has_exponent = true;
    bool negative = false;
    if (++i < word.size() && (word[i] == '-' || word[i] == '+')) negative = word[i++] == '-';
    if (i == word.size()) return written;
    for (; i < word.size() && is_digit(word[i]); ++i) {
      exponent = std::min(exponent * 10 + (word[i] - '0'), exponent_cap);
    }
    if (negative) exponent = -exponent;
  }
  written.magnitude = whole - 1 - leading_zeros + exponent;
  written.valid = i == word.size();
  return written;
}

bool names_non_finite(std::string_view word) {
  if (!word.empty() && (word[0] == '-' || word[0] == '+')) word.remove_prefix(1);
  return same_word(word.substr(0, 3), "nan") || same_word(word.substr(0, 3), "inf");
}

// `word` is known to be a plain decimal number without a plus sign.
bool convert(std::string_view word, double& value) {
#if defined(__cpp_lib_to_chars)
  return std::from_chars(word.data(), word.data() + word.size(), value).ec == std::errc{};
#else
  // Standard libraries without the floating-point overload: slower, but just as independent of the locale.
  std::istringstream stream{std::string(word)};
  stream.imbue(std::locale::classic());
  stream >> value;
  return !stream.fail();
#endif
}

}  // namespace

Lines::Lines(std::string_view text, std::int64_t first_number)
    : text_(text), number_(first_number - 1), following_number_(first_number) {
  const bool has_line_feed = text.find('\n') != std::string_view::npos;
  terminator_ = has_line_feed ? '\n' : '\r';
}

bool Lines::next(std::string_view& line) {
  if (at_end()) return false;
  const char* begin = text_.data() + offset_;
  const std::size_t left = text_.size() - offset_;
  const void* end = std::memchr(begin, terminator_, left);
  const std::size_t length = end ? static_cast<std::size_t>(static_cast<const char*>(end) - begin) : left;
  line = text_.substr(offset_, length);
  offset_ += length + (end ? 1 : 0);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  number_ = following_number_++;
  return true;
}

bool Lines::next_filled(std::string_view& line, char comment) {
  while (next(line)) {
    line = line.substr(0, line.find(comment));
    if (!Words(line).none_left()) return true;
  }
  return false;
}

bool Lines::next_joined(std::string_view& line) {
  joined_.clear();
  if (!next(line)) return false;
  // A comment ends with its line: one that ends in a Windows path must not swallow the vertex below it.
  const bool continued = !line.empty() && line.back() == '\\' && line.find('#') == std::string_view::npos;
  if (!continued) return true;
  const std::int64_t first = number_;
  do {
    joined_.append(line.substr(0, line.size() - 1));
    joined_.push_back(' ');
    if (!next(line)) {
      line = {};
      break;
    }
  } while (!line.empty() && line.back() == '\\');
  joined_.append(line);
  line = joined_;
  number_ = first;
  return true;
}

bool Words::next(std::string_view& word) {
  std::size_t begin = 0;
  while (begin < rest_.size() && is_blank(rest_[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest_.size() && !is_blank(rest_[end])) ++end;
  word = rest_.substr(begin, end - begin);
  rest_.remove_prefix(end);
  return !word.empty();
}

bool Words::none_left() { return std::all_of(rest_.begin(), rest_.end(), is_blank); }

bool same_word(std::string_view word, std::string_view lower_case) {
  return word.size() == lower_case.size() &&
         std::equal(word.begin(), word.end(), lower_case.begin(), [](char a, char b) { return lower(a) == b; });
}

std::string quoted(std::string_view word) {
  constexpr std::size_t longest = 24;  // characters, so that a message is one line
  std::string text = "'";
  for (char c : word.substr(0, longest)) text.push_back(c >= ' ' && c <= '~' ? c : '?');
  text += word.size() > longest ? "...'" : "'";
  return text;
}

double parse_coordinate(std::string_view word, std::int64_t line, MeshData& mesh) {
  const Written written = scan_number(word);
  if (!written.valid) {
    if (names_non_finite(word)) fail_at_line(code::non_finite, "non-finite coordinate " + quoted(word), line);
    fail_at_line(code::bad_record, "expected a coordinate, found " + quoted(word), line);
  }
  if (written.has_exponent) {
    mesh.significant = std::max(mesh.significant, written.significant);
  } else {
    mesh.decimals = std::max(mesh.decimals, written.decimals);
  }
  if (word.front() == '+') word.remove_prefix(1);
  double value = 0;
  if (convert(word, value)) return value;
  if (written.significant > 0 && written.magnitude > 0) {
    fail_at_line(code::non_finite, "coordinate " + quoted(word) + " is too large for float64", line);
  }
  return 0.0;  // below the smallest float64: nearest is zero
}

void parse_vertex(Words& words, std::int64_t line, MeshData& mesh) {
  for (int axis = 0; axis < 3; ++axis) {
    std::string_view word;
    if (!words.next(word)) fail_at_line(code::bad_record, "a vertex needs 3 coordinates", line);
    mesh.vertices.push_back(parse_coordinate(word, line, mesh));
  }
}

void check_numbers(Words& words, std::int64_t line) {
  std::string_view word;
  while (words.next(word)) {
    if (!scan_number(word).valid && !names_non_finite(word)) {
      fail_at_line(code::bad_record, "expected a number, found " + quoted(word), line);
    }
  }
}

ReadOutcome read_coordinates(std::string_view bytes) {
  return run_reader([&]() -> ReadOutcome {
    MeshData mesh;
    Lines lines(bytes);
    for (std::string_view line, word; lines.next(line);) {
      Words words(line);
      words.next(word);
      if (!words.none_left()) fail_at_line(code::bad_record, "expected one coordinate, found " + quoted(line), lines.number());
      mesh.vertices.push_back(parse_coordinate(word, lines.number(), mesh));
    }
    return mesh;
  });
}

std::int64_t parse_integer(std::string_view word, std::int64_t line, const char* what) {
  std::int64_t value = 0;
  const char* end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, value);
  if (result.ec == std::errc::result_out_of_range) {
    fail_at_line(code::index_out_of_range, std::string(what) + " " + quoted(word) + " is out of range", line);
  }
  if (result.ec != std::errc{} || result.ptr != end) {
    fail_at_line(code::bad_record, std::string("expected ") + what + ", found " + quoted(word), line);
  }
  return value;
}

}  // namespace satcheck::scene
