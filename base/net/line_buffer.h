#pragma once
// Divides received bytes into lines.

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace softgrip::net {

class LineBuffer {
 public:
  enum class Received : std::uint8_t {
    bytes,
    nothing,  ///< no bytes have arrived, or a signal interrupted the read
    end       ///< the peer has closed the connection, or the connection has failed
  };

  void append(std::string_view bytes) {
    bytes_.erase(0, begin_);
    const std::size_t searched = has_line() ? end_ - begin_ : bytes_.size();
    begin_ = 0;
    bytes_ += bytes;
    end_ = bytes_.find('\n', searched);
  }
  /// Reads once from the descriptor. At most `most` bytes are read; `most` must not exceed 16 KiB.
  Received receive(int descriptor, std::size_t most = 16 * 1024) {
    std::array<char, 16 * 1024> buffer;
    const ssize_t count = ::read(descriptor, buffer.data(), std::min(most, buffer.size()));
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return Received::nothing;
    if (count <= 0) return Received::end;
    append({buffer.data(), static_cast<std::size_t>(count)});
    return Received::bytes;
  }
  /// Removes the next complete line and returns it without its LF. The returned text is valid until the next
  /// append(), receive() or clear().
  [[nodiscard]] std::optional<std::string_view> next() {
    if (!has_line()) return std::nullopt;
    const std::string_view line = std::string_view(bytes_).substr(begin_, end_ - begin_);
    begin_ = end_ + 1;
    end_ = bytes_.find('\n', begin_);
    return line;
  }
  [[nodiscard]] bool has_line() const noexcept { return end_ != std::string::npos; }
  /// Returns true if the next line has more than `most` bytes, even if the line is incomplete.
  [[nodiscard]] bool exceeds(std::size_t most) const noexcept {
    return std::min(end_, bytes_.size()) - begin_ > most;
  }
  void clear() noexcept { *this = {}; }

 private:
  std::string bytes_;
  std::size_t begin_ = 0;                // start of the next line
  std::size_t end_ = std::string::npos;  // end of the next line; npos: the line is incomplete
};

/// Returns a line without the CR at its end, if it has one.
[[nodiscard]] inline std::string_view without_cr(std::string_view line) noexcept {
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

}  // namespace softgrip::net
