#pragma once
// What the service manager (systemd) is told, when there is one.

#include <cstdint>
#include <string>

#include "daemon/grid.h"

namespace softgrip::daemon {

/// sd_notify(3). Does nothing outside a unit of Type=notify.
class ServiceManager {
 public:
  ServiceManager();

  void ready(const std::string& status);
  void status(const std::string& status);
  void stopping();

  /// Feeds the unit's watchdog (WatchdogSec=) at half its time, but only while `progress` grows: a daemon
  /// whose loop or bus thread hangs is killed and restarted.
  void feed(Nanoseconds now, std::uint64_t progress);

 private:
  Nanoseconds interval_ = 0;  // 0: no watchdog
  Nanoseconds fed_ = 0;
  std::uint64_t progress_ = 0;
  std::string status_;
};

}  // namespace softgrip::daemon
