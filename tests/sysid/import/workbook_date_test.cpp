#include "sysid/import/workbook_sheet.h"

#include <gtest/gtest.h>

#include <string_view>

namespace softgrip::sysid::workbook_date_test {
namespace {

TEST(WorkbookDate, DatesAreRecognisedByFormatCode) {
  for (const char* code :
       {"yyyy-mm-dd", "hh:mm:ss.000", "[h]:mm:ss", "d. mmmm yy", "[$-407]d/m/yy", "mm:ss.0"})
    EXPECT_TRUE(is_date_format(std::string_view(code))) << code;
  for (const char* code :
       {"General", "0.00", "0.00\" mm\"", "0\\d", "[Red]0.0", "#,##0_d", "0.0E+00", "0;[s]"})
    EXPECT_FALSE(is_date_format(std::string_view(code))) << code;
  EXPECT_TRUE(is_date_format(22));
  EXPECT_FALSE(is_date_format(2));
}

TEST(WorkbookDate, IsWrittenInIso8601OrAsATimeOfDay) {
  using namespace std::chrono;
  constexpr sys_days from{year{1899} / 12 / 30};
  EXPECT_EQ(iso_date(45443.5, from, true), "2024-05-31T12:00:00.000000");
  EXPECT_EQ(iso_date(0.25, from, false), "06:00:00.000000");
}

}  // namespace
}  // namespace softgrip::sysid::workbook_date_test
