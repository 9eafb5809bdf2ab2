#pragma once
// A TCP server that does with each request whatever a test wants: the hostile peer. Plain sockets, nothing of
// drivers/ in it, so that an error there cannot cancel itself out here.

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

/// The server's end of a session.
class Peer {
 public:
  Peer(int socket, class ScriptedServer& server) : socket_(socket), server_(server) {}
  void send(const Bytes& bytes);
  /// One byte every `pause`, until all are out, the client hung up or the server is stopped.
  void drip(const Bytes& bytes, std::chrono::milliseconds pause);
  /// Pauses; ends early when the server is stopped.
  void wait(std::chrono::milliseconds duration);
  /// Ends the session in order.
  void hang_up();
  /// Ends it with RST.
  void reset();
  [[nodiscard]] bool is_open() const { return open_; }

 private:
  int socket_;
  ScriptedServer& server_;
  bool open_ = true;
};

class ScriptedServer {
 public:
  /// `index` counts the requests of all sessions from 0; `request` is one whole frame.
  using Handler = std::function<void(Peer& peer, const Bytes& request, std::size_t index)>;

  /// Listens on a free port of 127.0.0.1 and serves one session after the other.
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

/// The word at `at`, high byte first.
[[nodiscard]] std::uint16_t word(const Bytes& bytes, std::size_t at);
void set_word(Bytes& bytes, std::size_t at, std::uint16_t value);

/// A correct frame that answers `request` (its transaction and unit) with the given PDU.
[[nodiscard]] Bytes frame_for(const Bytes& request, const Bytes& pdu);
/// A correct answer to a read of registers: register `address` holds value_of(address).
[[nodiscard]] Bytes registers_reply(const Bytes& request,
                                    const std::function<std::uint16_t(std::uint16_t)>& value_of);
[[nodiscard]] Bytes exception_reply(const Bytes& request, std::uint8_t code);

}  // namespace softgrip::drivers::test
