#pragma once
// Repeats section 4 of Zhang et al. 2025 with simulated logs: a model is identified on the signal TP1, and
// predicts TP2, SP1 and SP2.

#include <cstdint>
#include <string>
#include <vector>

#include "model/model.h"
#include "model/signals.h"

namespace softgrip::studies {

/// The error of the identified model for one finger and one test signal.
struct PaperFigure {
  double rmse_mm = 0;
  double rmse_percent_of_span = 0;
};

/// One of the four RMSE values of the paper, with the corresponding values of two simulated fingers. For each
/// simulated finger, a model with the published structure was identified from tp1 alone.
struct PaperRow {
  model::SignalName signal = model::SignalName::tp1;
  double paper_mm = 0;    ///< RMSE that the paper states for this signal [mm]
  PaperFigure published;  ///< error for a finger that follows the published model, so that noise is the only
                          ///< cause of the error
  PaperFigure twin;       ///< error for bench_twin, whose lag and delay are missing in the published
                          ///< structure
};

struct PaperTableOptions {
  std::uint64_t seed = 1;  ///< seed of the noise and of the start points
  double rate_hz = 100;
  double noise_mm = 0.05;
  std::size_t starts = 12;
  unsigned threads = 0;
};

/// Returns four rows, one for each of the signals tp1, tp2, sp1 and sp2. Returns an empty list if an
/// identification fails.
[[nodiscard]] std::vector<PaperRow> paper_table(const PaperTableOptions& options);

/// Returns sentences that explain why the computed values differ from the values of the paper.
[[nodiscard]] const std::vector<std::string>& paper_table_remarks();

}  // namespace softgrip::studies
