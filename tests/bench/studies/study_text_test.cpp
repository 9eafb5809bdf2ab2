#include "bench/studies/study_text.h"

#include <gtest/gtest.h>

#include "bench/studies/models.h"

namespace softgrip::studies::study_text_test {
namespace {

TEST(StudyText, PadsACellOnTheLeftAndNeverTruncates) {
  EXPECT_EQ(cell("0.5", 6), "   0.5");
  EXPECT_EQ(cell("longer", 3), "longer");
}

TEST(StudyText, ListsEveryParameterUnderItsPath) {
  const model::Model model = bench_twin();
  const auto json = result::json_of(parameters_of(model));
  EXPECT_EQ(json.size(), model::flat_values(model).size());
  for (const auto& [path, value] : json.items()) EXPECT_EQ(value, value_of(model, path.c_str())) << path;
}

}  // namespace
}  // namespace softgrip::studies::study_text_test
