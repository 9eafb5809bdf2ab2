// Fuzz target: reads arbitrary bytes as a sequence file and prepares the sequence for a rig. Reading and
// preparation must end, and all values of an accepted sequence must be within their bounds. Seeds:
// config/sequences/, dictionary: tests/document/yaml.dict.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "control/sequences/sequence_file.h"
#include "tests/support/require.h"

namespace {

using namespace softgrip;

control::RigSettings rig() {
  control::RigSettings settings;
  for (const char* name : {"left", "right"}) {
    control::ChannelSettings channel;
    channel.name = name;
    channel.limits = {0, 60, 300, 600, -1, 35, 2};
    channel.feedforward.kind = control::FeedforwardKind::full_model;
    channel.pressure_measured = true;
    settings.channels.push_back(channel);
  }
  return settings;
}

using test::require;

void check(const control::PreparedSequence& sequence) {
  require(!sequence.steps.empty() && sequence.steps.size() <= 200);
  for (std::size_t i = 0; i < sequence.steps.size(); ++i) {
    const control::PreparedStep& prepared = sequence.steps[i];
    const control::Step& step = prepared.step;
    require(prepared.channels != 0 && (prepared.channels & ~3U) == 0);
    require(prepared.release_step > i);
    const bool timed = step.kind == control::StepKind::grip || step.kind == control::StepKind::release;
    require(!timed || step.timeout_s);
    require(std::isfinite(step.target.value) && step.target.speed >= 0 && step.target.duration_s >= 0);
    if (step.kind == control::StepKind::pressure) {
      const double end_s = control::duration_s(step.profile);
      require(std::isfinite(end_s));
      for (int k = 0; k <= 20; ++k) {
        const double kpa = control::value_at(step.profile, end_s * k / 20);
        require(kpa >= 0 && kpa <= 60);
      }
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const control::RigSettings settings = rig();
  document::Problems problems;
  const auto document =
      document::parse("fuzz.yaml", std::string(reinterpret_cast<const char*>(data), size), problems);
  const auto sequence = control::read_sequence(document, problems);
  if (!sequence) {
    require(!problems.empty());
    return 0;
  }
  const auto prepared = control::prepare(*sequence, settings, problems);
  require(prepared.has_value() || !problems.empty());
  if (prepared) check(*prepared);
  return 0;
}
