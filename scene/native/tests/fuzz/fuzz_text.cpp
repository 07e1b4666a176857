// Lines, words and numbers by themselves: every byte of the text is in one line, and no number is infinite.
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/invariants.hpp"
#include "tests/fuzz/target.hpp"
#include "text.hpp"

namespace {

using namespace satcheck::scene;

template <class Parse>
void attempt(Parse parse) {
  try {
    parse();
  } catch (const ReadError& error) {
    check(error);
  }
}

void parse_words(std::string_view line, std::int64_t number) {
  Words words(line);
  std::string_view word;
  MeshData mesh;
  while (words.next(word)) {
    require(word.find_first_of(" \t\r\v\f") == std::string_view::npos);
    attempt([&] { require(std::isfinite(parse_coordinate(word, number, mesh))); });
    attempt([&] { parse_integer(word, number, "a number"); });
  }
  require(words.none_left());
  Words again(line), numbers(line);
  attempt([&] { parse_vertex(again, number, mesh); });
  attempt([&] { check_numbers(numbers, number); });
}

void walk(std::string_view text, bool (*next)(Lines&, std::string_view&)) {
  Lines lines(text);
  std::string_view line;
  std::int64_t before = 0;
  while (next(lines, line)) {
    require(lines.number() > before);
    before = lines.number();
    parse_words(line, before);
  }
  require(lines.at_end());
}

}  // namespace

FUZZ_TARGET(text) {
  walk(data, [](Lines& lines, std::string_view& line) { return lines.next(line); });
  walk(data, [](Lines& lines, std::string_view& line) { return lines.next_joined(line); });
  walk(data, [](Lines& lines, std::string_view& line) { return lines.next_filled(line, '#'); });
}
