#pragma once
// Reports a log and its prediction: their fields, the table of the scores, and the figures. identify.json,
// validate.json and diagnosis.json use the same keys for these fields.

#include <optional>
#include <string>
#include <vector>

#include "base/result/result.h"
#include "sysid/fitting/score.h"
#include "sysid/logs/log.h"
#include "sysid/logs/record.h"
#include "sysid/pages/chart.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Returns two charts over time, one below the other: the measured and the predicted displacement, and the
/// error.
[[nodiscard]] std::vector<Chart> overlay(const Record& record, const Score& score);
/// Returns the chart of the measured and the predicted displacement over the pressure.
[[nodiscard]] Chart loops(const Record& record, const Score& score);
/// Returns the chart of the error over the pressure, with separate curves for loading and unloading.
[[nodiscard]] Chart error_by_pressure(const Record& record, const Score& score);

/// Adds the figures of one log to a page.
void add_log_figures(Page& page, const Record& record, const Score& score);

/// Returns the logs as an array for the JSON files, with one element per log.
[[nodiscard]] result::Value logs_value(const std::vector<Log>& logs);

/// Returns the keys drive, rmse_mm, rmse_percent_of_span and the keys of the other scores. The value of each
/// key is an object with one entry per log.
[[nodiscard]] result::Fields fields_of(const std::vector<Score>& scores);

/// Returns a table with one row per log. The columns are: name of the log, input of the model, number of
/// samples, span, RMSE, RMSE in % of the span, RMSE of the first cycle, RMSE after the first cycle, and the
/// largest error.
[[nodiscard]] result::Table score_table(const std::vector<Record>& records, const std::vector<Score>& scores);

/// Returns a number whose text has three significant digits. The text is an en dash if the number is absent
/// or not finite.
[[nodiscard]] result::Value or_dash(const std::optional<double>& value);

}  // namespace softgrip::sysid
