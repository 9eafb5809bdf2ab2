#pragma once
// What `softgrip baseline` leaves and `softgrip diagnose --baseline` reads: healthy_1.csv ..., model.yaml,
// baseline.json with where they came from.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "sysid/changes/change.h"

namespace softgrip::tools {

struct Baseline {
  std::vector<std::string> logs;  ///< paths inside the folder, in order
  std::string model;              ///< path of model.yaml
};

/// Copies the logs' files byte by byte and writes the rest. Returns the text of baseline.json.
/// @param about  what baseline.json says besides.
[[nodiscard]] tl::expected<std::string, std::string> write_baseline(const std::string& folder,
                                                                    const std::vector<sysid::Log>& logs,
                                                                    const model::Model& model,
                                                                    nlohmann::ordered_json about);

/// Reads baseline.json and compares the hashes of what it names; a folder that is none, or in which something
/// was changed, is refused with a sentence.
[[nodiscard]] tl::expected<Baseline, std::string> read_baseline(const std::string& folder);

}  // namespace softgrip::tools
