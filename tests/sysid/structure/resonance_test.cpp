#include "sysid/structure/resonance.h"

#include <gtest/gtest.h>

#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/inertia.h"
#include "model/blocks/transport_delay.h"
#include "model/named.h"
#include "sysid/fitting/trajectory.h"

namespace softgrip::sysid::resonance_test {
namespace {

model::Model finger(double delay_s) {
  const model::Model still =
      model::with_block({}, {model::block_type<model::BoucWen>(), {0.5, 0.3, 0.004, 0.03, 1}});
  return model::with_block(still, {model::block_type<model::TransportDelay>(), {delay_s}});
}

model::Model ringing_finger(double period_s) {
  return model::with_block(finger(0.06), {model::block_type<model::Inertia>(), {period_s, 0.2}});
}

/// Returns a record of steps between 0 and 60 kPa; each step lasts 4 s. The readings are computed with the
/// model.
Record steps(const model::Model& model) {
  Log log;
  log.name = "steps";
  for (int i = 0; i <= 1200; ++i) {
    log.time_s.push_back(0.02 * i);
    log.pressure_command_kpa.push_back(i / 200 % 2 == 0 ? 0 : 60);
  }
  log.displacement_mm.assign(log.size(), 0);
  Record record = make_records({log}, {})[0];
  record.reading_mm = predict(model, record, {});
  return record;
}

double period_s(const FitPoint& point) {
  return model::value<model::Inertia>(*model::find_block<model::Inertia>(point.model), "period_s");
}

TEST(Resonance, PeriodAndDelayAreFoundOverADecade) {
  for (const double truth_s : {0.2, 0.6, 2.0}) {
    const std::vector<Record> records{steps(ringing_finger(truth_s))};
    const ResonantFit fit = with_resonance({finger(0.1), {StartState{}}}, records, ResonanceFit::dynamics);
    EXPECT_NEAR(period_s(fit.point), truth_s, 0.01 * truth_s);
    EXPECT_LT(fit.rmse_mm, 1e-3) << truth_s;
    const auto* delay = model::find_block<model::TransportDelay>(fit.point.model);
    ASSERT_NE(delay, nullptr);
    EXPECT_NEAR(delay->values[0], 0.06, 0.002) << truth_s;
  }
}

/// The rig has a resonance and almost no dead time. The first fit has no resonance, so it represents the slow
/// rise of the displacement by a dead time of 0.14 s.
TEST(Resonance, IsFoundDespiteAnInflatedDeadTime) {
  const auto lagging = [](double delay_s, double lag_s) {
    return model::with_block(finger(delay_s),
                             {model::block_type<model::AsymmetricValveLag>(), {lag_s, lag_s}});
  };
  const model::Model truth =
      model::with_block(lagging(1e-6, 0.28), {model::block_type<model::Inertia>(), {0.7, 0.2}});
  const std::vector<Record> records{steps(truth)};
  const ResonantFit fit =
      with_resonance({lagging(0.14, 0.11), {StartState{}}}, records, ResonanceFit::dynamics);
  EXPECT_NEAR(period_s(fit.point), 0.7, 0.01);
  EXPECT_LT(fit.rmse_mm, 0.05);
}

TEST(Resonance, RefitFollowsAChangedPeriod) {
  const FitPoint before{ringing_finger(0.6), {StartState{}}};
  const FitPoint after = with_resonance_of(before, {finger(0.06), {StartState{}}},
                                           {steps(ringing_finger(0.66))}, ResonanceFit::dynamics);
  EXPECT_NEAR(period_s(after), 0.66, 0.007);
}

TEST(Resonance, OnlyTheCompleteFitChangesTheHysteresis) {
  const std::vector<Record> records{steps(ringing_finger(0.6))};
  model::Model softer = finger(0.1);
  double& alpha = model::find_block<model::BoucWen>(softer)->values[0];
  alpha = 0.55;
  const ResonantFit fast = with_resonance({softer, {StartState{}}}, records, ResonanceFit::dynamics);
  EXPECT_EQ(model::find_block<model::BoucWen>(fast.point.model)->values[0], 0.55);
  EXPECT_GT(fast.rmse_mm, 1);
  const ResonantFit complete = with_resonance({softer, {StartState{}}}, records, ResonanceFit::complete);
  EXPECT_LT(complete.rmse_mm, 0.05 * fast.rmse_mm);
  EXPECT_NEAR(period_s(complete.point), 0.6, 0.01);
}

}  // namespace
}  // namespace softgrip::sysid::resonance_test
