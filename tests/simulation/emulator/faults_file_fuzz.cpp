// Fuzz target: passes arbitrary bytes to the reader of the emulator's faults files. The reader must return
// faults within their bounds, or refuse the bytes with a message that states line and column. The emulator
// must be able to schedule all accepted faults.
//
//   Command: scripts/fuzz.sh faults_file_fuzz 30

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "simulation/emulator/fault.h"
#include "simulation/emulator/fault_schedule.h"
#include "tests/support/require.h"

namespace {

using namespace softgrip;

using test::require;

void check(const simulation::FaultSpec& fault) {
  require(!fault.name.empty());
  require(!fault.at_s || (std::isfinite(*fault.at_s) && *fault.at_s >= 0));
  require(!fault.for_s || (std::isfinite(*fault.for_s) && *fault.for_s > 0));
  require(!fault.channel || *fault.channel < 2);
  require(fault.delay_s >= 0 && fault.interval_s >= 0 && fault.line.share >= 0 && fault.line.share <= 1);
  require(std::isfinite(fault.sensor.value_mm));
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  document::Problems problems;
  const document::Document document =
      document::parse("faults.yaml", std::string(reinterpret_cast<const char*>(data), size), problems);
  const auto faults = simulation::read_faults(document, {"left", "right"}, problems);
  (void)problems.format();
  if (!problems.empty()) return 0;
  for (const simulation::FaultSpec& fault : faults) check(fault);
  simulation::FaultSchedule schedule(faults);
  schedule.start(1);
  for (Nanoseconds now = 1; now < 20'000'000'000; now += 1'700'000'000) {
    schedule.advance(now);
    for (std::size_t i = 0; i < faults.size(); ++i) {
      if (!schedule.active(i)) continue;
      require(schedule.since(i) <= now);
      if (simulation::on_the_wire(faults[i].kind)) schedule.count_reply(i);
    }
  }
  return 0;
}
