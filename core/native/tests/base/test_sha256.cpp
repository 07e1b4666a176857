// Against the examples of FIPS 180, and both ways of compression against each other.
#include "base/sha256.hpp"

#include <random>
#include <string>

#include "tests/check.hpp"

using namespace satcheck;

int main() {
  for (const bool instructions : {true, false}) {
    CHECK(sha256("", instructions) == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    CHECK(sha256("abc", instructions) == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", instructions) ==
          "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    CHECK(sha256(std::string(1000000, 'a'), instructions) ==
          "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  }
  std::mt19937 random(3);
  std::string text;
  for (int size = 0; size < 400; ++size) {
    CHECK(sha256(text, true) == sha256(text, false));
    text += static_cast<char>(random());
  }
  return satcheck::testing::exit_status();
}
