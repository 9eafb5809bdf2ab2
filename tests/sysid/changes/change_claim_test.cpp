#include "sysid/changes/change_claim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "sysid/changes/change_size.h"
#include "tests/sysid/changes/pressure_base.h"

namespace softgrip::sysid::change_claim_test {
namespace {

class ChangeClaim : public test::PressureBase {
 protected:
  [[nodiscard]] CauseSearch search_with(const RunSpread& spread) const {
    return {later_, none_, without_, healthy_, spread};
  }
  /// Returns the effect of this cause with the largest error reduction.
  [[nodiscard]] ScoredEffect scored(const std::string& id) const {
    std::vector<Effect> effects = effects_for(base_, later_.records(), {}, true);
    std::erase_if(effects, [&](const Effect& effect) { return effect.id != id; });
    return ranked_effects(later_, effects, {}, {}, 1).front();
  }
  [[nodiscard]] static bool never(const ScoredEffect&, const ScoredEffect&) { return false; }
  [[nodiscard]] static bool always(const ScoredEffect&, const ScoredEffect&) { return true; }

  const LaterReadings later_ = readings({.delay_s = 0.06});
  const std::vector<FittedEffect> none_;
  const Eigen::VectorXd without_ = later_.white(none_);
  const std::vector<HealthyFits> healthy_ = healthy_fits(base_, true, 1);
  const RunSpread spread_{healthy_, base_.units.runs()};
  const CauseSearch search_ = search_with(spread_);
};

/// The remaining error exceeds the spread, so only the error reductions decide.
TEST_F(ChangeClaim, AlternativesReduceTheErrorNearlyAsMuch) {
  const ScoredEffect best = scored("transport_delay");
  ScoredEffect other = scored("valve_lag");
  other.gain = 0.95 * best.gain;
  EXPECT_TRUE(is_alternative(search_, best, other, never));
  other.gain = 0.85 * best.gain;
  EXPECT_FALSE(is_alternative(search_, best, other, never));
  EXPECT_TRUE(is_alternative(search_, best, other, always));
  other.gain = 0.45 * best.gain;
  EXPECT_FALSE(is_alternative(search_, best, other, always));
}

TEST_F(ChangeClaim, AnAlternativeMayLeaveAnErrorWithinTheSpread) {
  const ScoredEffect best = scored("transport_delay");
  ScoredEffect other = scored("valve_lag");
  other.gain = 0.6 * best.gain;
  const RunSpread wide(healthy_, base_.units.runs(), {1e3, 1e3});
  EXPECT_FALSE(is_alternative(search_, best, other, never));
  EXPECT_TRUE(is_alternative(search_with(wide), best, other, never));
}

TEST_F(ChangeClaim, AnImitationWithMoreParametersIsNoAlternative) {
  const ScoredEffect best = scored("transport_delay");
  ScoredEffect other = best;
  other.fit.fitted.effect.id = "imitation";
  EXPECT_TRUE(is_alternative(search_, best, other, never));
  other.fit.fitted.effect.numbers.push_back({"unused", "", 1, 0, 1});
  EXPECT_FALSE(is_alternative(search_, best, other, never));
  other.gain = 1.01 * best.gain;
  EXPECT_TRUE(is_alternative(search_, best, other, never));
}

/// A delay must act while the command moves. It is not tested if it has no influence there.
TEST_F(ChangeClaim, AnInvisibleEffectIsNotTested) {
  ScoredEffect delay = scored("transport_delay");
  EXPECT_EQ(vetoed(search_, delay), Veto::none);
  delay.fit.white = without_;
  EXPECT_EQ(vetoed(search_, delay), Veto::not_tested);
}

/// The size of a lag of 0.1 ms is not certain.
TEST_F(ChangeClaim, ACauseMustNotMakeTheSizeOfAnotherCauseUncertain) {
  FittedEffect lag = scored("valve_lag").fit.fitted;
  lag.numbers.front() = 1e-4;
  const std::vector<FittedEffect> found{lag};
  const Eigen::VectorXd without = later_.white(found);
  const CauseSearch search{later_, found, without, healthy_, spread_};
  std::vector<Effect> effects = effects_for(base_, later_.records(), {}, true);
  std::erase_if(effects, [](const Effect& effect) { return effect.id != "transport_delay"; });
  EXPECT_EQ(vetoed(search, ranked_effects(later_, effects, found, {}, 1).front()),
            Veto::other_size_uncertain);
}

/// A loss of pressure causes the larger part of the error, with and without whitening.
TEST_F(ChangeClaim, AnEffectThatExplainsASmallPartOfTheErrorIsRejected) {
  const LaterReadings later = readings({.lost_kpa_per_s = 3, .delay_s = 0.02});
  const Eigen::VectorXd without = later.white(none_);
  const CauseSearch search{later, none_, without, healthy_, spread_};
  std::vector<Effect> effects = effects_for(base_, later.records(), {}, true);
  std::erase_if(effects, [](const Effect& effect) { return effect.id != "transport_delay"; });
  ScoredEffect delay = ranked_effects(later, effects, {}, {}, 1).front();
  const double excess = per_bin(later, without) - 1;
  delay.gain = 0.19 * excess;
  EXPECT_EQ(vetoed(search, delay), Veto::explains_too_little);
  delay.gain = 0.21 * excess;
  EXPECT_EQ(vetoed(search, delay), Veto::none);
}

/// Returns a log with short rests between ramps. The readings are the prediction of `base`, noise, and a
/// drift of 0.02 mm/s.
Log drifting_log(const Base& base) {
  Log log = test::log_of({}, 5);
  std::vector<double> noise_mm = log.displacement_mm;
  const std::vector<double> before = predict_base(base, make_records({log}, {}).front(), Extension{});
  for (std::size_t i = 0; i < log.size(); ++i) {
    noise_mm[i] -= before[i];
    const double phase_s = std::fmod(log.time_s[i], 9);
    log.pressure_command_kpa[i] = 15 * std::clamp(std::min(phase_s - 2.5, 9 - phase_s), 0.0, 3.0);
  }
  const std::vector<double> after = predict_base(base, make_records({log}, {}).front(), Extension{});
  for (std::size_t i = 0; i < log.size(); ++i)
    log.displacement_mm[i] = after[i] + noise_mm[i] + 0.02 * log.time_s[i];
  return log;
}

/// Whitening can remove a slow drift. It is then shown by the readings at rest without whitening.
TEST(ChangeClaimOfDrift, ADriftIsShownByReadingsAtRestWithoutWhitening) {
  const Base base =
      fit_base(make_records(test::logs_of({}, 1), {}), Judged::displacement, Drive::command, {});
  const std::vector<Record> records = make_records({drifting_log(base)}, {});
  const LaterReadings later = readings_of(base, records, residuals_of(base, records));
  std::vector<Effect> effects = effects_for(base, later.records(), {}, false);
  std::erase_if(effects, [](const Effect& effect) { return effect.id != "sensor_drift"; });
  const std::vector<FittedEffect> none;
  const Eigen::VectorXd without = later.white(none);
  const std::vector<HealthyFits> healthy = healthy_fits(base, false, 1);
  const RunSpread spread(healthy, base.units.runs());
  const CauseSearch search{later, none, without, healthy, spread};
  ScoredEffect drift = ranked_effects(later, effects, {}, {}, 1).front();
  EXPECT_EQ(vetoed(search, drift), Veto::none);
  const std::vector<bool> rests = required_rows(later, Appears::at_rest);
  EXPECT_GE(std::count(rests.begin(), rests.end(), true), 5);
  // With these whitened residuals, the drift does not reduce the error at rest.
  for (std::size_t i = 0; i < rests.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (rests[i]) drift.fit.white(row) = -without(row);
  }
  EXPECT_EQ(vetoed(search, drift), Veto::none);
  for (double& number : drift.fit.fitted.numbers) number *= 0.001;
  EXPECT_NE(vetoed(search, drift), Veto::none);
}

/// The mean of an oscillation at full pressure is nearly zero, but the oscillation has a period.
TEST(ChangeClaimOfInertia, AnOscillationIsShownByItsPeriod) {
  const Base base =
      fit_base(make_records(test::logs_of({}, 1), {}), Judged::displacement, Drive::command, {});
  std::vector<Log> logs = test::logs_of({}, 5);
  const std::vector<Record> healthy_records = make_records(logs, {});
  std::vector<Effect> effects = effects_for(base, healthy_records, {}, false);
  std::erase_if(effects, [](const Effect& effect) { return effect.id != "inertia"; });
  ASSERT_FALSE(effects.empty());
  constexpr double period_s = 0.6, damping_ratio = 0.1;
  for (std::size_t r = 0; r < logs.size(); ++r) {
    const Record& record = healthy_records[r];
    const std::vector<double> before = predict_base(base, record, Extension{});
    const std::vector<double> after =
        predict_base(base, record, extension_of({{effects.front(), {period_s, damping_ratio}}}));
    for (std::size_t i = 0; i < logs[r].size(); ++i) logs[r].displacement_mm[i] += after[i] - before[i];
  }
  const std::vector<Record> records = make_records(logs, {});
  const LaterReadings later = readings_of(base, records, residuals_of(base, records));
  const std::vector<FittedEffect> none;
  const Eigen::VectorXd without = later.white(none);
  const std::vector<HealthyFits> healthy = healthy_fits(base, false, 1);
  const RunSpread spread(healthy, base.units.runs());
  const ScoredEffect mode = ranked_effects(later, effects, {}, {}, 1).front();
  EXPECT_EQ(vetoed({later, none, without, healthy, spread}, mode), Veto::none);
  const std::vector<FittedEffect> found{mode.fit.fitted};
  const ShownSize shown = shown_size(later, found.front(), intervals_of(later, found, healthy).front());
  EXPECT_EQ(shown.size.unit, "s");
  EXPECT_NEAR(shown.size.value, period_s, 0.02);
}

}  // namespace
}  // namespace softgrip::sysid::change_claim_test
