#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/thread_budget.h"
#include "model/blocks/characteristic.h"
#include "model/blocks/inertia.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/linear_modes.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/pressure_regulator.h"
#include "model/blocks/rate_limit.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_lag.h"
#include "model/catalogue.h"
#include "model/chain.h"
#include "model/named.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/logs/resampled_record.h"
#include "sysid/structure/identify_structure.h"
#include "sysid/structure/published_element.h"
#include "sysid/structure/structure.h"
#include "sysid/structure/structure_choice.h"
#include "sysid/structure/structure_columns.h"
#include "sysid/structure/structure_fit.h"
#include "sysid/structure/structure_projection.h"
#include "sysid/structure/valve_stage.h"
#include "tests/sysid/root_mean_square.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::structure_test {
namespace {

using test::rms;

using model::SignalName;

/// Returns a finger with play operators, a nonlinear gain, and creep with three time constants from 0.3 s to
/// 27.5 s. The valve vents more slowly than it fills. The thresholds and time constants of the finger are not
/// on the grid of values that the fit uses.
model::Model play_finger() {
  model::Model m;
  m.name = "play_finger";
  m.source = "model made for this test";
  m = model::with_block(std::move(m), {model::block_type<model::TransportDelay>(), {0.06}});
  m = model::with_block(std::move(m), {*model::find_block("asymmetric_valve_lag"), {0.08, 0.2}});
  m = model::with_block(std::move(m), {model::block_type<model::PrandtlIshlinskii>(),
                                       {0, 0, 0, 0, 0, 0.2, 1.3, 0.06, 4.1, 0.05, 9.7, 0.04, 17, 0.03}});
  m = model::with_block(std::move(m),
                        {model::block_type<model::KelvinVoigt>(), {1e9, 25, 7.5, 30, 75, 40, 1100}});
  return model::with_block(std::move(m), {model::block_type<model::Characteristic>(), {0.6, 25}});
}

/// Returns play_finger() with generalised play operators in place of the ordinary ones.
model::Model bent_play_finger() {
  model::Model m = play_finger();
  std::vector<double>& values = m.blocks[*model::position_of<model::PrandtlIshlinskii>(m)].values;
  values[model::parameter_index<model::PrandtlIshlinskii>("envelope_bend")] = -0.2;
  values[model::parameter_index<model::PrandtlIshlinskii>("envelope_skew")] = 0.25;
  values[model::parameter_index<model::PrandtlIshlinskii>("envelope_kpa")] = 50;
  return m;
}

Log scaled(Log log, double mm) {
  for (double& y : log.displacement_mm) y *= mm;
  return log;
}

/// Predicts a log without noise that starts at rest, and returns the RMS of the prediction error [mm]. The
/// first part of the log is left out; `share` is its length divided by the length of the log.
double continuation_rmse_mm(const model::Model& truth, const model::Model& found, SignalName signal,
                            double share) {
  const Log log = simulated(truth, signal, 100, 0, 1);
  const std::vector<Record> records = make_records({log}, {});
  const std::vector<double> left =
      residual(records[0], predict(found, records[0], rest_starts(found, records)[0]));
  const auto first = static_cast<std::size_t>(share * static_cast<double>(left.size()));
  return rms(std::span(left).subspan(first));
}

TEST(StructureColumns, ReproduceTheResponseOfTheModelBlocks) {
  const std::vector<Log> logs{simulated(bent_play_finger(), SignalName::tp1, 97, 0.03, 4)};
  for (const Start start : {Start::rest, Start::unknown}) {
    RecordOptions options;
    options.start = start;
    const std::vector<Record> records = make_records(logs, options);
    const StructureGrid grid = grid_for(records);
    for (const BaseStructure& structure :
         {BaseStructure{}, BaseStructure{.hinged_creep = true}, BaseStructure{.envelopes = true},
          BaseStructure{.hysteresis = HysteresisForm::bouc_wen}}) {
      const FittedStructure fit = fit_form(records, structure, grid, {});
      const FitPoint point = point_of(fit, records, Drive::command);
      ASSERT_TRUE(model::validate(point.model).empty()) << model::validate(point.model).front();
      const std::vector<double> left =
          residual(records[0], predict(point.model, records[0], point.starts[0]));
      EXPECT_NEAR(rms(left), std::sqrt(fit.mean_square_mm2), 2e-5) << description_of(structure);
    }
  }
}

// The pressure rises and falls at different limited rates. If one rate is missing or both are exchanged, the
// prediction must therefore change.
TEST(StructureColumns, ReproduceTheResponseOfARateLimit) {
  const model::Model limited =
      model::with_block(play_finger(), {model::block_type<model::RateLimit>(), {0.03, 0.06}});
  const std::vector<Record> records = make_records({simulated(limited, SignalName::steps, 97, 0.03, 4)}, {});
  const StructureGrid grid = grid_for(records);
  const FittedStructure fit = fit_form(records, {.rate_limit = true}, grid, {});
  EXPECT_GT(fit.numbers.venting_s_per_kpa, 1.5 * fit.numbers.filling_s_per_kpa);
  const FitPoint point = point_of(fit, records, Drive::command);
  const std::vector<double> left = residual(records[0], predict(point.model, records[0], point.starts[0]));
  EXPECT_NEAR(rms(left), std::sqrt(fit.mean_square_mm2), 2e-5);
}

// The dead time, lags and creep times of this process are 100 times those of a soft finger. The search finds
// them, because its start points and limits are stated in units of time_unit_s().
TEST(StructureFit, FitsAProcessThatIsAHundredTimesSlowerEquallyWell) {
  constexpr double slower = 100;
  Log log = simulated(play_finger(), SignalName::tp1, 100, 0.03, 4);
  const auto fit_of = [](const Log& each) {
    const std::vector<Record> records = make_records({each}, {});
    return fit_form(records, {}, grid_for(records), {});
  };
  const FittedStructure usual = fit_of(log);
  for (double& time_s : log.time_s) time_s *= slower;
  const FittedStructure slow = fit_of(log);
  EXPECT_LT(slow.mean_square_mm2, 1.1 * usual.mean_square_mm2);
  EXPECT_NEAR(slow.numbers.delay_s, slower * usual.numbers.delay_s, 0.02 * slower);
  EXPECT_NEAR(slow.numbers.filling_s, slower * usual.numbers.filling_s, 0.02 * slower);
  EXPECT_NEAR(slow.numbers.venting_s, slower * usual.numbers.venting_s, 0.02 * slower);
}

TEST(StructureColumns, AreBitForBitTheSameOnMoreThreads) {
  const std::vector<Record> records = make_records({simulated(play_finger(), SignalName::tp1, 50, 0.03, 3),
                                                    simulated(play_finger(), SignalName::sp2, 50, 0.03, 4)},
                                                   {});
  const BaseStructure structure{.hinged_creep = true};
  const StructureGrid grid = grid_for(records);
  const NonlinearNumbers numbers{
      .delay_s = 0.05, .filling_s = 0.1, .venting_s = 0.2, .peak_before_kpa = {0, 0}};
  const Eigen::MatrixXd alone = structure_columns(records, structure, grid, numbers);
  ASSERT_GT(alone.bottomRows(1).cwiseAbs().maxCoeff(), 0);
  const ThreadBudget budget(3);
  EXPECT_EQ(structure_columns(records, structure, grid, numbers), alone);
}

// A fit with one start point computes its derivatives on two threads.
TEST(StructureFit, IsBitForBitTheSameOnMoreThreads) {
  const std::vector<Record> records =
      make_records({simulated(play_finger(), SignalName::tp1, 50, 0.03, 3)}, {});
  const StructureGrid grid = grid_for(records);
  const NonlinearNumbers near{.delay_s = 0.01, .filling_s = 0.05, .venting_s = 0.4, .peak_before_kpa = {0}};
  const auto fitted_with = [&](unsigned threads) {
    const ThreadBudget budget(threads);
    return fit_form(records, {.hinged_creep = true}, grid, {}, &near);
  };
  const FittedStructure alone = fitted_with(1), together = fitted_with(2);
  EXPECT_NE(alone.numbers, near);
  EXPECT_EQ(together.numbers, alone.numbers);
  EXPECT_EQ(together.weights, alone.weights);
}

TEST(PublishedElement, RefitWithoutABlockPredictsTheBlock) {
  const std::vector<Record> records =
      make_records({simulated(loaded("bench_twin"), SignalName::tp1, 100, 0.05, 2)}, {});
  const PublishedElement whole = fit_published(records, Drive::command, 6, 1);
  EXPECT_TRUE(whole.converged);
  EXPECT_NEAR(whole.rmse_mm, 0.05, 0.002);
  std::vector<Record> part = records;
  for (std::size_t i = 2000; i < 2600; ++i) part[0].reading_mm[i] = std::nan("");
  part[0].readings -= 600;
  const FitPoint again = refit_published(part, whole.point);
  const std::vector<double> left = residual(records[0], predict(again.model, records[0], again.starts[0]));
  EXPECT_LT(rms(std::span(left).subspan(2000, 600)), 1.1 * 0.05);
}

TEST(StructureProjection, WeightsAreNeverNegative) {
  // The readings fall when the outputs of the play operators rise. The best weight of each operator is
  // therefore 0.
  std::vector<Record> records = make_records({simulated(play_finger(), SignalName::tp1, 50, 0.03, 3)}, {});
  for (double& y : records[0].reading_mm) y = -y;
  const BaseStructure structure{.characteristic = false};
  const StructureGrid grid = grid_for(records);
  const Eigen::MatrixXd columns =
      structure_columns(records, structure, grid,
                        {.delay_s = 0.05, .filling_s = 0.1, .venting_s = 0.1, .peak_before_kpa = {0}});
  const ColumnLayout layout(structure, grid, records);
  const Eigen::VectorXd readings = Eigen::Map<const Eigen::VectorXd>(
      records[0].reading_mm.data(), static_cast<Eigen::Index>(records[0].reading_mm.size()));
  const Projection found = project({columns, layout, readings, grid.largest_kpa, 0, 1e-6}, {0, grid.span_mm});
  for (Eigen::Index i = 0; i < layout.own(); ++i) EXPECT_GE(found.weights(i), 0);
  EXPECT_NEAR(found.weights.head(layout.own()).sum(), 0, 1e-3);
}

TEST(WithoutWandering, RemovesZeroDriftAndKeepsTheFingerResponse) {
  const Log steady = simulated(play_finger(), SignalName::tp1, 100, 0.03, 5);
  Log drifting = steady;
  constexpr double drift_mm = 0.8, period_s = 90;
  for (std::size_t i = 0; i < drifting.size(); ++i)
    drifting.displacement_mm[i] += drift_mm * std::sin(2 * M_PI * drifting.time_s[i] / period_s);
  const auto moved_mm = [](const Log& log) {
    const std::vector<Record> records = make_records({log}, {});
    const std::vector<Record> left = without_zero_drift(records, {}, {});
    std::vector<double> moved(records[0].size());
    for (std::size_t i = 0; i < moved.size(); ++i)
      moved[i] = records[0].reading_mm[i] - left[0].reading_mm[i];
    return moved;
  };
  const std::vector<double> of_steady = moved_mm(steady), of_drifting = moved_mm(drifting);
  // The correction must remove the drift of the readings. It may also remove a small part of the slow creep,
  // because slow creep resembles a drift.
  EXPECT_LT(rms(of_steady), 0.3 * drift_mm);
  std::vector<double> missed(of_drifting.size());
  for (std::size_t i = 0; i < missed.size(); ++i) {
    missed[i] = of_drifting[i] - of_steady[i] - (drifting.displacement_mm[i] - steady.displacement_mm[i]);
  }
  EXPECT_LT(rms(missed), 0.1 * drift_mm);
}

/// Returns the number of columns of the drift for a log with this interval.
std::size_t knots_with(double interval_s, std::size_t samples) {
  Log log;
  for (std::size_t i = 0; i < samples; ++i) {
    const double kpa = 30 * std::abs(std::sin(0.05 * static_cast<double>(i)));
    log.time_s.push_back(interval_s * static_cast<double>(i));
    log.pressure_command_kpa.push_back(kpa);
    log.displacement_mm.push_back(0.5 * kpa);
  }
  const std::vector<Record> records = make_records({log}, {});
  BaseStructure structure;
  structure.zero_drift = true;
  return ColumnLayout(structure, grid_for(records), records).knots(0);
}

TEST(WithoutWandering, TheDriftOfALongLogHasFewKnots) {
  EXPECT_EQ(knots_with(0.1, 1001), 5U);   // 100 s: one knot per 20 s
  EXPECT_EQ(knots_with(0.1, 5001), 16U);  // 500 s
  // If a log is slow, the unit of time is longer than 1 s.
  EXPECT_EQ(knots_with(10, 5000), knots_with(1000, 5000));
  EXPECT_LE(knots_with(10, 5000), 4U);
}

/// Sampling rate of the logs from which the tests identify play_finger() and its variants [Hz]. At a higher
/// rate, the tests take longer and check the same properties.
constexpr double rate_hz = 25;

TEST(IdentifyStructure, FindsBoucWenWithDelayAndLag) {
  const model::Model twin = loaded("bench_twin");
  std::vector<Log> logs;
  for (const SignalName signal : {SignalName::tp1, SignalName::steps, SignalName::sp2})
    logs.push_back(simulated(twin, signal, 100, 0.05, 3));
  const auto found = identify_structure(logs, StructureQuestion::automatic);
  ASSERT_TRUE(found) << found.error();
  const auto chosen = std::find_if(found->structure->candidates.begin(), found->structure->candidates.end(),
                                   [](const auto& c) { return c.chosen; });
  EXPECT_EQ(chosen->structure, "bouc_wen");
  EXPECT_LT(found->rmse_mm, 1.02 * 0.05);
  int checked = 0;
  for (const Estimate& e : found->parameters) {
    const double truth = e.name == "transport_delay.delay_s"     ? 0.13
                         : e.name == "valve_lag.time_constant_s" ? 0.044
                                                                 : 0;
    if (truth == 0) continue;
    ASSERT_TRUE(e.ci95) << e.name;
    EXPECT_LE(e.ci95->lower, truth) << e.name;
    EXPECT_GE(e.ci95->upper, truth) << e.name;
    ++checked;
  }
  EXPECT_EQ(checked, 2);
}

TEST(IdentifyStructure, DenseLogIsAveragedForTheChoiceButFittedFully) {
  const double noise_mm = 0.05;
  const std::vector<Log> logs{simulated(loaded("bench_twin"), SignalName::tp1, 500, noise_mm, 3)};
  ASSERT_GT(logs.front().size(), enough_readings);
  const auto found = identify_structure(logs, StructureQuestion::bouc_wen);
  ASSERT_TRUE(found) << found.error();
  ASSERT_EQ(found->warnings.size(), 1U);
  EXPECT_NE(found->warnings.front().find("readings over 4 ms"), std::string::npos) << found->warnings.front();
  EXPECT_NEAR(found->rmse_mm, noise_mm, 0.02 * noise_mm)
      << "the error must be that of single samples, because means of two samples have less noise";
  const auto chosen = std::find_if(found->structure->candidates.begin(), found->structure->candidates.end(),
                                   [](const auto& c) { return c.chosen; });
  EXPECT_NEAR(chosen->heldout_rmse_mm, noise_mm, 0.05 * noise_mm)
      << "a mean of two samples is not centred on the second sample";
  for (const Estimate& e : found->parameters) {
    if (e.name != "transport_delay.delay_s") continue;
    ASSERT_TRUE(e.ci95);
    EXPECT_LE(e.ci95->lower, 0.13);
    EXPECT_GE(e.ci95->upper, 0.13);
  }
}

TEST(IdentifyStructure, FindsPlayOperatorsWithoutSpuriousBlocks) {
  const std::vector<Log> logs{simulated(play_finger(), SignalName::tp1, rate_hz, 0.03, 5),
                              simulated(play_finger(), SignalName::sp2, rate_hz, 0.03, 6)};
  const auto found = identify_structure(logs, StructureQuestion::automatic);
  ASSERT_TRUE(found) << found.error();
  const auto chosen = std::find_if(found->structure->candidates.begin(), found->structure->candidates.end(),
                                   [](const auto& c) { return c.chosen; });
  EXPECT_EQ(chosen->structure, "prandtl_ishlinskii");
  EXPECT_LT(found->rmse_mm, 1.4 * 0.03);
  EXPECT_LT(continuation_rmse_mm(play_finger(), found->model, SignalName::tp2, 0), 3 * 0.03)
      << "prediction error on a log that was not fitted";
  EXPECT_FALSE(model::position_of<model::ValveLag>(found->model)) << "the simulated finger has no second lag";
  EXPECT_FALSE(model::position_of<model::RateLimit>(found->model))
      << "the simulated finger has no rate limit";
  EXPECT_FALSE(model::position_of<model::Inertia>(found->model)) << "the simulated finger has no resonance";
  EXPECT_FALSE(model::position_of<model::LinearModes>(found->model))
      << "play operators already describe this finger, so linear modes must not be chosen";
  ASSERT_FALSE(found->structure->ablation.empty());
  for (const auto& without : found->structure->ablation) {
    if (without.without != "hysteresis" && without.without != "creep") continue;
    EXPECT_GT(without.heldout_rmse_mm, 1.5 * chosen->heldout_rmse_mm) << without.without;
  }
}

/// The fit must find the generalised play operators. A nonlinear gain after the operators cannot replace
/// them, and pressure-dependent creep cannot replace them.
TEST(IdentifyStructure, FindsNonlinearEnvelopesOfPlayOperators) {
  const std::vector<Log> logs{simulated(bent_play_finger(), SignalName::tp1, rate_hz, 0.03, 5),
                              simulated(bent_play_finger(), SignalName::sp2, rate_hz, 0.03, 6)};
  const auto found = identify_structure(logs, StructureQuestion::automatic);
  ASSERT_TRUE(found) << found.error();
  EXPECT_LT(found->rmse_mm, 2 * 0.03) << "the true thresholds and envelopes are not on the grid of the fit";
  EXPECT_LT(continuation_rmse_mm(bent_play_finger(), found->model, SignalName::tp2, 0), 3 * 0.03);
  const auto chosen = std::find_if(found->structure->candidates.begin(), found->structure->candidates.end(),
                                   [](const auto& c) { return c.chosen; });
  EXPECT_EQ(chosen->description.find("generalised play operators"), 0U) << chosen->description;
  const auto straight =
      std::find_if(found->structure->ablation.begin(), found->structure->ablation.end(),
                   [](const auto& without) { return without.without == "nonlinear envelopes"; });
  ASSERT_NE(straight, found->structure->ablation.end());
  EXPECT_GT(straight->heldout_rmse_mm, 1.3 * chosen->heldout_rmse_mm);
}

TEST(IdentifyStructure, FindsAnEarlierPeakPressure) {
  model::Model trained = play_finger();
  const std::size_t plays = *model::position_of<model::PrandtlIshlinskii>(trained);
  trained.blocks[plays].values.front() = 50;
  const std::vector<Log> logs{simulated(trained, SignalName::tp1, rate_hz, 0.03, 5),
                              simulated(trained, SignalName::sp2, rate_hz, 0.03, 6)};
  const auto found = identify_structure(logs, StructureQuestion::prandtl_ishlinskii);
  ASSERT_TRUE(found) << found.error();
  EXPECT_LT(found->rmse_mm, 1.4 * 0.03);
  const auto block = model::position_of<model::PrandtlIshlinskii>(found->model);
  ASSERT_TRUE(block);
  // A pressure above twice the largest threshold moves all play operators. An even larger pressure before the
  // logs has the same effect, so it cannot be estimated.
  EXPECT_GT(found->model.blocks[*block].values.front(), 30);
}

/// The log contains no measured pressure, but the overlap of the regulator is visible in the displacement.
/// The fit must find a regulator and not describe the overlap by a lag.
TEST(IdentifyStructure, FindsARegulatorWithoutMeasuredPressure) {
  model::Model regulated =
      model::without_block(play_finger(), model::block_type<model::AsymmetricValveLag>());
  regulated = model::with_block(std::move(regulated),
                                {model::block_type<model::PressureRegulator>(), {0.03, 0.05, 0.8, 0.4, 12}});
  for (const bool regulator : {false, true}) {
    std::vector<Log> logs;
    for (const SignalName signal : {SignalName::tp1, SignalName::sp2})
      logs.push_back(simulated(regulator ? regulated : play_finger(), signal, rate_hz, 0.03, 15));
    const auto found = identify_structure(logs, StructureQuestion::prandtl_ishlinskii);
    ASSERT_TRUE(found) << found.error();
    const auto position = model::position_of<model::PressureRegulator>(found->model);
    EXPECT_EQ(position.has_value(), regulator);
    EXPECT_LT(found->rmse_mm, 1.3 * 0.03);
    if (!position) continue;
    const std::vector<double>& values = found->model.blocks[*position].values;
    EXPECT_NEAR(values[model::parameter_index<model::PressureRegulator>("overlap_kpa")], 0.8, 0.4);
  }
}

/// This finger has two lags, and play_finger() has one. The test FindsPlayOperatorsWithoutSpuriousBlocks
/// checks that the fit finds no second lag for play_finger().
TEST(IdentifyStructure, FindsASecondLag) {
  const model::Model slower =
      model::with_block(play_finger(), {model::block_type<model::ValveLag>(), {0.12}});
  std::vector<Log> logs;
  for (const SignalName signal : {SignalName::tp1, SignalName::steps})
    logs.push_back(simulated(slower, signal, rate_hz, 0.03, 15));
  const auto found = identify_structure(logs, StructureQuestion::prandtl_ishlinskii);
  ASSERT_TRUE(found) << found.error();
  EXPECT_LT(found->rmse_mm, 1.4 * 0.03);
  const auto position = model::position_of<model::ValveLag>(found->model);
  ASSERT_TRUE(position);
  EXPECT_NEAR(found->model.blocks[*position].values[0], 0.12, 0.06);
}

/// The command changes by 12 kPa within 0.2 s. Because of the rate limit, the pressure needs 0.36 s to rise
/// and 0.72 s to fall.
TEST(IdentifyStructure, FindsARateLimit) {
  const model::Model limited =
      model::with_block(play_finger(), {model::block_type<model::RateLimit>(), {0.03, 0.06}});
  const auto found = identify_structure({simulated(limited, SignalName::steps, rate_hz, 0.03, 15)},
                                        StructureQuestion::prandtl_ishlinskii);
  ASSERT_TRUE(found) << found.error();
  EXPECT_LT(found->rmse_mm, 1.4 * 0.03);
  const auto position = model::position_of<model::RateLimit>(found->model);
  ASSERT_TRUE(position);
  EXPECT_NEAR(found->model.blocks[*position].values[0], 0.03, 0.003);
  EXPECT_NEAR(found->model.blocks[*position].values[1], 0.06, 0.006);
  const auto without = std::find_if(found->structure->ablation.begin(), found->structure->ablation.end(),
                                    [](const auto& each) { return each.without == "a rate limit"; });
  ASSERT_NE(without, found->structure->ablation.end());
  EXPECT_GT(without->heldout_rmse_mm, 2 * found->rmse_mm);
}

TEST(IdentifyStructure, FindsAResonance) {
  const model::Model ringing =
      model::with_block(play_finger(), {model::block_type<model::Inertia>(), {0.5, 0.15}});
  const auto found = identify_structure({simulated(ringing, SignalName::steps, rate_hz, 0.03, 15)},
                                        StructureQuestion::prandtl_ishlinskii);
  ASSERT_TRUE(found) << found.error();
  EXPECT_LT(found->rmse_mm, 1.4 * 0.03);
  const auto position = model::position_of<model::Inertia>(found->model);
  ASSERT_TRUE(position);
  EXPECT_NEAR(found->model.blocks[*position].values[0], 0.5, 0.03);
  EXPECT_NEAR(found->model.blocks[*position].values[1], 0.15, 0.05);
  const auto without = std::find_if(found->structure->ablation.begin(), found->structure->ablation.end(),
                                    [](const auto& each) { return each.without == "a resonance"; });
  ASSERT_NE(without, found->structure->ablation.end());
  EXPECT_GT(without->heldout_rmse_mm, 2 * found->rmse_mm);
}

/// The fit uses the first 20 s of the log, which contain one pressure cycle. The cycle begins and ends at an
/// idle pressure of 7 kPa.
TEST(IdentifyStructure, OneStrokeFromAnIdlePressureStartsAtRest) {
  constexpr double idle_kpa = 7;
  const model::Model finger = play_finger();
  Log log;
  log.name = "strokes";
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.05);
  model::Chain<double> chain(finger, {}, 0.02);
  chain.rest(idle_kpa);
  for (int i = 0; i < 2000; ++i) {
    const double command_kpa = i > 0 && (i / 500) % 2 == 0 ? 60 : idle_kpa;
    log.time_s.push_back(0.02 * i);
    log.pressure_command_kpa.push_back(command_kpa);
    log.displacement_mm.push_back((i == 0 ? chain.reading_mm() : chain.step(0.02, command_kpa)) +
                                  noise(random));
  }
  IdentifyOptions options;
  options.fit_share = 0.5;
  const auto found = identify_structure({log}, StructureQuestion::automatic, options);
  ASSERT_TRUE(found) << found.error();
  EXPECT_FALSE(found->records[0].start_unknown);
  EXPECT_LT(found->held_out[0].rmse_mm, 0.05 * span_mm(log)) << "prediction error in the second stroke";
}

TEST(SimplestStart, UnknownStartIsKeptIfStatedOrRequired) {
  const Log whole = simulated(play_finger(), SignalName::tp1, 100, 0.03, 15);
  Log late;  // the log without its first 3 s; it starts during a rise of the pressure, after other cycles
  late.name = "late";
  for (std::size_t i = 300; i < whole.size(); ++i) {
    late.time_s.push_back(whole.time_s[i] - whole.time_s[300]);
    late.pressure_command_kpa.push_back(whole.pressure_command_kpa[i]);
    late.displacement_mm.push_back(whole.displacement_mm[i]);
  }
  const std::vector<Record> records = make_records({late}, {});
  ASSERT_TRUE(records[0].start_unknown);
  EXPECT_TRUE(with_simplest_start(records, {})[0].start_unknown)
      << "if a start at rest is assumed, the error is clearly larger";
  RecordOptions stated;
  stated.start = Start::unknown;
  EXPECT_TRUE(with_simplest_start(make_records({whole}, stated), {})[0].start_unknown)
      << "the options state that the initial state is unknown";
}

TEST(IdentifyStructure, ResultIsIndependentOfTheDisplacementUnit) {
  const Log log = simulated(play_finger(), SignalName::tp1, rate_hz, 0.03, 7);
  const auto one = identify_structure({log}, StructureQuestion::prandtl_ishlinskii);
  ASSERT_TRUE(one);
  for (const double factor : {1e-3, 1e3}) {
    const auto other = identify_structure({scaled(log, factor)}, StructureQuestion::prandtl_ishlinskii);
    ASSERT_TRUE(other) << other.error();
    EXPECT_NEAR(other->rmse_mm, factor * one->rmse_mm, 1e-3 * factor * one->rmse_mm) << factor;
    ASSERT_EQ(other->structure->candidates.size(), one->structure->candidates.size());
    for (std::size_t i = 0; i < one->structure->candidates.size(); ++i)
      EXPECT_EQ(other->structure->candidates[i].chosen, one->structure->candidates[i].chosen) << factor;
  }
}

TEST(IdentifyStructure, FitReachesTheMinimumOfTheLinearProblem) {
  // If the nonlinear parameters have their true values, the weights result from a linear problem. A fit of
  // the same structure must reach the minimum of this problem, except for the effect of the ridge penalty.
  const std::vector<Log> logs{simulated(play_finger(), SignalName::tp1, 100, 0.03, 8)};
  const std::vector<Record> records = make_records(logs, {});
  const StructureGrid grid = grid_for(records);
  const NonlinearNumbers truth{
      .delay_s = 0.06, .filling_s = 0.08, .venting_s = 0.2, .curvature = 0.6, .peak_before_kpa = {0}};
  StructureFitOptions options;
  options.ridge = 1e-7;
  const FittedStructure searched = fit_form(records, {}, grid, options);
  options.most_iterations = 0;
  const FittedStructure relaxed = fit_form(records, {}, grid, options, &truth);
  EXPECT_LT(searched.mean_square_mm2, 1.01 * relaxed.mean_square_mm2);
}

TEST(IdentifyStructure, MeasuredPressureGivesASeparateValveStage) {
  // The valve blocks of the identified model must predict the measured pressure. The other blocks must
  // predict the displacement.
  const model::Model whole = play_finger();
  Log log = simulated(whole, SignalName::tp1, 100, 0.03, 9);
  const model::Model valve =
      model::only(whole, [](const model::BlockInfo& info) { return info.station == model::Station::valve; });
  model::Chain<double> chain(valve, {}, 0.01);
  std::mt19937_64 random(10);
  std::normal_distribution<double> noise(0, 0.3);
  chain.reset(log.pressure_command_kpa.front());
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (i > 0) chain.step(log.time_s[i] - log.time_s[i - 1], log.pressure_command_kpa[i]);
    log.pressure_kpa.push_back(chain.pressure_kpa() + noise(random));
  }
  const auto found = identify_structure({log}, StructureQuestion::automatic);
  ASSERT_TRUE(found) << found.error();
  ASSERT_TRUE(found->structure->valve);
  EXPECT_NEAR(found->structure->valve->delay_s, 0.06, 0.01);
  EXPECT_NEAR(found->structure->valve->filling_time_constant_s, 0.08, 0.01);
  EXPECT_NEAR(found->structure->valve->venting_time_constant_s, 0.2, 0.01);
  EXPECT_NEAR(found->structure->valve->rmse_kpa, 0.3, 0.03);
  EXPECT_LT(found->rmse_mm, 2 * 0.03) << "0.3 kPa of noise on the input must not reverse the hysteresis";
  EXPECT_EQ(found->scores.front().drive, Drive::measured);
  EXPECT_EQ(found->structure->valve->from_command.front().drive, Drive::command);
  EXPECT_TRUE(model::validate(found->model).empty());
}

TEST(ValveStage, StartsAtTheMeasuredPressure) {
  Log log;
  log.name = "log";
  double p = 8;
  for (int i = 0; i < 4000; ++i) {
    const double t = 0.01 * i, u = i < 500 ? 40 : i < 2000 ? 10 : 30;
    log.time_s.push_back(t);
    log.pressure_command_kpa.push_back(u);
    log.displacement_mm.push_back(0);
    log.pressure_kpa.push_back(p);
    p += 0.01 * (u - p) / (u > p ? 0.3 : 0.8);
  }
  const ValveStage stage = fit_valve_stage({log}, 1, true);
  EXPECT_NEAR(stage.filling_s, 0.3, 0.02);
  EXPECT_NEAR(stage.venting_s, 0.8, 0.02);
  EXPECT_LT(stage.rmse_percent, 1);
}

TEST(IdentifyStructure, InsufficientLogsAreRejectedWithAReason) {
  Log log = simulated(play_finger(), SignalName::tp1, 100, 0.03, 5);
  EXPECT_FALSE(identify_structure({}, StructureQuestion::automatic));
  IdentifyOptions measured;
  measured.record.drive = Drive::measured;
  EXPECT_FALSE(identify_structure({log}, StructureQuestion::automatic, measured));
  const auto few = identify_structure({slice(log, 0, 50)}, StructureQuestion::automatic);
  ASSERT_FALSE(few);
  EXPECT_NE(few.error().find("too few"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::sysid::structure_test
