// Passes every file of the fuzz corpus to the parser. No file may crash the parser. In contrast to the fuzz
// target, this test is a part of every build.

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/support/files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace softgrip::document::corpus_test {
namespace {

TEST(Corpus, NoCorpusFileCrashesTheParser) {
  std::size_t files = 0;
  const std::filesystem::path folder = std::filesystem::path(SOFTGRIP_SOURCE_DIR) / "tests/document/corpus";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string text = test::text_of(entry.path());
    const std::string whole =
        text + text;  // the second copy begins a second document or continues the last line of the first copy
    for (const std::string& input : {text, whole, text.substr(text.size() / 2)}) {
      LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
    }
    ++files;
  }
  EXPECT_GE(files, 50U);
}

}  // namespace
}  // namespace softgrip::document::corpus_test
