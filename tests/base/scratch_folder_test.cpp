#include "base/scratch_folder.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/files.h"

namespace softgrip::scratch_folder_test {
namespace {

TEST(ScratchFolder, IsGoneWithWhatIsInIt) {
  std::string path;
  {
    const ScratchFolder one, other;
    path = one.path();
    ASSERT_FALSE(path.empty());
    EXPECT_NE(path, other.path());
    ASSERT_TRUE(write_file(path + "/deeper/file", "text"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace softgrip::scratch_folder_test
