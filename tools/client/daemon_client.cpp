#include "tools/client/daemon_client.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/json.h"
#include "base/net/listener.h"
#include "tools/command_line/command.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

// Greatest permitted length of a line from the daemon [bytes]. A longer line counts as malformed.
constexpr std::size_t longest_line = std::size_t{8} << 20U;

constexpr const char* how_to_start =
    "start the service ('systemctl start softgripd') or your own daemon ('softgripd --config RIG'), or name "
    "the socket of the daemon with --socket";

ClientFailure cannot_connect(const std::string& path, int error) {
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      return {ExitCode::io, "no daemon is running: there is no socket " + path + "; " + how_to_start, true};
    case ECONNREFUSED:
      return {ExitCode::io, "no daemon is running: no process listens on " + path + "; " + how_to_start,
              true};
    case EACCES:
      return {ExitCode::io, "no permission to open " + path +
                                ": the group of this file determines who may move the gripper"};
    case EAGAIN:
      return {ExitCode::io, "the daemon at " + path +
                                " accepts no connections, because the daemon is paused or overloaded"};
    default:
      return {ExitCode::io, "cannot connect to " + path + ": " + std::strerror(error)};
  }
}

}  // namespace

std::string problem_list(const Json& problems) {
  std::string text;
  for (const Json& problem : problems) {
    text += "\n" + problem.value("file", "");
    // A problem without `line_text` concerns the whole file, so it is shown without a line number.
    if (problem.value("line_text", Json()) != Json("")) {
      text +=
          ":" + std::to_string(problem.value("line", 0)) + ":" + std::to_string(problem.value("column", 0));
    }
    text += ": " + problem.value("message", "");
    if (const std::string hint = problem.value("hint", ""); !hint.empty()) text += " (" + hint + ")";
  }
  return text;
}

namespace {

/// Returns the failure that an error of the daemon means. The message may contain a text of another client,
/// for example its name, so control characters are escaped.
ClientFailure failure_of(const Json& error) {
  const std::string code = error.value("code", "");
  std::string message = error.value("message", "the daemon gave no reason for the refusal");
  ExitCode exit_code = ExitCode::failed;
  if (code == "sequence_refused") {
    exit_code = ExitCode::input_refused;
    message += problem_list(error.value("problems", Json::array()));
  } else if (code == "too_long") {
    exit_code = ExitCode::input_refused;
  } else if (code == "refused") {
    exit_code = ExitCode::state_refused;
    message = "refused (" + error.value("refusal", Json::object()).value("code", "?") + "): " + message;
  } else if (code == "busy" || code == "abandoned" || code == "owned" || code == "not_allowed") {
    exit_code = ExitCode::state_refused;
  }
  return {exit_code, visible_lines(message)};
}

}  // namespace

std::string default_socket_path() {
  const char* configured = std::getenv("SOFTGRIP_SOCKET");
  return configured != nullptr && *configured != '\0' ? configured : "/run/softgrip/softgripd.sock";
}

tl::expected<DaemonClient, ClientFailure> DaemonClient::connect(const std::string& path) {
  return connect(path, 0, reply_timeout);
}

tl::expected<DaemonClient, ClientFailure> DaemonClient::connect_without_waiting(const std::string& path) {
  auto client = connect(path, SOCK_NONBLOCK, send_timeout);
  // connect() must not block. From here on the socket may block, so that send() sends each line completely.
  if (client) ::fcntl(client->descriptor(), F_SETFL, 0);
  return client;
}

tl::expected<DaemonClient, ClientFailure> DaemonClient::connect(const std::string& path, int flags,
                                                                std::chrono::milliseconds send_limit) {
  const auto address = net::unix_address(path);
  if (!address)
    return tl::unexpected{ClientFailure{ExitCode::io, "the path " + path + " is too long for a socket"}};
  Descriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | flags, 0)};
  const timeval limit{send_limit.count() / 1000, send_limit.count() % 1000 * 1000};
  // SO_SNDTIMEO limits the duration of connect() and of send().
  if (!socket || ::setsockopt(socket.get(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit) != 0 ||
      !net::connect_unix(socket, *address)) {
    return tl::unexpected{cannot_connect(path, errno)};
  }
  return DaemonClient{std::move(socket), path};
}

void DaemonClient::send(const Json& request) {
  const std::string line = json_dump(request) + "\n";
  for (std::size_t sent = 0; sent < line.size();) {
    const ssize_t count = ::send(socket_.get(), line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      send_timed_out_ = errno == EAGAIN || errno == EWOULDBLOCK;
      // The daemon has a partial request and would join it with the next request, so the connection is
      // closed.
      if (send_timed_out_) ::shutdown(socket_.get(), SHUT_RDWR);
      return;
    }
    sent += static_cast<std::size_t>(count);
  }
}

tl::expected<Json, ClientFailure> DaemonClient::result_of(const Json& answer) {
  if (!answer.value("ok", false)) return tl::unexpected{failure_of(answer.value("error", Json::object()))};
  return answer.value("result", Json::object());
}

tl::expected<Json, ClientFailure> DaemonClient::call(const Json& request, std::chrono::milliseconds timeout) {
  send(request);
  const auto answer = next_line(timeout);
  if (!answer) return tl::unexpected{answer.error()};
  if (!*answer)
    return tl::unexpected{ClientFailure{ExitCode::io, "the daemon at " + path_ + " does not respond"}};
  return result_of(**answer);
}

tl::expected<std::optional<Json>, ClientFailure> DaemonClient::next_line(std::chrono::milliseconds timeout) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + timeout;
  auto next = pending_.next();
  for (; !next; next = pending_.next()) {
    if (pending_.exceeds(longest_line)) return tl::unexpected{malformed("a line is longer than 8 MiB")};
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd watched{socket_.get(), POLLIN, 0};
    const int ready = ::poll(&watched, 1, static_cast<int>(std::max<std::int64_t>(left, 0)));
    if (ready < 0 && errno == EINTR) return std::optional<Json>{};
    if (ready == 0) return std::optional<Json>{};
    if (pending_.receive(socket_.get()) != net::LineBuffer::Received::bytes)
      return tl::unexpected{connection_closed()};
  }
  auto line = parse_reply(*next);
  if (!line) return tl::unexpected{malformed(line.error())};
  return std::optional<Json>{std::move(*line)};
}

/// Ends the connection, because the lines after a malformed line may also be malformed.
ClientFailure DaemonClient::malformed(const std::string& why) {
  ::shutdown(socket_.get(), SHUT_RDWR);
  pending_.clear();
  return {ExitCode::io, "softgripd sent a malformed reply: " + why};
}

ClientFailure DaemonClient::connection_closed() const {
  return {ExitCode::io, "the daemon at " + path_ +
                            (send_timed_out_ ? " does not accept requests" : " closed the connection")};
}

bool daemon_runs(const std::string& path) {
  const auto client = DaemonClient::connect(path);
  return client.has_value() || !client.error().no_listener;
}

bool DaemonLink::connect(Nanoseconds now) {
  constexpr Nanoseconds retry_pause = ns_per_s / 4;
  if (client_ || (last_attempt_at_ != 0 && now - last_attempt_at_ < retry_pause)) return false;
  last_attempt_at_ = now;
  return !connect_now();
}

std::optional<ClientFailure> DaemonLink::connect_now() {
  if (client_) return std::nullopt;
  auto client = DaemonClient::connect_without_waiting(path_);
  if (!client) return std::move(client.error());
  client_.emplace(std::move(*client));
  return std::nullopt;
}

bool DaemonLink::receive_lines(const std::function<void(nlohmann::ordered_json&)>& on_line) {
  while (client_) {
    auto line = client_->next_line(std::chrono::milliseconds(0));
    if (!line) {
      client_.reset();
    } else if (*line) {
      on_line(**line);
    } else {
      return true;
    }
  }
  return false;
}

}  // namespace softgrip::tools
