#include "control/elements/fault.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace softgrip::control::fault_test {
namespace {

TEST(Faults, CodesAreStable) {
  const std::vector<std::pair<std::string, std::string>> expected{{"F101", "bus_down"},
                                                                  {"F102", "bus_timed_out"},
                                                                  {"F103", "bus_bad_reply"},
                                                                  {"F104", "bus_exception"},
                                                                  {"F201", "reading_stale"},
                                                                  {"F202", "reading_out_of_range"},
                                                                  {"F203", "sensor_error"},
                                                                  {"F204", "reading_jumped"},
                                                                  {"F205", "reading_frozen"},
                                                                  {"F206", "displacement_beyond_limits"},
                                                                  {"F207", "pressure_not_followed"},
                                                                  {"F208", "pressure_invalid"},
                                                                  {"F301", "readback_mismatch"},
                                                                  {"F302", "write_refused"},
                                                                  {"F303", "board_watchdog_tripped"},
                                                                  {"F304", "outputs_overwritten"},
                                                                  {"F401", "model_unfit"},
                                                                  {"F501", "emergency_stop"},
                                                                  {"F502", "inputs_lost"},
                                                                  {"F901", "cycles_lost"},
                                                                  {"F902", "not_finite"}};
  ASSERT_EQ(all_faults().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const FaultInfo& info = all_faults()[i];
    EXPECT_EQ(info.id, expected[i].first);
    EXPECT_EQ(info.name, expected[i].second);
    EXPECT_EQ(std::string(info.id), "F" + std::to_string(static_cast<int>(info.code)));
    EXPECT_EQ(&info_of(info.code), &info);
    EXPECT_FALSE(info.meaning.empty() || info.cause.empty() || info.remedy.empty() || info.bound.empty());
  }
  EXPECT_EQ(info_of(FaultCode::none).id, "F000");
  EXPECT_LE(all_faults().size(), 32U) << "a fault is one bit of a 32-bit word in the supervisor";
}

TEST(Refusals, HaveIdAndName) {
  std::set<std::string> ids;
  for (int i = 0; i <= 12; ++i) {
    const auto code = static_cast<RefusalCode>(i);
    EXPECT_EQ(id_of(code), std::string(i < 10 ? "R0" : "R") + std::to_string(i));
    EXPECT_TRUE(ids.insert(std::string(name_of(code))).second);
    EXPECT_FALSE(i > 0 && (text_of(code).meaning.empty() || text_of(code).next.empty()));
  }
}

std::string refusal_table() {
  std::ostringstream out;
  out << "| code | name | meaning | what to do |\n|---|---|---|---|\n";
  for (int i = 1; i <= 12; ++i) {
    const auto code = static_cast<RefusalCode>(i);
    out << "| " << id_of(code) << " | `" << name_of(code) << "` | " << text_of(code).meaning << " | "
        << text_of(code).next << " |\n";
  }
  return out.str();
}

/// Returns the fault table that must be in docs/reference/faults.md.
std::string table() {
  std::ostringstream out;
  out << "| code | name | meaning | usual cause | what to do | latches within |\n|---|---|---|---|---|---|\n";
  for (const FaultInfo& info : all_faults()) {
    out << "| " << info.id << " | `" << info.name << "` | " << info.meaning << " | " << info.cause << " | "
        << info.remedy << " | " << info.bound << " |\n";
  }
  return out.str();
}

TEST(Faults, TheManualTablesEqualTheTablesOfTheCode) {
  const std::string manual = test::text_of(SOFTGRIP_SOURCE_DIR "/docs/reference/faults.md");
  EXPECT_NE(manual.find(table()), std::string::npos)
      << "the table in docs/reference/faults.md must be equal to this table:\n"
      << table();
  EXPECT_NE(manual.find(refusal_table()), std::string::npos)
      << "the table of refusals in docs/reference/faults.md must be equal to this table:\n"
      << refusal_table();
}

}  // namespace
}  // namespace softgrip::control::fault_test
