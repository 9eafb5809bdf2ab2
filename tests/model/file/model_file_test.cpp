#include "model/file/model_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "document/node.h"
#include "model/catalogue.h"
#include "model/file/earlier_blocks.h"
#include "model/named.h"
#include "tests/model/presets.h"

namespace softgrip::model::testing::model_file_test {
namespace {

struct Outcome {
  std::optional<Model> model;
  document::Problems problems;
};

Outcome read(const std::string& text) {
  Outcome outcome;
  const document::Document document = document::parse("model.yaml", text, outcome.problems);
  outcome.model = read_model(document, outcome.problems);
  return outcome;
}

// Returns a random value between the bounds. A value that need not be whole has a random magnitude and uses
// all digits of a double.
double random_value(const ParameterSpec& spec, std::mt19937& generator) {
  if (spec.whole)
    return std::floor(std::uniform_real_distribution<double>(spec.lower, spec.upper + 1)(generator));
  const double spread = std::uniform_real_distribution<double>(-9, 9)(generator);
  const double value = spec.default_value * std::pow(10.0, spread) + std::pow(10.0, spread - 3);
  return std::fmin(std::fmax(value, spec.lower), spec.upper);
}

Model random_model(std::mt19937& generator) {
  Model model{"a \"quoted\" \\ name with # : everything, {and} [µm]", "source: - ?", {}};
  std::uniform_real_distribution<double> chance(0, 1);
  for (std::size_t type = 0; type < catalogue().size(); ++type) {
    const BlockDescriptor& descriptor = catalogue()[type];
    const bool needed = descriptor.info.id == "kelvin_voigt";
    if (!needed && chance(generator) < 0.5) continue;
    const int copies = descriptor.info.repeatable && chance(generator) < 0.5 ? 2 : 1;
    for (int copy = 0; copy < copies; ++copy) {
      const auto parts =
          static_cast<std::size_t>(1 + chance(generator) * static_cast<double>(descriptor.max_parts - 1));
      BlockSpec block = default_block(type, descriptor.max_parts == 0 ? 1 : parts);
      for (std::size_t i = 0; i < block.values.size(); ++i)
        block.values[i] = random_value(descriptor.spec(i), generator);
      if (descriptor.objection != nullptr && !descriptor.objection(block.values).empty()) continue;
      model = with_block(model, block);
    }
  }
  return model;
}

TEST(ModelFile, RandomModelsRoundTripExactly) {
  std::mt19937 generator(77);
  for (int round = 0; round < 500; ++round) {
    const Model model = random_model(generator);
    ASSERT_TRUE(validate(model).empty()) << "round " << round << ": " << validate(model).front();
    const Outcome outcome = read(to_yaml(model));
    ASSERT_TRUE(outcome.model) << "round " << round << "\n" << outcome.problems.format() << to_yaml(model);
    ASSERT_EQ(*outcome.model, model) << "round " << round << "\n" << to_yaml(model);
  }
}

TEST(ModelFile, OutputUnitRoundTripsAndDefaultsToMillimetres) {
  std::mt19937 generator(1);
  Model model = random_model(generator);
  const std::string in_mm = to_yaml(model);
  EXPECT_EQ(in_mm.find("output_unit"), std::string::npos);
  model.output_unit = OutputUnit::deg;
  const Outcome outcome = read(to_yaml(model));
  ASSERT_TRUE(outcome.model) << outcome.problems.format();
  EXPECT_EQ(*outcome.model, model);
  EXPECT_NE(model_hash(model), model_hash(*read(in_mm).model));
  EXPECT_FALSE(read("output_unit: rad\n" + in_mm).model);
}

TEST(ModelFile, ARigRefusesAModelInDegrees) {
  std::mt19937 generator(1);
  const std::string in_mm = to_yaml(random_model(generator));
  document::Problems problems;
  EXPECT_TRUE(read_rig_model(document::parse("model.yaml", in_mm, problems), problems)) << problems.format();
  EXPECT_FALSE(
      read_rig_model(document::parse("model.yaml", "output_unit: deg\n" + in_mm, problems), problems));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems.list().front().at.line, 1);
  EXPECT_NE(problems.list().front().message.find("a rig measures and controls in mm"), std::string::npos);
}

TEST(ModelFile, PresetsRoundTripExactly) {
  for (const std::string name : {"zhang2025", "bench_twin", "soft_arm_play"}) {
    const Model model = preset(name);
    const Outcome outcome = read(to_yaml(model));
    ASSERT_TRUE(outcome.model) << name << "\n" << outcome.problems.format();
    EXPECT_EQ(*outcome.model, model) << to_yaml(model);
  }
}

TEST(ModelFile, PresetsContainThePublishedValues) {
  const Model published = preset("zhang2025");
  EXPECT_EQ(number(published, "bouc_wen.alpha_mm_per_kpa"), 0.07079);
  EXPECT_EQ(number(published, "bouc_wen.eta_per_kpa"), 0.02);
  EXPECT_NE(published.source.find("assumed"), std::string::npos);
  const Model twin = preset("bench_twin");
  EXPECT_EQ(number(twin, "transport_delay.delay_s"), 0.13);
  EXPECT_EQ(number(twin, "kelvin_voigt.c1_kpa_s_per_mm"), 299.8);
}

/// Reads a model file. The actuator of the model has a spring, and the component `station` has the blocks
/// that the text `block` lists.
Outcome read_with(const std::string& station, const std::string& block) {
  const std::string spring =
      "actuator:\n  - kelvin_voigt: {k0_kpa_per_mm: 5, k1_kpa_per_mm: 5, c1_kpa_s_per_mm: 5}\n";
  const std::string item = "  - " + block + "\n";
  if (station == "actuator") return read("name: old\nsource: before\n" + spring + item);
  return read("name: old\nsource: before\n" + spring + station + ":\n" + item);
}

/// Returns the blocks of the model that read_with() reads, without the spring.
std::vector<BlockSpec> blocks_of(const std::string& station, const std::string& block) {
  const Outcome outcome = read_with(station, block);
  if (!outcome.model) throw std::runtime_error(block + "\n" + outcome.problems.format());
  return without_block<KelvinVoigt>(*outcome.model).blocks;
}

// The first version of the file format does not have these parameters. They are optional, so that files of
// the first version have the same meaning as before.
TEST(ModelFile, ParametersOfLaterVersionsAreOptional) {
  EXPECT_EQ(blocks_of("sensor", "sensor_sinusoidal_drift: {drift_sin_mm: 0.1}"),
            (std::vector<BlockSpec>{{block_type<SensorSinusoidalDrift>(), {0.1, 0, 300}}}));
  EXPECT_EQ(blocks_of("actuator", "asymmetric_bouc_wen: {epsilon_per_kpa: 0.01}"),
            (std::vector<BlockSpec>{{block_type<AsymmetricBoucWen>(), {0, 0.01, 0}}}));
}

struct Earlier {
  const char* station;
  const char* text;
  std::vector<BlockSpec> means;
};

// Some blocks of earlier versions have been divided into several blocks. The new blocks must all belong to
// the same component (valve, actuator, load or sensor), because an older file lists the original block under
// one component.
TEST(ModelFile, EachFormerBlockMapsToBlocksOfOneComponent) {
  EXPECT_EQ(find_earlier_block("valve_lag"), nullptr);
  for (const char* id :
       {"valve_deadband", "asymmetric_hysteresis", "rate_dependent_hysteresis", "ageing", "sensor_drift"}) {
    const EarlierBlock* const earlier = find_earlier_block(id);
    ASSERT_NE(earlier, nullptr) << id;
    ASSERT_GE(earlier->types.size(), 2U) << id;
    const Station station = catalogue()[earlier->types.front()].info.station;
    for (const std::size_t type : earlier->types) EXPECT_EQ(catalogue()[type].info.station, station) << id;
  }
}

// Some blocks of earlier versions contained several mechanisms. The reader must convert such a block to the
// blocks of the present version.
TEST(ModelFile, ConvertsFormerBlocksToPresentBlocks) {
  const std::vector<Earlier> files{
      {"valve", "valve_deadband: {band_kpa: 2}", {{block_type<ValveDeadband>(), {2}}}},
      {"valve", "valve_deadband: {band_kpa: 2, form: 0}", {{block_type<ValveDeadband>(), {2}}}},
      {"valve", "valve_deadband: {band_kpa: 2, form: 1}", {{block_type<ValveStiction>(), {2}}}},
      {"actuator",
       "asymmetric_hysteresis: {gain_mm_per_kpa: 0.05, unloading_kpa: 15, loading_kpa: 5}",
       {{block_type<DuhemHysteresis>(), {0.05, 15, 5}}}},
      {"actuator",
       "asymmetric_hysteresis: {gain_mm_per_kpa: 0, unloading_kpa: 15, loading_kpa: 5, delta_per_kpa: 0.01, "
       "epsilon_per_kpa: 0, beta_share: 0.1}",
       {{block_type<AsymmetricBoucWen>(), {0.01, 0, 0.1}}}},
      {"actuator",
       "asymmetric_hysteresis: {gain_mm_per_kpa: 0.05, unloading_kpa: 15, loading_kpa: 5, delta_per_kpa: "
       "0.01}",
       {{block_type<DuhemHysteresis>(), {0.05, 15, 5}}, {block_type<AsymmetricBoucWen>(), {0.01, 0, 0}}}},
      {"actuator",
       "asymmetric_hysteresis: {gain_mm_per_kpa: 0, unloading_kpa: 15, loading_kpa: 5}",
       {{block_type<DuhemHysteresis>(), {0, 15, 5}}}},
      {"actuator",
       "rate_dependent_hysteresis: {gain_mm_per_kpa: 0.03, width_kpa: 10, time_constant_s: 1}",
       {{block_type<RelaxingFriction>(), {0.03, 10, 1}}}},
      {"actuator",
       "rate_dependent_hysteresis: {gain_mm_per_kpa: 0, width_kpa: 10, time_constant_s: 1, growth: 0.2, "
       "rate_kpa_per_s: 15, settling_s: 0.1, levelling: 0}",
       {{block_type<RateDependentWidth>(), {0.2, 15, 0.1}}}},
      {"actuator",
       "rate_dependent_hysteresis: {gain_mm_per_kpa: 0, width_kpa: 10, time_constant_s: 1, levelling: 0.4}",
       {{block_type<RateDependentSaturation>(), {0.4, 20, 0.05}}}},
      {"actuator",
       "rate_dependent_hysteresis: {gain_mm_per_kpa: 0, width_kpa: 10, time_constant_s: 1, saturation: 0.4}",
       {{block_type<RateDependentSaturation>(), {0.4, 20, 0.05}}}},
      {"actuator", "ageing: {gain_per_h: 0.1}", {{block_type<Ageing>(), {0.1}}}},
      {"actuator",
       "ageing: {gain_per_h: 0, run_in: 0.1, run_in_time_s: 40, gain_per_m: 0}",
       {{block_type<RunningIn>(), {0.1, 40}}}},
      {"actuator", "ageing: {gain_per_h: 0, gain_per_m: 0.3}", {{block_type<Wear>(), {0.3}}}},
      {"sensor",
       "sensor_drift: {rate_mm_per_h: 1, warm_up_mm: 0, warm_up_time_s: 50}",
       {{block_type<SensorDrift>(), {1}}}},
      {"sensor",
       "sensor_drift: {rate_mm_per_h: 1, warm_up_mm: 0.1, warm_up_time_s: 50}",
       {{block_type<SensorDrift>(), {1}}, {block_type<SensorWarmUp>(), {0.1, 50}}}},
      {"sensor",
       "sensor_drift: {rate_mm_per_h: 0, warm_up_mm: 0, warm_up_time_s: 50, wander_sin_mm: 0.3, "
       "wander_cos_mm: 0.1, wander_period_s: 80, knot_interval_s: 30}",
       {{block_type<SensorSinusoidalDrift>(), {0.3, 0.1, 80}}}},
      {"sensor",
       "sensor_drift: {rate_mm_per_h: 0, warm_up_mm: 0, warm_up_time_s: 50, knot_interval_s: 12, knot1_mm: "
       "0.1, "
       "knot2_mm: 0.2}",
       {{block_type<SensorPiecewiseDrift>(), {12, 0.1, 0.2}}}}};
  for (const Earlier& file : files) EXPECT_EQ(blocks_of(file.station, file.text), file.means) << file.text;
}

// In earlier versions, the block `ageing` added the gains of its two mechanisms. The present blocks multiply
// the two gains. Therefore the reader must refuse an older file that uses both mechanisms.
TEST(ModelFile, RefusesAFormerBlockWithoutAnEquivalent) {
  const Outcome outcome = read_with("actuator", "ageing: {gain_per_h: 0.1, run_in: 0.2, run_in_time_s: 40}");
  EXPECT_FALSE(outcome.model);
  ASSERT_EQ(outcome.problems.size(), 1u) << outcome.problems.format();
  const document::Problem& problem = outcome.problems.list().front();
  EXPECT_EQ(problem.at.line, 5u);
  EXPECT_EQ(problem.at.column, 5u);
  EXPECT_NE(problem.hint.find("`- ageing: {gain_per_h: 0.1}`"), std::string::npos) << problem.hint;
  EXPECT_NE(problem.hint.find("`- running_in: {run_in: 0.2, run_in_time_s: 40}`"), std::string::npos)
      << problem.hint;
}

TEST(ModelFile, ChecksTheParametersOfFormerBlocks) {
  for (const auto& [text, says] : std::vector<std::pair<std::string, std::string>>{
           {"asymmetric_hysteresis: {gain_mm_per_kpa: 0.05}", "unloading_kpa"},
           {"asymmetric_hysteresis: {gain_mm_per_kpa: 0.05, unloading_kpa: 15, loading_kpa: 5, delta: 1}",
            "delta_per_kpa"},
           {"rate_dependent_hysteresis: {gain_mm_per_kpa: 99, width_kpa: 10, time_constant_s: 1}",
            "gain_mm_per_kpa"},
           {"ageing: {gain_per_h: 0.1, form: 1}", "form"},
           {"ageing: {}", "gain_per_h"}}) {
    const Outcome outcome = read_with("actuator", text);
    EXPECT_FALSE(outcome.model) << text;
    EXPECT_NE(outcome.problems.format().find(says), std::string::npos) << outcome.problems.format();
  }
}

TEST(ModelFile, HashDependsOnTheParameterValues) {
  const Model twin = preset("bench_twin");
  EXPECT_EQ(model_hash(twin).size(), 16u);
  EXPECT_EQ(model_hash(twin), model_hash(preset("bench_twin")));
  Model other = twin;
  other.blocks[1].values[0] = std::nextafter(other.blocks[1].values[0], 1);
  EXPECT_NE(model_hash(other), model_hash(twin));
}

struct Broken {
  const char* what;
  const char* text;
  int line;
  const char* says;
};

const std::vector<Broken> broken_files{
    {"unknown block",
     "name: a\nsource: b\nactuator:\n  - bouc_ven: {}\n  - kelvin_voigt: {k0_kpa_per_mm: 300, k1_kpa_per_mm: "
     "5, c1_kpa_s_per_mm: 9}\n",
     4, "bouc_wen"},
    {"block in the wrong station",
     "name: a\nsource: b\nvalve:\n  - contact: {position_mm: 1, stiffening: 1}\nactuator:\n  - kelvin_voigt: "
     "{k0_kpa_per_mm: 300, k1_kpa_per_mm: 5, c1_kpa_s_per_mm: 9}\n",
     4, "load"},
    {"wrong order inside a station",
     "name: a\nsource: b\nactuator:\n  - kelvin_voigt: {k0_kpa_per_mm: 300, k1_kpa_per_mm: 5, "
     "c1_kpa_s_per_mm: 9}\nsensor:\n  - sensor_noise: {rms_mm: 0.1, correlation_time_s: 0}\n  - sensor_lag: "
     "{time_constant_s: 0.1}\n",
     7, "before"},
    {"a block twice",
     "name: a\nsource: b\nvalve:\n  - valve_lag: {time_constant_s: 0.1}\n  - valve_lag: {time_constant_s: "
     "0.1}\nactuator:\n  - kelvin_voigt: {k0_kpa_per_mm: 300, k1_kpa_per_mm: 5, c1_kpa_s_per_mm: 9}\n",
     5, "twice"},
    {"missing parameter",
     "name: a\nsource: b\nactuator:\n  - kelvin_voigt: {k0_kpa_per_mm: 300, k1_kpa_per_mm: 5}\n", 4,
     "c1_kpa_s_per_mm"},
    {"a gap in the branches",
     "name: a\nsource: b\nactuator:\n  - kelvin_voigt: {k0_kpa_per_mm: 300, k1_kpa_per_mm: 5, "
     "c1_kpa_s_per_mm: 9, k3_kpa_per_mm: 5, c3_kpa_s_per_mm: 9}\n",
     4, "k2_kpa_per_mm"},
    {"missing unit",
     "name: a\nsource: b\nvalve:\n  - transport_delay: {delay: 0.1}\nactuator:\n  - kelvin_voigt: "
     "{k0_kpa_per_mm: 300, k1_kpa_per_mm: 5, c1_kpa_s_per_mm: 9}\n",
     4, "delay_s"},
    {"other unit",
     "name: a\nsource: b\nvalve:\n  - transport_delay: {delay_ms: 100}\nactuator:\n  - kelvin_voigt: "
     "{k0_kpa_per_mm: 300, k1_kpa_per_mm: 5, c1_kpa_s_per_mm: 9}\n",
     4, "delay_s"},
    {"out of range",
     "name: a\nsource: b\nvalve:\n  - valve_lag: {time_constant_s: -0.1}\nactuator:\n  - kelvin_voigt: "
     "{k0_kpa_per_mm: 300, k1_kpa_per_mm: 5, c1_kpa_s_per_mm: 9}\n",
     4, "time_constant_s"},
    {"not finite",
     "name: a\nsource: b\nvalve:\n  - valve_lag: {time_constant_s: .nan}\nactuator:\n  - kelvin_voigt: "
     "{k0_kpa_per_mm: 300, k1_kpa_per_mm: 5, c1_kpa_s_per_mm: 9}\n",
     4, "time_constant_s"},
    {"an exponent that is not whole",
     "name: a\nsource: b\nactuator:\n  - bouc_wen: {alpha_mm_per_kpa: 0.1, beta_mm_per_kpa: 0.1, "
     "gamma_per_kpa: 0.1, eta_per_kpa: 0.1, exponent: 1.5}\n",
     4, "exponent"},
    {"hysteresis without bound",
     "name: a\nsource: b\nactuator:\n  - bouc_wen: {alpha_mm_per_kpa: 0.1, beta_mm_per_kpa: 0.1, "
     "gamma_per_kpa: -0.2, eta_per_kpa: 0.1, exponent: 1}\n",
     4, "without bound"},
    {"no source",
     "name: a\nactuator:\n  - kelvin_voigt: {k0_kpa_per_mm: 300, k1_kpa_per_mm: 5, c1_kpa_s_per_mm: 9}\n", 1,
     "source"},
    {"no actuator", "name: a\nsource: b\nvalve:\n  - valve_lag: {time_constant_s: 0.1}\n", 1, "actuator"},
    {"unknown station",
     "name: a\nsource: b\nactuators: []\nactuator:\n  - kelvin_voigt: {k0_kpa_per_mm: 300, k1_kpa_per_mm: 5, "
     "c1_kpa_s_per_mm: 9}\n",
     3, "actuator"},
    {"a block that is no map",
     "name: a\nsource: b\nvalve:\n  - valve_lag\nactuator:\n  - kelvin_voigt: {k0_kpa_per_mm: 300, "
     "k1_kpa_per_mm: 5, c1_kpa_s_per_mm: 9}\n",
     4, "map"},
    {"two blocks in one item",
     "name: a\nsource: b\nvalve:\n  - valve_lag: {time_constant_s: 0.1}\n    transport_delay: {delay_s: "
     "1}\nactuator:\n  - kelvin_voigt: {k0_kpa_per_mm: 300, k1_kpa_per_mm: 5, c1_kpa_s_per_mm: 9}\n",
     4, "one key"},
};

TEST(ModelFile, RefusesMalformedFilesWithTheLineOfTheError) {
  for (const Broken& broken : broken_files) {
    if (std::string(broken.text).find("sensor_lag") != std::string::npos && !find_block("sensor_lag"))
      continue;
    const Outcome outcome = read(broken.text);
    EXPECT_FALSE(outcome.model) << broken.what;
    bool found = false;
    for (const document::Problem& problem : outcome.problems.list()) {
      found = found || (problem.at.line == broken.line &&
                        (problem.message + " " + problem.hint).find(broken.says) != std::string::npos);
    }
    EXPECT_TRUE(found) << broken.what << " should say '" << broken.says << "' in line " << broken.line
                       << ":\n"
                       << outcome.problems.format();
  }
}

TEST(ModelFile, ReportsAllErrorsTogether) {
  const Outcome outcome = read(
      "nam: a\nsource: b\nvalve:\n  - valve_lag: {time_constant: 0.1}\n  - pressure_saturation: {limit_kpa: "
      "-5}\n"
      "actuator:\n  - bouc_wen: {alpha_mm_per_kpa: x, beta_mm_per_kpa: 0.1, gamma_per_kpa: 0.1, exponent: "
      "9}\n");
  // The reader must report the unknown keys `nam` and `time_constant` and the missing keys `name` and
  // `time_constant_s`. It must also report errors of limit, alpha, eta and exponent.
  EXPECT_GE(outcome.problems.size(), 6u) << outcome.problems.format();
  EXPECT_FALSE(outcome.model);
}

TEST(ModelFile, AcceptsEmptyAndMissingComponents) {
  const Outcome outcome = read(
      "name: a\nsource: b\nvalve: []\nactuator:\n  - kelvin_voigt: {k0_kpa_per_mm: 300, k1_kpa_per_mm: 5, "
      "c1_kpa_s_per_mm: 9}\nload: []\n");
  EXPECT_TRUE(outcome.model) << outcome.problems.format();
}

TEST(ModelFile, ReportsAMissingModelFile) {
  document::Problems problems;
  EXPECT_FALSE(load_model("/nowhere/model.yaml", problems));
  EXPECT_FALSE(problems.empty());
}

}  // namespace
}  // namespace softgrip::model::testing::model_file_test
