#include "tools/log_input/log_input.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/files.h"

namespace softgrip::tools::import_hint_test {
namespace {

TEST(ImportHint, ProposesAnImportCommandOrOneThatListsTheColumns) {
  const auto folder = std::filesystem::temp_directory_path() / "softgrip_import_hint_test";
  const std::string path = (folder / "day 1.csv").string();
  const auto hint_for = [&](const std::string& header) {
    std::string text = header + "\n";
    for (int i = 0; i < 60; ++i)
      text += std::to_string(10 * i) + "," + std::to_string(i % 9) + "," + std::to_string(i % 9) + "\n";
    EXPECT_TRUE(write_file(path, text));
    return import_hint(path);
  };
  EXPECT_EQ(hint_for("t_ms,set_psi,x_mm"),
            path + " as a log: softgrip import '" + path +
                "' --time t_ms --command set_psi --displacement x_mm --out 'day 1_log.csv'\n");
  EXPECT_EQ(hint_for("a,b,c"),
            "To see the columns of " + path + ": softgrip import '" + path + "' --out 'day 1_log.csv'\n");
  EXPECT_EQ(import_hint(folder.string() + "/absent"), "");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace softgrip::tools::import_hint_test
