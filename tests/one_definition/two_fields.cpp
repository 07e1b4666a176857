// One of two types of one name; the other has more fields.
namespace satcheck {
struct Defined {
  int first;
  double second;
};
double second_of_two(const Defined& value) { return value.second; }
}  // namespace satcheck
