#pragma once
// Lines over a Unix domain socket, every bound enforced. Knows nothing of what the lines mean.

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "model/reading.h"
#include "rig/socket_settings.h"

namespace softgrip::daemon {

/// Whether a daemon listens on the socket at `path`.
[[nodiscard]] bool socket_answers(const std::string& path);

/// A listening socket and its clients. All calls come from one thread.
class SocketServer {
 public:
  struct Handlers {
    std::function<void(std::uint64_t client, std::string_view line)> on_line;
    std::function<void(std::uint64_t client)> on_closed;
  };

  /// Creates the socket's file with the owner's rights first and the settings' then. A file left by a daemon
  /// that is gone is replaced; one of a daemon that answers is an error. The error is a sentence.
  [[nodiscard]] static tl::expected<SocketServer, std::string> listen(const rig::SocketSettings& settings);
  SocketServer(const SocketServer&) = delete;
  SocketServer& operator=(const SocketServer&) = delete;
  SocketServer(SocketServer&& other) noexcept;
  SocketServer& operator=(SocketServer&&) = delete;
  /// Removes the socket's file.
  ~SocketServer();

  /// To be set before the first poll().
  void set_handlers(Handlers handlers) { handlers_ = std::move(handlers); }

  /// Waits for something to happen, at most until `until`, and deals with it.
  void poll(Nanoseconds now, Nanoseconds until);

  /// Queues a line for a client; unknown clients are ignored. `skippable`: dropped if the client has not yet
  /// read what was queued before.
  void send(std::uint64_t client, std::string_view line, bool skippable);

  [[nodiscard]] std::size_t clients() const noexcept { return clients_.size(); }

 private:
  struct Client {
    Descriptor socket;
    std::string input;
    std::string output;
    Nanoseconds stalled_since = 0;  // output is waiting and nothing was taken since; 0: not
    Nanoseconds ended_at = 0;       // will send no more; 0: may
    bool closing = false;           // after the output is gone
    bool dead = false;
  };

  SocketServer(const rig::SocketSettings& settings, Descriptor listener)
      : settings_(settings), listener_(std::move(listener)) {}
  void accept_all();
  void read_from(std::uint64_t id, Client& client);
  void take_lines(std::uint64_t id, Client& client);
  void write_to(Client& client, Nanoseconds now);
  void sweep(Nanoseconds now);

  rig::SocketSettings settings_;
  Descriptor listener_;
  Handlers handlers_;
  std::map<std::uint64_t, Client> clients_;
  std::uint64_t last_id_ = 0;
  Nanoseconds now_ = 0;
};

}  // namespace softgrip::daemon
