#include "sysid/import/role_sources.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace softgrip::sysid::role_sources_test {
namespace {

TableColumn column(const std::string& name, const std::string& unit) {
  TableColumn made;
  made.name = name;
  made.unit = unit;
  made.values = {1, 2, 3};
  return made;
}

ForeignTable table() {
  ForeignTable made;
  made.file = "m.csv";
  made.columns = {column("t", "ms"), column("p", "bar"), column("x", "mm"), column("y", "")};
  return made;
}

Mapping mapping(const std::string& displacement) {
  Mapping made;
  made[Role::time].columns = {"t"};
  made[Role::pressure].columns = {"p"};
  made[Role::displacement].columns = {displacement};
  return made;
}

TEST(RoleSources, ColumnsHaveTheFactorOfTheUnit) {
  document::Problems problems;
  const RoleSources sources = resolve_sources(table(), mapping("x"), problems);
  EXPECT_TRUE(problems.empty()) << problems.format();
  EXPECT_DOUBLE_EQ(sources.of_roles[static_cast<std::size_t>(Role::time)].conversions.at(0).factor, 1e-3);
  EXPECT_DOUBLE_EQ(sources.of_roles[static_cast<std::size_t>(Role::pressure)].conversions.at(0).factor, 100);
  EXPECT_EQ(sources.of_roles[static_cast<std::size_t>(Role::displacement)].columns,
            std::vector<std::size_t>{2});
  EXPECT_TRUE(sources.uses(2));
  EXPECT_FALSE(sources.uses(3));
}

TEST(RoleSources, ColumnWithoutAUnitIsRefused) {
  document::Problems problems;
  static_cast<void>(resolve_sources(table(), mapping("y"), problems));
  EXPECT_NE(problems.format().find("displacement: 'y' has no unit"), std::string::npos) << problems.format();
}

TEST(RoleSources, MeanOfALengthAndAnAngleIsRefused) {
  ForeignTable mixed = table();
  mixed.columns[3].unit = "deg";
  Mapping both = mapping("x");
  both[Role::displacement].columns.emplace_back("y");
  document::Problems problems;
  static_cast<void>(resolve_sources(mixed, both, problems));
  EXPECT_NE(problems.format().find("displacement: 'x' in mm and 'y' in deg have no mean"), std::string::npos)
      << problems.format();
}

TEST(RoleSources, UsedColumnWithAmbiguousCommasIsRefused) {
  ForeignTable ambiguous = table();
  ambiguous.columns[2].ambiguous_mark = "20,000";
  document::Problems problems;
  static_cast<void>(resolve_sources(ambiguous, mapping("x"), problems));
  EXPECT_NE(
      problems.format().find("displacement: the comma in the cell '20,000' of 'x' can be a decimal comma"),
      std::string::npos)
      << problems.format();
  EXPECT_NE(problems.format().find("export the file without thousands separators"), std::string::npos);
  ambiguous.columns[2].ambiguous_mark = "1.234";
  document::Problems of_point;
  static_cast<void>(resolve_sources(ambiguous, mapping("x"), of_point));
  EXPECT_NE(of_point.format().find("the point in the cell '1.234' of 'x' can be a decimal point or separate "
                                   "thousands"),
            std::string::npos)
      << of_point.format();
  ambiguous.columns[3].unit = "mm";
  document::Problems none;
  static_cast<void>(resolve_sources(ambiguous, mapping("y"), none));
  EXPECT_TRUE(none.empty()) << none.format();
}

TEST(RoleSources, ScaledDisplacementCanBeAnAngle) {
  ColumnMapping mapped;
  mapped.columns = {"x"};
  mapped.scale = 2;
  mapped.unit = "deg";
  const auto unit = angle_of_scale(spec_of(Role::displacement), mapped);
  ASSERT_TRUE(unit);
  EXPECT_NE(unit->output, model::OutputUnit::mm);
  EXPECT_FALSE(angle_of_scale(spec_of(Role::pressure), mapped));
  mapped.unit = "mm";
  EXPECT_FALSE(angle_of_scale(spec_of(Role::displacement), mapped));
}

}  // namespace
}  // namespace softgrip::sysid::role_sources_test
