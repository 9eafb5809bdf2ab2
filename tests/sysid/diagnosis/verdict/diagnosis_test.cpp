#include "sysid/diagnosis/verdict/diagnosis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <mutex>
#include <numbers>
#include <string>
#include <vector>

#include "model/blocks/transport_delay.h"
#include "model/named.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::diagnosis_test {
namespace {

constexpr double noise_mm = 0.03;

model::Model without_valve() {
  return model::only(loaded("bench_twin"),
                     [](const model::BlockInfo& info) { return info.station != model::Station::valve; });
}

// A cause that explains nearly everything: that its form is a little off asks for no other base.
TEST(Diagnosis, LittleLeftByTheFirstCauseIsNoQuestionForAnotherBase) {
  const model::Model given = without_valve();
  const model::Model truth =
      model::with_block(given, model::block_of<model::TransportDelay>({{"delay_s", 0.4}}));
  std::vector<Log> logs;
  for (const model::SignalName signal : {model::SignalName::tp1, model::SignalName::sp2}) {
    logs.push_back(simulated(truth, signal, 25, noise_mm, 17));
    // Bumps of a thing that no cause knows.
    for (double& y : logs.back().displacement_mm)
      y += 0.9 * noise_mm * std::sin(2 * std::numbers::pi * y / 5);
  }
  DiagnosisOptions options;
  std::mutex mutex;
  std::vector<std::string> said;
  options.progress = [&](const std::string& text) {
    const std::lock_guard lock(mutex);
    said.push_back(text);
  };
  const auto diagnosis = diagnose(logs, given, options);
  ASSERT_TRUE(diagnosis) << diagnosis.error();
  ASSERT_TRUE(diagnosis->structure_left.present);
  EXPECT_GT(diagnosis->structure_left.excess_mm, 0.2 * noise_mm);
  ASSERT_EQ(diagnosis->causes.size(), 1U);
  EXPECT_EQ(diagnosis->causes.front().cause.id, "transport_delay");
  for (const std::string& text : said) {
    EXPECT_NE(text, "looks for another base");
    EXPECT_NE(text, "looks for a staircase");
  }
}

}  // namespace
}  // namespace softgrip::sysid::diagnosis_test
