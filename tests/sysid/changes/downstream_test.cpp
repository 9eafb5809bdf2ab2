#include "sysid/changes/downstream.h"

#include <cmath>

#include <gtest/gtest.h>

#include "model/catalogue.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/fitting/trajectory.h"

namespace softgrip::sysid::downstream_test {
namespace {

model::BlockSpec block(const char* id) {
  return model::default_block(*model::find_block(id));
}

model::Model base() {
  model::Model model;
  for (const char* id :
       {"transport_delay", "asymmetric_valve_lag", "bouc_wen", "kelvin_voigt", "characteristic"})
    model = model::with_block(std::move(model), block(id));
  return model;
}

Record waving() {
  Record record;
  record.name = "waving";
  constexpr double interval_s = 0.02;
  for (int i = 0; i < 400; ++i) {
    const double t = interval_s * i;
    record.time_s.push_back(t);
    record.duration_s.push_back(i > 0 ? interval_s : 0);
    record.drive_kpa.push_back(12 - 10 * std::cos(t) * std::cos(0.3 * t));
    record.reading_mm.push_back(0);
    record.temperature_c.push_back(20 + t);
  }
  record.sample_time_s = interval_s;
  record.largest_kpa = 22;
  record.span_mm = 10;
  record.campaign_time_s = 500;
  return record;
}

std::vector<double> walked(const model::Model& model, const Record& record) {
  return predict(model, record, rest_starts(model, {record}).front());
}

TEST(Downstream, EqualsTheFullSimulationOfDownstreamChains) {
  const Record record = waving();
  const std::vector<double> plain = walked(base(), record);
  const std::vector<std::vector<const char*>> chains{
      {"stiffening"},        {"thermal_gain"},      {"ageing"},
      {"running_in"},        {"contact"},           {"sensor_nonlinearity"},
      {"sensor_drift"},      {"sensor_warm_up"},    {"sensor_piecewise_drift"},
      {"sensor_saturation"}, {"contact", "ageing"}, {"thermal_gain", "contact", "periodic_disturbance"}};
  for (const auto& chain : chains) {
    SCOPED_TRACE(chain.front());
    model::Model whole = base();
    std::vector<model::BlockSpec> blocks;
    for (const char* id : chain) {
      blocks.push_back(block(id));
      whole = model::with_block(std::move(whole), blocks.back());
    }
    if (!is_downstream(blocks, base(), record)) {
      // In the signal path, ageing comes before the contact, so {contact, ageing} is in the wrong order.
      EXPECT_STREQ(chain.back(), "ageing");
      continue;
    }
    EXPECT_EQ(downstream(blocks, record, plain), walked(whole, record));
  }
}

// is_downstream() returns true if a block can be applied to the samples of a prediction, so that the model is
// not simulated again. For such a block, the result must equal the simulation of the model with the block.
TEST(Downstream, EqualsTheFullSimulationForEveryDownstreamBlock) {
  const Record record = waving();
  const std::vector<double> plain = walked(base(), record);
  std::size_t count = 0;
  for (std::size_t type = 0; type < model::catalogue().size(); ++type) {
    const model::BlockSpec one = model::default_block(type);
    if (!is_downstream({one}, base(), record)) continue;
    ++count;
    EXPECT_EQ(downstream({one}, record, plain), walked(model::with_block(base(), one), record))
        << model::catalogue()[type].info.id;
  }
  EXPECT_GE(count, 10U);
}

TEST(Downstream, RejectsDynamicRandomAndUpstreamBlocks) {
  const Record record = waving();
  for (const char* id : {"backlash", "inertia", "sensor_lag", "wear", "slow_creep", "stress_softening",
                         "valve_deadband", "sensor_noise", "outliers"})
    EXPECT_FALSE(is_downstream({block(id)}, base(), record)) << id;
  EXPECT_FALSE(is_downstream({block("contact")}, model::with_block(base(), block("sensor_drift")), record));
  EXPECT_FALSE(is_downstream({block("contact")}, {}, record));
}

TEST(Downstream, RejectsHeldCommandsAndUnknownStarts) {
  Record held = waving(), unknown = waving();
  held.held = true;
  unknown.start_unknown = true;
  EXPECT_FALSE(is_downstream({block("contact")}, base(), held));
  EXPECT_FALSE(is_downstream({block("contact")}, base(), unknown));
}

}  // namespace
}  // namespace softgrip::sysid::downstream_test
