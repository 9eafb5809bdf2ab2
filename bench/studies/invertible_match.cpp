#include "bench/studies/invertible_match.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/parallel.h"
#include "base/random.h"
#include "sysid/fitting/minimise.h"
#include "sysid/fitting/residuals.h"
#include "sysid/logs/record.h"

namespace softgrip::studies {
namespace {

/// Weight of the constraint on beta [kPa]: the additional residual [mm] is this weight times the excess of
/// beta over its bound [mm/kPa].
constexpr double weight_kpa = 1e5;
/// Ratio of the largest to the smallest random start value of a parameter.
constexpr double spread = 3;

std::size_t index_of(const model::Model& model, const char* path) {
  return model::find_path(model, path).value();
}

/// Residuals of a model, with one additional residual for the constraint beta <= most_ratio (alpha + 1/k0).
/// The additional residual is 0 while the constraint is met.
class WithBoundOnRatio final : public sysid::Residuals {
 public:
  WithBoundOnRatio(const std::vector<sysid::Record>& records, const sysid::FitSpace& space,
                   const model::Model& model, double most_ratio)
      : Residuals(records, space),
        inner_(sysid::residuals_for(records, space)),
        alpha_(column_of(model, "bouc_wen.alpha_mm_per_kpa")),
        beta_(column_of(model, "bouc_wen.beta_mm_per_kpa")),
        stiff_mm_per_kpa_(1 / model::flat_values(model)[index_of(model, "kelvin_voigt.k0_kpa_per_mm")]),
        most_ratio_(most_ratio) {
    count_ = inner_->count() + 1;
  }

  bool evaluate(std::span<const double> z, std::span<double> r, std::span<double> jacobian) const override {
    const std::size_t rows = inner_->count();
    const std::size_t columns = space_.size();
    if (!inner_->evaluate(z, r.empty() ? r : r.first(rows),
                          jacobian.empty() ? jacobian : jacobian.first(rows * columns))) {
      return false;
    }
    const auto& free = space_.free();
    const double alpha = free[alpha_].to_value(z[alpha_]);
    const double beta = free[beta_].to_value(z[beta_]);
    const double excess = beta - most_ratio_ * (alpha + stiff_mm_per_kpa_);
    if (!r.empty()) r[rows] = weight_kpa * std::max(0.0, excess);
    if (!jacobian.empty()) {
      const std::span<double> line = jacobian.subspan(rows * columns, columns);
      std::fill(line.begin(), line.end(), 0.0);
      if (excess > 0) {
        line[alpha_] = -weight_kpa * most_ratio_ * free[alpha_].slope(z[alpha_]);
        line[beta_] = weight_kpa * free[beta_].slope(z[beta_]);
      }
    }
    return true;
  }

 private:
  [[nodiscard]] std::size_t column_of(const model::Model& model, const char* path) const {
    const std::size_t flat = index_of(model, path);
    const auto& free = space_.free();
    return static_cast<std::size_t>(
        std::find_if(free.begin(), free.end(), [&](const auto& p) { return p.flat_index == flat; }) -
        free.begin());
  }

  std::unique_ptr<Residuals> inner_;
  std::size_t alpha_;
  std::size_t beta_;
  double stiff_mm_per_kpa_;
  double most_ratio_;
};

}  // namespace

model::Model invertible_match(const std::vector<sysid::Log>& logs, const model::Model& start,
                              const MatchOptions& options) {
  sysid::RecordOptions record_options;
  record_options.start = sysid::Start::rest;
  const std::vector<sysid::Record> records = sysid::make_records(logs, record_options);
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < model::parameter_count(start); ++i) {
    if (model::parameter_spec(start, i).whole) continue;
    if (model::parameter_path(start, i) != "kelvin_voigt.k0_kpa_per_mm") free.push_back(i);
  }
  const sysid::FitSpace space(start, records, free);
  const WithBoundOnRatio residuals(records, space, start, options.most_ratio);

  std::vector<sysid::Minimum> minima(options.starts);
  parallel_for(options.starts, options.threads, [&](std::size_t i) {
    std::vector<double> values = model::flat_values(start);
    const std::uint64_t seed = derived_seed(options.seed, i);
    for (std::size_t k = 0; k < free.size() && i > 0; ++k) {
      values[free[k]] *= std::pow(spread, 2 * uniform_at(seed, k) - 1);
    }
    sysid::FitPoint point;
    point.model = model::with_values(start, values);
    point.starts = sysid::rest_starts(point.model, records);
    sysid::MinimiseOptions minimise_options;
    minimise_options.most_iterations = 200;
    minima[i] = sysid::minimise(residuals, space.z(point), minimise_options);
  });
  const auto best = std::min_element(minima.begin(), minima.end(),
                                     [](const auto& a, const auto& b) { return a.cost < b.cost; });
  return space.point(best->z).model;
}

}  // namespace softgrip::studies
