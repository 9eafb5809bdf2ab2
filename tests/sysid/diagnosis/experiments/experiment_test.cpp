// Tests the experiment that a diagnosis proposes. The experiment must stay within the limits of the rig, and
// softgripd must be able to execute it. It must also separate the causes as predicted.

#include "sysid/diagnosis/experiments/experiment.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "control/sequences/sequence_file.h"
#include "sysid/diagnosis/experiments/experiment_advice.h"
#include "sysid/diagnosis/experiments/separation.h"
#include "sysid/diagnosis/search/search.h"
#include "sysid/fitting/trajectory.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::experiment_test {
namespace {

constexpr double noise_mm = 0.04;
constexpr double interval_s = 0.02;

Record record_of(std::string name, std::vector<double> drive_kpa, double campaign_time_s) {
  Record record;
  record.name = std::move(name);
  record.drive_kpa = std::move(drive_kpa);
  const std::size_t count = record.drive_kpa.size();
  for (std::size_t i = 0; i < count; ++i) record.time_s.push_back(static_cast<double>(i) * interval_s);
  record.duration_s.assign(count, interval_s);
  record.duration_s[0] = 0;
  record.sample_time_s = interval_s;
  record.finest_interval_s = interval_s;
  record.campaign_time_s = campaign_time_s;
  record.largest_kpa = *std::max_element(record.drive_kpa.begin(), record.drive_kpa.end());
  return record;
}

/// Replaces the readings of a record by the prediction of a model plus noise.
void fill(Record& record, const model::Model& truth, std::uint64_t seed) {
  record.reading_mm = predict(truth, record, rest_starts(truth, {record}).front());
  for (std::size_t i = 0; i < record.size(); ++i) record.reading_mm[i] += noise_mm * normal_at(seed, i);
  const auto [low, high] = std::minmax_element(record.reading_mm.begin(), record.reading_mm.end());
  record.span_mm = *high - *low;
  record.readings = record.size();
}

/// Returns a command that loads the finger twice. The second load is larger than the first one, and no load
/// is repeated. Softening and creep therefore have similar effects.
std::vector<double> poor_command() {
  const Waveform waveform{"poor", "", {{0, 0}, {1, 0}, {4, 30}, {7, 0}, {9, 0}, {13, 55}, {17, 0}, {20, 0}}};
  return sampled_kpa(waveform, interval_s);
}

model::Model softened() {
  return model::with_block(loaded("bench_twin"),
                           {find_cause("stress_softening")->forms.front().type, {0.004, 0}});
}

/// Returns a diagnosis that names softening and has the given alternatives. Its record is simulated with a
/// softening finger.
Diagnosis ambiguous(const std::vector<std::string>& alternatives) {
  const model::Model base = loaded("bench_twin");
  Record record = record_of("poor", poor_command(), 0);
  fill(record, softened(), 11);
  Diagnosis d;
  d.verdict = Verdict::ambiguous;
  d.records = {record};
  d.noise_mm = noise_mm;
  const FitPoint given{base, rest_starts(base, d.records)};
  d.as_given = evaluate_structure(d.records, {}, given);
  d.recalibrated = fit_structure(d.records, {}, given);
  const SearchData data = make_search_data(d.records, base);
  NamedCause named;
  named.cause = *find_cause("stress_softening");
  d.extended = fit_candidates(data, d.recalibrated, {.only = {named.cause}}).front().fit.value();
  for (const std::string& alternative : alternatives) named.alternatives.push_back(*find_cause(alternative));
  d.causes = {named};
  return d;
}

TEST(ExperimentMenu, StaysWithinTheRigsLimitsAndComesBackToZero) {
  for (const RigLimits& limits : {RigLimits{60, 300}, RigLimits{40, 50}, RigLimits{200, 5000}}) {
    std::set<std::string> names;
    for (const Waveform& waveform : experiment_menu(limits)) {
      EXPECT_TRUE(names.insert(waveform.name).second);
      EXPECT_EQ(waveform.corners.front().pressure_kpa, 0);
      EXPECT_EQ(waveform.corners.back().pressure_kpa, 0);
      for (std::size_t i = 1; i < waveform.corners.size(); ++i) {
        const Corner& from = waveform.corners[i - 1];
        const Corner& to = waveform.corners[i];
        ASSERT_GT(to.time_s, from.time_s) << waveform.name;
        EXPECT_LE(std::abs(to.pressure_kpa - from.pressure_kpa) / (to.time_s - from.time_s),
                  limits.slew_kpa_per_s)
            << waveform.name << " at " << to.time_s;
        EXPECT_LE(to.pressure_kpa, limits.pressure_max_kpa);
        EXPECT_GE(to.pressure_kpa, 0);
      }
    }
    EXPECT_EQ(names.size(), 6U);
  }
}

TEST(ExperimentMenu, ThreeRatesSpanTwoDecades) {
  for (const Waveform& waveform : experiment_menu({60, 300})) {
    if (waveform.name != "triangles_three_rates") continue;
    std::set<long> rates;
    double slowest = 1e9, fastest = 0;
    for (std::size_t i = 1; i < waveform.corners.size(); ++i) {
      const double rise = waveform.corners[i].pressure_kpa - waveform.corners[i - 1].pressure_kpa;
      const double rate = rise / (waveform.corners[i].time_s - waveform.corners[i - 1].time_s);
      if (rate <= 0) continue;
      rates.insert(std::lround(10 * rate));
      slowest = std::min(slowest, rate);
      fastest = std::max(fastest, rate);
    }
    EXPECT_EQ(rates.size(), 3U);
    EXPECT_GE(fastest / slowest, 99);
  }
}

TEST(ExperimentMenu, DaemonReadsEveryEntryAsTheSameProfile) {
  for (const Waveform& waveform : experiment_menu({57.3, 300})) {
    NextExperiment next;
    next.best = JudgedWaveform{waveform, 1, {}, 1};
    next.separates = {"slow_creep", "stress_softening"};
    document::Problems problems;
    const auto document = document::parse("next_experiment.yaml", sequence_yaml(next, "left"), problems);
    const auto sequence = control::read_sequence(document, problems);
    ASSERT_TRUE(sequence) << problems.format();
    ASSERT_EQ(sequence->steps.size(), 1U);
    const control::Profile& profile = sequence->steps[0].profile;
    EXPECT_NEAR(control::duration_s(profile), waveform.duration_s(), 1e-9);
    const std::vector<double> meant = sampled_kpa(waveform, interval_s);
    for (std::size_t i = 0; i < meant.size(); ++i)
      ASSERT_NEAR(control::value_at(profile, static_cast<double>(i) * interval_s), meant[i], 1e-9);
  }
}

TEST(Experiment, NothingIsProposedWithoutAlternatives) {
  Diagnosis d;
  d.verdict = Verdict::cause_found;
  EXPECT_FALSE(design_experiment(d, {}).best);
  EXPECT_TRUE(result::json_of(fields_of(NextExperiment()))["next_experiment"].is_null());
}

TEST(Experiment, WhitenedNoiseIsWhiteAndOfUnitVariance) {
  NoiseModel noise;
  noise.coefficients = {0.9};
  noise.innovation_mm = 0.02;
  std::vector<double> series{0};
  for (std::size_t i = 1; i < 20000; ++i) series.push_back(0.9 * series.back() + 0.02 * normal_at(3, i));
  const std::vector<double> white = whitened(series, noise);
  double square = 0, product = 0;
  for (std::size_t i = 1; i < white.size(); ++i) {
    square += white[i] * white[i];
    product += white[i] * white[i - 1];
  }
  EXPECT_NEAR(square / 20000, 1, 0.04);
  EXPECT_NEAR(product / 20000, 0, 0.03);
}

TEST(Experiment, SeparatesSofteningFromCreepAsPredicted) {
  const Diagnosis d = ambiguous({"slow_creep"});
  ExperimentOptions options;
  options.limits = RigLimits{58, 300};
  options.threads = 1;
  const NextExperiment next = design_experiment(d, options);
  ASSERT_TRUE(next.best);
  EXPECT_EQ(next.separates, (std::vector<std::string>{"stress_softening", "slow_creep"}));
  EXPECT_GE(next.predicted_separation_sigma, separation_needed_sigma);
  EXPECT_GT(next.best->minutes, next.best->waveform.duration_s() / 60);

  // The simulated finger has softening. It executes the proposed experiment. Then softening and the
  // alternative cause are fitted to all records.
  Record played = record_of("played", sampled_kpa(next.best->waveform, interval_s), 20);
  played.largest_before_kpa = 55;
  fill(played, softened(), 12);
  const std::vector<Record> all{d.records[0], played};
  const SearchData data = make_search_data(all, loaded("bench_twin"));
  const StructureFit base = fit_structure(all, {}, data.given);
  const auto misfit = [&](const char* id) {
    const double mean = fit_candidates(data, base, {.only = {*find_cause(id)}}).front().fit->mean_square_mm2;
    return mean * static_cast<double>(all[0].size() + all[1].size()) / (noise_mm * noise_mm);
  };
  const double seen_sigma = std::sqrt(std::max(0.0, misfit("slow_creep") - misfit("stress_softening")));
  EXPECT_GT(seen_sigma, 0.6 * next.predicted_separation_sigma);

  const auto json = result::json_of(fields_of(next));
  EXPECT_EQ(json["next_experiment"]["file"], "next_experiment.yaml");
  EXPECT_EQ(json["next_experiment"]["separates"].size(), 2U);
  EXPECT_EQ(json["next_experiment"]["predicted_separation_sigma"], next.predicted_separation_sigma);
  EXPECT_GT(json["next_experiment"]["minutes"], 0);
}

TEST(Experiment, CompletedExperimentsAreNotProposedAgain) {
  const Diagnosis d = ambiguous({"slow_creep"});
  ExperimentOptions options;
  options.threads = 1;
  for (const Waveform& waveform : experiment_menu({60, 300})) options.done.push_back(waveform.name);
  const NextExperiment next = design_experiment(d, options);
  EXPECT_FALSE(next.best);
  EXPECT_TRUE(next.menu.empty());
}

TEST(Experiment, RefitReducesTheDistanceOfTheAlternative) {
  const Diagnosis d = ambiguous({});
  NoiseModel noise;
  noise.innovation_mm = noise_mm;
  const Hypothesis alternative(d.records, d.recalibrated, noise);
  const Hypothesis truth(d.records, d.extended, noise);
  Record record = record_of("new", sampled_kpa(experiment_menu({58, 300})[0], interval_s), 20);
  record.largest_before_kpa = 55;
  const std::vector<double> truth_mm = truth.prediction(record);
  const std::vector<double> own = alternative.prediction(record);
  double before = 0;
  for (std::size_t i = 0; i < own.size(); ++i) before += std::pow((own[i] - truth_mm[i]) / noise_mm, 2);
  EXPECT_LT(alternative.linear_distance(record, truth_mm), std::sqrt(before));
  EXPECT_LT(alternative.refitted_distance(record, truth_mm), std::sqrt(before));
  EXPECT_NEAR(truth.linear_distance(record, truth_mm), 0, 1e-6);
}

TEST(Advice, NamesTheActionThatSeparatesEachPair) {
  const auto text = [](const char* one, const char* other, const AdviceFacts& facts) {
    std::string all;
    for (const std::string& sentence : advice_for(one, other, facts)) all += sentence + "\n";
    return all;
  };
  EXPECT_NE(text("valve_lag", "sensor_lag", {}).find("pressure_kpa"), std::string::npos);
  EXPECT_EQ(text("valve_lag", "sensor_lag", {true, false, true}), "");
  EXPECT_NE(text("stiffening", "sensor_nonlinearity", {}).find("Change the load"), std::string::npos);
  EXPECT_NE(text("thermal_gain", "sensor_drift", {}).find("temperature_c"), std::string::npos);
  EXPECT_NE(text("slow_creep", "actuator_threshold", {}).find("No waveform"), std::string::npos);
  EXPECT_EQ(text("slow_creep", "actuator_threshold", {false, false, true}), "");
}

}  // namespace
}  // namespace softgrip::sysid::experiment_test
