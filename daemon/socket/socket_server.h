#pragma once
// Exchanges lines over a Unix domain socket, with limits for sizes, times and the number of clients. The
// server does not interpret the lines.

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "base/net/line_buffer.h"
#include "base/net/poll_set.h"
#include "daemon/socket/client_request.h"
#include "daemon/socket/listener.h"
#include "model/reading.h"
#include "rig/daemon_settings.h"

namespace softgrip::daemon {

/// The listening sockets, one per role, and their clients. Each role has its own maximum number of clients.
/// All functions must be called from one thread.
class SocketServer {
 public:
  struct Handlers {
    std::function<void(std::uint64_t client, std::string_view line)> on_line;
    std::function<void(std::uint64_t client)> on_closed;
    /// Returns true if a line must be processed even if its client exceeds the maximum number of clients.
    /// Examples are stop and vent.
    std::function<bool(std::string_view line)> is_urgent;
    /// Called before the first line of a client is processed.
    std::function<void(std::uint64_t client, Role role)> on_opened = nullptr;
    /// Returns true if a client keeps its connection although it sends nothing.
    std::function<bool(std::uint64_t client)> keeps_connection = nullptr;
  };

  /// Opens the sockets that `settings` gives (daemon/socket/listener.h). The error is a sentence.
  [[nodiscard]] static tl::expected<SocketServer, std::string> listen(const rig::SocketSettings& settings);
  SocketServer(const SocketServer&) = delete;
  SocketServer& operator=(const SocketServer&) = delete;
  SocketServer(SocketServer&& other) noexcept;
  SocketServer& operator=(SocketServer&&) = delete;
  ~SocketServer();

  /// Sets the functions that process the lines. Must be called before the first poll().
  void set_handlers(Handlers handlers) { handlers_ = std::move(handlers); }

  /// Waits for events, at most until `until`. Processes a part of the lines of each client; the next call
  /// processes the remaining lines. If the maximum number of clients is connected, a new client replaces a
  /// client that was silent for too long and does not keep its connection. If there is no such client, the
  /// new client may send one line, which is refused unless it is urgent. If a client has closed its end, its
  /// urgent lines are still processed.
  void poll(Nanoseconds now, Nanoseconds until);

  /// Queues a line for a client. Returns false if the client has disconnected. Also returns false if
  /// `skippable` is true and the client has not read all queued lines.
  bool send(std::uint64_t client, std::string_view line, bool skippable);

  [[nodiscard]] std::size_t clients() const noexcept { return clients_.size(); }

 private:
  struct Client {
    Descriptor socket;
    Role role = Role::look;
    net::LineBuffer input;
    std::string output;
    Nanoseconds stalled_since = 0;   // time since which the client has not read the waiting output; 0: no
                                     // output waits
    Nanoseconds input_ended_at = 0;  // time at which the server read the last line of the client; 0: the
                                     // client can still send lines
    Nanoseconds last_active_at = 0;  // time of the last line that was sent to or read from the client; before
                                     // the first line: time of the connection
    bool has_sent_line = false;      // true: the client has sent a line
    bool over_limit = false;         // true: the client exceeds the maximum number of clients
    bool closing = false;            // true: the connection is closed after all output is sent
    bool output_closed = false;  // true: the client does not read any more; the server still processes the
                                 // lines that the client sent before
    bool failed = false;
    net::PollSet::Entry poll_entry;
  };

  struct Endpoint {
    Role role;
    Listener listener;
    net::PollSet::Entry poll_entry = {};
  };

  explicit SocketServer(const rig::SocketSettings& settings) : settings_(settings) {}
  [[nodiscard]] std::size_t count_of(Role role) const;
  void accept_clients(const Endpoint& endpoint);
  Descriptor accept_one(const Endpoint& endpoint);
  [[nodiscard]] bool may_disconnect(std::uint64_t id, const Client& client, bool force) const;
  bool disconnect_one(Role role, bool force);
  [[nodiscard]] std::string too_many_clients_line() const;
  void process_line(std::uint64_t id, Client& client, std::string_view line);
  void read_from(Client& client);
  void process_lines(std::uint64_t id, Client& client);
  void write_to(Client& client, Nanoseconds now);
  static void close_output(Client& client);
  void remove_finished(Nanoseconds now);

  rig::SocketSettings settings_;
  std::vector<Endpoint> endpoints_;
  Handlers handlers_;
  net::PollSet polled_;
  std::map<std::uint64_t, Client> clients_;
  std::uint64_t last_id_ = 0;
  Nanoseconds now_ = 0;
  Nanoseconds accept_resumes_at_ = 0;  // time until which the server accepts no clients, because no
                                       // descriptor was free
  bool has_pending_lines_ = false;     // true: a client has lines that the next call of poll() must process
};

}  // namespace softgrip::daemon
