#pragma once
// Reports the state of the daemon to the service manager (systemd), if the daemon runs under a service
// manager.

#include <systemd/sd-daemon.h>

#include <cstdint>
#include <string>

#include "base/periodic_schedule.h"

namespace softgrip::daemon {

/// Uses sd_notify(3). Has no effect if the process is not a unit of Type=notify.
class ServiceManager {
 public:
  ServiceManager() {
    std::uint64_t timeout_us = 0;
    if (sd_watchdog_enabled(0, &timeout_us) > 0) interval_ = static_cast<Nanoseconds>(timeout_us) * 1000 / 4;
  }

  void ready(const std::string& text) { sd_notify(0, ("READY=1\nSTATUS=" + text).c_str()); }
  void status(const std::string& text) {
    if (text == status_) return;
    status_ = text;
    sd_notify(0, ("STATUS=" + text).c_str());
  }
  void stopping() { sd_notify(0, "STOPPING=1\nSTATUS=writing the safe outputs"); }

  /// Feeds the unit's watchdog (WatchdogSec=) four times per watchdog period while all threads run (`alive`,
  /// see Heartbeat). If a thread has stopped, does not feed the watchdog, so the service manager restarts the
  /// daemon.
  void feed(Nanoseconds now, bool alive) {
    if (interval_ == 0 || !alive || now - fed_ < interval_) return;
    sd_notify(0, "WATCHDOG=1");
    fed_ = now;
  }

 private:
  Nanoseconds interval_ = 0;  // time between two messages to the watchdog of the service manager [ns]; 0: the
                              // unit has no watchdog
  Nanoseconds fed_ = 0;
  std::string status_;
};

}  // namespace softgrip::daemon
