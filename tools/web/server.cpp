#include "tools/web/server.h"

#include <sys/resource.h>
#include <sys/socket.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace softgrip::web {

namespace {

/// Longest time between two checks of the daemon, of the time limits and of the sessions.
constexpr Nanoseconds poll_timeout = ns_per_s / 20;
constexpr Nanoseconds check_period = ns_per_s;
/// Largest number of connections that are accepted in one cycle, so that accepting does not delay the
/// connected clients.
constexpr int most_accepted = 32;
constexpr int service_unavailable = 503;
/// Time limit for reading the health result. After this time, a collector gets the metrics with the previous
/// health result.
constexpr Nanoseconds health_timeout = ns_per_s;
constexpr Nanoseconds disk_timeout = 8 * ns_per_s;

/// Size of the send buffer of a socket [bytes]. Without a set size, the system would buffer megabytes for a
/// client that does not read. The system doubles the size that is set. The memory limit of the systemd unit
/// includes these buffers.
constexpr int send_buffer_size = 65536;
constexpr std::size_t most_connections = 512;  // largest number of connections that the configuration file
                                               // may set
constexpr std::size_t process_memory = std::size_t{20} << 20U;
constexpr std::size_t unit_memory_limit = std::size_t{128} << 20U;  // memory limit in
                                                                    // systemd/softgrip-web.service.in [bytes]
static_assert(process_memory + max_unsent +
                      most_connections * (2 * std::size_t{send_buffer_size} + longest_head + longest_body) <
                  unit_memory_limit,
              "the responses that clients have not read yet must fit into the memory of the service");

using Phase = Client::Phase;

}  // namespace

std::size_t descriptor_limit() noexcept {
  rlimit limit{};
  constexpr std::size_t usual_limit = 1024;
  return ::getrlimit(RLIMIT_NOFILE, &limit) == 0 ? std::size_t{limit.rlim_cur} : usual_limit;
}

Server::Server(const Settings& settings, Tokens tokens, std::string chart_js, Descriptor listener,
               Descriptor signals)
    : settings_(settings),
      max_connections_(max_connections_for(settings.max_connections, descriptor_limit())),
      gate_(settings, std::move(tokens)),
      site_(settings, gate_, state_, counts_, std::move(chart_js)),
      watch_(settings.look_socket, state_),
      commander_(settings.operate_socket),
      archive_(settings.recordings),
      acceptor_(std::move(listener)),
      signals_(std::move(signals)) {}

void Server::run() {
  serve_until_signal();
  commander_.abandon_all();
}

void Server::serve_until_signal() {
  net::PollSet polled;
  for (;; polled.clear()) {
    const auto signal = polled.add(signals_.get());
    const auto listener = polled.add(acceptor_.descriptor(clock_.now()));
    polled.add(watch_.descriptor());
    polled.add(commander_.descriptor());
    const auto disk = polled.add(archive_.descriptor());
    for (Connection& connection : connections_) {
      const Client& client = connection.client;
      connection.poll_entry = polled.add(client.descriptor(), !client.input_closed(), client.has_unsent());
    }
    const auto outcome = polled.wait(poll_timeout);
    if (outcome == net::PollSet::Outcome::too_many_descriptors && reduce_connection_limit()) continue;
    if (outcome != net::PollSet::Outcome::done || polled[signal]) return;
    const Nanoseconds now = clock_.now();
    watch_.update(now);
    commander_.update(now);
    if (polled[disk]) archive_.clear_event();
    for (Connection& connection : connections_) {
      if (!connection.closing) process_events(connection, polled[connection.poll_entry], now);
    }
    send_messages(now);
    remove_closing();
    if (polled[listener]) accept(now);
    update_counts();
  }
}

/// Reduces the largest number of connections and closes connections. Must be called if poll() fails because
/// it would watch more descriptors than the process may have. Returns false if there was no connection to
/// close. The failure of poll() then has another cause.
bool Server::reduce_connection_limit() {
  const std::size_t before = connections_.size();
  max_connections_ = max_connections_for(settings_.max_connections, descriptor_limit());
  std::size_t number = 0;
  for (Connection& connection : connections_) {
    if (!connection.closing && ++number > max_long_lived(max_connections_)) evict(connection);
  }
  remove_closing();
  return connections_.size() < before;
}

void Server::update_counts() {
  const Candidates candidates = candidates_except(nullptr);
  counts_.connections = connections_.size();
  counts_.unsent = total_unsent(candidates.infos);
  counts_.streams = static_cast<std::size_t>(std::count_if(
      connections_.begin(), connections_.end(),
      [](const Connection& connection) { return connection.client.phase() == Phase::streaming; }));
}

void Server::accept(Nanoseconds now) {
  for (int i = 0; i < most_accepted; ++i) {
    Descriptor socket = acceptor_.accept(now);
    // If the number of free descriptors is too small for the next client, another connection is closed.
    if (acceptor_.out_of_descriptors()) static_cast<void>(make_room_for_connection(now));
    if (!socket) return;
    ::setsockopt(socket.get(), SOL_SOCKET, SO_SNDBUF, &send_buffer_size, sizeof send_buffer_size);
    if (connections_.size() < max_connections_ || make_room_for_connection(now)) {
      connections_.push_back({Client(std::move(socket), now), {}, {}, {}, 0, {}, 0, false});
      continue;
    }
    ++counts_.rejected;
    const std::string refusal = Site::error_response(service_unavailable);
    // Sends as many bytes of the refusal as the socket accepts at once, because the server does not wait for
    // this client.
    [[maybe_unused]] const ssize_t sent =
        ::send(socket.get(), refusal.data(), refusal.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }
}

void Server::process_events(Connection& connection, net::PollSet::Events events, Nanoseconds now) {
  Client& client = connection.client;
  if (events.input() || events.hangup_or_error()) {
    connection.closing = !client.receive();
    if (!connection.closing && client.phase() == Phase::receiving) {
      serve(connection, now);
      // A client that has closed its sending side before the request was complete can never complete the
      // request, so it is removed.
      if (client.phase() == Phase::receiving && client.input_closed()) connection.closing = true;
    }
  }
  // A client that has closed its sending side has possibly disconnected and cannot receive the outcome of its
  // start request. The server therefore abandons this start request.
  if (client.input_closed() && commander_.is_open_start(connection.command)) connection.closing = true;
  if (client.phase() == Phase::waiting && !connection.closing) process_reply(connection, now);
  if (client.phase() == Phase::sending_file && !connection.closing) process_chunk(connection);
  if (connection.closing) return;
  const bool is_sending = client.phase() != Phase::receiving && client.phase() != Phase::waiting;
  connection.closing = (is_sending && !client.send_pending(now)) || client.timed_out(now);
  if (client.phase() == Phase::sending_file && !connection.closing) request_chunk(connection);
}

void Server::serve(Connection& connection, Nanoseconds now) {
  const std::string& request = connection.client.request();
  const Frame frame = frame_of(request);
  if (frame.state == Frame::State::incomplete) return;
  if (frame.state == Frame::State::refused) return send_error(connection, frame.status, now);
  Outcome outcome = site_.serve(std::string_view(request).substr(0, frame.size), now);
  connection.role = outcome.role;
  if (outcome.disk_request) return request_disk(connection, std::move(*outcome.disk_request), now);
  if (!outcome.command) return respond(connection, std::move(outcome), now);
  const auto sent = commander_.send(std::move(*outcome.command), now);
  if (!sent) return respond(connection, site_.serve(request, now, {.daemon = &sent.error()}), now);
  connection.command = *sent;
  connection.client.wait();
}

void Server::request_disk(Connection& connection, DiskRequest disk_request, Nanoseconds now) {
  const bool is_short_lived = disk_request.kind == DiskRequest::Kind::health;
  if (!is_short_lived && !make_room_for_long_lived(connection, now))
    return send_error(connection, service_unavailable, now);
  connection.task = archive_.submit(std::move(disk_request));
  connection.deadline = now + (is_short_lived ? health_timeout : disk_timeout);
  connection.client.wait();
}

void Server::respond(Connection& connection, Outcome outcome, Nanoseconds now) {
  Client& client = connection.client;
  const Phase next = outcome.stream_reader ? Phase::streaming
                     : outcome.file        ? Phase::sending_file
                                           : Phase::responding;
  if (next != Phase::responding && !make_room_for_long_lived(connection, now))
    return send_error(connection, service_unavailable, now);
  if (outcome.stream_reader) connection.stream_reader = std::move(*outcome.stream_reader);
  connection.download = {std::move(outcome.file), 0, nullptr};
  ++counts_.responses[outcome.status];
  client.respond(std::move(outcome.bytes), next, now);
  connection.closing = !client.send_pending(now);
  if (connection.closing || client.unsent() == 0) return;
  // The socket did not accept all bytes, so the connection becomes a long-lived connection until the
  // remaining bytes are sent.
  if (!make_room_for_long_lived(connection, now) || !make_room_for_bytes(&connection, connection.role))
    evict(connection);
}

void Server::send_error(Connection& connection, int status, Nanoseconds now) {
  Outcome outcome;
  outcome.bytes = Site::error_response(status);
  outcome.status = status;
  respond(connection, std::move(outcome), now);
}

void Server::process_reply(Connection& connection, Nanoseconds now) {
  const std::string& request = connection.client.request();
  if (!connection.task) {
    const auto response = commander_.take_response(connection.command, now);
    if (response) respond(connection, site_.serve(request, now, {.daemon = &*response}), now);
    return;
  }
  const bool done = connection.task->done();
  if (!done && now < connection.deadline) return;
  const auto task = std::exchange(connection.task, nullptr);
  if (done && task->request().kind == DiskRequest::Kind::health) state_.set_health(task->health());
  respond(connection, site_.serve(request, now, {.disk = task.get()}), now);
}

void Server::process_chunk(Connection& connection) {
  Download& download = connection.download;
  if (!download.chunk || !download.chunk->done()) return;
  const auto chunk = std::exchange(download.chunk, nullptr);
  const auto bytes = std::string_view(chunk->text()).substr(0, download.file->size - download.read);
  download.read += bytes.size();
  // If the file has become shorter since the response began, it has fewer bytes than the head of the response
  // has announced. The client is then disconnected.
  connection.closing = bytes.empty() || !connection.client.add(bytes);
  if (download.read == download.file->size) connection.client.finish();
}

/// Requests the next chunk of a file if the previous chunk was sent and memory is available. If there is too
/// little memory, the download waits, so that no other client must be disconnected.
void Server::request_chunk(Connection& connection) {
  Download& download = connection.download;
  if (download.chunk || connection.client.has_unsent() || counts_.unsent + Archive::chunk_size > max_unsent)
    return;
  counts_.unsent += Archive::chunk_size;
  download.chunk = archive_.submit({.kind = DiskRequest::Kind::chunk, .from = download.file});
}

/// Returns true if the reader of a stream has the same role now as when the stream began.
bool Server::has_same_role(const StreamReader& stream_reader, Nanoseconds now) {
  const auto role = gate_.authorize(stream_reader.credentials, false, now);
  return role && *role == stream_reader.role;
}

void Server::send_messages(Nanoseconds now) {
  const std::string messages = state_.take_messages();
  const bool check = now - checked_at_ > check_period;
  if (check) checked_at_ = now;
  if (messages.empty() && !check) return;
  for (Connection& connection : connections_) {
    Client& client = connection.client;
    if (client.phase() != Phase::streaming || connection.closing) continue;
    if (!check || has_same_role(connection.stream_reader, now)) {
      if (!client.add(messages))
        evict(connection);
      else
        connection.closing = !client.send_pending(now);
    } else {
      client.finish();
      connection.closing = !client.add("event: ended\ndata: null\n\n");
    }
  }
  static_cast<void>(make_room_for_bytes(nullptr, Role::operate));
}

void Server::remove_closing() {
  std::erase_if(connections_, [this](const Connection& connection) {
    if (connection.closing && connection.command != 0) commander_.abandon(connection.command);
    return connection.closing;
  });
}

ConnectionInfo Server::info_of(const Connection& connection) {
  const Client& client = connection.client;
  const std::size_t unsent = client.unsent() + (connection.download.chunk ? Archive::chunk_size : 0);
  ConnectionInfo info{ConnectionInfo::Kind::long_lived, connection.role, client.last_progress_at(), unsent};
  if (client.phase() == Phase::receiving) {
    info.kind = ConnectionInfo::Kind::receiving;
    info.last_progress_at = client.connected_at();
  } else if (client.phase() == Phase::waiting) {
    const bool is_short_lived =
        !connection.task || connection.task->request().kind == DiskRequest::Kind::health;
    if (is_short_lived) info.kind = ConnectionInfo::Kind::short_lived;
  } else if (client.phase() == Phase::responding && unsent == 0) {
    info.kind = ConnectionInfo::Kind::short_lived;
  }
  return info;
}

Server::Candidates Server::candidates_except(const Connection* connection) {
  Candidates candidates;
  for (Connection& other : connections_) {
    if (&other == connection || other.closing) continue;
    candidates.infos.push_back(info_of(other));
    candidates.connections.push_back(&other);
  }
  return candidates;
}

/// Marks a connection for which a limit leaves no room for removal at the end of the cycle. Frees the
/// connection's unsent bytes at once, because many responses may be created before the end of the cycle.
void Server::evict(Connection& connection) {
  connection.closing = true;
  connection.client.drop_unsent();
  ++counts_.rejected;
}

bool Server::make_room_for_connection(Nanoseconds now) {
  const Candidates candidates = candidates_except(nullptr);
  const Victim victim = victim_for_new_connection(candidates.infos, now);
  if (!victim) return false;
  evict(*candidates.connections[*victim]);
  remove_closing();
  return true;
}

bool Server::make_room_for_long_lived(const Connection& connection, Nanoseconds now) {
  const Candidates candidates = candidates_except(&connection);
  const auto long_lived =
      std::count_if(candidates.infos.begin(), candidates.infos.end(),
                    [](const ConnectionInfo& info) { return info.kind == ConnectionInfo::Kind::long_lived; });
  if (static_cast<std::size_t>(long_lived) < max_long_lived(max_connections_)) return true;
  const Victim victim = victim_for_long_lived(candidates.infos, connection.role, now);
  if (!victim) return false;
  evict(*candidates.connections[*victim]);
  return true;
}

bool Server::make_room_for_bytes(const Connection* connection, Role role) {
  for (;;) {
    const Candidates candidates = candidates_except(connection);
    const std::size_t unsent =
        total_unsent(candidates.infos) + (connection != nullptr ? connection->client.unsent() : 0);
    if (unsent <= max_unsent) return true;
    const Victim victim = victim_for_memory(candidates.infos, role);
    if (!victim) return false;
    evict(*candidates.connections[*victim]);
  }
}

}  // namespace softgrip::web
