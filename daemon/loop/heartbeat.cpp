#include "daemon/loop/heartbeat.h"

#include <algorithm>
#include <cstddef>

namespace softgrip::daemon {

Heartbeat::Heartbeat(const std::vector<Nanoseconds>& patience) {
  for (const Nanoseconds each : patience) counters_.push_back({each, 0, 0});
}

bool Heartbeat::beats(Nanoseconds now, const std::vector<std::uint64_t>& counts) {
  bool all = true;
  for (std::size_t i = 0; i < std::min(counters_.size(), counts.size()); ++i) {
    Counter& counter = counters_[i];
    if (!begun_ || counts[i] != counter.count) counter.grew_at = now;
    counter.count = counts[i];
    all = all && now - counter.grew_at <= counter.patience;
  }
  begun_ = true;
  return all;
}

}  // namespace softgrip::daemon
