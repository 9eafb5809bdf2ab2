#include "sysid/import/mapping.h"

#include <gtest/gtest.h>

namespace softgrip::sysid::mapping_test {
namespace {

Mapping full() {
  Mapping mapping;
  mapping[Role::time] = {{"Time \"s\" \\ \xc2\xb5"}, "ms", {}, {}, false};
  mapping[Role::command] = {{"p1", "p2"}, "psi", {}, 14.7, false};
  mapping[Role::displacement] = {{"3"}, "V", -2.5, {}, true};
  mapping.separator = '\t';
  mapping.missing = {"-999", "lost"};
  mapping.missing_in = {{"p1", 999}, {"p1", -0.5}, {"a=\"b\"", 0}};
  mapping.channel = "left: 1";
  mapping.sheet = "Run \"1\"";
  mapping.skip_bad_lines = true;
  mapping.from_s = 1.5;
  mapping.to_s = 20;
  return mapping;
}

TEST(MappingFile, WrittenMappingIsReadBackUnchanged) {
  document::Problems problems;
  const std::string text =
      mapping_yaml(full(), {"a\nb.csv", "0123", "CSV"}, "softgrip 1", {"a remark\nof two lines"});
  const auto read = parse_mapping("m.yaml", text, problems);
  ASSERT_TRUE(read) << problems.format() << text;
  EXPECT_EQ(*read, full());
  EXPECT_NE(text.find("# sha256: 0123\n"), std::string::npos);
  EXPECT_NE(text.find("  - {column: \"p1\", values: [999, -0.5]}\n"), std::string::npos) << text;
}

TEST(MappingFile, MessagesDoNotExceedTheSizeOfAMappingFile) {
  const std::vector<std::string> remarks(1000, std::string(300, 'x'));
  const std::string text = mapping_yaml(full(), {"a.csv", "0123", "CSV"}, "softgrip 1", remarks);
  EXPECT_LT(text.size(), std::size_t{40} * 1024);
  EXPECT_NE(text.find("# messages that are not in this file: 892\n"), std::string::npos);
  document::Problems problems;
  EXPECT_EQ(parse_mapping("m.yaml", text, problems), full()) << problems.format();
}

TEST(MappingFile, ErrorsStateTheLocation) {
  const auto refused = [](const std::string& text) {
    document::Problems problems;
    EXPECT_FALSE(parse_mapping("m.yaml", text, problems)) << text;
    return problems.format();
  };
  const std::string good = "schema: 1\nrate_hz: 100\ncommand: {columns: [a]}\n";
  EXPECT_NE(refused(good).find("the mapping is incomplete"), std::string::npos);
  const std::string scaled =
      "schema: 1\nrate_hz: 100\ncommand: {columns: [a]}\ndisplacement: {columns: [b], scale: ";
  EXPECT_NE(refused(scaled + "0}\n").find("a scale must not be 0"), std::string::npos);
  const std::string no_number = refused(scaled + "hundred}\n");
  EXPECT_NE(no_number.find("hundred"), std::string::npos) << no_number;
  EXPECT_EQ(no_number.find("must not be 0"), std::string::npos) << no_number;
  EXPECT_NE(refused(good + "displacment: {columns: [b]}\n").find("m.yaml:4:1"), std::string::npos);
  EXPECT_NE(refused(good + "displacement: {columns: [], scale: 0}\n").find("m.yaml:4:"), std::string::npos);
  EXPECT_NE(refused(good + "displacement: {columns: [b], zero: last}\n").find("m.yaml:4:"),
            std::string::npos);
  EXPECT_NE(refused(good + "displacement: {columns: [b]}\nmissing_in: [{column: b, values: [x]}]\n")
                .find("m.yaml:5:"),
            std::string::npos);
  EXPECT_NE(refused(good + "displacement: {columns: [b]}\nseparator: dots\n").find("separates no columns"),
            std::string::npos);
}

TEST(Mapping, SeparatorsHaveNames) {
  EXPECT_EQ(separator_named("tab"), '\t');
  EXPECT_EQ(separator_named(";"), ';');
  EXPECT_EQ(separator_named("dots"), 0);
}

}  // namespace
}  // namespace softgrip::sysid::mapping_test
