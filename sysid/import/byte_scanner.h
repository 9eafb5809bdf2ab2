#pragma once
// Reads numbers and texts from a binary file, one after the other.

#include <cstdint>
#include <cstring>
#include <string_view>

namespace softgrip::sysid {

/// Reads little-endian values one after the other. If a read would pass the end of the data, the read
/// function returns 0 or an empty text. From then on, good() returns false.
class ByteScanner {
 public:
  explicit ByteScanner(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  T value() {
    T value{};
    const char* const at = skip(sizeof(T));
    if (at != nullptr) std::memcpy(&value, at, sizeof(T));
    return value;
  }
  /// Reads a text that is preceded by its length as a 32-bit number.
  std::string_view text() {
    const auto size = value<std::uint32_t>();
    const char* const at = skip(size);
    return at == nullptr ? std::string_view{} : std::string_view(at, size);
  }
  /// Skips `size` bytes and returns a pointer to the first skipped byte. Returns nullptr if fewer than `size`
  /// bytes are left.
  const char* skip(std::uint64_t size) {
    good_ = good_ && size <= bytes_.size();
    if (!good_) return nullptr;
    const char* const at = bytes_.data();
    bytes_.remove_prefix(size);
    return at;
  }
  [[nodiscard]] bool good() const { return good_; }
  /// Returns the bytes that have not been read yet.
  [[nodiscard]] std::string_view rest() const { return bytes_; }

 private:
  std::string_view bytes_;
  bool good_ = true;
};

}  // namespace softgrip::sysid
