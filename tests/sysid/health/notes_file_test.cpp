#include "sysid/health/finger_health.h"

#include <gtest/gtest.h>

namespace softgrip::sysid::health::notes_file_test {
namespace {

std::optional<std::vector<Note>> notes_of(const std::string& text, document::Problems& problems) {
  return read_notes("notes.yaml", text, problems);
}

TEST(NotesFile, NotesAreSortedByDate) {
  document::Problems problems;
  const auto notes = notes_of(
      "notes:\n"
      "  - {date: 2026-11-20T14:30:00Z, action: \"sensors clamped again\"}\n"
      "  - {date: 2026-11-03, finger: left, mended: finger replaced}\n",
      problems);
  ASSERT_TRUE(notes) << problems.format();
  ASSERT_EQ(notes->size(), 2U);
  EXPECT_EQ(notes->front().finger, "left");
  EXPECT_EQ(notes->front().action, "finger replaced") << "the action must be read from the deprecated key";
  EXPECT_EQ(notes->back().action, "sensors clamped again");
  EXPECT_EQ(notes->back().finger, "");
}

TEST(NotesFile, InvalidNotesAreRefusedWithTheLocation) {
  for (const char* text :
       {"notes:\n  - {date: 2026-24-11, mended: x}\n", "notes:\n  - {date: 2026-02-30, mended: x}\n",
        "notes:\n  - {date: 2026-11-03T24:00:00Z, mended: x}\n", "notes:\n  - {date: yesterday, mended: x}\n",
        "notes:\n  - {date: 2026-11-3, mended: x}\n", "notes:\n  - {date: 2026-11-03}\n",
        "notes:\n  - {date: 2026-11-03, mended: x, fingers: left}\n",
        "notes:\n  - {date: 2026-11-03, mended: x, action: x}\n", "note: []\n", ""}) {
    document::Problems problems;
    EXPECT_FALSE(notes_of(text, problems)) << text;
    EXPECT_NE(problems.format().find("notes.yaml:"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace softgrip::sysid::health::notes_file_test
