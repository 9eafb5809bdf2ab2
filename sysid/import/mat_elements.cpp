#include "sysid/import/table_readers.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace softgrip::sysid {
namespace {

// Codes of data elements and of array classes, from "MAT-File Format", MathWorks, version 5.
constexpr std::uint32_t type_flags = 6;
constexpr std::uint32_t type_matrix = 14;
constexpr std::uint32_t type_compressed = 15;
constexpr std::uint32_t first_numeric_class = 6;
constexpr std::uint32_t last_numeric_class = 15;
constexpr std::uint32_t opaque_class = 17;
constexpr std::size_t header_bytes = 128;
constexpr std::size_t tag_bytes = 8;
constexpr std::size_t longest_name = 64;

/// Reads the bytes of one element and decompresses them if necessary.
class ElementSource {
 public:
  ElementSource(std::string_view bytes, bool compressed) : bytes_(bytes), compressed_(compressed) {
    if (!compressed_) return;
    // zlib only reads these bytes, although its interface requires a pointer that is not const.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream_.avail_in = static_cast<uInt>(bytes.size());
    state_ = inflateInit(&stream_);
  }
  ElementSource(const ElementSource&) = delete;
  ElementSource& operator=(const ElementSource&) = delete;
  ElementSource(ElementSource&&) = delete;
  ElementSource& operator=(ElementSource&&) = delete;
  ~ElementSource() {
    if (compressed_) inflateEnd(&stream_);
  }

  /// Reads `count` bytes and stores them at `to`. Returns false if the element ends before, or if its
  /// compressed data are damaged.
  bool read(char* to, std::size_t count) {
    position_ += count;
    if (compressed_) return inflate_to(to, count);
    if (count > bytes_.size()) return false;
    std::memcpy(to, bytes_.data(), count);
    bytes_.remove_prefix(count);
    return true;
  }
  bool skip(std::size_t count) {
    if (!compressed_) {
      position_ += count;
      if (count > bytes_.size()) return false;
      bytes_.remove_prefix(count);
      return true;
    }
    while (count > 0) {
      const std::size_t part = std::min(count, scratch_.size());
      if (!read(scratch_.data(), part)) return false;
      count -= part;
    }
    return true;
  }
  /// Returns true if the compressed data end here, except for padding, and match their checksum.
  bool ends() { return !compressed_ || (!inflate_to(scratch_.data(), tag_bytes) && state_ == Z_STREAM_END); }
  /// Returns the number of bytes that have been read after decompression.
  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  bool inflate_to(char* to, std::size_t count) {
    stream_.next_out = reinterpret_cast<Bytef*>(to);
    stream_.avail_out = static_cast<uInt>(count);
    while (stream_.avail_out > 0 && state_ == Z_OK) state_ = inflate(&stream_, Z_NO_FLUSH);
    return stream_.avail_out == 0;
  }

  std::string_view bytes_;
  bool compressed_;
  int state_ = Z_OK;
  std::size_t position_ = 0;
  z_stream stream_{};
  std::array<char, 1U << 16U> scratch_{};
};

struct Tag {
  std::uint32_t type = 0;
  std::uint32_t bytes = 0;     ///< size of the data after the tag, without padding
  std::uint32_t small = 0;     ///< size of the data in the tag; 0: the data are after the tag
  std::array<char, 4> data{};  ///< data in the tag
};

std::uint32_t word(const char* at, bool big_endian) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8U | static_cast<std::uint8_t>(at[big_endian ? i : 3 - i]);
  return value;
}

/// Returns the size of one number of a data element; 0 if the element does not contain numbers.
std::size_t size_of_number(std::uint32_t type) {
  constexpr std::array<std::size_t, 14> sizes{0, 1, 1, 2, 2, 4, 4, 4, 0, 8, 0, 0, 8, 8};
  return type < sizes.size() ? sizes[type] : 0;
}

/// Checks the elements of a file one after the other. See mat_variables().
class ElementCheck {
 public:
  ElementCheck(bool big_endian, std::size_t most_parts, std::size_t most_bytes)
      : big_endian_(big_endian),
        parts_left_(most_parts),
        bytes_left_(most_bytes),
        numbers_left_(most_bytes) {}

  /// Checks one top-level element. Returns false if it is incomplete or damaged, or if the number of parts or
  /// bytes exceeds its bound.
  bool take(std::string_view bytes, bool compressed) {
    name_.clear();
    counts_ = false;
    ElementSource source(bytes, compressed);
    Tag tag;
    if (!read_tag(source, tag) || tag.type != type_matrix || tag.small > 0) return false;
    const std::size_t end = tag_bytes + tag.bytes;
    bool is_checked = true;
    if (!array(source, end, is_checked)) return false;
    if (!is_checked) return true;
    counts_ = true;
    return parts(source, end) && source.ends();
  }

  /// True: take() returned false because the number of parts or bytes exceeds its bound.
  [[nodiscard]] bool exceeded() const { return exceeded_; }
  /// Returns the name of the last checked variable; empty if the name is unknown.
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  bool read_tag(ElementSource& source, Tag& tag) const {
    std::array<char, tag_bytes> raw{};
    if (!source.read(raw.data(), raw.size())) return false;
    tag = {word(raw.data(), big_endian_), word(raw.data() + 4, big_endian_)};
    if (tag.type >> 16U == 0) return true;
    // If the data of an element are small, they are stored in the tag.
    tag = {tag.type & 0xffffU, 0, tag.type >> 16U, {raw[4], raw[5], raw[6], raw[7]}};
    return tag.small <= tag.data.size();
  }

  /// Reads the tag of a part of an array that ends at `end`.
  bool part(ElementSource& source, std::size_t end, Tag& tag) {
    if (end - source.position() < tag_bytes || !read_tag(source, tag)) return false;
    if (tag.bytes > end - source.position()) return false;
    if (!counts_) return true;
    const std::size_t size = tag_bytes + (tag.type == type_matrix ? 0 : tag.bytes);
    exceeded_ = parts_left_ == 0 || size > bytes_left_;
    if (exceeded_) return false;
    --parts_left_;
    bytes_left_ -= size;
    return true;
  }

  /// Skips the data of a part, except the first `used` bytes.
  static bool skip_data(ElementSource& source, std::size_t end, const Tag& tag, std::size_t used = 0) {
    constexpr std::size_t alignment = 8;
    const std::size_t padded = (tag.bytes + alignment - 1) / alignment * alignment - used;
    return source.skip(std::min(padded, end - source.position()));
  }

  /// Reads the first parts of an array: flags, dimensions and name, and the real values of an array of
  /// numbers. The lowest byte of the flags is the class of the array. `is_checked` becomes false if the
  /// values of a top-level array exceed the bound, because the import skips such an array.
  bool array(ElementSource& source, std::size_t end, bool& is_checked) {
    Tag tag;
    std::array<char, tag_bytes> flags{};
    if (!part(source, end, tag) || tag.type != type_flags || tag.bytes != flags.size() ||
        !source.read(flags.data(), flags.size()))
      return false;
    const std::uint32_t kind = word(flags.data(), big_endian_) & 0xffU;
    std::size_t count = 1;
    if (kind != opaque_class && !dimensions(source, end, count)) return false;
    if (!part(source, end, tag) || !name(source, end, tag)) return false;
    if (kind < first_numeric_class || kind > last_numeric_class || count == 0) return true;
    if (!part(source, end, tag)) return false;
    const std::size_t size = size_of_number(tag.type);
    if (size == 0 || (tag.bytes + tag.small) / size != count) return false;
    is_checked = counts_ || tag.bytes <= numbers_left_;
    if (!is_checked) return true;
    if (!counts_) numbers_left_ -= tag.bytes;
    return skip_data(source, end, tag);
  }

  /// Reads the dimensions of an array and computes the number of its values.
  bool dimensions(ElementSource& source, std::size_t end, std::size_t& count) {
    Tag tag;
    if (!part(source, end, tag)) return false;
    std::array<char, 4> raw{};
    for (std::size_t i = 0; i < tag.bytes / raw.size(); ++i) {
      if (!source.read(raw.data(), raw.size())) return false;
      // A count of more than 2^32 values is not exact, but it differs from the number of values in any case.
      count = std::min(count, std::size_t{1} << 32U) * word(raw.data(), big_endian_);
    }
    return skip_data(source, end, tag, tag.bytes / raw.size() * raw.size());
  }

  /// Reads the name of an array. Keeps the name if the array is a variable of the file.
  bool name(ElementSource& source, std::size_t end, const Tag& tag) {
    std::string text(tag.data.data(), tag.small);
    text.resize(std::max<std::size_t>(tag.small, std::min<std::size_t>(tag.bytes, longest_name)));
    if (tag.small == 0 && !source.read(text.data(), text.size())) return false;
    if (!counts_) name_ = text;
    return skip_data(source, end, tag, tag.small > 0 ? 0 : text.size());
  }

  /// Checks all other parts of an array. The tags of nested parts directly follow the tag of their parent,
  /// without an end mark. Therefore one loop over the tags visits all parts.
  bool parts(ElementSource& source, std::size_t end) {
    std::vector<std::size_t> ends{end};
    while (!ends.empty()) {
      const std::size_t left = ends.back() - source.position();
      if (left < tag_bytes) {
        if (!source.skip(left)) return false;
        ends.pop_back();
        continue;
      }
      Tag tag;
      if (!part(source, ends.back(), tag)) return false;
      if (tag.type != type_matrix) {
        if (!skip_data(source, ends.back(), tag)) return false;
      } else if (tag.bytes > 0) {
        bool is_checked = true;
        ends.push_back(source.position() + tag.bytes);
        if (!array(source, ends.back(), is_checked)) return false;
      }
    }
    return true;
  }

  bool big_endian_;
  std::size_t parts_left_;
  std::size_t bytes_left_;
  std::size_t numbers_left_;  ///< bytes that the values of the remaining top-level arrays may have
  bool counts_ = false;       ///< true: the next parts count towards the bounds
  bool exceeded_ = false;
  std::string name_;
};

/// Words of the header of a variable in a file of version 4.
struct Header4 {
  std::uint32_t type, rows, columns, imaginary, name;
};
constexpr std::size_t header4_bytes = sizeof(Header4);

Header4 header4(std::string_view bytes) {
  const auto at = [&](std::size_t i) { return word(bytes.data() + 4 * i, false); };
  return {at(0), at(1), at(2), at(3), at(4)};
}

/// Returns the size of the first variable of a file of version 4.
std::size_t variable4_bytes(std::string_view bytes) {
  constexpr std::array<std::size_t, 6> sizes{8, 4, 4, 2, 2, 1};
  constexpr std::uint32_t sparse = 2;
  const Header4 header = header4(bytes);
  const std::size_t parts = header.imaginary != 0 && header.type % 10 != sparse ? 2 : 1;
  return header4_bytes + header.name +
         std::size_t{header.rows} * header.columns * sizes[header.type / 10] * parts;
}

std::nullopt_t refuse_damaged(const std::string& path, const std::string& name, std::size_t at,
                              document::Problems& problems) {
  problems.add({path,
                {1, 1},
                {},
                "this MATLAB file cannot be read: it is cut off or damaged in " +
                    (name.empty() ? "the data element at byte " + std::to_string(at)
                                  : "the variable '" + document::shown(name) + "'"),
                "copy the file again, or save its variables again"});
  return std::nullopt;
}

std::optional<std::size_t> mat4_variables(const std::string& path, std::string_view file,
                                          document::Problems& problems) {
  std::size_t count = 0;
  for (std::size_t at = 0; at < file.size(); ++count) {
    const std::string_view rest = file.substr(at);
    if (!is_matlab_4(rest)) return refuse_damaged(path, {}, at, problems);
    const std::size_t size = variable4_bytes(rest);
    if (size > rest.size())
      return refuse_damaged(path, std::string(rest.data() + header4_bytes), at, problems);
    at += size;
  }
  return count;
}

}  // namespace

bool is_matlab_4(std::string_view bytes) {
  if (bytes.size() < header4_bytes) return false;
  const auto [type, rows, columns, imaginary, name] = header4(bytes);
  return type < 60 && type % 10 < 3 && rows < most_values && columns < most_values && imaginary < 2 &&
         name > 1 && name < 64 && bytes.size() > header4_bytes + name &&
         bytes[header4_bytes + name - 1] == '\0' && bytes[header4_bytes] > ' ';
}

std::optional<std::size_t> mat_variables(const std::string& path, std::string_view file,
                                         std::size_t most_parts, std::size_t most_bytes,
                                         document::Problems& problems) {
  if (is_matlab_4(file)) return mat4_variables(path, file, problems);
  if (file.size() < header_bytes) return 0;
  const bool big_endian = file.substr(header_bytes - 2, 2) == "MI";
  ElementCheck check(big_endian, most_parts, most_bytes);
  std::size_t count = 0;
  for (std::size_t at = header_bytes; at < file.size(); ++count) {
    const std::string_view rest = file.substr(at);
    if (rest.size() < tag_bytes) return refuse_damaged(path, {}, at, problems);
    const bool compressed = word(rest.data(), big_endian) == type_compressed;
    // A compressed element has no padding. If an element is not compressed, its tag is read together with its
    // data.
    const std::size_t size = word(rest.data() + 4, big_endian);
    const bool sound =
        check.take(rest.substr(compressed ? tag_bytes : 0, compressed ? size : size + tag_bytes), compressed);
    if (check.exceeded()) {
      problems.add({path,
                    {1, 1},
                    {},
                    "the cells, structures and objects of the file have more than " +
                        std::to_string(most_parts) + " parts, or more than 1 GiB",
                    "save only arrays of numbers"});
      return std::nullopt;
    }
    if (!sound) return refuse_damaged(path, check.name(), at, problems);
    at += tag_bytes + size;
  }
  return count;
}

}  // namespace softgrip::sysid
