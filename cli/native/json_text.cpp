#include "json_text.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace satcheck::cli {
namespace {

// Exponents from which on repr writes one.
constexpr int kFirstSmall = -5;
constexpr int kFirstLarge = 16;
// The numbers between these have none.
constexpr double kSmallestPlain = 1e-4;
constexpr double kLargestPlain = 1e16;
// "-d.dddddddddddddddde-308" and a zero byte fit.
constexpr std::size_t kLongest = 32;

// "d.ddde+xx": as few digits as read back as the number, of these the nearest; returns the end.
char* scientific(char* first, char* last, double value) {
#if defined(__cpp_lib_to_chars)
  return std::to_chars(first, last, value, std::chars_format::scientific).ptr;
#else
  for (int precision = 0;; ++precision) {
    const int size = std::snprintf(first, last - first, "%.*e", precision, value);
    if (precision == 16 || std::strtod(first, nullptr) == value) return first + size;
  }
#endif
}

// What JSON writes as a backslash and a letter; 0 for other characters.
char short_escape(char c) {
  switch (c) {
    case '"': return '"';
    case '\\': return '\\';
    case '\b': return 'b';
    case '\f': return 'f';
    case '\n': return 'n';
    case '\r': return 'r';
    case '\t': return 't';
    default: return 0;
  }
}

// Whether of the next eight bytes none needs an escape. A byte less n borrows from its highest bit where it is below n,
// unless it had that bit; a borrow from the byte below can only make this say no.
bool is_plain(const char* bytes) {
  constexpr std::uint64_t kOnes = 0x0101010101010101u, kHighs = 0x8080808080808080u;
  std::uint64_t eight;
  std::memcpy(&eight, bytes, sizeof eight);
  const auto has_below = [](std::uint64_t v, std::uint64_t n) { return ((v - kOnes * n) & ~v & kHighs) != 0; };
  const auto has = [&](char c) { return has_below(eight ^ (kOnes * static_cast<unsigned char>(c)), 1); };
  return !has_below(eight, 0x20) && !has('"') && !has('\\');
}

}  // namespace

void append_number(std::string& text, double value) {
  char buffer[kLongest];
#if defined(__cpp_lib_to_chars)
  const double size = std::fabs(value);
  if (value == 0 || (size >= kSmallestPlain && size < kLargestPlain)) {
    const std::string_view plain(buffer, std::to_chars(buffer, buffer + kLongest, value, std::chars_format::fixed).ptr - buffer);
    text += plain;
    if (plain.find('.') == std::string_view::npos) text += ".0";
    return;
  }
#endif
  const std::string_view written(buffer, scientific(buffer, buffer + kLongest, value) - buffer);
  const std::size_t mark = written.find('e');
  const int exponent = std::atoi(std::string(written.substr(mark + 1)).c_str());
  if (exponent <= kFirstSmall || exponent >= kFirstLarge) {
    text += written;
    return;
  }
  std::string_view mantissa = written.substr(0, mark);
  if (mantissa.front() == '-') {
    text += '-';
    mantissa.remove_prefix(1);
  }
  std::string digits(1, mantissa.front());
  if (mantissa.size() > 2) digits += mantissa.substr(2);  // behind the point
  const int count = static_cast<int>(digits.size());
  if (exponent < 0) {
    text += "0.";
    text.append(-exponent - 1, '0');
    text += digits;
  } else if (exponent + 1 >= count) {
    text += digits;
    text.append(exponent + 1 - count, '0');
    text += ".0";
  } else {
    text.append(digits, 0, exponent + 1);
    text += '.';
    text.append(digits, exponent + 1);
  }
}

void append_string(std::string& text, std::string_view utf8) {
  text += '"';
  std::size_t begin = 0;  // of what is not yet written
  for (std::size_t at = 0; at < utf8.size(); ++at) {
    while (at + sizeof(std::uint64_t) <= utf8.size() && is_plain(utf8.data() + at)) at += sizeof(std::uint64_t);
    if (at == utf8.size()) break;
    const char c = utf8[at];
    const bool control = static_cast<unsigned char>(c) < 0x20;
    if (!control && c != '"' && c != '\\') continue;
    text += utf8.substr(begin, at - begin);
    begin = at + 1;
    text += '\\';
    if (const char letter = short_escape(c)) {
      text += letter;
    } else {
      constexpr char hex[] = "0123456789abcdef";
      text += "u00";
      text += hex[c >> 4];
      text += hex[c & 15];
    }
  }
  text += utf8.substr(begin);
  text += '"';
}

}  // namespace satcheck::cli
