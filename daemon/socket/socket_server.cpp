#include "daemon/socket/socket_server.h"

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/net/listener.h"
#include "base/periodic_schedule.h"
#include "daemon/socket/reply_json.h"

namespace softgrip::daemon {

namespace {

/// Largest number of new clients that one call accepts, so that the clients that are already connected do not
/// wait too long.
constexpr int most_accepts = 4;
/// If `max_clients` clients are connected, the server can disconnect a silent client to admit a new client. A
/// client that has sent no request counts as silent after `first_request_timeout` [ns]. Any other client
/// counts as silent `client_idle_timeout` [ns] after its last request or reply.
constexpr Nanoseconds first_request_timeout = ns_per_s / 10;
constexpr Nanoseconds client_idle_timeout = 5 * ns_per_s;
/// Largest number of clients of one role that are connected in addition to the permitted `max_clients`. The
/// server refuses the requests of these clients, except urgent requests such as stop and vent.
constexpr std::size_t max_over_limit = 32;
/// Longest time for which the lines of one client are processed in one call. Processing a line is never
/// interrupted.
constexpr std::chrono::microseconds max_turn_time(500);
/// Time until the server tries to accept a client again if no descriptor was free [ns]. Without a descriptor,
/// the server cannot even refuse a client.
constexpr Nanoseconds accept_pause = ns_per_s / 10;
/// Time after which a client that does not read its output is disconnected [ns].
constexpr Nanoseconds stall_timeout = 10 * ns_per_s;
/// Longest time for which a client that has closed its sending side may wait for its replies [ns].
constexpr Nanoseconds half_closed_timeout = 2 * ns_per_s;

}  // namespace

tl::expected<SocketServer, std::string> SocketServer::listen(const rig::SocketSettings& settings) {
  SocketServer server(settings);
  const auto add = [&server](Role role, const rig::SocketFile& file) -> std::string {
    auto listener = Listener::open(file);
    if (!listener) return std::move(listener.error());
    server.endpoints_.push_back({role, std::move(*listener)});
    return {};
  };
  std::string problem = add(Role::operate, settings);
  if (problem.empty() && !settings.look.path.empty()) problem = add(Role::look, settings.look);
  if (!problem.empty()) return tl::unexpected(std::move(problem));
  return server;
}

SocketServer::SocketServer(SocketServer&& other) noexcept = default;
SocketServer::~SocketServer() = default;

void SocketServer::poll(Nanoseconds now, Nanoseconds until) {
  now_ = now;
  const bool accepts = now >= accept_resumes_at_;
  polled_.clear();
  for (Endpoint& endpoint : endpoints_)
    endpoint.poll_entry = polled_.add(endpoint.listener.socket().get(), accepts);
  for (auto& [id, client] : clients_) {
    // Nothing is read from a client that has not read its replies, or that has unprocessed lines from its
    // last turn.
    const bool writes = !client.output.empty();
    const bool reads = !writes && client.input_ended_at == 0 && !client.input.has_line();
    client.poll_entry = polled_.add(client.socket.get(), reads, writes);
  }
  // If the wait fails, there are no events, so the result is ignored.
  static_cast<void>(polled_.wait(has_pending_lines_ ? 0 : std::max<Nanoseconds>(until - now, 0)));
  for (auto& [id, client] : clients_) {
    const net::PollSet::Events events = polled_[client.poll_entry];
    if (events.hangup_or_error()) close_output(client);
    if (events.output()) write_to(client, now);
    if (events.input() || (events.hangup_or_error() && !client.input.has_line())) read_from(client);
    if (events.invalid()) client.failed = true;
  }
  for (const Endpoint& endpoint : endpoints_) {
    if (polled_[endpoint.poll_entry].input()) accept_clients(endpoint);
  }
  has_pending_lines_ = false;
  // Clients that may stop or vent the rig are served first.
  for (const Role role : {Role::operate, Role::look}) {
    for (auto& [id, client] : clients_) {
      if (client.role != role) continue;
      process_lines(id, client);
      has_pending_lines_ =
          has_pending_lines_ || (!client.failed && client.output.empty() && client.input.has_line());
    }
  }
  remove_finished(now);
}

std::size_t SocketServer::count_of(Role role) const {
  return static_cast<std::size_t>(std::count_if(
      clients_.begin(), clients_.end(), [role](const auto& entry) { return entry.second.role == role; }));
}

void SocketServer::accept_clients(const Endpoint& endpoint) {
  const Role role = endpoint.role;
  for (int i = 0; i < most_accepts; ++i) {
    Descriptor socket = accept_one(endpoint);
    if (!socket) return;
    const bool over_limit = count_of(role) >= settings_.max_clients && !disconnect_one(role, false);
    if (count_of(role) >= settings_.max_clients + max_over_limit) disconnect_one(role, true);
    Client& client = clients_[++last_id_];
    client.socket = std::move(socket);
    client.role = role;
    client.last_active_at = now_;
    client.over_limit = over_limit;
    if (handlers_.on_opened) handlers_.on_opened(last_id_, role);
    read_from(client);  // in most cases, the first line of a new client has already arrived
  }
}

/// Accepts a new client. If no client waits, returns an invalid descriptor. If no descriptor is free,
/// disconnects the client that was silent for the longest time, and tries to accept again. A new read-only
/// client cannot replace a client that may operate the rig. If no client can be disconnected, returns an
/// invalid descriptor.
Descriptor SocketServer::accept_one(const Endpoint& endpoint) {
  for (;;) {
    Descriptor socket = net::accept_client(endpoint.listener.socket());
    if (socket || !net::is_descriptor_shortage(errno)) return socket;
    if (disconnect_one(Role::look, true)) continue;
    if (endpoint.role == Role::operate && disconnect_one(Role::operate, true)) continue;
    accept_resumes_at_ = now_ + accept_pause;
    return socket;
  }
}

/// Returns true if the server may disconnect the client to admit another one: the client has ended, or was
/// silent for too long, or `force` is true. A client that keeps its connection is not disconnected, because,
/// for example, a running sequence would lose its owner.
bool SocketServer::may_disconnect(std::uint64_t id, const Client& client, bool force) const {
  if (client.input_ended_at != 0) return true;
  if (handlers_.keeps_connection && handlers_.keeps_connection(id)) return false;
  return force ||
         now_ - client.last_active_at >= (client.has_sent_line ? client_idle_timeout : first_request_timeout);
}

/// Disconnects one client of the role to admit another one, if possible. The order of preference is: a client
/// that has ended, a client over the limit, a client that never sent a line, and the client that was silent
/// for the longest time. Returns false if no client may be disconnected.
bool SocketServer::disconnect_one(Role role, bool force) {
  const auto rank = [](const Client& client) {
    return std::tuple(client.input_ended_at == 0, !client.over_limit, client.has_sent_line,
                      client.last_active_at);
  };
  auto found = clients_.end();
  for (auto entry = clients_.begin(); entry != clients_.end(); ++entry) {
    const Client& client = entry->second;
    if (client.role != role || !may_disconnect(entry->first, client, force)) continue;
    if (found == clients_.end() || rank(client) < rank(found->second)) found = entry;
  }
  if (found == clients_.end()) return false;
  // An error of send() is ignored, because the server does not wait for a client that does not read.
  const std::string line = too_many_clients_line();
  [[maybe_unused]] const ssize_t sent =
      ::send(found->second.socket.get(), line.data(), line.size(), MSG_NOSIGNAL);
  const std::uint64_t id = found->first;
  clients_.erase(found);
  handlers_.on_closed(id);
  return true;
}

std::string SocketServer::too_many_clients_line() const {
  return error_line(
      std::nullopt, "too_many_clients",
      fmt::format(
          "at most {} clients may be connected at the same time; stop and vent requests are still accepted",
          settings_.max_clients));
}

void SocketServer::process_line(std::uint64_t id, Client& client, std::string_view line) {
  const bool within_limit = !client.over_limit && !client.output_closed;
  if (within_limit || (handlers_.is_urgent && handlers_.is_urgent(line))) {
    handlers_.on_line(id, line);
  } else if (!client.output_closed) {
    send(id, too_many_clients_line(), false);
    client.closing = true;
  }
  // A client over the limit may send one line and wait for the reply to this line.
  if (client.over_limit) client.input_ended_at = now_;
}

void SocketServer::read_from(Client& client) {
  if (client.closing) return;
  // A client such as `echo ... | socat` closes its sending side, but waits for the reply.
  if (client.input.receive(client.socket.get()) == net::LineBuffer::Received::end)
    client.input_ended_at = now_;
}

/// Processes the lines of a client until the client's turn ends, or until the client has unread replies.
void SocketServer::process_lines(std::uint64_t id, Client& client) {
  const auto began = std::chrono::steady_clock::now();
  bool too_long = false;
  while (!client.failed && client.output.empty()) {
    const auto next = client.input.next();
    if (!next) break;
    const std::string_view line = net::without_cr(*next);
    too_long = line.size() > settings_.max_line_bytes;
    if (too_long) break;
    client.last_active_at = now_;
    client.has_sent_line = true;
    if (!line.empty()) process_line(id, client, line);
    if (client.over_limit) client.input.clear();
    if (std::chrono::steady_clock::now() - began > max_turn_time) break;
  }
  if (too_long || client.input.exceeds(settings_.max_line_bytes)) {
    send(id,
         error_line(std::nullopt, "too_long",
                    fmt::format("a line may have at most {} bytes", settings_.max_line_bytes)),
         false);
    client.input.clear();
    client.closing = true;
  }
}

bool SocketServer::send(std::uint64_t id, std::string_view line, bool skippable) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return false;
  Client& client = found->second;
  if (client.failed || client.output_closed || client.closing || (skippable && !client.output.empty()))
    return false;
  if (client.output.size() + line.size() > settings_.max_queue_bytes) {
    client.failed = true;
    return false;
  }
  client.output += line;
  write_to(client, now_);
  return true;
}

void SocketServer::write_to(Client& client, Nanoseconds now) {
  while (!client.output.empty()) {
    const ssize_t count =
        ::send(client.socket.get(), client.output.data(), client.output.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) {
      if (client.stalled_since == 0) client.stalled_since = now;
      return;
    }
    if (count < 0) {
      close_output(client);
      return;
    }
    client.output.erase(0, static_cast<std::size_t>(count));
    client.stalled_since = 0;
    client.last_active_at = now;
  }
}

/// Sends nothing more to a client that has closed its end. The server still reads the lines that the client
/// sent before, because they may contain a stop or a vent.
void SocketServer::close_output(Client& client) {
  client.output_closed = true;
  client.output.clear();
  client.stalled_since = 0;
}

void SocketServer::remove_finished(Nanoseconds now) {
  for (auto entry = clients_.begin(); entry != clients_.end();) {
    Client& client = entry->second;
    const bool stalled = client.stalled_since != 0 && now - client.stalled_since > stall_timeout;
    const bool waits = !client.output_closed && now - client.input_ended_at <= half_closed_timeout;
    const bool ended = client.input_ended_at != 0 && !waits && !client.input.has_line();
    const bool done = (client.closing || ended) && client.output.empty();
    if (!client.failed && !stalled && !done) {
      ++entry;
      continue;
    }
    const std::uint64_t id = entry->first;
    entry = clients_.erase(entry);
    handlers_.on_closed(id);
  }
}

}  // namespace softgrip::daemon
