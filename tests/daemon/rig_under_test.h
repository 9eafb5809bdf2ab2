#pragma once
// Reads the example rigs and sequences of the project for tests.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "daemon/socket/sequence_loader.h"
#include "rig/rig_file.h"

namespace softgrip::daemon::testing {

/// Reads the rig file config/NAME. If the file is refused, the test fails.
[[nodiscard]] inline rig::RigFile example_rig(const std::string& name) {
  document::Problems problems;
  auto rig = rig::load_rig(std::string(SOFTGRIP_SOURCE_DIR "/config/") + name, problems);
  EXPECT_TRUE(rig.has_value()) << problems.format();
  return rig ? std::move(*rig) : rig::RigFile{};
}

/// Reads the sequence config/sequences/NAME for a rig. If the sequence is refused, the test fails and the
/// result is nullptr.
[[nodiscard]] inline std::shared_ptr<const LoadedSequence> example_sequence(const rig::RigFile& rig,
                                                                            const std::string& name) {
  auto sequence = SequenceLoader(rig.settings, "")
                      .load_file(std::string(SOFTGRIP_SOURCE_DIR "/config/sequences/") + name);
  EXPECT_TRUE(sequence.has_value()) << (sequence ? "" : sequence.error().format());
  return sequence ? *sequence : nullptr;
}

}  // namespace softgrip::daemon::testing
