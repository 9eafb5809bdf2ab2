#pragma once
// Implements the server of the emulator. One thread waits with poll() for Modbus clients, control clients and
// signals.
// Executes the control commands of the emulator. Scripts and users send each command as a line:
//
//   status                 one line of JSON: true state of board, fingers and faults
//   fault NAME             begins the fault NAME of the faults file
//   clear NAME             ends the fault NAME
//   object out | back      removes the object, or puts the same object back
//   object stone | screw | POSITION_MM[:YIELDING]    puts a new object between the fingers
//   quit                   ends the emulator

#include <csignal>
#include <cstddef>
#include <functional>
#include <list>
#include <optional>
#include <string_view>
#include <vector>

#include "base/descriptor.h"
#include "base/net/line_buffer.h"
#include "base/net/listener.h"
#include "base/net/poll_set.h"
#include "simulation/emulator/emulator.h"
#include "simulation/emulator/serial_end.h"
#include "simulation/emulator/wire.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

struct ServerSockets {
  std::vector<Descriptor> modbus;  ///< listening sockets, one for each link of a network
  /// Settings of the serial line; empty if the links are on a network. The server needs the settings to open
  /// the line again after the fault `disconnect`.
  std::optional<drivers::SerialLine> line;
  std::optional<SerialEnd> end;
  Descriptor control;           ///< listening socket for control commands; empty: the server has no control
                                ///< socket
  Descriptor signals;           ///< signalfd descriptor: SIGUSR1 removes the object, and every other signal
                                ///< ends run()
  bool standard_input = false;  ///< true: control commands are also read from the standard input
};

class Server {
 public:
  Server(Emulator& emulator, ServerSockets sockets);
  /// Serves the clients until a signal or the control command `quit` arrives. `idle` is called at least every
  /// 20 ms.
  void run(const std::function<void()>& idle);

 private:
  struct ControlClient {
    Descriptor socket;  ///< socket of the client; empty: the client is the standard input
    net::LineBuffer pending;
    bool open = true;
    net::PollSet::Entry poll_entry = {};
    [[nodiscard]] int input() const noexcept;
  };

  [[nodiscard]] Nanoseconds now() const;
  [[nodiscard]] Nanoseconds timeout() const;
  /// Closes the connection of one network client after the limit of descriptors was lowered. Returns false if
  /// no such client is connected.
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
    net::PollSet::Entry poll_entry = {};
  };
  /// Processes the events of a Modbus client. Returns false if the client has closed its connection or must
  /// be disconnected.
  [[nodiscard]] bool serve(Client& client, net::PollSet::Events events);
  void read_control(ControlClient& client);
  void answer_control(const ControlClient& client, std::string_view line);

  Emulator& emulator_;
  ServerSockets sockets_;
  std::vector<net::Acceptor> acceptors_;  // one acceptor for each link
  net::Acceptor control_acceptor_;
  Clock::time_point start_ = Clock::now();
  std::list<Client> clients_;
  std::list<ControlClient> control_clients_;
  bool quit_ = false;
};

/// Returns the object that a text describes, for example "stone", "screw", "13" or "13:0.2". Returns nullopt
/// if the text describes no object.
[[nodiscard]] std::optional<simulation::PlantObject> object_named(std::string_view text);

struct ControlAnswer {
  std::string line;   ///< reply to the command: "ok", "error: ..." or the status, without a line break
  bool quit = false;  ///< true: the command requests that the emulator ends
};

/// Executes one command line at the time `now`.
[[nodiscard]] ControlAnswer control(Emulator& emulator, Nanoseconds now, std::string_view line);

}  // namespace softgrip::simulation
