#include "sysid/import/table_readers.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "base/files.h"
#include "sysid/import/table.h"

// tests/system/test_import.py tests the values that the import reads from MATLAB and HDF5 files.
namespace softgrip::sysid::foreign_file_test {
namespace {

TEST(ArrayCollector, TallAndWideMatricesBecomeColumns) {
  ArrayCollector arrays("f");
  arrays.add("tall", "", 3, 2, {1, 2, 3, 4, 5, 6});
  arrays.add("wide", "", 2, 3, {1, 4, 2, 5, 3, 6});
  arrays.add("row", "psi", 1, 3, {7, 8, 9});
  arrays.add("other", "", 1, 5, {0, 0, 0, 0, 0});
  document::Problems problems;
  const auto table = arrays.table("test", problems);
  ASSERT_TRUE(table);
  ASSERT_EQ(table->columns.size(), 5U);
  EXPECT_EQ(table->columns[1].name, "tall(:,2)");
  EXPECT_EQ(table->columns[1].values, (std::vector<double>{4, 5, 6}));
  EXPECT_EQ(table->columns[2].name, "wide(1,:)");
  EXPECT_EQ(table->columns[2].values, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(table->columns[4].unit, "psi");
  EXPECT_EQ(table->notes, std::vector<std::string>{"'other' is skipped: 5 values, but other arrays have 3"});
}

TEST(Gunzipped, SizeIsLimitedAndErrorsAreReported) {
  // the output of `printf 'hello hello' | gzip -n`
  const std::string packed(
      "\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03\xcb\x48\xcd\xc9\xc9\x57\xc8\x00\x91\x00\x40\xa6\x2d\x01\x0b"
      "\x00\x00\x00",
      28);
  const auto text = gunzipped(packed, 100);
  ASSERT_TRUE(text) << text.error();
  EXPECT_EQ(*text, "hello hello");
  EXPECT_FALSE(gunzipped(packed, 5));
  EXPECT_EQ(gunzipped(packed.substr(0, 15), 100).error(), "the gzip file is cut off");
  std::string broken = packed;
  broken[11] = '\x11';
  EXPECT_FALSE(gunzipped(broken, 100));
}

TEST(ForeignFile, BrokenBinariesAreRefusedAndMissingOnesUnreadable) {
  const auto folder = std::filesystem::temp_directory_path() / "softgrip_foreign_file_test";
  for (const std::string& text :
       {std::string("MATLAB 5.0 MAT-file"), std::string("\x89HDF\r\n\x1a\n and no more"),
        std::string("PK\x03\x04"), std::string(40, '\0')}) {
    const std::string path = (folder / "file").string();
    ASSERT_TRUE(write_file(path, text));
    document::Problems problems;
    bool unreadable = false;
    EXPECT_FALSE(read_foreign_file(path, {}, problems, unreadable)) << text;
    EXPECT_EQ(problems.size(), 1U);
    EXPECT_FALSE(unreadable);
  }
  std::filesystem::remove_all(folder);
  document::Problems problems;
  bool unreadable = false;
  EXPECT_FALSE(read_foreign_file((folder / "file").string(), {}, problems, unreadable));
  EXPECT_TRUE(unreadable);
}

/// The file is a named pipe, which the function must refuse. If the function waited for a writer of the pipe,
/// this test would never end.
TEST(ForeignFile, NamedPipeIsUnreadableWithoutWaiting) {
  const ScratchFolder scratch;
  const std::string pipe = scratch.path() + "/log.csv";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  document::Problems problems;
  bool unreadable = false;
  EXPECT_FALSE(read_foreign_file(pipe, {}, problems, unreadable));
  EXPECT_TRUE(unreadable);
}

}  // namespace
}  // namespace softgrip::sysid::foreign_file_test
