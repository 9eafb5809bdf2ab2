#pragma once
// Reading a model as the desk's commands take it.

#include <string>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "model/model.h"

namespace softgrip::tools {

/// Reads a model file; where it is refused, prints all problems and returns the exit code.
[[nodiscard]] tl::expected<model::Model, ExitCode> read_model(const std::string& path);
/// Reads a model file for a rig: another output unit than mm is refused.
[[nodiscard]] tl::expected<model::Model, ExitCode> read_rig_model(const std::string& path);

}  // namespace softgrip::tools
