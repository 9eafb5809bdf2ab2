#pragma once
// Repeats section 4 of the paper with simulated logs: the model is identified on TP1, and predicts TP2, SP1
// and SP2.

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

/// One of the four RMSE values of the paper, and the corresponding values of two simulated fingers. For each
/// finger, the published structure was identified on tp1 alone.
struct PaperRow {
  model::SignalName signal = model::SignalName::tp1;
  double paper_mm = 0;    ///< RMSE that the paper states for this signal [mm]
  PaperFigure published;  ///< error for a finger that follows the published model, so that the noise is the
                          ///< only source of error
  PaperFigure twin;       ///< error for bench_twin, which has a lag and a delay that the published structure
                          ///< lacks
};

struct PaperTableOptions {
  std::uint64_t seed = 1;  ///< seed of the noise and of the start points
  double rate_hz = 100;
  double noise_mm = 0.05;
  std::size_t starts = 12;
  unsigned threads = 0;
};

/// Returns four rows: tp1, tp2, sp1 and sp2. Returns an empty list if an identification fails.
[[nodiscard]] std::vector<PaperRow> paper_table(const PaperTableOptions& options);

/// Returns sentences that explain why the computed values differ from the values of the paper.
[[nodiscard]] const std::vector<std::string>& paper_table_remarks();

}  // namespace softgrip::studies
