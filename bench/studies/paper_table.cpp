#include "bench/studies/paper_table.h"

#include <array>
#include <utility>

#include "base/random.h"
#include "bench/studies/models.h"
#include "sysid/identification/identify.h"
#include "sysid/identification/validate.h"
#include "sysid/logs/simulated_log.h"

namespace softgrip::studies {
namespace {

using model::SignalName;

constexpr std::array<std::pair<SignalName, double>, 4> printed{
    {{SignalName::tp1, 0.194}, {SignalName::tp2, 0.256}, {SignalName::sp1, 0.540}, {SignalName::sp2, 0.392}}};

/// Returns the error of the identified model for each test signal. Returns an empty list if the
/// identification fails.
std::vector<PaperFigure> figures_of(const model::Model& finger, const PaperTableOptions& options) {
  std::vector<sysid::Log> logs;
  for (std::size_t i = 0; i < printed.size(); ++i) {
    sysid::Log log = sysid::sampled_signal(printed[i].first, options.rate_hz);
    log.name = model::name_of(printed[i].first);
    simulate(finger, {options.noise_mm, derived_seed(options.seed, i)}, log);
    logs.push_back(std::move(log));
  }
  sysid::IdentifyOptions fit;
  fit.starts = options.starts;
  fit.seed = options.seed;
  fit.threads = options.threads;
  const auto identified = sysid::identify({logs.front()}, sysid::base_model({logs.front()}, 2), fit);
  if (!identified) return {};
  std::vector<PaperFigure> figures;
  for (const sysid::Score& score : sysid::validate_logs(identified->fitted, logs).scores) {
    figures.push_back({score.rmse_mm, score.rmse_percent_of_span});
  }
  return figures;
}

}  // namespace

std::vector<PaperRow> paper_table(const PaperTableOptions& options) {
  const std::vector<PaperFigure> published = figures_of(published_model(2), options);
  const std::vector<PaperFigure> twin = figures_of(bench_twin(), options);
  if (published.empty() || twin.empty()) return {};
  std::vector<PaperRow> rows;
  for (std::size_t i = 0; i < printed.size(); ++i) {
    rows.push_back({printed[i].first, printed[i].second, published[i], twin[i]});
  }
  return rows;
}

const std::vector<std::string>& paper_table_remarks() {
  static const std::vector<std::string> remarks{
      "The paper gives its pressures, rates, spans and data only in figures, so this study uses other "
      "signals of similar shape. The patterns of the columns can be compared, but not the exact values.",
      "For a finger that follows the published model, only the noise remains, even on signals that were not "
      "fitted. The real finger of the paper had an error several times larger. On signals that were not "
      "fitted, the error of the real finger was up to 2.8 times as large as on TP1. The real finger has an "
      "effect that the published structure lacks.",
      "An ordinary actuator behind lag and dead time shows the pattern of the paper's "
      "values at a fraction of their size. The hidden latency explains the published parameters and the "
      "shape of the "
      "residual, but not the size of the residual. The paper does not name a further effect."};
  return remarks;
}

}  // namespace softgrip::studies
