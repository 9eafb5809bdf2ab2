// Fuzz target of the gauge file reader. The reader must either reject the bytes, or return readings that can
// be written to a file and read back.
//
//   scripts/fuzz.sh gauge_fuzz 30

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "sysid/diagnosis/gauge/gauge_file.h"
#include "tests/support/require.h"

namespace {

using namespace softgrip;

using test::require;

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  document::Problems problems;
  const auto gauge = sysid::parse_gauge("fuzz.csv", text, problems);
  require(gauge.has_value() == problems.empty());
  (void)problems.format();
  if (!gauge) return 0;
  require(sysid::distinct_positions(gauge->readings).size() >= sysid::fewest_gauge_positions);
  for (const sysid::GaugeReading& r : gauge->readings)
    require(std::isfinite(r.position_mm) && std::isfinite(r.reading_mm) && r.samples >= 1);
  document::Problems again;
  const auto copy = sysid::parse_gauge("fuzz.csv", sysid::format_gauge(gauge->readings), again);
  require(copy.has_value() && copy->readings == gauge->readings);
  return 0;
}
