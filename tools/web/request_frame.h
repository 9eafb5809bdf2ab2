#pragma once
// Finds the end of an HTTP request and checks that the server supports the request. Uses no sockets.

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
  std::size_t size = 0;  ///< size of the complete request with its body [bytes]
  int status = 0;        ///< HTTP status with which the request is refused; 0: the request is not refused
};

/// Checks the bytes that a client has sent so far. The check is stricter than the check of cpp-httplib, which
/// parses the request after this check. Lines must end with CR LF. Control characters, folded lines, a second
/// Content-Length, chunked bodies and Expect headers are refused.
[[nodiscard]] Frame frame_of(std::string_view bytes);

}  // namespace softgrip::web
