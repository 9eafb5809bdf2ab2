// Fuzz target: passes arbitrary bytes to the reader of rig files. The reader must return a rig with all
// properties that RigFile guarantees, or refuse the bytes with a message that states line and column.
// Relative paths in the rig file refer to the folder of config/rig.yaml.
//
//   Command: scripts/fuzz.sh rig_file_fuzz 30

#include <cstddef>
#include <cstdint>
#include <string>

#include "control/tick/settings.h"
#include "rig/rig_file.h"
#include "tests/support/require.h"

namespace {

using namespace softgrip;

using test::require;

void check(const rig::RigFile& rig) {
  require(control::settings_problems(rig.settings).empty());
  require(!rig.name.empty() && rig.name.size() <= 32);
  require(rig.settings.rate_hz >= 1 && rig.settings.rate_hz <= 10000);
  require(!rig.settings.channels.empty() && rig.settings.channels.size() <= 16);
  require(rig.valves.size() == rig.settings.channels.size());
  for (const auto& channel : rig.settings.channels) {
    require(channel.limits.pressure_min_kpa < channel.limits.pressure_max_kpa);
    require(channel.limits.slew_up_kpa_per_s > 0 && channel.limits.slew_down_kpa_per_s > 0);
  }
  require(rig.loop.max_missed_commands >= 1 && rig.loop.exchange_deadline_s >= 0);
  require(!rig.inputs.empty() && rig.inputs.front().role == rig::InputFile::Role::rig);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  document::Problems problems;
  const document::Document document =
      document::parse(SOFTGRIP_SOURCE_DIR "/config/fuzz.yaml",
                      std::string(reinterpret_cast<const char*>(data), size), problems);
  const auto rig = rig::read_rig(document, problems);
  (void)problems.format();
  if (rig && problems.empty()) {
    check(*rig);
  } else {
    require(!problems.empty());
  }
  return 0;
}
