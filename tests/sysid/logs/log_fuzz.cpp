// Fuzz target: passes arbitrary bytes to the log reader. The reader must refuse the bytes, or return a log
// that can be written to a file and read back.
//
//   Command: scripts/fuzz.sh log_fuzz 30

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "sysid/logs/log.h"
#include "tests/support/require.h"

namespace {

using namespace softgrip;

using test::require;

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] != b[i] && !(std::isnan(a[i]) && std::isnan(b[i]))) return false;
  }
  return true;
}

void check(const sysid::Log& log) {
  require(log.size() >= 2 && log.pressure_command_kpa.size() == log.size());
  require(log.displacement_mm.size() == log.size() || log.displacement_mm.empty());
  for (std::size_t i = 0; i < log.size(); ++i) {
    require(std::isfinite(log.time_s[i]) && std::isfinite(log.pressure_command_kpa[i]));
    require(i == 0 || log.time_s[i] > log.time_s[i - 1]);
  }
  for (const sysid::OtherColumn& other : log.others) require(other.cells.size() == log.size());
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  sysid::LogOptions options;
  // The tools that read logs have different requirements. The first byte selects the requirements that this
  // log must meet.
  options.require_motion = size > 0 && (data[0] & 1U) != 0;
  options.need_readings = size > 0 && (data[0] & 2U) != 0;
  const std::vector<std::string> channels = sysid::channels_of(text);
  if (!channels.empty()) options.channel = channels.back();
  document::Problems problems;
  const auto log = sysid::parse_log("fuzz.csv", text, problems, options);
  require(log.has_value() == problems.empty());
  (void)problems.format();
  if (!log) return 0;
  check(*log);
  (void)sysid::sampling_of(*log);
  (void)sysid::span_mm(*log);
  document::Problems again;
  const auto copy = sysid::parse_log("fuzz.csv", sysid::format_log(*log), again, options);
  require(copy.has_value() && again.empty());
  require(same(copy->time_s, log->time_s) && same(copy->pressure_command_kpa, log->pressure_command_kpa));
  require(same(copy->displacement_mm, log->displacement_mm) && same(copy->pressure_kpa, log->pressure_kpa));
  require(copy->others == log->others);
  return 0;
}
