#include "sysid/import/table_readers.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace softgrip::sysid {
namespace {

// Codes of data elements and of array classes, from "MAT-File Format", MathWorks, version 5.
constexpr std::uint32_t type_matrix = 14;
constexpr std::uint32_t type_compressed = 15;
constexpr std::uint32_t first_numeric_class = 6;
constexpr std::uint32_t last_numeric_class = 15;
constexpr std::size_t header_bytes = 128;
constexpr std::size_t tag_bytes = 8;

/// Reads the bytes of one element and decompresses them if necessary.
class ElementSource {
 public:
  ElementSource(std::string_view bytes, bool compressed, std::size_t& budget)
      : bytes_(bytes), compressed_(compressed), budget_(budget) {
    if (!compressed_) return;
    // zlib only reads these bytes, although its interface requires a pointer that is not const.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream_.avail_in = static_cast<uInt>(bytes.size());
    good_ = inflateInit(&stream_) == Z_OK;
  }
  ElementSource(const ElementSource&) = delete;
  ElementSource& operator=(const ElementSource&) = delete;
  ElementSource(ElementSource&&) = delete;
  ElementSource& operator=(ElementSource&&) = delete;
  ~ElementSource() {
    if (compressed_) inflateEnd(&stream_);
  }

  /// Reads `count` bytes and stores them at `to`. Returns false at the end of the element, or if the budget
  /// of `budget_` bytes is exhausted.
  bool read(char* to, std::size_t count) {
    if (count > budget_) count = budget_ = 0;
    budget_ -= count;
    if (count == 0 || !good_) return false;
    if (compressed_) return inflate_to(to, count);
    if (count > bytes_.size()) return false;
    std::memcpy(to, bytes_.data(), count);
    bytes_.remove_prefix(count);
    return true;
  }
  bool skip(std::size_t count) {
    while (count > 0) {
      const std::size_t part = std::min(count, scratch_.size());
      if (!read(scratch_.data(), part)) return false;
      count -= part;
    }
    return true;
  }

 private:
  bool inflate_to(char* to, std::size_t count) {
    stream_.next_out = reinterpret_cast<Bytef*>(to);
    stream_.avail_out = static_cast<uInt>(count);
    while (stream_.avail_out > 0 && good_) good_ = inflate(&stream_, Z_NO_FLUSH) == Z_OK;
    return stream_.avail_out == 0;
  }

  std::string_view bytes_;
  bool compressed_;
  bool good_ = true;
  std::size_t& budget_;
  z_stream stream_{};
  std::array<char, 1U << 16U> scratch_{};
};

struct Tag {
  std::uint32_t type = 0;
  std::uint32_t bytes = 0;  ///< size of the data after the tag, without padding
};

std::uint32_t word(const char* at, bool big_endian) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8U | static_cast<std::uint8_t>(at[big_endian ? i : 3 - i]);
  return value;
}

bool read_tag(ElementSource& source, bool big_endian, Tag& tag) {
  std::array<char, tag_bytes> raw{};
  if (!source.read(raw.data(), raw.size())) return false;
  tag = {word(raw.data(), big_endian), word(raw.data() + 4, big_endian)};
  // If the data of an element are small, they are stored in the tag.
  if (tag.type >> 16U != 0) tag = {tag.type & 0xffffU, 0};
  return true;
}

class Counter {
 public:
  Counter(bool big_endian, std::size_t most_parts, std::size_t most_bytes)
      : big_endian_(big_endian), parts_left_(most_parts), bytes_left_(most_bytes) {}

  /// Counts the parts of one top-level element. Returns false if the number of parts or bytes exceeds its
  /// bound.
  bool take(std::string_view bytes, bool compressed) {
    ElementSource source(bytes, compressed, bytes_left_);
    Tag tag;
    if (!read_tag(source, big_endian_, tag) || tag.type != type_matrix) return bytes_left_ > 0;
    // The flags are the first part of an array. The lowest byte of the flags is the class of the array.
    std::array<char, tag_bytes> flags{};
    if (!source.skip(tag_bytes) || !source.read(flags.data(), flags.size())) return bytes_left_ > 0;
    const std::uint32_t kind = word(flags.data(), big_endian_) & 0xffU;
    if (kind >= first_numeric_class && kind <= last_numeric_class) return true;
    // The tags of nested parts directly follow the tag of their parent, without an end mark. Therefore one
    // loop over the tags visits all parts.
    while (read_tag(source, big_endian_, tag)) {
      if (parts_left_-- == 0) return false;
      constexpr std::size_t alignment = 8;
      const std::size_t padded = (tag.bytes + alignment - 1) / alignment * alignment;
      if (tag.type != type_matrix && !source.skip(padded)) break;
    }
    return bytes_left_ > 0;
  }

 private:
  bool big_endian_;
  std::size_t parts_left_;
  std::size_t bytes_left_;
};

}  // namespace

bool mat_elements_within(std::string_view file, std::size_t most_parts, std::size_t most_bytes) {
  if (file.size() < header_bytes) return true;
  const bool big_endian = file.substr(header_bytes - 2, 2) == "MI";
  Counter counter(big_endian, most_parts, most_bytes);
  file.remove_prefix(header_bytes);
  while (file.size() >= tag_bytes) {
    const std::uint32_t type = word(file.data(), big_endian);
    const bool compressed = type == type_compressed;
    // A compressed element has no padding. If an element is not compressed, its tag is read together with its
    // data.
    const std::size_t size = word(file.data() + 4, big_endian);
    if (!counter.take(file.substr(compressed ? tag_bytes : 0, compressed ? size : size + tag_bytes),
                      compressed))
      return false;
    file.remove_prefix(std::min(file.size(), tag_bytes + size));
  }
  return true;
}

}  // namespace softgrip::sysid
