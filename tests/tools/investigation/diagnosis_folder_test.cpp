#include "tools/investigation/diagnosis_folder.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/files.h"
#include "model/file/model_file.h"

namespace softgrip::tools::diagnosis_folder_test {
namespace {

model::Model loaded(const std::string& path) {
  document::Problems problems;
  return model::load_model(path, problems).value();
}

/// `softgrip diagnose` must remove the file feedforward_model.yaml of an earlier diagnosis, because a user
/// would associate this file with the new model.
TEST(DiagnosisFolder, ContainsAFeedforwardModelOnlyIfItIsPartOfTheModel) {
  const ScratchFolder scratch;
  const std::filesystem::path file = std::filesystem::path(scratch.path()) / "feedforward_model.yaml";
  sysid::Diagnosis diagnosis;
  diagnosis.extended_model = loaded(SOFTGRIP_SOURCE_DIR "/config/models/zhang2025.yaml");
  const model::Model part = loaded(SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml");
  const std::vector<sysid::Log> logs;
  const DiagnosisSource source{logs, part, {}};
  Consequences consequences;
  consequences.closed_loop.emplace();
  for (const bool is_part : {true, false}) {
    consequences.closed_loop->extended.part =
        is_part ? std::optional(control::InvertiblePart{part, {"bouc_wen"}}) : std::nullopt;
    const auto written = write_diagnosis_folder(scratch.path(), diagnosis, source, consequences, "finger");
    ASSERT_TRUE(written) << written.error();
    ASSERT_EQ(std::filesystem::exists(file), is_part);
    if (is_part) {
      EXPECT_EQ(loaded(file.string()).blocks, part.blocks);
    }
  }
}

}  // namespace
}  // namespace softgrip::tools::diagnosis_folder_test
