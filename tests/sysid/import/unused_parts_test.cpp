#include "sysid/import/conversion.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace softgrip::sysid::unused_parts_test {
namespace {

TableColumn column(const std::string& name, std::vector<double> values) {
  TableColumn made;
  made.name = name;
  made.values = std::move(values);
  return made;
}

class UnusedPartsTest : public testing::Test {
 protected:
  UnusedPartsTest() {
    table_.file = "m.mat";
    table_.columns = {column("t", {0, 1, 2}), column("p", {5, 6, 7}), column("x", {1, 2, 3})};
    for (const Role role : {Role::time, Role::pressure, Role::displacement}) {
      const std::size_t next = used_++;
      mapping_[role].columns = {table_.columns[next].name};
      sources_.of_roles[static_cast<std::size_t>(role)].columns = {next};
    }
  }
  void report() { report_unused(table_, mapping_, sources_, remarks_, problems_); }

  ForeignTable table_;
  Mapping mapping_;
  RoleSources sources_;
  ImportRemarks remarks_;
  document::Problems problems_;
  std::size_t used_ = 0;
};

TEST_F(UnusedPartsTest, AColumnWithoutARoleIsANote) {
  table_.columns.push_back(column("humidity", {40, 41, 42}));
  report();
  EXPECT_EQ(remarks_.notes, std::vector<std::string>{"unused columns: 'humidity'"});
  EXPECT_TRUE(remarks_.warnings.empty());
  EXPECT_TRUE(problems_.empty()) << problems_.format();
}

TEST_F(UnusedPartsTest, AnUnusedColumnWithTheNameOfAUsedOneIsAWarning) {
  table_.columns.push_back(column("x", {2, 4, 6}));
  report();
  EXPECT_EQ(
      remarks_.warnings,
      std::vector<std::string>{"column 4 is not used, but has the name of column 3: 'x'. State the correct "
                               "column by its number"});
}

TEST_F(UnusedPartsTest, ARepeatedTimeColumnIsReportedOnce) {
  table_.columns.push_back(table_.columns.front());
  report();
  ASSERT_EQ(remarks_.warnings.size(), 1U);
  EXPECT_EQ(remarks_.warnings.front().find("the column 't' looks like a time"), 0U)
      << remarks_.warnings.front();
}

TEST_F(UnusedPartsTest, AnOptionWithoutEffectIsAWarning) {
  mapping_.sheet = "Data";
  report();
  EXPECT_EQ(remarks_.warnings, std::vector<std::string>{"--sheet has no effect: the file is not a workbook"});
}

TEST_F(UnusedPartsTest, RowsOfSeveralFingersAreAProblem) {
  table_.columns.push_back(column("finger", {1, 2, 1}));
  report();
  EXPECT_NE(problems_.format().find("the rows belong to 2 fingers"), std::string::npos) << problems_.format();
}

TEST_F(UnusedPartsTest, AUnitHasNoEffectIfEachOfTwoTimesStatesItsUnit) {
  table_.columns[0].unit = "s";
  table_.columns.push_back(column("t2 (s)", {0, 1, 2}));
  mapping_[Role::time].columns.emplace_back("t2 (s)");
  mapping_[Role::time].unit = "ms";
  sources_.of_roles[static_cast<std::size_t>(Role::time)].columns.push_back(3);
  report();
  EXPECT_EQ(remarks_.warnings,
            std::vector<std::string>{"--unit time=ms has no effect: each time column states its unit"});
  remarks_.warnings.clear();
  table_.columns[0].unit = "";
  report();
  EXPECT_TRUE(remarks_.warnings.empty()) << remarks_.warnings.front();
}

}  // namespace
}  // namespace softgrip::sysid::unused_parts_test
