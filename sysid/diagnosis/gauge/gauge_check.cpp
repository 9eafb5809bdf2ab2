#include "sysid/diagnosis/gauge/gauge_check.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <span>

#include "base/statistics.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/causes/sensor_nonlinearity.h"
#include "sysid/diagnosis/causes/sensor_saturation.h"
#include "sysid/fitting/minimise.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Distance between a clipping limit and the nearest extreme reading of the logs. It is the larger one of two
/// values: `beyond_share` times the range of the readings, and `beyond_noise` standard deviations of the
/// noise. With this distance, the check can distinguish a saturated sensor from a sensor without saturation.
constexpr double beyond_share = 0.05;
constexpr double beyond_noise = 10;

using Line = std::pair<double, double>;  // a straight line, stated as its value at 0 and its slope

Line line_through(const std::vector<GaugeReading>& readings, const std::vector<double>& values,
                  const std::function<bool(std::size_t)>& use) {
  PairSums sums;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (use(i)) sums.add(readings[i].position_mm, values[i]);
  }
  if (sums.count < 2 || sums.variance_x() <= 1e-12 * sums.count * sums.xx)
    return {sums.count > 0 ? sums.y / sums.count : 0, 0};
  return {(sums.y - sums.slope() * sums.x) / sums.count, sums.slope()};
}

class Checker {
 public:
  Checker(const std::vector<GaugeReading>& readings, const GaugeScales& scales)
      : readings_(readings), scales_(scales) {
    find_noise();
    const double margin =
        std::max(beyond_share * (scales.highest_mm - scales.lowest_mm), beyond_noise * result_.noise_mm);
    result_.lower_mm = scales.lowest_mm - margin;
    result_.upper_mm = scales.highest_mm + margin;
    for (const GaugeReading& r : readings) result_.cut_mm.push_back(cut(r.reading_mm));
  }

  GaugeCheck run(const std::vector<SensorShape>& hypotheses) {
    for (const SensorShape& shape : hypotheses) result_.fits.push_back(fitted(shape));
    const double offset_mm = hypotheses.front().offset_mm;
    result_.straight = fitted({{}, offset_mm});
    result_.free_bend = freely_bent(offset_mm);
    result_.free_end = freely_ending(offset_mm);
    compare();
    return std::move(result_);
  }

 private:
  [[nodiscard]] double cut(double reading_mm) const {
    return std::clamp(reading_mm, result_.lower_mm, result_.upper_mm);
  }

  void find_noise() {
    std::map<double, std::vector<double>> at;
    const std::vector<double> positions = distinct_positions(readings_);
    double fewest_samples = std::numeric_limits<double>::infinity();
    for (const GaugeReading& r : readings_) {
      const auto nearest = std::min_element(positions.begin(), positions.end(), [&](double a, double b) {
        return std::abs(a - r.position_mm) < std::abs(b - r.position_mm);
      });
      at[*nearest].push_back(r.reading_mm);
      fewest_samples = std::min(fewest_samples, r.samples);
    }
    double sum = 0, freedom = 0;
    for (const auto& [position, values] : at) {
      double mean = 0;
      for (const double v : values) mean += v / static_cast<double>(values.size());
      for (const double v : values) sum += square(v - mean);
      freedom += static_cast<double>(values.size() - 1);
    }
    if (freedom > 0) result_.repeat_noise_mm = std::sqrt(sum / freedom);
    result_.noise_mm =
        std::max({result_.repeat_noise_mm, scales_.noise_mm / std::sqrt(fewest_samples), 1e-9});
  }

  [[nodiscard]] std::vector<double> predicted(const SensorShape& shape, double zero, double scale) const {
    std::vector<double> values;
    values.reserve(readings_.size());
    for (const GaugeReading& r : readings_) values.push_back(cut(shape.at(zero + scale * r.position_mm)));
    return values;
  }

  /// Returns start values of zero and scale as four straight lines. The first line is fitted to all readings,
  /// and the second to the readings that are not clipped. The third line is fitted to the lower half of these
  /// readings, because a saturation does not affect them. The fourth line is the identity (zero 0, scale 1).
  [[nodiscard]] std::vector<Line> starts(double offset_mm) const {
    const double middle = (scales_.lowest_mm + scales_.highest_mm) / 2;
    const auto all = [](std::size_t) { return true; };
    const auto inside = [&](std::size_t i) {
      return result_.cut_mm[i] > result_.lower_mm && result_.cut_mm[i] < result_.upper_mm;
    };
    const auto lower = [&](std::size_t i) { return inside(i) && result_.cut_mm[i] < middle; };
    std::vector<Line> lines{line_through(readings_, result_.cut_mm, all),
                            line_through(readings_, result_.cut_mm, inside),
                            line_through(readings_, result_.cut_mm, lower),
                            {offset_mm, 1}};
    for (Line& line : lines) line.first -= offset_mm;
    return lines;
  }

  using Numbers = std::span<const double>;
  using Bent = causes::SensorNonlinearity;
  using Ending = causes::SensorSaturation;

  /// Fits zero and scale together with the parameters of a sensor shape.
  /// @param shape_of  function that converts these parameters to a sensor shape.
  /// @param own  start values of these parameters.
  [[nodiscard]] GaugeFit fitted_with(const std::function<SensorShape(Numbers own)>& shape_of,
                                     const std::vector<std::vector<double>>& own, double offset_mm) const {
    const auto residuals = [&](Numbers p, std::span<double> r) {
      const std::vector<double> values = predicted(shape_of(p.subspan(2)), p[0], p[1]);
      for (std::size_t i = 0; i < r.size(); ++i) r[i] = values[i] - result_.cut_mm[i];
    };
    PlainMinimum best{{}, std::numeric_limits<double>::infinity()};
    for (const Line& line : starts(offset_mm)) {
      for (const std::vector<double>& more : own) {
        std::vector<double> p{line.first, line.second};
        p.insert(p.end(), more.begin(), more.end());
        PlainMinimum found = minimise_plain(residuals, readings_.size(), std::move(p));
        if (found.sum_of_squares < best.sum_of_squares) best = std::move(found);
      }
    }
    GaugeFit result;
    result.shape = shape_of(Numbers(best.p).subspan(2));
    result.zero_mm = best.p[0];
    result.scale = best.p[1];
    result.free = best.p.size();
    result.predicted_mm = predicted(result.shape, result.zero_mm, result.scale);
    result.rms_mm = std::sqrt(best.sum_of_squares / static_cast<double>(readings_.size()));
    return result;
  }

  [[nodiscard]] GaugeFit fitted(const SensorShape& shape) const {
    return fitted_with([&](Numbers) { return shape; }, {{}}, shape.offset_mm);
  }

  [[nodiscard]] GaugeFit freely_bent(double offset_mm) const {
    const std::size_t type = find_cause(Bent::id)->forms.front().type;
    const double range_mm = std::max(1e-3, scales_.highest_mm - std::min(0.0, scales_.lowest_mm));
    return fitted_with(
        [=](Numbers bend) {
          return SensorShape{{{type, Bent::bent(bend[0], bend[1], range_mm)}}, offset_mm};
        },
        {{0, 0}, {0.05 * range_mm, 0}, {-0.05 * range_mm, 0}}, offset_mm);
  }

  [[nodiscard]] GaugeFit freely_ending(double offset_mm) const {
    const std::size_t type = find_cause(Ending::id)->forms.front().type;
    std::vector<std::vector<double>> ends;
    const double highest = *std::max_element(result_.cut_mm.begin(), result_.cut_mm.end()) - offset_mm;
    const double span = scales_.highest_mm - scales_.lowest_mm;
    for (const double share : {0.0, 0.05, 0.15, 0.3, 0.5}) ends.push_back({highest - share * span});
    return fitted_with(
        [=](Numbers end) {
          return SensorShape{{{type, Ending::ending(end[0])}}, offset_mm};
        },
        ends, offset_mm);
  }

  /// Returns the RMS difference between the predictions of two hypotheses.
  [[nodiscard]] double apart_mm(const GaugeFit& one, const GaugeFit& other) const {
    double sum = 0;
    for (std::size_t i = 0; i < readings_.size(); ++i)
      sum += square(one.predicted_mm[i] - other.predicted_mm[i]);
    return std::sqrt(sum / static_cast<double>(readings_.size()));
  }

  [[nodiscard]] double chi_square(const GaugeFit& fit, double tolerance_mm) const {
    return static_cast<double>(readings_.size()) * square(fit.rms_mm) /
           (square(result_.noise_mm) + square(tolerance_mm));
  }

  [[nodiscard]] bool explains(const GaugeFit& fit, double tolerance_mm) const {
    const auto freedom = static_cast<double>(readings_.size()) - static_cast<double>(fit.free);
    return freedom < 1 ||
           chi_square(fit, tolerance_mm) <= chi_square_quantile(limits::strict_deviate, freedom);
  }

  /// Compares every hypothesis with the most likely one. A share of the difference between their predictions
  /// is tolerated in addition to the noise.
  void compare() {
    std::vector<GaugeFit>& fits = result_.fits;
    const auto likelier = [](const GaugeFit& a, const GaugeFit& b) { return a.rms_mm < b.rms_mm; };
    result_.best =
        static_cast<std::size_t>(std::min_element(fits.begin(), fits.end(), likelier) - fits.begin());
    GaugeFit& best = fits[result_.best];
    double next = std::numeric_limits<double>::infinity();
    std::size_t out = 0;
    best.tolerance_mm = limits::hidden_by_noise * scales_.noise_mm;
    for (std::size_t i = 0; i < fits.size(); ++i) {
      if (i == result_.best) continue;
      GaugeFit& fit = fits[i];
      fit.tolerance_mm = limits::least_explained_share * apart_mm(fit, best);
      fit.behind = (chi_square(fit, fit.tolerance_mm) - chi_square(best, fit.tolerance_mm)) / 2;
      fit.explains = explains(fit, fit.tolerance_mm);
      fit.ruled_out = fit.behind >= gauge_log_likelihood_needed && explains(best, fit.tolerance_mm);
      next = std::min(next, fit.behind);
      if (fit.ruled_out)
        ++out;
      else
        best.tolerance_mm = std::max(best.tolerance_mm, fit.tolerance_mm);
    }
    const bool alone = fits.size() > 1 && out + 1 == fits.size();
    best.explains = alone || explains(best, best.tolerance_mm);
    result_.log_likelihood_ratio = fits.size() > 1 ? next : 0;
    result_.outcome = !best.explains                ? GaugeOutcome::unexplained
                      : out > 0 || fits.size() == 1 ? GaugeOutcome::decided
                                                    : GaugeOutcome::undecided;
    judge_coverage();
  }

  void judge_coverage() {
    // The covered range is computed from the fitted straight line and not from the readings. If the sensor
    // does not move, the noise of the readings would otherwise count as coverage.
    const auto [least, most] =
        std::minmax_element(result_.straight.predicted_mm.begin(), result_.straight.predicted_mm.end());
    result_.covered_share = (*most - *least) / std::max(1e-9, scales_.highest_mm - scales_.lowest_mm);
    if (result_.covered_share >= limits::majority_share) return;
    for (GaugeFit& fit : result_.fits) fit.ruled_out = false;
    result_.outcome = GaugeOutcome::uncovered;
  }

  const std::vector<GaugeReading>& readings_;
  const GaugeScales& scales_;
  GaugeCheck result_;
};

}  // namespace

std::vector<model::BlockSpec> static_sensor_blocks(const model::Model& model) {
  std::vector<model::BlockSpec> blocks;
  for (const model::BlockSpec& block : model.blocks) {
    const Cause* const cause = cause_of(block.type);
    if (cause != nullptr && cause->is_static_sensor()) blocks.push_back(block);
  }
  return blocks;
}

double SensorShape::at(double displacement_mm) const {
  double y = displacement_mm;
  for (const model::BlockSpec& block : blocks) y = form_of(*cause_of(block.type), block).shown_mm(block, y);
  return y + offset_mm;
}

std::string SensorShape::id() const {
  std::string text;
  for (const model::BlockSpec& block : blocks)
    text += (text.empty() ? "" : "+") + std::string(cause_of(block.type)->id);
  return text.empty() ? "straight" : text;
}

const char* name_of(GaugeOutcome outcome) {
  switch (outcome) {
    case GaugeOutcome::decided:
      return "decided";
    case GaugeOutcome::undecided:
      return "undecided";
    case GaugeOutcome::unexplained:
      return "unexplained";
    case GaugeOutcome::uncovered:
      return "uncovered";
  }
  return "unexplained";
}

GaugeCheck::Departure GaugeCheck::departure() const {
  const bool clips = free_end.rms_mm < free_bend.rms_mm;
  const GaugeFit& fit = clips ? free_end : free_bend;
  const auto n = static_cast<double>(cut_mm.size());
  Departure result;
  result.clips = clips;
  double sum = 0;
  for (std::size_t i = 0; i < cut_mm.size(); ++i) {
    const double apart = fit.predicted_mm[i] - straight.predicted_mm[i];
    sum += square(apart);
    result.largest_mm = std::max(result.largest_mm, std::abs(apart));
  }
  result.rms_mm = std::sqrt(sum / n);
  // The deviation from a straight line is compared with the noise only. The tolerance of compare() cannot be
  // used, because it requires a second hypothesis.
  const double gained = n * (square(straight.rms_mm) - square(fit.rms_mm)) / (2 * square(noise_mm));
  const auto more = static_cast<double>(fit.free - straight.free);
  result.clear = n > static_cast<double>(fit.free) && gained - more >= gauge_log_likelihood_needed;
  return result;
}

GaugeCheck check_gauge(const std::vector<GaugeReading>& readings, const std::vector<SensorShape>& hypotheses,
                       const GaugeScales& scales) {
  return Checker(readings, scales).run(hypotheses);
}

}  // namespace softgrip::sysid
