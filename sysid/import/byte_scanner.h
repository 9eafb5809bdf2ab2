#pragma once
// Reads the numbers and texts of a binary file in turn.

#include <cstdint>
#include <cstring>
#include <string_view>

namespace softgrip::sysid {

/// Reads little-endian bytes from their begin to their end. Behind the end each value is 0 or empty, and
/// good() is false from then on.
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
  /// A text behind its length of 32 bits.
  std::string_view text() {
    const auto size = value<std::uint32_t>();
    const char* const at = skip(size);
    return at == nullptr ? std::string_view{} : std::string_view(at, size);
  }
  /// The place of the next `size` bytes; null behind the end.
  const char* skip(std::uint64_t size) {
    good_ = good_ && size <= bytes_.size();
    if (!good_) return nullptr;
    const char* const at = bytes_.data();
    bytes_.remove_prefix(size);
    return at;
  }
  [[nodiscard]] bool good() const { return good_; }
  /// The bytes that are not read yet.
  [[nodiscard]] std::string_view rest() const { return bytes_; }

 private:
  std::string_view bytes_;
  bool good_ = true;
};

}  // namespace softgrip::sysid
