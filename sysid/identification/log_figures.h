#pragma once
// The pictures of a log and its prediction, alike in every report.

#include <vector>

#include "sysid/fitting/score.h"
#include "sysid/logs/record.h"
#include "sysid/pages/chart.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Measured and predicted displacement over time, and below it the error.
[[nodiscard]] std::vector<Chart> overlay(const Record& record, const Score& score);
/// Displacement over pressure, measured and predicted.
[[nodiscard]] Chart loops(const Record& record, const Score& score);
/// The error over pressure, loading and unloading apart.
[[nodiscard]] Chart error_by_pressure(const Record& record, const Score& score);

/// Adds the figures of one log to a page.
void add_log_figures(Page& page, const Record& record, const Score& score);

/// One row per log: the signal that drives the model, samples, RMSE, % of span, first and settled cycles,
/// largest error.
[[nodiscard]] Table score_table(const std::vector<Record>& records, const std::vector<Score>& scores);

/// A number for people, or a dash.
[[nodiscard]] std::string or_dash(double value, int digits = 3);

}  // namespace softgrip::sysid
