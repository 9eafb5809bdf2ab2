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
  std::string figures;  ///< folder for the figures as files; "": no figures
  std::vector<std::string> call;
  bool json = false;
  bool explain = false;  ///< also prints the comparison that led to each reported cause
};

/// Diagnoses the change of the finger, writes diagnosis.json and report.html, and prints the result.
[[nodiscard]] ExitCode run_change(ChangeQuestion question);

}  // namespace softgrip::tools
