#pragma once
// Figures of a log and its prediction, equal in all reports.

#include <vector>

#include "sysid/fitting/score.h"
#include "sysid/logs/record.h"
#include "sysid/pages/chart.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Returns measured and predicted displacement over time, and the error below.
[[nodiscard]] std::vector<Chart> overlay(const Record& record, const Score& score);
/// Returns measured and predicted displacement over pressure.
[[nodiscard]] Chart loops(const Record& record, const Score& score);
/// Returns the error over pressure, separately for loading and unloading.
[[nodiscard]] Chart error_by_pressure(const Record& record, const Score& score);

/// Adds the figures of one log to a page.
void add_log_figures(Page& page, const Record& record, const Score& score);

/// Returns one row per log: signal that drives the model, samples, RMSE, % of span, first and settled cycles,
/// largest error.
[[nodiscard]] Table score_table(const std::vector<Record>& records, const std::vector<Score>& scores);

/// Returns a formatted number, or a dash if it is not finite.
[[nodiscard]] std::string or_dash(double value, int digits = 3);

}  // namespace softgrip::sysid
