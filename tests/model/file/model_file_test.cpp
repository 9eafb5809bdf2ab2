#include "model/file/model_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "document/node.h"
#include "model/catalogue.h"
#include "tests/model/presets.h"

namespace softgrip::model::testing {
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

// A number of any size inside the bounds, with all its digits.
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
    const Descriptor& descriptor = catalogue()[type];
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

TEST(ModelFile, RandomModelsComeBackBitForBit) {
  std::mt19937 generator(77);
  for (int round = 0; round < 500; ++round) {
    const Model model = random_model(generator);
    ASSERT_TRUE(validate(model).empty()) << "round " << round << ": " << validate(model).front();
    const Outcome outcome = read(to_yaml(model));
    ASSERT_TRUE(outcome.model) << "round " << round << "\n" << outcome.problems.format() << to_yaml(model);
    ASSERT_EQ(*outcome.model, model) << "round " << round << "\n" << to_yaml(model);
  }
}

TEST(ModelFile, PresetsHoldTheNumbersOfTheirSources) {
  const Model published = preset("zhang2025");
  EXPECT_EQ(number(published, "bouc_wen.alpha_mm_per_kpa"), 0.07079);
  EXPECT_EQ(number(published, "bouc_wen.eta_per_kpa"), 0.02);
  EXPECT_NE(published.source.find("assumed"), std::string::npos);
  const Model twin = preset("bench_twin");
  EXPECT_EQ(number(twin, "transport_delay.delay_s"), 0.13);
  EXPECT_EQ(number(twin, "kelvin_voigt.c1_kpa_s_per_mm"), 299.8);
}

// Parameters that came to a block later: older files say what they always said.
TEST(ModelFile, LaterParametersMayBeLeftOut) {
  const Outcome outcome = read(
      "name: old\nsource: before\n"
      "valve:\n  - valve_deadband: {band_kpa: 2}\n"
      "actuator:\n  - kelvin_voigt: {k0_kpa_per_mm: 5, k1_kpa_per_mm: 5, c1_kpa_s_per_mm: 5}\n"
      "  - asymmetric_hysteresis: {gain_mm_per_kpa: 0.05, unloading_kpa: 15, loading_kpa: 5}\n"
      "sensor:\n  - sensor_drift: {rate_mm_per_h: 1, warm_up_mm: 0.1, warm_up_time_s: 50}\n");
  ASSERT_TRUE(outcome.model) << outcome.problems.format();
  EXPECT_EQ(outcome.model->blocks[0].values, (std::vector<double>{2, 0}));
  EXPECT_EQ(outcome.model->blocks[2].values, (std::vector<double>{0.05, 15, 5, 0, 0, 0}));
  EXPECT_EQ(outcome.model->blocks[3].values, (std::vector<double>{1, 0.1, 50, 0, 0, 300, 30}));
}

TEST(ModelFile, HashStandsForTheNumbers) {
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

TEST(ModelFile, BrokenFilesAreRefusedWhereTheyAreBroken) {
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

TEST(ModelFile, AllErrorsAtOnce) {
  const Outcome outcome = read(
      "nam: a\nsource: b\nvalve:\n  - valve_lag: {time_constant: 0.1}\n  - pressure_saturation: {limit_kpa: "
      "-5}\n"
      "actuator:\n  - bouc_wen: {alpha_mm_per_kpa: x, beta_mm_per_kpa: 0.1, gamma_per_kpa: 0.1, exponent: "
      "9}\n");
  // nam unknown, name missing, time_constant unknown, time_constant_s missing, limit, alpha, eta, exponent
  EXPECT_GE(outcome.problems.size(), 6u) << outcome.problems.format();
  EXPECT_FALSE(outcome.model);
}

TEST(ModelFile, EmptyStationsMayStandOrNot) {
  const Outcome outcome = read(
      "name: a\nsource: b\nvalve: []\nactuator:\n  - kelvin_voigt: {k0_kpa_per_mm: 300, k1_kpa_per_mm: 5, "
      "c1_kpa_s_per_mm: 9}\nload: []\n");
  EXPECT_TRUE(outcome.model) << outcome.problems.format();
}

TEST(ModelFile, AFileThatIsNotThereIsAProblem) {
  document::Problems problems;
  EXPECT_FALSE(load_model("/nowhere/model.yaml", problems));
  EXPECT_FALSE(problems.empty());
}

}  // namespace
}  // namespace softgrip::model::testing
