#pragma once
// Reports the state of the daemon to the service manager (systemd), if the daemon runs under a service
// manager.

#include <string>

#include "base/periodic_schedule.h"

namespace softgrip::daemon {

/// Uses sd_notify(3). Has no effect if the process is not a unit of Type=notify.
class ServiceManager {
 public:
  ServiceManager();

  void ready(const std::string& status);
  void status(const std::string& status);
  void stopping();

  /// Feeds the unit's watchdog (WatchdogSec=) four times per watchdog period while all threads run (`alive`,
  /// see Heartbeat). If a thread has stopped, does not feed the watchdog, so the service manager restarts the
  /// daemon.
  void feed(Nanoseconds now, bool alive);

 private:
  Nanoseconds interval_ = 0;  // time between two messages to the watchdog of the service manager [ns]; 0: the
                              // unit has no watchdog
  Nanoseconds fed_ = 0;
  std::string status_;
};

}  // namespace softgrip::daemon
