#include "tools/exporting/c_source.h"

#include <gtest/gtest.h>

#include "document/problem.h"
#include "model/file/model_file.h"

// These tests check the text of the exported C source. tests/system/test_export.py compares the results of
// the compiled source with `softgrip simulate`.
namespace softgrip::tools::c_source_test {
namespace {

model::Model bench_twin() {
  document::Problems problems;
  auto model = model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml", problems);
  EXPECT_TRUE(model) << problems.format();
  return *model;
}

TEST(CSource, ContainsOnlyTheCodeThatTheModelNeeds) {
  const auto source = c_source(bench_twin(), 0.001, 60, "test");
  ASSERT_TRUE(source) << source.error();
  EXPECT_EQ(source->name, "bench_twin");
  EXPECT_NE(source->text.find(c_text::transport_delay), std::string::npos);
  EXPECT_NE(source->text.find("bench_twin_inverse_step"), std::string::npos);
  EXPECT_EQ(source->text.find(c_text::prandtl_ishlinskii), std::string::npos);
  EXPECT_EQ(source->text.find('#', source->text.find("#define DELAY_PIECES") + 1), std::string::npos);
}

TEST(CSource, ReplacesCharactersThatAreInvalidInCNamesAndComments) {
  model::Model model = bench_twin();
  model.name = "7 */ int x;";
  const auto source = c_source(model, 0.001, 60, "test");
  ASSERT_TRUE(source);
  EXPECT_EQ(source->name, "model_7____int_x_");
  EXPECT_EQ(source->text.find("*/ int"), std::string::npos);
  // The functions of the model must not have the names of the functions of a block.
  for (const char* const name : {"bouc_wen", "body", "two_way_lag"}) {
    model.name = name;
    EXPECT_EQ(c_source(model, 0.001, 60, "test").value().name, std::string("model_") + name);
  }
}

TEST(CSource, ErrorNamesABlockWithoutCImplementation) {
  model::Model model = bench_twin();
  model.blocks[2].values.back() = 3;
  const auto source = c_source(model, 0.001, 60, "test");
  ASSERT_FALSE(source);
  EXPECT_NE(source.error().find("bouc_wen of an exponent above 1"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::tools::c_source_test
