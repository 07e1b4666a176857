// One of two types of one name; the other has fewer fields.
namespace satcheck {
struct Defined {
  int first;
  float second;
  float third;
};
float third_of_three(const Defined& value) { return value.third; }
}  // namespace satcheck
