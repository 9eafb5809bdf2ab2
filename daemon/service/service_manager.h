#pragma once
// Reports to the service manager (systemd), if there is one.

#include <string>

#include "base/periodic_schedule.h"

namespace softgrip::daemon {

/// Uses sd_notify(3). Does nothing outside a unit of Type=notify.
class ServiceManager {
 public:
  ServiceManager();

  void ready(const std::string& status);
  void status(const std::string& status);
  void stopping();

  /// Feeds the unit's watchdog (WatchdogSec=) four times per period while all threads run (`alive`, see
  /// Heartbeat). If a thread has stopped, it does not feed the watchdog, and the service manager restarts the
  /// daemon.
  void feed(Nanoseconds now, bool alive);

 private:
  Nanoseconds interval_ = 0;  // 0: no watchdog
  Nanoseconds fed_ = 0;
  std::string status_;
};

}  // namespace softgrip::daemon
