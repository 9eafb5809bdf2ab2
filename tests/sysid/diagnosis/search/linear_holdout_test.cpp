#include "sysid/diagnosis/search/linear_holdout.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sysid/diagnosis/search/fit.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::linear_holdout_test {
namespace {

constexpr double noise_mm = 0.05;

StructureFit fitted(const std::vector<Record>& records) {
  const model::Model model = loaded("bench_twin");
  return fit_structure(records, {}, {model, rest_starts(model, records)});
}

TEST(LinearHeldOutLosses, AreThoseOfRefitsWhereEveryPartShowsAllNumbers) {
  const std::vector<Record> records =
      make_records({simulated(loaded("bench_twin"), model::SignalName::tp1, 25, noise_mm, 11)}, {});
  const StructureFit fit = fitted(records);
  const Division division = divide(records, 3);
  const double refitted_mm = rmse_mm(held_out_losses(records, division, fit));
  EXPECT_NEAR(rmse_mm(linear_held_out_losses(records, division, fit)), refitted_mm, 0.05 * refitted_mm);
}

/// The log contains one jump and long holds. If the block with the jump is held out, the other blocks contain
/// almost no information about the time of the jump.
TEST(LinearHeldOutLosses, StayOfTheReadingsSizeWhereOneStretchAloneShowsANumber) {
  const model::Model model = loaded("bench_twin");
  Log log;
  log.name = "jump";
  for (int i = 0; i < 4000; ++i) {
    log.time_s.push_back(0.02 * i);
    log.pressure_command_kpa.push_back(log.time_s.back() < 12 ? 0 : 40);
    log.displacement_mm.push_back(0);
  }
  const std::vector<Record> blank = make_records({log}, {});
  const StructureFit at_truth = evaluate_structure(blank, {}, {model, rest_starts(model, blank)});
  const Log noise = simulated(model, model::SignalName::tp1, 100, noise_mm, 3);
  const Log quiet = simulated(model, model::SignalName::tp1, 100, 0, 3);
  for (std::size_t i = 0; i < log.time_s.size(); ++i) {
    log.displacement_mm[i] =
        -at_truth.residual_mm[0][i] + noise.displacement_mm[i] - quiet.displacement_mm[i];
  }
  const std::vector<Record> records = make_records({log}, {});
  const BlockLosses losses = linear_held_out_losses(records, divide(records, 8), fitted(records));
  for (const double loss_mm2 : losses) EXPECT_LT(std::sqrt(loss_mm2), 3 * noise_mm);
}

}  // namespace
}  // namespace softgrip::sysid::linear_holdout_test
