#pragma once
// What the service manager (systemd) is told, when there is one.

#include <string>

#include "base/grid.h"

namespace softgrip::daemon {

/// sd_notify(3). Does nothing outside a unit of Type=notify.
class ServiceManager {
 public:
  ServiceManager();

  void ready(const std::string& status);
  void status(const std::string& status);
  void stopping();

  /// Feeds the unit's watchdog (WatchdogSec=) four times in its time, as long as it is told that all threads
  /// go on (`alive`, see Heartbeat); otherwise not at all, and the service manager kills and restarts.
  void feed(Nanoseconds now, bool alive);

 private:
  Nanoseconds interval_ = 0;  // 0: no watchdog
  Nanoseconds fed_ = 0;
  std::string status_;
};

}  // namespace softgrip::daemon
