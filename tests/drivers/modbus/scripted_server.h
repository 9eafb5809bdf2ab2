#pragma once
// A TCP server for tests. The test specifies the response to each request, for example a faulty response. The
// server uses plain sockets and no code of drivers/, because the same error in the server and the driver
// would remain undetected.

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

namespace softgrip::drivers::test {

using Bytes = std::vector<std::uint8_t>;

/// The server's end of a TCP session with a client.
class Peer {
 public:
  Peer(int socket, class ScriptedServer& server) : socket_(socket), server_(server) {}
  void send(const Bytes& bytes);
  /// Sends the bytes one by one at intervals of `pause`. Stops early if the client closes the connection or
  /// the test stops the server.
  void drip(const Bytes& bytes, std::chrono::milliseconds pause);
  /// Waits for `duration`. Returns earlier if the test stops the server.
  void wait(std::chrono::milliseconds duration);
  /// Closes the session in the normal way, with FIN.
  void hang_up();
  /// Aborts the session with RST.
  void reset();
  [[nodiscard]] bool is_open() const { return open_; }

 private:
  int socket_;
  ScriptedServer& server_;
  bool open_ = true;
};

class ScriptedServer {
 public:
  /// Function that sends the response to a request. `index` is the number of the request, counted from 0
  /// across all sessions. `request` is one complete frame.
  using Handler = std::function<void(Peer& peer, const Bytes& request, std::size_t index)>;

  /// Listens on a free port of 127.0.0.1. Serves one session after the other.
  explicit ScriptedServer(Handler handler);
  ScriptedServer(const ScriptedServer&) = delete;
  ScriptedServer& operator=(const ScriptedServer&) = delete;
  ScriptedServer(ScriptedServer&&) = delete;
  ScriptedServer& operator=(ScriptedServer&&) = delete;
  ~ScriptedServer();

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::size_t sessions() const { return sessions_; }

 private:
  friend class Peer;
  void serve();
  void serve_session(int socket);
  bool read_exactly(int socket, std::span<std::uint8_t> bytes);
  [[nodiscard]] bool wait_readable(int socket);

  Handler handler_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<bool> stopping_{false};
  std::atomic<std::size_t> sessions_{0};
  std::size_t requests_ = 0;
  std::mutex mutex_;
  std::condition_variable stop_;
  std::thread thread_;
};

/// Returns the 16-bit word at the position `at`, high byte first.
[[nodiscard]] std::uint16_t word(const Bytes& bytes, std::size_t at);
void set_word(Bytes& bytes, std::size_t at, std::uint16_t value);

/// Returns a correct frame with the given PDU. The transaction id and the unit id are those of `request`.
[[nodiscard]] Bytes frame_for(const Bytes& request, const Bytes& pdu);
/// Returns a correct response to a read request. In the response, register `address` contains
/// value_of(address).
[[nodiscard]] Bytes registers_reply(const Bytes& request,
                                    const std::function<std::uint16_t(std::uint16_t)>& value_of);
[[nodiscard]] Bytes exception_reply(const Bytes& request, std::uint8_t code);

}  // namespace softgrip::drivers::test
