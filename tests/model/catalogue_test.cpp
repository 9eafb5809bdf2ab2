#include "model/catalogue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "document/node.h"
#include "model/chain.h"
#include "model/file/model_file.h"
#include "model/model.h"
#include "model/named.h"
#include "model/signals.h"
#include "tests/model/presets.h"

namespace softgrip::model::testing::catalogue_test {
namespace {

/// A deprecated name in the catalogue, either of a block type or of a parameter of a block type.
struct Deprecated {
  std::size_t type = 0;
  std::optional<std::size_t>
      value;  ///< index of the parameter; nullopt: the name is the deprecated id of the block

  [[nodiscard]] const BlockDescriptor& block() const { return catalogue()[type]; }
  [[nodiscard]] std::string name() const {
    return value ? block().name(*value) : std::string(block().info.id);
  }
  [[nodiscard]] std::string former() const {
    return value ? block().former_name(*value) : std::string(block().info.formerly);
  }
};

std::vector<Deprecated> all_deprecated() {
  std::vector<Deprecated> all;
  for (std::size_t type = 0; type < catalogue().size(); ++type) {
    const BlockDescriptor& block = catalogue()[type];
    if (!block.info.formerly.empty()) all.push_back({type, {}});
    for (std::size_t i = 0; i < block.parameters.size() + block.repeated.size(); ++i) {
      if (!block.spec(i).formerly.empty()) all.push_back({type, i});
    }
  }
  return all;
}

/// Returns bench_twin with the block of the deprecated name. At the parameter values of this block, it has an
/// effect.
Model model_with(const Deprecated& deprecated) {
  return with_block(preset("bench_twin"), default_block(deprecated.type, 2));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error(from + " is missing in\n" + text);
  return text.replace(at, from.size(), to);
}

/// Returns the beginning of the line of a block or a parameter in a model file.
std::string line_of(const Deprecated& deprecated, const std::string& name) {
  return (deprecated.value ? "      " : "  - ") + name + ":";
}

struct Outcome {
  std::optional<Model> model;
  document::Problems problems;
};

Outcome read(const std::string& text) {
  Outcome outcome;
  outcome.model = read_model(document::parse("finger.yaml", text, outcome.problems), outcome.problems);
  return outcome;
}

std::vector<double> response(const Model& model) {
  constexpr double dt = 0.02;
  Chain<double> chain(model, {}, dt, 1);
  std::vector<double> y;
  for (int i = 1; i <= std::lround(duration_s(SignalName::tp1) / dt); ++i) {
    Surroundings around;
    around.time_s = i * dt;
    y.push_back(chain.step(dt, value_kpa(SignalName::tp1, i * dt), around));
  }
  return y;
}

class DeprecatedName : public ::testing::TestWithParam<Deprecated> {};

TEST_P(DeprecatedName, IsReadAsTheNewNameAndWrittenAsTheNewName) {
  const Deprecated& deprecated = GetParam();
  const Model model = model_with(deprecated);
  const std::string text = to_yaml(model);
  const std::string former =
      replaced(text, line_of(deprecated, deprecated.name()), line_of(deprecated, deprecated.former()));
  const Outcome outcome = read(former);
  ASSERT_TRUE(outcome.model) << outcome.problems.format();
  EXPECT_EQ(*outcome.model, model);
  EXPECT_EQ(to_yaml(*outcome.model), text);
  EXPECT_EQ(text.find(line_of(deprecated, deprecated.former())), std::string::npos) << text;
  EXPECT_EQ(model_hash(*outcome.model), model_hash(model));
  EXPECT_EQ(response(*outcome.model), response(*read(text).model));
  EXPECT_NE(response(model), response(without_block(model, deprecated.type)));
}

TEST_P(DeprecatedName, IsRefusedBesideTheNewNameWithFileAndLine) {
  const Deprecated& deprecated = GetParam();
  const Model model = model_with(deprecated);
  const std::string text = to_yaml(model);
  const std::string line = line_of(deprecated, deprecated.name());
  const std::size_t at = text.find(line);
  // Repeats the parameter, or the complete block, under its deprecated name directly after its last line.
  std::size_t end = text.find('\n', at) + 1;
  std::string added = text.substr(at, end - at);
  if (!deprecated.value) {
    while (end < text.size() && text.substr(end).starts_with("      ")) end = text.find('\n', end) + 1;
    added = text.substr(at, end - at);
  }
  const std::string both =
      std::string(text).insert(end, replaced(added, line, line_of(deprecated, deprecated.former())));
  const Outcome outcome = read(both);
  EXPECT_FALSE(outcome.model);
  ASSERT_EQ(outcome.problems.size(), 1U) << outcome.problems.format();
  const document::Problem& problem = outcome.problems.list().front();
  const auto lines_before = std::count(both.begin(), both.begin() + static_cast<std::ptrdiff_t>(end), '\n');
  EXPECT_EQ(problem.file, "finger.yaml");
  EXPECT_EQ(problem.at.line, lines_before + 1);
  const std::string says = problem.message + " " + problem.hint;
  EXPECT_NE(says.find(deprecated.name()), std::string::npos) << says;
  EXPECT_NE(says.find(deprecated.former()), std::string::npos) << says;
  EXPECT_NE(says.find("deprecated name of"), std::string::npos) << says;
}

TEST_P(DeprecatedName, IsAcceptedInPaths) {
  const Deprecated& deprecated = GetParam();
  const Model model = model_with(deprecated);
  const BlockInfo& info = deprecated.block().info;
  const std::size_t block = *position_of(model, deprecated.type);
  EXPECT_EQ(find_block(info.id), deprecated.type);
  if (!deprecated.value) {
    EXPECT_EQ(find_block(info.formerly), deprecated.type);
  }
  for (std::size_t i = 0; i < parameter_count(model); ++i) {
    if (place_of(model, i).block != block) {
      EXPECT_EQ(former_path(model, i), "");
      continue;
    }
    const std::size_t value = place_of(model, i).value;
    EXPECT_EQ(find_path(model, parameter_path(model, i)), i);
    if (deprecated.value && value != *deprecated.value) continue;
    EXPECT_EQ(find_path(model, former_path(model, i)), i) << former_path(model, i);
    const std::string id(deprecated.value ? info.id : info.formerly);
    const std::string name = deprecated.value ? deprecated.former() : deprecated.block().name(value);
    EXPECT_EQ(find_path(model, id + "." + name), i) << id << "." << name;
  }
}

std::string id_of(const ::testing::TestParamInfo<Deprecated>& one) {
  return std::string(one.param.block().info.id) + (one.param.value ? "_" + one.param.former() : "");
}

INSTANTIATE_TEST_SUITE_P(All, DeprecatedName, ::testing::ValuesIn(all_deprecated()), id_of);

TEST(Catalogue, DeprecatedNamesExist) {
  EXPECT_GE(all_deprecated().size(), 8U);
}

TEST(Catalogue, EveryNameAndDeprecatedNameHasOneMeaning) {
  std::set<std::string_view> ids;
  for (const BlockDescriptor& block : catalogue()) {
    EXPECT_TRUE(ids.insert(block.info.id).second) << block.info.id;
    if (!block.info.formerly.empty()) {
      EXPECT_TRUE(ids.insert(block.info.formerly).second) << block.info.formerly;
    }
    std::set<std::string_view> names;
    for (std::size_t i = 0; i < block.parameters.size() + block.repeated.size(); ++i) {
      const ParameterSpec& spec = block.spec(i);
      EXPECT_TRUE(names.insert(spec.name).second) << block.info.id << "." << spec.name;
      if (spec.formerly.empty()) continue;
      EXPECT_TRUE(names.insert(spec.formerly).second) << block.info.id << "." << spec.formerly;
      EXPECT_EQ(spec.formerly.find('#') == std::string_view::npos, i < block.parameters.size());
    }
  }
}

// The catalogue contains no block whose repeated parts have a deprecated name, so this test declares such a
// block type.
TEST(Catalogue, DeprecatedNamesOfRepeatedPartsContainTheNumberOfThePart) {
  constexpr std::array parts{
      parameter("gain#_mm", "mm", "a gain", Typical{1}, Within{0, 2}, Scale{1}, Formerly{"size#_mm"})};
  BlockDescriptor block{catalogue()[0].info, {}, parts, 1, 3, nullptr};
  EXPECT_EQ(block.name(2), "gain3_mm");
  EXPECT_EQ(block.former_name(2), "size3_mm");
  EXPECT_TRUE(block.is_named(2, "size3_mm"));
  EXPECT_FALSE(block.is_named(1, "size3_mm"));
}

// Recordings of earlier versions contain this hash of this model. At that time, the deprecated names were the
// only names.
TEST(Catalogue, NewNamesDoNotChangeTheHashOfAModel) {
  const Outcome outcome = read(R"(name: renamed
source: deprecated names
actuator:
  - stress_softening: {softening_per_kpa: 0.004, levelling_per_kpa: 0.02}
  - bouc_wen: {alpha_mm_per_kpa: 0.21105, beta_mm_per_kpa: 0.1713, gamma_per_kpa: 0.01625, eta_per_kpa: 0.02428, exponent: 1}
  - rate_dependent_levelling: {levelling: 0.5, rate_kpa_per_s: 20, settling_s: 0.05}
sensor:
  - sensor_wander: {wander_sin_mm: 0.1, wander_cos_mm: 0.2, wander_period_s: 60}
  - sensor_free_drift: {knot_interval_s: 12, knot1_mm: 0.1, knot2_mm: 0.2}
)");
  ASSERT_TRUE(outcome.model) << outcome.problems.format();
  EXPECT_EQ(model_hash(*outcome.model), "7b7807a5bb394f90");
}

}  // namespace
}  // namespace softgrip::model::testing::catalogue_test
