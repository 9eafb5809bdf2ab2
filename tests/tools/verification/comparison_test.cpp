#include "tools/verification/comparison.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "model/file/model_file.h"

namespace softgrip::tools::comparison_test {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> places(const Comparison& comparison) {
  std::vector<std::string> all;
  for (const Difference& difference : comparison.differences) all.push_back(difference.where);
  return all;
}

TEST(Comparison, NamesEveryNumberOfAJsonThatDiffers) {
  const Json was{
      {"rmse_mm", {{"a", 0.1}, {"b", 0.2}}}, {"list", {1, 2, 3}}, {"verdict", "x"}, {"n", nullptr}};
  Json is = was;
  Comparison same{1e-6, 0, {}};
  compare_json("f.json", was, is, same);
  EXPECT_TRUE(same.differences.empty());
  EXPECT_EQ(same.numbers, 5U);
  is["rmse_mm"]["b"] = 0.2001;
  is["list"][2] = 4;
  is["verdict"] = "y";
  is["n"] = 1;
  is["more"] = true;
  Comparison other{1e-6, 0, {}};
  compare_json("f.json", was, is, other);
  EXPECT_EQ(places(other), (std::vector<std::string>{"f.json: list[2]", "f.json: more", "f.json: n",
                                                     "f.json: rmse_mm.b", "f.json: verdict"}));
  EXPECT_EQ(other.differences[3].reported, "0.2");
  EXPECT_EQ(other.differences[3].recomputed, "0.2001");
}

TEST(Comparison, TheToleranceIsRelativeAndTimesDoNotCount) {
  const Json was{
      {"value", 1000.0}, {"wall_s", 3}, {"software", "a"}, {"logs", {{{"path", "x"}, {"samples", 9}}}}};
  const Json is{
      {"value", 1000.5}, {"wall_s", 4}, {"software", "b"}, {"logs", {{{"path", "y"}, {"samples", 9}}}}};
  Comparison wide{1e-3, 0, {}}, narrow{1e-6, 0, {}};
  compare_json("f.json", was, is, wide);
  compare_json("f.json", was, is, narrow);
  EXPECT_TRUE(places(wide).empty());
  EXPECT_EQ(places(narrow), std::vector<std::string>{"f.json: value"});
}

TEST(Comparison, OfACsvTheWorstLineOfEachColumnIsTold) {
  const std::string was = "t,y\n0,1\n1,2\n2,\n";
  Comparison comparison{1e-6, 0, {}};
  compare_csv("s.csv", was, "t,y\n0,1.1\n1,2.5\n2,\n", comparison);
  EXPECT_EQ(places(comparison), std::vector<std::string>{"s.csv: y, line 3"});
  compare_csv("s.csv", was, "t,y\n0,1\n1,2\n2,7\n", comparison);
  EXPECT_EQ(comparison.differences.back().recomputed, "7")
      << "the cell is empty in the report but not in the repeated result";
  compare_csv("s.csv", was, "t,y\n0,1\n", comparison);
  EXPECT_EQ(comparison.differences.back().where, "s.csv: lines");
}

TEST(Comparison, ModelsAreComparedByParameter) {
  document::Problems problems;
  const model::Model twin =
      model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml", problems).value();
  std::vector<double> values = model::flat_values(twin);
  values[0] *= 1.01;
  Comparison comparison{1e-6, 0, {}};
  compare_models("model.yaml", twin, twin, comparison);
  EXPECT_TRUE(comparison.differences.empty());
  compare_models("model.yaml", twin, model::with_values(twin, values), comparison);
  EXPECT_EQ(places(comparison), std::vector<std::string>{"model.yaml: " + model::parameter_path(twin, 0)});
}

}  // namespace
}  // namespace softgrip::tools::comparison_test
