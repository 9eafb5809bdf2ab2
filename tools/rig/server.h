#pragma once
// The emulator on the wire: one thread, poll(), Modbus clients, control clients, signals.

#include <csignal>
#include <cstddef>
#include <functional>
#include <list>
#include <string>

#include "tools/descriptor.h"
#include "tools/rig/connection.h"
#include "tools/rig/emulator.h"

namespace softgrip::tools::rig {

struct ServerSockets {
  Descriptor modbus;            ///< listening
  Descriptor control;           ///< listening, or empty
  Descriptor signals;           ///< a signalfd: SIGUSR1 pulls the object out, all others end run()
  bool standard_input = false;  ///< take control commands from there as well
};

class Server {
 public:
  Server(Emulator& emulator, ServerSockets sockets);
  /// Until a signal or the control command `quit`. `idle` is called many times a second.
  void run(const std::function<void()>& idle);

 private:
  struct ControlClient {
    Descriptor socket;  ///< empty: the standard input
    std::string pending;
    bool open = true;
    [[nodiscard]] int input() const noexcept;
  };

  [[nodiscard]] model::Nanoseconds now() const;
  [[nodiscard]] int timeout_ms() const;
  void accept_modbus();
  void accept_control();
  void take_signal();
  void serve(Connection& connection, short events, bool& open);
  void read_control(ControlClient& client);
  void answer_control(const ControlClient& client, std::string_view line);

  Emulator& emulator_;
  ServerSockets sockets_;
  Clock::time_point start_ = Clock::now();
  std::list<Connection> connections_;
  std::list<ControlClient> control_clients_;
  bool quit_ = false;
};

}  // namespace softgrip::tools::rig
