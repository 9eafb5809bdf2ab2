#include "sysid/diagnosis/search/stick_slip_selection.h"

#include <algorithm>
#include <utility>

#include "model/named.h"
#include "sysid/diagnosis/causes/valve_deadband.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/residual/spectrum_peaks.h"
#include "sysid/diagnosis/search/scored.h"
#include "sysid/diagnosis/search/stick_slip.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Returns the cause "dead band" with only one form, the smooth form. The smooth form is the mean of all
/// possible stick-slip motions.
Cause dragged_along(Cause dead_band) {
  constexpr std::size_t play = model::block_type<model::ValveDeadband>();
  const auto form = std::find_if(dead_band.forms.begin(), dead_band.forms.end(),
                                 [](const CauseForm& one) { return one.type == play; });
  dead_band.forms = {form, 1};
  return dead_band;
}

/// Returns the structure with the dead band in its smooth form. If the structure has no dead band, the block
/// is added and the structure is refitted. The refit is necessary because a model without a dead band has
/// absorbed the mean lag of the valve.
std::optional<StructureFit> with_mean_of_stick_slip(const SearchData& data, const StructureFit& selected,
                                                    const Cause& dead_band) {
  if (position_of(selected.point.model, dead_band)) return selected;
  std::vector<Candidate> fits = fit_candidates(data, selected, {.only = {dragged_along(dead_band)}});
  return fits.empty() ? std::nullopt : std::move(fits.front().fit);
}

/// Adds one cause to a structure that contains the mean stick-slip motion. It is the cause that leaves the
/// smallest error. Such a second effect may have been missed before, because a single cause had to represent
/// both effects.
std::optional<StructureFit> with_second_effect(const SearchData& data, const StructureFit& beside) {
  std::optional<StructureFit> best;
  for (Candidate& candidate : fit_candidates(data, beside)) {
    if (!candidate.fit || is_free_form({candidate, {}})) continue;
    if (!best || candidate.fit->mean_square_mm2 < best->mean_square_mm2) best = std::move(candidate.fit);
  }
  return best;
}

/// Removes a cause that only replaced the stick-slip motion. This is done only if the selection has at least
/// two causes. A cause is removed if the error is not larger after a fit without the cause.
StickSlip without_stand_in(const SearchData& data, StickSlip found, double noise_mm) {
  if (found.fit.causes.size() < 2) return found;
  const std::vector<Cause> causes = found.fit.causes;
  for (const Cause& cause : causes) {
    auto rest = stick_slip_without(data.records, found, cause, noise_mm, data.threads);
    if (rest && rest->fit.mean_square_mm2 <= found.fit.mean_square_mm2) return std::move(*rest);
  }
  return found;
}

/// Searches for stick-slip motions with several structures of the finger. Keeps the result with the smallest
/// remaining error.
class BestStickSlip {
 public:
  BestStickSlip(const SearchData& data, const Cause& dead_band, double noise_mm)
      : data_(data), dead_band_(dead_band), noise_mm_(noise_mm) {}

  /// Searches for a stick-slip motion with the structure `beside`. Keeps the result if its remaining error is
  /// the smallest so far.
  /// @param beside  structure that contains the dead band in its smooth form.
  void look(const std::optional<StructureFit>& beside) {
    if (!beside) return;
    auto found = find_stick_slip(data_.records, without_cause(*beside, dead_band_), noise_mm_, data_.threads);
    if (found) found = without_stand_in(data_, std::move(*found), noise_mm_);
    if (!found || (best_ && found->fit.mean_square_mm2 > best_->fit.mean_square_mm2)) return;
    best_ = std::move(found);
  }
  /// Returns true if the remaining error is small. Then at most a few jumps of the valve can be wrong.
  [[nodiscard]] bool meets_all() const {
    return best_ && unexplained_error_of(best_->fit.residual_mm, noise_mm_).excess_mm <
                        limits::tolerated_noise * noise_mm_;
  }
  [[nodiscard]] const std::optional<StickSlip>& best() const { return best_; }

 private:
  const SearchData& data_;
  const Cause& dead_band_;
  double noise_mm_;
  std::optional<StickSlip> best_;
};

/// Searches for a stick-slip motion with the base structure, and with the structure that contains all
/// selected causes. Returns the motion with the smaller remaining error. A selected cause may be a second
/// effect, or it may only replace the stick-slip motion. If neither structure leads to a stick-slip motion, a
/// base structure with a second effect is tried.
std::optional<StickSlip> stick_slip_before(const SearchData& data, const Selection& plain,
                                           const Cause& dead_band, double noise_mm) {
  BestStickSlip stick_slip(data, dead_band, noise_mm);
  const auto beside_base = with_mean_of_stick_slip(data, plain.base, dead_band);
  stick_slip.look(beside_base);
  if (!stick_slip.meets_all() && !plain.chosen.empty())
    stick_slip.look(with_mean_of_stick_slip(data, plain.extended, dead_band));
  if (!stick_slip.best() && beside_base) stick_slip.look(with_second_effect(data, *beside_base));
  return stick_slip.best();
}

/// Returns the fit of the base structure, without any cause, to records whose drive is the valve position.
StructureFit base_behind(const StickSlip& found) {
  StructureFit base = found.fit;
  for (const Cause& cause : found.fit.causes) base = without_cause(base, cause);
  return found.fit.causes.empty() ? base : fit_structure(found.records, {}, base.point);
}

/// Returns a copy of the point whose model contains the valve block in addition.
template <template <class> class Valve>
FitPoint with_valve(const FitPoint& behind, double band_kpa) {
  FitPoint point = behind;
  point.model = model::with_block(point.model, model::block_of<Valve>({{"band_kpa", band_kpa}}));
  return point;
}

/// Adds the dead band to the model for a simulation from the command alone. The jumping form is used if it
/// leads to the smaller held-out error, that is, if the simulated jumps stay synchronous with the readings.
/// Otherwise the smooth form is used.
void extend(Selection& selection, const SearchData& data, const StructureFit& behind, const Cause& dead_band,
            double band_kpa, const Division& division) {
  std::vector<Cause> causes{dead_band};
  causes.insert(causes.end(), behind.causes.begin(), behind.causes.end());
  StructureFit stick_slip =
      evaluate_structure(data.records, causes, with_valve<model::ValveStiction>(behind.point, band_kpa));
  StructureFit mean =
      fit_structure(data.records, causes, with_valve<model::ValveDeadband>(behind.point, band_kpa));
  stick_slip.free_parameters = mean.free_parameters;
  BlockLosses stick_slip_losses = held_out_losses(data.records, division, stick_slip);
  BlockLosses mean_losses = held_out_losses(data.records, division, mean);
  const bool in_step = rmse_mm(stick_slip_losses) < rmse_mm(mean_losses);
  selection.extended = in_step ? std::move(stick_slip) : std::move(mean);
  selection.extended_losses = in_step ? std::move(stick_slip_losses) : std::move(mean_losses);
}

}  // namespace

std::optional<StickSlipSelection> select_behind_stick_slip(const SearchData& data, const Selection& plain,
                                                           double noise_mm, const Division& division,
                                                           const SelectionOptions& options) {
  const Cause dead_band = *find_cause(causes::ValveDeadband::id);
  if (position_of(data.given.model, dead_band)) return std::nullopt;
  const auto found = stick_slip_before(data, plain, dead_band, noise_mm);
  if (!found) return std::nullopt;

  SearchData driven = make_search_data(found->records, data.given.model);
  driven.threads = data.threads;
  StructureFit base = base_behind(*found);
  driven.scales.residual_lines = spectrum_peaks(driven.records, base.residual_mm);
  // A few wrong jumps of the valve leave an error. If the remaining error is small, no second cause is
  // searched, because a second cause would only represent the wrong jumps.
  SelectionOptions behind = options;
  if (!leaves_too_much(unexplained_error_of(base.residual_mm, noise_mm), plain.base_unexplained, noise_mm))
    behind.most_causes = 0;
  Selection beyond = select_causes(driven, std::move(base), noise_mm, division, behind);

  StickSlipSelection result;
  result.evidence = {found->band_kpa,
                     found->band_ci95,
                     found->jumps,
                     found->scatter,
                     rmse_mm(beyond.extended_losses),
                     gain_percent(plain.base_losses, beyond.extended_losses, options.seed)};
  result.selection = plain;
  result.selection.chosen = {{dead_band,
                              {},
                              gain_percent(plain.base_losses, beyond.base_losses, options.seed),
                              {},
                              mean_difference(plain.base_losses, beyond.base_losses, options.seed),
                              winning_share(beyond.base_losses, plain.base_losses, options.seed)}};
  for (ChosenCause& more : beyond.chosen) result.selection.chosen.push_back(std::move(more));
  result.selection.left = beyond.left;
  extend(result.selection, data, beyond.extended, dead_band, found->band_kpa, division);
  return result;
}

}  // namespace softgrip::sysid
