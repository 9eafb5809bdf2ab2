#pragma once
// Where a request of HTTP ends, and whether it is one that is answered here. No sockets.

#include <cstddef>
#include <string_view>

namespace softgrip::web {

inline constexpr std::size_t longest_head = 8192;
inline constexpr std::size_t longest_target = 2048;
inline constexpr std::size_t most_headers = 64;
inline constexpr std::size_t longest_body = 16384;

struct Frame {
  enum class State : unsigned char { incomplete, complete, refused };
  State state = State::incomplete;
  std::size_t size = 0;  ///< of the complete request, body included
  int status = 0;        ///< of a refusal
};

/// Looks at what a client has sent so far. Stricter than the library that reads it afterwards: lines end with
/// CR LF, no control characters, no folded lines, one length at most, and nothing that has a client send its
/// body in pieces or wait for leave to send it.
[[nodiscard]] Frame frame_of(std::string_view bytes);

}  // namespace softgrip::web
