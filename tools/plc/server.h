#pragma once
// Masters on the network, in one thread that never waits for any of them.

#include <chrono>
#include <list>
#include <string>

#include "base/clock.h"
#include "base/descriptor.h"
#include "drivers/modbus_server/connection.h"
#include "drivers/modbus_server/entrance.h"
#include "tools/plc/daemon_line.h"
#include "tools/plc/gateway.h"

namespace softgrip::plc {

class Server {
 public:
  /// `listener`: of modbus::listen_tcp(). `signals`: a signalfd; any signal ends run(). References outlive
  /// it.
  Server(const Settings& settings, Gateway& gateway, Descriptor listener, Descriptor signals);
  void run();

 private:
  struct Line {
    Masters::Id master;
    modbus::Connection connection;
  };
  /// The limit of descriptors was lowered. False: there is no connection to give up.
  [[nodiscard]] bool give_up_line();
  void accept(Nanoseconds now);
  /// False: it has gone, or is to be closed.
  [[nodiscard]] bool serve(Line& line, short events, Nanoseconds now);

  const Settings& settings_;
  Gateway& gateway_;
  DaemonLine daemon_;
  modbus::Entrance entrance_;
  Descriptor signals_;
  MonotonicClock clock_;
  std::list<Line> lines_;
};

/// Returns the numeric address of the peer, an IPv4 address in IPv6 as IPv4; empty if it is not known.
[[nodiscard]] std::string address_of(int socket);

}  // namespace softgrip::plc
