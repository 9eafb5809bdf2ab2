#pragma once
// Loads a model of config/models for a benchmark. An error is printed, and the program ends with exit code 1.

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "model/file/model_file.h"

namespace softgrip::bench {

/// Returns the value. If there is none, prints the problems and ends the program.
template <class Value>
Value or_exit(const std::optional<Value>& value, const document::Problems& problems) {
  if (!value) {
    std::fputs(problems.format().c_str(), stderr);
    std::exit(1);
  }
  return *value;
}

/// Returns the model of the file config/models/NAME.yaml.
inline model::Model model_named(const std::string& name) {
  document::Problems problems;
  return or_exit(model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/" + name + ".yaml", problems),
                 problems);
}

}  // namespace softgrip::bench
