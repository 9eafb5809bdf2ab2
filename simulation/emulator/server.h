#pragma once
// The emulator on the wire: one thread, poll(), Modbus clients, control clients, signals.

#include <csignal>
#include <cstddef>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include "base/descriptor.h"
#include "drivers/modbus_server/entrance.h"
#include "simulation/emulator/emulator.h"
#include "simulation/emulator/serial_end.h"
#include "simulation/emulator/wire.h"

namespace softgrip::simulation {

struct ServerSockets {
  std::vector<Descriptor> modbus;  ///< listening, one per link of a network
  /// A serial line in the place of the network: how it is opened, and opened again after `disconnect`.
  std::optional<drivers::SerialLine> line;
  std::optional<SerialEnd> end;
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

  [[nodiscard]] Nanoseconds now() const;
  [[nodiscard]] std::chrono::nanoseconds timeout() const;
  /// The limit of descriptors was lowered. False: there is no client to give up.
  [[nodiscard]] bool give_up_client();
  void accept_modbus(std::size_t link);
  void count_clients();
  void plug_line();
  void accept_control();
  void take_signal();
  struct Client {
    Connection connection;
    std::size_t link = 0;
    Nanoseconds opened_at = 0;
  };
  void serve(Client& client, short events, bool& open);
  void read_control(ControlClient& client);
  void answer_control(const ControlClient& client, std::string_view line);

  Emulator& emulator_;
  ServerSockets sockets_;
  std::vector<modbus::Entrance> entrances_;  // one per link
  modbus::Entrance control_entrance_;
  Clock::time_point start_ = Clock::now();
  std::list<Client> clients_;
  std::list<ControlClient> control_clients_;
  bool quit_ = false;
};

}  // namespace softgrip::simulation
