#pragma once
// Reads models for the commands that need no rig.

#include <string>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "model/model.h"

namespace softgrip::tools {

/// Reads a model file. If the file is refused, prints all problems and returns the exit code.
[[nodiscard]] tl::expected<model::Model, ExitCode> read_model(const std::string& path);
/// Reads a model file for a rig. Refuses an output unit other than mm.
[[nodiscard]] tl::expected<model::Model, ExitCode> read_rig_model(const std::string& path);

}  // namespace softgrip::tools
