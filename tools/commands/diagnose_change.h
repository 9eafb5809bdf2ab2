#pragma once
// softgrip diagnose --healthy: reports the change of a finger since its healthy logs.

#include <string>
#include <vector>

#include "base/exit_code.h"
#include "sysid/changes/change.h"

namespace softgrip::tools {

struct ChangeQuestion {
  std::vector<sysid::Log> healthy;
  std::vector<sysid::Log> later;
  model::Model given;
  sysid::ChangeOptions options;
  std::string out;
  std::string figures;  ///< folder into which the figures are written as files; "": no figures are written
  std::vector<std::string> call;
  bool json = false;
  bool explain = false;  ///< true: the comparison that led to each reported cause is also printed
};

/// Diagnoses the change of the finger, writes diagnosis.json and report.html, and prints the result.
[[nodiscard]] ExitCode run_change(ChangeQuestion question);

}  // namespace softgrip::tools
