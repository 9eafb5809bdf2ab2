#include "daemon/service/service_manager.h"

#include <systemd/sd-daemon.h>

#include <cstdint>

namespace softgrip::daemon {

ServiceManager::ServiceManager() {
  std::uint64_t timeout_us = 0;
  if (sd_watchdog_enabled(0, &timeout_us) > 0) interval_ = static_cast<Nanoseconds>(timeout_us) * 1000 / 4;
}

void ServiceManager::ready(const std::string& text) {
  sd_notify(0, ("READY=1\nSTATUS=" + text).c_str());
}

void ServiceManager::status(const std::string& text) {
  if (text == status_) return;
  status_ = text;
  sd_notify(0, ("STATUS=" + text).c_str());
}

void ServiceManager::stopping() {
  sd_notify(0, "STOPPING=1\nSTATUS=writing the safe outputs");
}

void ServiceManager::feed(Nanoseconds now, bool alive) {
  if (interval_ == 0 || !alive || now - fed_ < interval_) return;
  sd_notify(0, "WATCHDOG=1");
  fed_ = now;
}

}  // namespace softgrip::daemon
