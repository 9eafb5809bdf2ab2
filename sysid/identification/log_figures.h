#pragma once
// Draws the figures of a log and its prediction, which are the same in all reports.

#include <vector>

#include "sysid/fitting/score.h"
#include "sysid/logs/record.h"
#include "sysid/pages/chart.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Returns two charts: measured and predicted displacement over time, and below them the error.
[[nodiscard]] std::vector<Chart> overlay(const Record& record, const Score& score);
/// Returns measured and predicted displacement over pressure.
[[nodiscard]] Chart loops(const Record& record, const Score& score);
/// Returns the error over pressure, separately for loading and unloading.
[[nodiscard]] Chart error_by_pressure(const Record& record, const Score& score);

/// Adds the figures of one log to a page.
void add_log_figures(Page& page, const Record& record, const Score& score);

/// Returns a table with one row per log. Its columns are the signal that drives the model, number of samples,
/// RMSE, RMSE in % of the span, RMSE of the first cycle and of the settled cycles, and the largest error.
[[nodiscard]] Table score_table(const std::vector<Record>& records, const std::vector<Score>& scores);

/// Returns a formatted number, or a dash if it is not finite.
[[nodiscard]] std::string or_dash(double value, int digits = 3);

}  // namespace softgrip::sysid
