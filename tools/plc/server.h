#pragma once
// Masters on the network, in one thread that never waits for any of them.

#include <chrono>
#include <list>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/descriptor.h"
#include "drivers/modbus_server/connection.h"
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
  struct Master {
    modbus::Connection connection;
    Nanoseconds asked_at = 0;  // last, or when it came
  };
  void accept(Nanoseconds now);
  /// False: it has gone, or is to be shown out.
  [[nodiscard]] bool serve(Master& master, short events, Nanoseconds now);

  const Settings& settings_;
  Gateway& gateway_;
  DaemonLine daemon_;
  Descriptor listener_;
  Descriptor signals_;
  MonotonicClock clock_;
  std::list<Master> masters_;
};

/// Whether a connection comes from one of the addresses, as numbers; an IPv4 address may come in IPv6.
[[nodiscard]] bool is_allowed(int socket, const std::vector<std::string>& allow);

}  // namespace softgrip::plc
