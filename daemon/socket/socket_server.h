#pragma once
// Lines over a Unix domain socket, every bound enforced. Knows nothing of what the lines mean.

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

/// The listening sockets, one per role, and their clients. Every role has places of its own. All calls come
/// from one thread.
class SocketServer {
 public:
  struct Handlers {
    std::function<void(std::uint64_t client, std::string_view line)> on_line;
    std::function<void(std::uint64_t client)> on_closed;
    /// Returns true if a line must be heard even from a client for which there is no place.
    std::function<bool(std::string_view line)> is_urgent;
    /// Before its first line.
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

  /// To be set before the first poll().
  void set_handlers(Handlers handlers) { handlers_ = std::move(handlers); }

  /// Waits for something to happen, at most until `until`, and deals with it: a part of it, if there is much,
  /// so that every client has its turn in the next call. When all places are taken, a new client gets that of
  /// one that has been silent for long and does not keep its place. If there is none, the new client may send
  /// one line, which is refused unless it is urgent. Urgent lines of a client that has closed its end
  /// meanwhile are heard.
  void poll(Nanoseconds now, Nanoseconds until);

  /// Queues a line for a client; false if it is gone. `skippable`: dropped, and false, if the client has not
  /// yet read what was queued before.
  bool send(std::uint64_t client, std::string_view line, bool skippable);

  [[nodiscard]] std::size_t clients() const noexcept { return clients_.size(); }

 private:
  struct Client {
    Descriptor socket;
    Role role = Role::look;
    std::string input;
    std::string output;
    Nanoseconds stalled_since = 0;  // output is waiting and nothing was taken since; 0: not
    Nanoseconds ended_at = 0;       // will send no more; 0: may
    Nanoseconds active_at = 0;      // it sent a line or took one, or it came
    bool spoke = false;             // it has sent a line
    bool stands = false;            // there was no place for it
    bool closing = false;           // after the output is gone
    bool deaf = false;              // it reads no more; its last lines are still to be read
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
  Nanoseconds accepts_again_ = 0;  // out of descriptors until then
  bool lines_left_ = false;        // of any client, for the next call
};

}  // namespace softgrip::daemon
