#pragma once
// Reads the preset models from their files, with the code that also reads the model files of users.

#include <gtest/gtest.h>

#include <string>

#include "model/file/model_file.h"

namespace softgrip::model::testing {

inline Model preset(const std::string& name) {
  document::Problems problems;
  const std::optional<Model> model =
      load_model(std::string(SOFTGRIP_SOURCE_DIR) + "/config/models/" + name + ".yaml", problems);
  if (!model) throw std::runtime_error(problems.format());
  return *model;
}

/// Returns the value of one parameter of a model. The path selects the parameter. Returns 0 if the model does
/// not have this parameter.
inline double number(const Model& model, std::string_view path) {
  const auto index = find_path(model, path);
  return index ? flat_values(model)[*index] : 0.0;
}

}  // namespace softgrip::model::testing
