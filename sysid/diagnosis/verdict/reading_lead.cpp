#include "sysid/diagnosis/verdict/reading_lead.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/statistics.h"
#include "sysid/diagnosis/causes/clock_offset.h"
#include "sysid/diagnosis/verdict/another_base.h"
#include "sysid/identification/uncertainty.h"

namespace softgrip::sysid {
namespace {

/// Further trial values of the lead, as multiples of the lead in the fitted block. They are needed because
/// the block is inaccurate at corners of the motion, so its lead may be wrong.
constexpr std::array other_leads{0.5, 1.5, 2.0, 3.0};
/// First trial value of a lead without a fitted block, in units of time_unit_s().
constexpr double first_lead_in_units = 0.1;
/// Largest trial value of a lead, as a share of the longest record.
constexpr double longest_lead_share = 0.1;
constexpr int refinements = 5;

class LeadSearch {
 public:
  LeadSearch(const SearchData& data, const Selection& selection) : data_(data), selection_(selection) {}

  [[nodiscard]] LeadFit at(double lead_s) const {
    LeadFit shifted{{lead_s, {}}, {}, with_drive_ahead(data_.records, lead_s)};
    shifted.fit = fit_structure(shifted.records, {}, selection_.base.point);
    StructureFit from_given = fit_structure(shifted.records, {}, data_.given);
    if (from_given.mean_square_mm2 < shifted.fit.mean_square_mm2) shifted.fit = std::move(from_given);
    return shifted;
  }

  /// Returns the best lead on a grid of trial values, refined by search steps of decreasing size. If the
  /// largest trial value is the best one, larger values are tried.
  [[nodiscard]] LeadFit best(double about_s) const {
    LeadFit best = at(about_s);
    const auto try_at = [&](double lead_s) {
      LeadFit other = at(lead_s);
      if (other.fit.mean_square_mm2 < best.fit.mean_square_mm2) best = std::move(other);
    };
    for (const double ratio : other_leads) try_at(ratio * about_s);
    const double longest_s = longest_lead_share * campaign_size(data_.records).longest_s;
    double largest_s = other_leads.back() * about_s;
    while (best.lead.lead_s == largest_s && 1.5 * largest_s <= longest_s) try_at(largest_s *= 1.5);
    double step_s = std::max(0.25 * about_s, 0.25 * best.lead.lead_s);
    for (int k = 0; k < refinements; ++k, step_s /= 2) {
      const double middle_s = best.lead.lead_s;
      try_at(middle_s - step_s);
      try_at(middle_s + step_s);
    }
    best.lead.ci95 = interval(best, step_s);
    return best;
  }

 private:
  /// Returns the 95 % interval of the lead, computed from the parabola through the mean squares at three
  /// values of the lead. Correlated residuals count as their effective number of samples.
  [[nodiscard]] Interval interval(const LeadFit& best, double step_s) const {
    const double lead_s = best.lead.lead_s, least_mm2 = best.fit.mean_square_mm2;
    const double beside_mm2 =
        0.5 * (at(lead_s - step_s).fit.mean_square_mm2 + at(lead_s + step_s).fit.mean_square_mm2);
    const std::vector<std::span<const double>> residuals(best.fit.residual_mm.begin(),
                                                         best.fit.residual_mm.end());
    const double samples = fit_noise(autocovariance_of(residuals)).effective_samples;
    const double rise_mm2 = beside_mm2 - least_mm2;
    const double deviation_s = rise_mm2 > 0 ? step_s * std::sqrt(least_mm2 / (samples * rise_mm2)) : lead_s;
    const std::size_t parameters =
        1 + structure_space(best.records, best.fit.point.model, best.fit.causes).size();
    const double half_s = t_quantile(samples - static_cast<double>(parameters)) * deviation_s;
    return {lead_s - half_s, lead_s + half_s};
  }

  const SearchData& data_;
  const Selection& selection_;
};

/// Returns true if too much error remains and the block of the cause reduces the held-out error
/// significantly.
bool is_possible(const Cause& clock_offset, const Selection& selection, double noise_mm) {
  if (selection.chosen.empty() || !leaves_too_much(selection.left, selection.base_unexplained, noise_mm))
    return false;
  return std::ranges::any_of(selection.chosen, [&](const ChosenCause& chosen) {
    return std::ranges::any_of(chosen.candidates, [&](const CandidateScore& score) {
      return score.cause == clock_offset && score.gain_percent.lower > 0;
    });
  });
}

}  // namespace

std::vector<Record> with_drive_ahead(std::vector<Record> records, double lead_s) {
  for (Record& record : records) {
    const std::vector<double> drive_kpa = record.drive_kpa;
    const std::vector<double>& time_s = record.time_s;
    std::size_t next = 0;
    if (record.size() > 1) {
      record.duration_s[1] = step_duration_s(record.duration_s[1] + lead_s);
      hide_reading(record, 0);
    }
    for (std::size_t i = 1; i < record.size(); ++i) {
      const double at_s = time_s[i] + lead_s;
      while (next < time_s.size() && time_s[next] <= at_s) ++next;
      if (next == time_s.size()) {
        record.drive_kpa[i] = drive_kpa.back();
        if (at_s > time_s.back()) hide_reading(record, i);
        continue;
      }
      const double part = record.held ? 0 : (at_s - time_s[next - 1]) / (time_s[next] - time_s[next - 1]);
      record.drive_kpa[i] = std::lerp(drive_kpa[next - 1], drive_kpa[next], part);
    }
  }
  return records;
}

std::optional<LeadFit> fit_lead(const SearchData& data, const Selection& selection, double noise_mm) {
  const Cause clock_offset = *find_cause(causes::ClockOffset::id);
  const auto position = position_of(selection.extended.point.model, clock_offset);
  if (!position && !is_possible(clock_offset, selection, noise_mm)) return std::nullopt;
  const double about_s = position ? selection.extended.point.model.blocks[*position].values.front()
                                  : first_lead_in_units * data.scales.time_unit_s;
  if (about_s <= 0) return std::nullopt;
  LeadFit shifted = LeadSearch(data, selection).best(about_s);
  const UnexplainedError left = unexplained_error_of(shifted.fit.residual_mm, noise_mm, data.scales.step_mm);
  const double may_be_left = position ? 1 : left_by_what_was_missing;
  if (shifted.lead.ci95.lower <= 0 || square(left.excess_mm) > may_be_left * square(selection.left.excess_mm))
    return std::nullopt;
  return shifted;
}

}  // namespace softgrip::sysid
