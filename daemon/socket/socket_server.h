#pragma once
// Exchanges lines over a Unix domain socket, with limits for sizes, times and the number of clients. It does
// not interpret the lines.

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "daemon/socket/listener.h"
#include "daemon/socket/role.h"
#include "model/reading.h"
#include "rig/socket_settings.h"

namespace softgrip::daemon {

/// The listening sockets, one per role, and their clients. Each role has its own number of places. All calls
/// come from one thread.
class SocketServer {
 public:
  struct Handlers {
    std::function<void(std::uint64_t client, std::string_view line)> on_line;
    std::function<void(std::uint64_t client)> on_closed;
    /// Returns true if a line must be processed even for a client without a place.
    std::function<bool(std::string_view line)> is_urgent;
    /// Called before the first line of a client.
    std::function<void(std::uint64_t client, Role role)> on_opened = nullptr;
    /// Returns true if a client keeps its place while it is silent.
    std::function<bool(std::uint64_t client)> keeps_place = nullptr;
  };

  /// Opens the sockets of the settings (daemon/socket/listener.h). The error is a sentence.
  [[nodiscard]] static tl::expected<SocketServer, std::string> listen(const rig::SocketSettings& settings);
  SocketServer(const SocketServer&) = delete;
  SocketServer& operator=(const SocketServer&) = delete;
  SocketServer(SocketServer&& other) noexcept;
  SocketServer& operator=(SocketServer&&) = delete;
  ~SocketServer();

  /// Must be called before the first poll().
  void set_handlers(Handlers handlers) { handlers_ = std::move(handlers); }

  /// Waits for events, at most until `until`, and processes a part of the lines of each client; the next call
  /// processes the others. If all places are taken, a new client gets the place of a client that has been
  /// silent for long and does not keep its place. If there is no such client, the new client may send one
  /// line, which is refused unless it is urgent. If a client has closed its end meanwhile, its urgent lines
  /// are still processed.
  void poll(Nanoseconds now, Nanoseconds until);

  /// Queues a line for a client. Returns false if the client has disconnected, or if `skippable` is true and
  /// the client has not read all queued lines.
  bool send(std::uint64_t client, std::string_view line, bool skippable);

  [[nodiscard]] std::size_t clients() const noexcept { return clients_.size(); }

 private:
  struct Client {
    Descriptor socket;
    Role role = Role::look;
    std::string input;
    std::string output;
    Nanoseconds stalled_since = 0;  // time since which output waits and nothing was read; 0: no output waits
    Nanoseconds ended_at = 0;       // time at which the client ended: it will send no more lines; 0: it may
    Nanoseconds active_at = 0;      // time of the last sent or read line, or of the connection
    bool spoke = false;             // it has sent a line
    bool stands = false;            // it has no place
    bool closing = false;           // the connection is closed after the output is sent
    bool deaf = false;              // it reads no more; its last lines are still processed
    bool dead = false;
  };

  struct Entrance {
    Role role;
    Listener listener;
  };

  explicit SocketServer(const rig::SocketSettings& settings) : settings_(settings) {}
  [[nodiscard]] std::size_t count_of(Role role) const;
  void accept_some(const Entrance& entrance);
  Descriptor accept_one(const Entrance& entrance);
  [[nodiscard]] bool may_go(std::uint64_t id, const Client& client, bool any) const;
  bool displace_one(Role role, bool any);
  [[nodiscard]] std::string too_many() const;
  void hear(std::uint64_t id, Client& client, std::string_view line);
  void read_from(Client& client);
  void take_lines(std::uint64_t id, Client& client);
  [[nodiscard]] static bool has_line(const Client& client);
  void write_to(Client& client, Nanoseconds now);
  static void stop_writing(Client& client);
  void sweep(Nanoseconds now);

  rig::SocketSettings settings_;
  std::vector<Entrance> listeners_;
  Handlers handlers_;
  std::map<std::uint64_t, Client> clients_;
  std::uint64_t last_id_ = 0;
  Nanoseconds now_ = 0;
  Nanoseconds accepts_again_ = 0;  // no free descriptor until this time
  bool lines_left_ = false;        // a client has lines for the next call
};

}  // namespace softgrip::daemon
