#include "daemon/service/daemon_answers.h"

#include <poll.h>
#include <sys/socket.h>

#include <cstddef>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/descriptor.h"
#include "base/net/line_buffer.h"
#include "daemon/service/trusted_user.h"
#include "daemon/socket/listener.h"

namespace softgrip::daemon {

namespace {

/// Longest time from a request to the reply: one turn of the thread that serves clients (service_patience in
/// real_run.cpp) [ns].
constexpr Nanoseconds answer_patience = 2 * ns_per_s;
constexpr std::size_t longest_reply = std::size_t{8} << 20U;
constexpr std::string_view question = "{\"command\": \"status\"}\n";

/// Returns the first line that arrives before `deadline`. If the line is incomplete at the deadline, returns
/// the part that has arrived.
std::string line_from(int socket, Nanoseconds deadline) {
  net::LineBuffer lines;
  while (!lines.has_line() && !lines.exceeds(longest_reply - 1)) {
    if (wait_for(socket, POLLIN, deadline) != Waited::ready) break;
    if (lines.receive(socket) == net::LineBuffer::Received::end) break;
  }
  lines.append("\n");  // adds a line end, so that the incomplete line is returned
  return std::string(lines.next().value_or(""));
}

}  // namespace

bool daemon_answers(const std::string& socket_path) {
  const Descriptor socket = connect_to(socket_path);
  if (!socket) return false;
  const auto peer = peer_of(socket.get());
  if (!peer || !peer->trusted) return false;
  const ssize_t sent = ::send(socket.get(), question.data(), question.size(), MSG_NOSIGNAL);
  if (sent != static_cast<ssize_t>(question.size())) return false;
  const auto reply =
      nlohmann::json::parse(line_from(socket.get(), monotonic_now() + answer_patience), nullptr, false);
  return reply.is_object() && reply.contains("ok");
}

}  // namespace softgrip::daemon
