// Reads the deadline of exchanges with a board, and the settings for the attempts to reopen a lost session.

#include "base/numbers.h"
#include "document/number.h"
#include "rig/rig_file_reader.h"

namespace softgrip::rig {

namespace {

std::chrono::nanoseconds read_duration(MapReader& reader, std::string_view key, document::Range range) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(reader.number(key, range) * 1e9));
}

}  // namespace

void read_timing(Context& context, MapReader& reader) {
  RigFile& rig = context.rig;
  rig.loop.exchange_deadline_s = reader.number("exchange_deadline_s", {1e-4, 1});
  rig.reconnect.connect_deadline = read_duration(reader, "connect_deadline_s", {1e-3, 30});
  rig.reconnect.first_pause = read_duration(reader, "first_pause_s", {1e-3, 60});
  rig.reconnect.longest_pause = read_duration(reader, "longest_pause_s", {1e-3, 600});
  if (reader.good("longest_pause_s") && reader.good("first_pause_s") &&
      rig.reconnect.longest_pause < rig.reconnect.first_pause) {
    reader.report("longest_pause_s", "`longest_pause_s` must not be shorter than `first_pause_s`");
  }
  const double patience_s = rig.settings.faults.bus_down_cycles * context.period_s();
  if (context.rate_known && reader.good("exchange_deadline_s") &&
      rig.loop.exchange_deadline_s >= patience_s) {
    reader.warn("exchange_deadline_s",
                "with these settings, a single exchange that misses its deadline causes the fault bus_down",
                "`bus_down_cycles` correspond to " + written(patience_s) + " s");
  }
  rig.accept_over_budget = reader.optional_boolean("accept_over_budget").value_or(false);
}

}  // namespace softgrip::rig
