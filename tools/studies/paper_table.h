#pragma once
// The paper's section 4 on simulated logs: identified on TP1, predicted on TP2, SP1 and SP2.

#include <cstdint>
#include <string>
#include <vector>

#include "model/model.h"
#include "model/signals.h"

namespace softgrip::tools {

/// A finger's figure for one signal.
struct PaperFigure {
  double rmse_mm = 0;
  double rmse_percent_of_span = 0;
};

/// One of the paper's four figures, beside those of two simulated fingers, both identified with the published
/// structure on tp1 alone.
struct PaperRow {
  model::SignalName signal = model::SignalName::tp1;
  double paper_mm = 0;    ///< as printed
  PaperFigure published;  ///< the finger is the published model: nothing is left but the noise
  PaperFigure twin;       ///< the finger is bench_twin: the structure has neither its lag nor its dead time
};

struct PaperTableOptions {
  std::uint64_t seed = 1;  ///< of noise and starts
  double rate_hz = 100;
  double noise_mm = 0.05;
  std::size_t starts = 12;
  unsigned threads = 0;
};

/// Four rows: tp1, tp2, sp1, sp2. Empty if an identification fails.
[[nodiscard]] std::vector<PaperRow> paper_table(const PaperTableOptions& options);

/// Why the figures differ from the paper's, in sentences.
[[nodiscard]] const std::vector<std::string>& paper_table_remarks();

}  // namespace softgrip::tools
