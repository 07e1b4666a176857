#include "json_text.hpp"

#include <charconv>
#include <cstdio>
#include <cstdlib>

namespace satcheck::cli {
namespace {

// Exponents from which on repr writes one.
constexpr int kFirstSmall = -5;
constexpr int kFirstLarge = 16;
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

}  // namespace

void append_number(std::string& text, double value) {
  char buffer[kLongest];
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
