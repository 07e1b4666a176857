// Runs the unit that the command line names, or all. Exit status 0 when each made checks and none failed.
#include <cstring>

#include "tests/check.hpp"

using namespace satcheck::testing;

namespace {

bool passes(const Unit& unit) {
  checks = failures = 0;
  unit.run();
  std::printf("%s: %d checks, %d failures\n", unit.name, checks, failures);
  return failures == 0 && checks > 0;
}

}  // namespace

int main(int count, char** arguments) {
  bool any = false, all_passed = true;
  for (const Unit* unit = units; unit; unit = unit->next) {
    if (count > 1 && std::strcmp(arguments[1], unit->name) != 0) continue;
    any = true;
    all_passed = passes(*unit) && all_passed;
  }
  if (!any) std::fprintf(stderr, "no unit of this name\n");
  return any && all_passed ? 0 : 1;
}
