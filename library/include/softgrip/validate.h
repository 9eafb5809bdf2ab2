#pragma once
/// @file
/// Declares the prediction of logs to which a model was not fitted. The changelog announces every
/// incompatible change of this interface. New versions may add members to the result.

#include <stop_token>
#include <string>
#include <vector>

#include <softgrip/export.h>
#include <softgrip/identify.h>
#include <softgrip/log.h>
#include <softgrip/model.h>

namespace softgrip {

/// Result of validate().
struct Validation {
  std::string verdict;                  ///< assessment of the predictions in one sentence
  std::vector<std::string> warnings;    ///< warnings about the logs
  std::vector<Prediction> predictions;  ///< one prediction per log
  std::string json;                     ///< content of validate.json that `softgrip validate` writes
  std::string html;                     ///< content of report.html that `softgrip validate` writes
};

/// Predicts logs with a model, as `softgrip validate` does. Throws InvalidArgument if an argument is invalid.
/// @param model  the model
/// @param logs   at least one log, in the unit of the model
/// @param use    how the logs are used: input, initial state, hold of the command
[[nodiscard]] SOFTGRIP_API Validation validate(const Model& model, const std::vector<Log>& logs,
                                               const LogUse& use = {});

/// Predicts logs with a model, as the other function with this name does. Throws Cancelled after a request
/// through `stop`.
/// @param model  the model
/// @param logs   at least one log, in the unit of the model
/// @param use    how the logs are used: input, initial state, hold of the command
/// @param stop   token through which the caller can end the computation early
[[nodiscard]] SOFTGRIP_API Validation validate(const Model& model, const std::vector<Log>& logs,
                                               const LogUse& use, const std::stop_token& stop);

}  // namespace softgrip
