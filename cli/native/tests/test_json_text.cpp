// Numbers and strings as JSON, without Python: the layout of repr, and that what is written reads back the same.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include "json_text.hpp"

namespace {

using namespace satcheck::cli;

int failures = 0;

void check(bool passed, const std::string& what, int line) {
  if (passed) return;
  ++failures;
  std::fprintf(stderr, "line %d: failed: %s\n", line, what.c_str());
}
#define CHECK_NUMBER(value, expected) check(number(value) == (expected), number(value) + " is not " + (expected), __LINE__)
#define CHECK_STRING(value, expected) check(string(value) == (expected), string(value) + " is not " + (expected), __LINE__)

std::string number(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

std::string string(std::string_view value) {
  std::string text;
  append_string(text, value);
  return text;
}

void layout_of_numbers() {
  CHECK_NUMBER(0.0, "0.0");
  CHECK_NUMBER(-0.0, "-0.0");
  CHECK_NUMBER(1.0, "1.0");
  CHECK_NUMBER(-12.5, "-12.5");
  CHECK_NUMBER(0.1, "0.1");
  CHECK_NUMBER(120.0, "120.0");
  CHECK_NUMBER(0.0001, "0.0001");
  CHECK_NUMBER(-0.00012, "-0.00012");
  CHECK_NUMBER(0.00001, "1e-05");
  CHECK_NUMBER(1.5e-7, "1.5e-07");
  CHECK_NUMBER(123456789012345.6, "123456789012345.6");
  CHECK_NUMBER(1e15, "1000000000000000.0");
  CHECK_NUMBER(9007199254740993.0, "9007199254740992.0");
  CHECK_NUMBER(1e16, "1e+16");
  CHECK_NUMBER(-1.25e300, "-1.25e+300");
  CHECK_NUMBER(5e-324, "5e-324");
  CHECK_NUMBER(1.7976931348623157e308, "1.7976931348623157e+308");
}

void numbers_read_back_the_same() {
  std::mt19937_64 random(20260728);
  int exponent = 0;
  for (int k = 0; k < 100000; ++k) {
    double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    if (k % 2 == 0) value = std::ldexp(std::frexp(value, &exponent), k % 80 - 20);  // those of usual sizes
    const std::string text = number(value);
    check(std::bit_cast<std::uint64_t>(std::strtod(text.c_str(), nullptr)) == std::bit_cast<std::uint64_t>(value), text,
          __LINE__);
  }
}

void escapes() {
  CHECK_STRING("", "\"\"");
  CHECK_STRING("plain", "\"plain\"");
  CHECK_STRING("a\"b\\c/", "\"a\\\"b\\\\c/\"");
  CHECK_STRING("\b\f\n\r\t", "\"\\b\\f\\n\\r\\t\"");
  CHECK_STRING(std::string_view("\0\x1b\x7f", 3), "\"\\u0000\\u001b\x7f\"");
  for (std::size_t at = 0; at < 40; ++at) {
    std::string long_text(40, '\x7e'), escaped(long_text.size() + 2, '\x7e');
    escaped.front() = escaped.back() = '"';
    long_text[at] = '"';
    escaped.insert(at + 1, "\\");
    escaped[at + 2] = '"';
    CHECK_STRING(long_text, escaped);
  }
  CHECK_STRING("\xc3\xa4\xf0\x9f\x98\x80", "\"\xc3\xa4\xf0\x9f\x98\x80\"");
}

}  // namespace

int main() {
  layout_of_numbers();
  numbers_read_back_the_same();
  escapes();
  if (failures == 0) std::puts("all passed");
  return failures == 0 ? 0 : 1;
}
