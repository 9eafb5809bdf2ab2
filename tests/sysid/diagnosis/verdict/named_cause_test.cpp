#include "sysid/diagnosis/verdict/named_cause.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/stress_softening.h"
#include "model/blocks/transport_delay.h"
#include "model/named.h"
#include "sysid/diagnosis/causes/transport_delay.h"
#include "sysid/diagnosis/causes/valve_lag.h"
#include "sysid/diagnosis/verdict/data_warnings.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::named_cause_test {
namespace {

using model::SignalName;

TEST(BlockNumbers, OnlyDeterminedParametersHaveIntervals) {
  const model::Model truth = model::only(loaded("bench_twin"), [](const model::BlockInfo& info) {
    return info.station != model::Station::valve;
  });
  const std::vector<Record> records = make_records({simulated(truth, SignalName::tp1, 25, 0.03, 5)}, {});
  const StructureFit fit = fit_structure(records, {}, {truth, rest_starts(truth, records)});
  const FitSpace space = structure_space(records, fit.point.model, {});
  const UncertainPoint at = uncertain_point(records, fit.point, space);
  const std::size_t creep = model::block_type<model::KelvinVoigt>();
  const std::vector<CauseParameter> numbers = block_numbers(at, creep);
  const model::BlockSpec& real = truth.blocks[*model::position_of(truth, creep)];
  ASSERT_EQ(numbers.size(), real.values.size());
  EXPECT_EQ(numbers[0].name, "k0_kpa_per_mm");
  EXPECT_FALSE(numbers[0].has_interval) << "only the sum alpha + 1/k0 affects the prediction";
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    ASSERT_TRUE(numbers[i].has_interval) << numbers[i].name;
    EXPECT_LT(numbers[i].ci95.lower, numbers[i].value);
    EXPECT_GT(numbers[i].ci95.upper, numbers[i].value);
    EXPECT_NEAR(numbers[i].value, real.values[i], 0.1 * real.values[i]) << numbers[i].name;
  }
}

TEST(BlockNumbers, IntervalsEndAtTheLowerParameterBound) {
  model::Model truth = loaded("bench_twin");
  const std::size_t delay = model::block_type<model::TransportDelay>();
  truth.blocks[*model::position_of(truth, delay)].values[0] = 0.001;
  // The log has few readings with large noise. The symmetric interval of the delay would therefore extend
  // below 0.
  const std::vector<Record> records = make_records({simulated(truth, SignalName::tp1, 5, 1.0, 5)}, {});
  const FitPoint point{truth, rest_starts(truth, records)};
  const FitSpace space = structure_space(records, truth, {*find_cause(causes::TransportDelay::id)});
  const std::vector<CauseParameter> numbers = block_numbers(uncertain_point(records, point, space), delay);
  ASSERT_TRUE(numbers[0].has_interval);
  EXPECT_GT(numbers[0].ci95.upper, numbers[0].value);
  EXPECT_EQ(numbers[0].ci95.lower, 0);
}

TEST(BlockNumbers, HaveTheDeprecatedNameOfTheParameter) {
  const model::Model truth = model::with_block(
      loaded("bench_twin"), model::block_of<model::StressSoftening>({{"softening_per_kpa", 0.004}}));
  const std::vector<Record> records = make_records({simulated(truth, SignalName::tp1, 5, 0.05, 5)}, {});
  const FitPoint point{truth, rest_starts(truth, records)};
  const FitSpace space = structure_space(records, truth, {});
  const std::vector<CauseParameter> numbers =
      block_numbers(uncertain_point(records, point, space), model::block_type<model::StressSoftening>());
  ASSERT_EQ(numbers.size(), 2U);
  EXPECT_EQ(numbers[0].formerly, "");
  EXPECT_EQ(numbers[1].name, "saturation_per_kpa");
  EXPECT_EQ(numbers[1].formerly, "levelling_per_kpa");
}

/// Returns the error reduction [%] by the outliers of a log with 2000 readings. The noise is 0.02 mm.
/// @param sizes_mm  distances of the outliers from the other readings.
Spread reduction_by_outliers(const std::vector<double>& sizes_mm) {
  constexpr double noise_mm = 0.02;
  Log log;
  log.name = "outliers";
  for (int i = 0; i < 2000; ++i) {
    log.time_s.push_back(0.02 * i);
    log.pressure_command_kpa.push_back(30);
    log.displacement_mm.push_back(10 + noise_mm * (i % 2 == 0 ? 1 : -1));
  }
  for (std::size_t k = 0; k < sizes_mm.size(); ++k) log.displacement_mm[300 * (k + 1)] += sizes_mm[k];
  std::vector<Record> records = make_records({log}, {});
  const OutlierEvidence outliers = hide_outliers(records, noise_mm);
  EXPECT_EQ(outliers.count, sizes_mm.size());
  EXPECT_TRUE(outliers.present);
  return causes_in_readings(outliers, {}, noise_mm, model::OutputUnit::mm).at(0).gain_percent;
}

TEST(CausesInReadings, TheErrorReductionOfLargeOutliersIsAtMost100Percent) {
  const Spread reduction = reduction_by_outliers({41, 42, 43, 44, 45});
  EXPECT_GT(reduction.value, 95);
  EXPECT_LT(reduction.lower, reduction.value);
  EXPECT_GT(reduction.upper, reduction.value);
  EXPECT_LE(reduction.upper, 100);
  EXPECT_GT(reduction.standard_error, 0);
}

TEST(CausesInReadings, OutliersOfDifferentSizesReduceTheErrorSignificantly) {
  const Spread reduction = reduction_by_outliers({40, 1, 1, 1, 1});
  EXPECT_GT(reduction.lower, 0);
  EXPECT_LT(reduction.lower, reduction.value);
  EXPECT_GT(reduction.upper, reduction.value);
  EXPECT_LE(reduction.upper, 100);
}

TEST(CausesInReadings, TheErrorReductionOfRepeatedReadingsIsBetween0And100Percent) {
  for (const std::size_t hidden : {std::size_t{1}, std::size_t{4}, std::size_t{400}}) {
    const SamplingEvidence sampling{
        .interval_s = 0.1, .excess_mm = 3, .hidden = hidden, .readings = 1000, .present = true};
    const Spread reduction = causes_in_readings({}, sampling, 0.02, model::OutputUnit::mm)[0].gain_percent;
    EXPECT_GE(reduction.lower, 0) << hidden;
    EXPECT_LT(reduction.lower, reduction.value) << hidden;
    EXPECT_GT(reduction.upper, reduction.value) << hidden;
    EXPECT_LE(reduction.upper, 100) << hidden;
  }
}

TEST(AlternativeTitle, MarksAnAlreadyNamedCauseAsFurther) {
  const Cause delay = *find_cause(causes::TransportDelay::id), lag = *find_cause(causes::ValveLag::id);
  NamedCause first, second;
  first.cause = delay;
  second.cause = lag;
  EXPECT_EQ(alternative_title(lag, {first}), "valve lag");
  EXPECT_EQ(alternative_title(lag, {first, second}), "a further valve lag");
}

TEST(VerdictSentence, ReportsAReductionOnlyIfTheErrorDecreases) {
  Diagnosis d;
  NamedCause lag;
  lag.cause = *find_cause(causes::ValveLag::id);
  d.causes = {lag};
  d.verdict = Verdict::cause_found;
  d.recalibrated_rmse_mm = 2.3;
  d.extended_rmse_mm = 0.4;
  d.base = "Bouc-Wen, lag";
  EXPECT_EQ(verdict_sentence(d),
            "The model lacks valve lag: with it the held-out error falls from 2.3 mm to 0.4 mm.");
  d.extended_rmse_mm = 2.5;
  EXPECT_EQ(verdict_sentence(d),
            "The model lacks valve lag: without it the model fits these logs only with an inverse response, "
            "which no finger has; the held-out error is 2.3 mm without and 2.5 mm with it.");
}

TEST(VerdictSentence, ValveOfAClosedLoopHasNoErrorReduction) {
  Diagnosis d;
  d.causes.emplace_back().cause = *find_cause("valve_deadband");
  d.causes.front().only_in_loop = true;
  d.partial.emplace_back().cause = *find_cause("hysteresis_shape");
  d.verdict = Verdict::partly_explained;
  d.loop_bands_kpa = {2.7};
  d.noise_mm = 0.08;
  d.recalibrated_rmse_mm = 0.33;
  d.extended_rmse_mm = 0.086;
  d.extended.causes = {d.partial.front().cause};
  const std::string found =
      "The model lacks valve dead band: one-step predictions in the closed loop show that the valve sticks, "
      "with a dead band of about 2.7 kPa. ";
  EXPECT_EQ(verdict_sentence(d),
            found +
                "The extended model does not contain this dead band; its held-out error is 0.086 mm, and the "
                "held-out error of the recalibrated model is 0.33 mm.");
  d.extended.causes.clear();
  d.extended_rmse_mm = d.recalibrated_rmse_mm;
  d.loop_bands_kpa = {2.7, 3};
  EXPECT_EQ(verdict_sentence(d),
            "The model lacks valve dead band: one-step predictions in the closed loop show that the valve "
            "sticks, with a dead band of about 2.7, 3 kPa. The recalibrated model does not contain this dead "
            "band; its held-out error is 0.33 mm.");
}

TEST(VerdictSentence, ACauseFoundByChanceIsStatedAfterTheReadings) {
  Diagnosis d;
  d.causes.emplace_back().cause = *find_cause("clock_offset");
  d.partial.emplace_back().cause = *find_cause("backlash");
  d.verdict = Verdict::partly_explained;
  d.lead = ReadingLead{0.15, {0.14, 0.16}};
  d.extended_rmse_mm = 0.4;
  d.null_calibration = NullCalibration{.campaigns = 19, .named = 19, .p_value = 0.5};
  EXPECT_EQ(verdict_sentence(d),
            "The readings are 0.15 s ahead of their command, because the clocks of readings and commands "
            "differ; without this clock offset the recalibrated model's error is 0.4 mm. The cause of the "
            "remaining error cannot be named: in simulated data without any cause, the search reaches the "
            "error reduction by backlash, too (p = 0.5).");
}

TEST(VerdictSentence, StatesBothFormsOfRepeatedReadings) {
  Diagnosis d;
  d.verdict = Verdict::cause_found;
  d.extended_rmse_mm = 0.4;
  d.sampling = {.interval_s = 0.1, .frozen_s = 3, .present = true};
  EXPECT_EQ(verdict_sentence(d),
            "Readings repeat (a new reading arrives every 0.1 s, and the sensor is frozen for 3 s); "
            "without these readings the recalibrated model's error is 0.4 mm.");
}

TEST(VerdictSentence, StatesACoarseResolution) {
  Diagnosis d;
  d.verdict = Verdict::cause_found;
  d.extended_rmse_mm = 0.15;
  d.sampling = {.present = true, .step_mm = 0.5};
  EXPECT_EQ(
      verdict_sentence(d),
      "The sensor has a coarse resolution of 0.5 mm, which causes an error of 0.14 mm; the recalibrated "
      "model's error is 0.15 mm.");
}

TEST(DataWarnings, ReportUndeterminedHysteresisWithoutUnloading) {
  Log ramp;
  ramp.name = "ramp";
  for (int i = 0; i < 500; ++i) {
    ramp.time_s.push_back(0.02 * i);
    ramp.pressure_command_kpa.push_back(0.1 * i);
    ramp.displacement_mm.push_back(0.05 * i);
  }
  std::vector<std::string> warnings;
  warn_of_data({ramp}, scales_of(make_records({ramp}, {})), warnings);
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& w) {
    return w ==
           "the logs contain no unloading (decrease of the pressure), so hysteresis cannot be determined";
  }));
}

using model::SignalName;

constexpr double noise_mm = 0.04;
constexpr double true_delay_s = 0.130;

struct Named {
  std::vector<NamedCause> causes;
  Interval alone;  ///< interval of the delay if the model contains no lag
  std::vector<std::string> sentences;
};

/// Simulates a log of bench_twin, which has a delay and a lag. Returns the delay as the only named cause,
/// with its intervals without and with the lag.
Named delay_of(SignalName signal, const model::Model& twin) {
  const model::Model without_valve =
      model::only(twin, [](const model::BlockInfo& info) { return info.station != model::Station::valve; });
  const SearchData data =
      make_search_data(make_records({simulated(twin, signal, 50, noise_mm, 2)}, {}), without_valve);
  const Division division = divide(data.records, 8);
  const Cause delay = *find_cause("transport_delay");
  const StructureFit base = fit_structure(data.records, {}, data.given);
  Selection selection;
  selection.extended = *fit_candidates(data, base, {.only = {delay}}).front().fit;
  selection.extended_losses = held_out_losses(data.records, division, selection.extended);
  selection.undecided = fit_confounded(data, selection.extended, division);
  selection.chosen.push_back({delay, {}, {}, 1, {}, {}});
  Named named{name_chosen(data.records, selection.extended, selection.chosen), {}, {}};
  if (named.causes.empty()) return named;
  named.alone = named.causes.front().parameters.front().ci95;
  named.sentences = mix_intervals(named.causes, data.records, selection, 1);
  return named;
}

TEST(MixedIntervals, CoverTheTrueDelayIfALagIsUndecided) {
  const Named named = delay_of(SignalName::tp2, loaded("bench_twin"));
  ASSERT_EQ(named.causes.size(), 1U);
  ASSERT_EQ(named.causes.front().cause.id, "transport_delay");
  EXPECT_GT(named.alone.lower, true_delay_s) << "without a lag in the model, the delay includes the lag";
  const Interval mixed = named.causes.front().parameters.front().ci95;
  EXPECT_LT(mixed.lower, true_delay_s);
  EXPECT_GT(mixed.upper, true_delay_s);
  ASSERT_EQ(named.sentences.size(), 1U);
  EXPECT_EQ(named.sentences.front(),
            "these logs do not determine whether valve_lag is present in addition to transport_delay, so the "
            "intervals cover both cases");
}

}  // namespace
}  // namespace softgrip::sysid::named_cause_test
