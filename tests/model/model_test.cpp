#include "model/model.h"

#include <gtest/gtest.h>

#include <set>

#include "model/catalogue.h"
#include "tests/model/presets.h"

namespace softgrip::model::testing::model_test {
namespace {

TEST(Catalogue, EveryDeclarationIsSound) {
  std::set<std::string_view> ids;
  for (const BlockDescriptor& descriptor : catalogue()) {
    EXPECT_TRUE(ids.insert(descriptor.info.id).second) << descriptor.info.id;
    EXPECT_FALSE(descriptor.info.title.empty());
    EXPECT_EQ(descriptor.info.meaning.back(), '.') << descriptor.info.id;
    EXPECT_EQ(descriptor.repeated.empty(), descriptor.max_parts == 0);
    bool has_neutral = false;
    const std::size_t count = descriptor.parameters.size() + descriptor.repeated.size();
    for (std::size_t i = 0; i < count; ++i) {
      const ParameterSpec& spec = descriptor.spec(i);
      EXPECT_LE(spec.lower, spec.default_value) << descriptor.info.id << " " << spec.name;
      EXPECT_LE(spec.default_value, spec.upper) << descriptor.info.id << " " << spec.name;
      EXPECT_GT(spec.scale, 0);
      EXPECT_FALSE(spec.meaning.empty());
      EXPECT_EQ(spec.name.find('#') != std::string_view::npos, i >= descriptor.parameters.size());
      if (spec.neutral == spec.neutral) {
        has_neutral = true;
        EXPECT_LE(spec.lower, spec.neutral) << descriptor.info.id << " " << spec.name;
        EXPECT_LE(spec.neutral, spec.upper) << descriptor.info.id << " " << spec.name;
      }
    }
    EXPECT_TRUE(has_neutral) << descriptor.info.id;
  }
}

// Returns the suffix that a unit adds to a key: _mm_per_kpa for mm/kPa, _per_mm2 for 1/mm^2, _c for degC.
// Returns an empty text for a quantity without a unit.
std::string ending_of(const std::string& unit) {
  std::string ending = unit.empty() ? "" : "_" + unit;
  for (const auto& [written, named] : {std::pair<std::string, std::string>{"degC", "C"},
                                       {"_1/", "_per_"},
                                       {"/", "_per_"},
                                       {" ", "_"},
                                       {"^", ""}}) {
    for (std::size_t at = ending.find(written); at != std::string::npos; at = ending.find(written))
      ending.replace(at, written.size(), named);
  }
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending;
}

TEST(Catalogue, NamesEndWithTheirUnits) {
  EXPECT_EQ(ending_of("kPa s/mm"), "_kpa_s_per_mm");
  EXPECT_EQ(ending_of("1/degC"), "_per_c");
  for (const BlockDescriptor& descriptor : catalogue()) {
    for (std::size_t i = 0; i < descriptor.parameters.size() + descriptor.repeated.size(); ++i) {
      const ParameterSpec& spec = descriptor.spec(i);
      EXPECT_TRUE(spec.name.ends_with(ending_of(std::string(spec.unit))))
          << descriptor.info.id << "." << spec.name << " [" << spec.unit << "]";
    }
  }
}

TEST(Model, PresetsAreValid) {
  for (const std::string name : {"zhang2025", "bench_twin", "soft_arm_play"})
    EXPECT_TRUE(validate(preset(name)).empty()) << name;
}

TEST(Model, PathsNameEveryValueOnce) {
  Model model = preset("bench_twin");
  model = with_block(model, {*find_block("contact"), {10.0, 1.0}});
  model = with_block(model, {*find_block("contact"), {20.0, 5.0}});
  std::set<std::string> paths;
  for (std::size_t i = 0; i < parameter_count(model); ++i) {
    const std::string path = parameter_path(model, i);
    EXPECT_TRUE(paths.insert(path).second) << path;
    EXPECT_EQ(find_path(model, path), i);
  }
  EXPECT_TRUE(paths.contains("kelvin_voigt.c2_kpa_s_per_mm"));
  EXPECT_TRUE(paths.contains("contact.position_mm"));
  EXPECT_TRUE(paths.contains("contact_2.position_mm"));
  EXPECT_FALSE(find_path(model, "contact_3.position_mm"));
  EXPECT_EQ(flat_values(model)[*find_path(model, "kelvin_voigt.c2_kpa_s_per_mm")], 1.621);
  EXPECT_EQ(parameter_spec(model, *find_path(model, "bouc_wen.exponent")).whole, true);
}

TEST(Model, FlatValuesRestoreTheModel) {
  const Model model = preset("bench_twin");
  EXPECT_EQ(with_values(model, flat_values(model)), model);
}

TEST(Model, AddedBlocksAreSortedIntoTheChain) {
  Model model;
  for (const std::string_view id :
       {"quantisation", "kelvin_voigt", "contact", "valve_lag", "sensor_noise", "bouc_wen"}) {
    model = with_block(model, default_block(*find_block(id)));
  }
  EXPECT_TRUE(validate(model).empty());
  EXPECT_EQ(*position_of(model, "valve_lag"), 0u);
  EXPECT_EQ(*position_of(model, "sensor_noise"), 4u);
  EXPECT_EQ(*position_of(model, "quantisation"),
            5u);  // quantisation is the last block of the chain, although it was added first
  EXPECT_FALSE(position_of(model, "transport_delay"));
  EXPECT_FALSE(position_of(without_block(model, *find_block("contact")), "contact"));
}

TEST(Model, ValidationReportsEveryError) {
  const std::size_t lag = *find_block("valve_lag"), bouc_wen = *find_block("bouc_wen");
  EXPECT_EQ(validate(Model{}).size(), 1u);  // one error: the model has no element
  Model model = preset("bench_twin");
  model.blocks.push_back({lag, {0.1}});
  EXPECT_EQ(validate(model).size(), 2u);  // two errors: the block occurs twice, and the blocks are in the
                                          // wrong order
  model = preset("zhang2025");
  model.blocks[0].values[4] = 1.5;
  EXPECT_EQ(validate(model).size(), 1u);
  model.blocks[0].values[4] = 1;
  model.blocks[0].values[0] = std::nan("");
  EXPECT_EQ(validate(model).size(), 1u);
  model = preset("zhang2025");
  model.blocks[*position_of(model, bouc_wen)].values[2] = -0.03;
  EXPECT_EQ(validate(model).size(), 1u);
  model = preset("zhang2025");
  model.blocks[1].values.pop_back();
  EXPECT_EQ(validate(model).size(), 1u);
  model.blocks[0].type = 999;
  EXPECT_EQ(validate(model).size(), 1u);
}

}  // namespace
}  // namespace softgrip::model::testing::model_test
