// After the bitstream in the appendices of KHR_meshopt_compression (Khronos Group; Arseny Kapoulkine, 2025), of which
// EXT_meshopt_compression is version 0. Every read is checked against the end; speed is left to the compiler.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "builder.hpp"
#include "readers.hpp"

namespace satcheck::scene {
namespace {

[[noreturn]] void fail_damaged(const char* what) { fail(code::bad_record, std::string("meshopt data: ") + what); }

// The bytes of a stream in order, up to where its tail begins.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}

  std::uint8_t next() { return static_cast<std::uint8_t>(take(1)[0]); }

  std::string_view take(std::size_t count) {
    if (count > bytes_.size()) fail_damaged("it ends too early");
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  // An unsigned number in steps of 7 bits, the lowest first.
  std::uint32_t varint() {
    std::uint32_t value = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
      const std::uint8_t byte = next();
      value |= static_cast<std::uint32_t>(byte & 0x7f) << shift;
      if (byte < 0x80) return value;
    }
    fail_damaged("a number is longer than 5 bytes");
  }

  void check_end() const {
    if (!bytes_.empty()) fail_damaged("it goes on after its last element");
  }

 private:
  std::string_view bytes_;
};

template <class Unsigned>
Unsigned unzigzag(Unsigned value) {
  return static_cast<Unsigned>((value & 1) != 0 ? ~(value >> 1) : value >> 1);
}

// The bytes between the first byte, which is the version, and the tail.
Bytes body(std::string_view stream, std::size_t tail) {
  if (stream.size() < 1 + tail) fail_damaged("it is too short");
  return Bytes(stream.substr(1, stream.size() - 1 - tail));
}

// ---- attributes ----------------------------------------------------------------------------------------------------

constexpr std::size_t group_size = 16;
constexpr std::size_t max_block_bytes = 8192, max_block_elements = 256, max_stride = 256, channel_size = 4;

// 16 values of `bits` each. Values with all bits set are escapes: their full bytes follow after all 16.
void unpack_group(Bytes& bytes, unsigned bits, std::uint8_t* group) {
  if (bits == 0) {
    std::fill_n(group, group_size, std::uint8_t{0});
    return;
  }
  const std::string_view packed = bytes.take(group_size * bits / 8);
  const unsigned mask = (1u << bits) - 1, in_a_byte = 8 / bits;
  for (unsigned i = 0; i < group_size; ++i) {
    const unsigned place = bits == 1 ? i % in_a_byte : in_a_byte - 1 - i % in_a_byte;  // single bits begin with the lowest
    group[i] = (static_cast<std::uint8_t>(packed[i / in_a_byte]) >> (place * bits)) & mask;
  }
  if (bits == 8) return;
  for (std::size_t i = 0; i < group_size; ++i) {
    if (group[i] == mask) group[i] = bytes.next();
  }
}

class Attributes {
 public:
  Attributes(std::string_view stream, std::size_t count, std::size_t stride)
      : stride_(stride), left_(count), version_(version_of(stream)), bytes_(body(stream, tail_size())) {
    const std::string_view tail = stream.substr(stream.size() - stride_ - channels());
    std::copy_n(tail.begin(), stride_, last_.begin());
    std::copy_n(tail.begin() + static_cast<std::ptrdiff_t>(stride_), channels(), channels_.begin());
  }

  std::string read() {
    std::string elements;
    while (left_ > 0) block(elements);
    bytes_.check_end();
    return elements;
  }

 private:
  static int version_of(std::string_view stream) {
    const unsigned head = stream.empty() ? 0 : static_cast<std::uint8_t>(stream[0]);
    if (head != 0xa0 && head != 0xa1) fail_damaged("no attributes of version 0 or 1");
    return static_cast<int>(head & 1);
  }
  std::size_t channels() const { return version_ == 0 ? 0 : stride_ / channel_size; }
  std::size_t tail_size() const { return std::max<std::size_t>(stride_ + channels(), version_ == 0 ? 32 : 24); }

  void block(std::string& elements) {
    const std::size_t most = std::min((max_block_bytes / stride_) / group_size * group_size, max_block_elements);
    const std::size_t count = std::min(left_, most);
    const std::string_view controls = bytes_.take(channels());
    for (std::size_t k = 0; k < stride_; ++k) {
      const unsigned control = version_ == 0 ? 0 : (static_cast<std::uint8_t>(controls[k / 4]) >> (k % 4 * 2)) & 3;
      deltas(count, control, deltas_[k]);
    }
    const std::size_t from = elements.size();
    elements.resize(from + count * stride_);
    for (std::size_t k = 0; k < stride_; k += channel_size) channel(k, count, elements.data() + from);
    left_ -= count;
  }

  // One byte of each element of a block.
  void deltas(std::size_t count, unsigned control, std::array<std::uint8_t, max_block_elements>& into) {
    constexpr unsigned all_zero = 2, verbatim = 3;
    constexpr unsigned bits_of[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
    constexpr unsigned bits_of_version_0[4] = {0, 2, 4, 8};
    if (control == all_zero) into.fill(0);
    if (control == verbatim) {
      const std::string_view bytes = bytes_.take(count);
      std::copy(bytes.begin(), bytes.end(), into.begin());
    }
    if (control >= all_zero) return;
    const unsigned* bits = version_ == 0 ? bits_of_version_0 : bits_of[control];
    const std::size_t groups = (count + group_size - 1) / group_size;
    const std::string_view header = bytes_.take((groups + 3) / 4);
    for (std::size_t g = 0; g < groups; ++g) {
      const unsigned mode = (static_cast<std::uint8_t>(header[g / 4]) >> (g % 4 * 2)) & 3;
      unpack_group(bytes_, bits[mode], into.data() + g * group_size);
    }
  }

  // Four bytes of each element, from byte k on. They are stored as differences to the previous element.
  void channel(std::size_t k, std::size_t count, char* elements) {
    const unsigned kind = version_ == 0 ? 0 : static_cast<std::uint8_t>(channels_[k / channel_size]);
    const unsigned mode = kind & 15, rotation = kind >> 4;
    if (mode > 2 || (mode < 2 && rotation != 0)) fail_damaged("an unknown channel mode");
    std::uint32_t value = load<std::uint32_t>(last_.data() + k);
    for (std::size_t i = 0; i < count; ++i) {
      std::uint32_t delta = 0;
      for (std::size_t j = 0; j < channel_size; ++j) delta |= static_cast<std::uint32_t>(deltas_[k + j][i]) << (8 * j);
      if (mode == 0) value = add<std::uint8_t>(value, delta);
      if (mode == 1) value = add<std::uint16_t>(value, delta);
      if (mode == 2) value ^= std::rotr(delta, static_cast<int>(rotation));
      for (std::size_t j = 0; j < channel_size; ++j) elements[i * stride_ + k + j] = static_cast<char>(value >> (8 * j));
    }
    for (std::size_t j = 0; j < channel_size; ++j) last_[k + j] = static_cast<char>(value >> (8 * j));
  }

  // Adds zigzag differences to each of the numbers in a word.
  template <class Number>
  static std::uint32_t add(std::uint32_t value, std::uint32_t delta) {
    std::uint32_t sum = 0;
    for (unsigned shift = 0; shift < 32; shift += 8 * sizeof(Number)) {
      const auto number = static_cast<Number>((value >> shift) + unzigzag(static_cast<Number>(delta >> shift)));
      sum |= static_cast<std::uint32_t>(number) << shift;
    }
    return sum;
  }

  std::size_t stride_, left_;
  int version_;
  Bytes bytes_;
  std::array<char, max_stride> last_{};  // the element before
  std::array<char, max_stride / channel_size> channels_{};
  std::array<std::array<std::uint8_t, max_block_elements>, max_stride> deltas_;
};

// ---- indices -------------------------------------------------------------------------------------------------------

void append(std::string& elements, std::uint32_t index, std::size_t stride) {
  for (std::size_t j = 0; j < stride; ++j) elements.push_back(static_cast<char>(index >> (8 * j)));
}

std::string unpack_indices(std::string_view stream, std::size_t count, std::size_t stride) {
  constexpr std::size_t tail = 4;
  if (stream.empty() || static_cast<std::uint8_t>(stream[0]) != 0xd1) fail_damaged("no indices of version 1");
  Bytes bytes = body(stream, tail);
  std::array<std::uint32_t, 2> last{};
  std::string elements;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t word = bytes.varint();
    append(elements, last[word & 1] += unzigzag(word >> 1), stride);
  }
  bytes.check_end();
  return elements;
}

// The last 16 pushed values. Reading a value that was never pushed is an error.
template <class Value>
class Recent {
 public:
  void push(const Value& value) { values_[pushed_++ % values_.size()] = value; }
  const Value& operator[](std::size_t ago) const {
    if (ago >= std::min(pushed_, values_.size())) fail_damaged("a triangle refers to what was not there yet");
    return values_[(pushed_ - 1 - ago) % values_.size()];
  }

 private:
  std::array<Value, 16> values_{};
  std::size_t pushed_ = 0;
};

class Triangles {
 public:
  Triangles(std::string_view stream, std::size_t triangles, std::size_t stride)
      : stride_(stride), data_(body(checked(stream), codeaux_size)), codes_(data_.take(triangles)),
        codeaux_(stream.substr(stream.size() - codeaux_size)) {}

  std::string read() {
    for (const char code : codes_) triangle(static_cast<std::uint8_t>(code));
    data_.check_end();
    return std::move(elements_);
  }

 private:
  using Edge = std::array<std::uint32_t, 2>;
  static constexpr std::size_t codeaux_size = 16;
  static constexpr unsigned none = 0xf;

  static std::string_view checked(std::string_view stream) {
    if (stream.empty() || static_cast<std::uint8_t>(stream[0]) != 0xe1) fail_damaged("no triangles of version 1");
    return stream;
  }

  void triangle(unsigned code) {
    const unsigned high = code >> 4, low = code & 15;
    if (high < none) {
      beside(edges_[high], low);
    } else if (low < 0xe) {
      const unsigned pair = static_cast<std::uint8_t>(codeaux_[low]);
      if (pair >> 4 == none || (pair & 15) == none) fail_damaged("a bad table of codes");
      apart(next_++, pair >> 4, pair & 15);
    } else {
      const unsigned pair = data_.next();
      if (pair == 0) next_ = 0;
      apart(low == 0xe ? next_++ : decoded(), pair >> 4, pair & 15);
    }
  }

  // A triangle that shares an edge with an earlier one.
  void beside(Edge edge, unsigned low) {
    const auto [a, b] = edge;
    std::uint32_t c = 0;
    if (low == 0) {
      c = next_++;
    } else if (low < 0xd) {
      c = vertices_[low];
    } else if (low < none) {
      c = last_ += low == 0xd ? ~std::uint32_t{0} : 1;
    } else {
      c = decoded();
    }
    if (low == 0 || low >= 0xd) vertices_.push(c);
    edges_.push({c, b});
    edges_.push({a, c});
    emit(a, b, c);
  }

  // A triangle without a shared edge.
  void apart(std::uint32_t a, unsigned for_b, unsigned for_c) {
    const std::uint32_t b = corner(for_b), c = corner(for_c);
    vertices_.push(a);
    if (for_b == 0 || for_b == none) vertices_.push(b);
    if (for_c == 0 || for_c == none) vertices_.push(c);
    edges_.push({b, a});
    edges_.push({c, b});
    edges_.push({a, c});
    emit(a, b, c);
  }

  std::uint32_t corner(unsigned code) {
    if (code == 0) return next_++;
    return code == none ? decoded() : vertices_[code - 1];
  }

  std::uint32_t decoded() { return last_ += unzigzag(data_.varint()); }

  void emit(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t index : {a, b, c}) append(elements_, index, stride_);
  }

  std::size_t stride_;
  Bytes data_;
  std::string_view codes_, codeaux_;
  Recent<Edge> edges_;
  Recent<std::uint32_t> vertices_;
  std::uint32_t next_ = 0, last_ = 0;
  std::string elements_;
};

}  // namespace

std::string unpack_meshopt(std::string_view stream, MeshoptMode mode, std::size_t count, std::size_t stride) {
  if (mode == MeshoptMode::attributes) {
    if (stride < channel_size || stride > max_stride || stride % channel_size != 0) fail_damaged("a bad stride");
    return Attributes(stream, count, stride).read();
  }
  if (stride != 2 && stride != 4) fail_damaged("a bad stride");
  if (mode == MeshoptMode::indices) return unpack_indices(stream, count, stride);
  if (count % 3 != 0) fail_damaged("corners that make no whole triangles");
  return Triangles(stream, count / 3, stride).read();
}

void undo_exponential_filter(std::string& elements) {
  for (std::size_t at = 0; at + 4 <= elements.size(); at += 4) {
    const std::int32_t word = load<std::int32_t>(elements.data() + at);
    const std::int32_t mantissa = static_cast<std::int32_t>(static_cast<std::uint32_t>(word) << 8) >> 8;
    const auto bits = std::bit_cast<std::uint32_t>(std::ldexp(static_cast<float>(mantissa), word >> 24));
    for (std::size_t j = 0; j < 4; ++j) elements[at + j] = static_cast<char>(bits >> (8 * j));
  }
}

// The largest component is not stored. The last word says which one it is, and the integer that means 1 for the others.
void undo_quaternion_filter(std::string& elements) {
  constexpr double largest = 32767;
  for (std::size_t at = 0; at + 8 <= elements.size(); at += 8) {
    const auto word = [&](std::size_t i) { return static_cast<int>(load<std::int16_t>(elements.data() + at + 2 * i)); };
    const int last = word(3), unit = last | 3;
    std::array<double, 4> parts{};
    double rest = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      parts[i + 1] = word(i) / (unit * std::sqrt(2.0));
      rest -= parts[i + 1] * parts[i + 1];
    }
    parts[0] = std::sqrt(std::max(0.0, rest));
    for (std::size_t i = 0; i < 4; ++i) {
      const double scaled = std::clamp(std::round(parts[i] * largest), -largest, largest);
      const auto number = static_cast<std::uint16_t>(static_cast<std::int16_t>(scaled));
      const std::size_t to = at + 2 * ((static_cast<std::size_t>(last & 3) + i) % 4);
      elements[to] = static_cast<char>(number & 0xff);
      elements[to + 1] = static_cast<char>(number >> 8);
    }
  }
}

}  // namespace satcheck::scene
