#include "sysid/identification/identify.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "base/numbers.h"
#include "base/statistics.h"
#include "base/text.h"
#include "document/problem.h"
#include "model/blocks/bouc_wen.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/fitting/minimise.h"
#include "sysid/fitting/multistart.h"
#include "sysid/fitting/start_estimate.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/identification/combinations.h"
#include "sysid/identification/estimates.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/division.h"

namespace softgrip::sysid {
namespace {

using Failure = tl::unexpected<std::string>;

/// Indices of the fitted parameters in the list of all parameters of the model.
struct FreeIndices {
  std::vector<std::size_t> flat;
  /// True: the program keeps k0 fixed, because only the sum of alpha and 1/k0 affects the displacement.
  bool k0_kept = false;
};

/// Returns the error sentence for a parameter that the model does not have. The sentence contains the most
/// similar parameter, or the list of all parameters if no parameter is similar.
std::string unknown_parameter(const model::Model& model, const std::string& path) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < model::parameter_count(model); ++i)
    names.push_back(model::parameter_path(model, i));
  const std::string near = document::nearest(path, names);
  return "the model has no parameter '" + path + "'; " +
         (near.empty() ? "its parameters are " + with_commas(names) : "did you mean '" + near + "'?");
}

tl::expected<FreeIndices, std::string> free_indices(const model::Model& model,
                                                    const IdentifyOptions& options) {
  std::array<std::set<std::size_t>, 2> indices;
  for (auto [list, into] : {std::pair(&options.fixed, &indices[0]), std::pair(&options.free, &indices[1])}) {
    for (const std::string& path : *list) {
      const auto index = model::find_path(model, path);
      if (!index) return Failure(unknown_parameter(model, path));
      into->insert(*index);
    }
  }
  const auto& [fixed, chosen] = indices;
  const auto alpha = model::find_path(model, "bouc_wen.alpha_mm_per_kpa");
  const auto k0 = model::find_path(model, "kelvin_voigt.k0_kpa_per_mm");
  const bool alpha_free = alpha && !fixed.contains(*alpha) && (chosen.empty() || chosen.contains(*alpha));
  FreeIndices free;
  for (std::size_t i = 0; i < model::parameter_count(model); ++i) {
    const model::ParameterSpec& spec = model::parameter_spec(model, i);
    if (spec.whole || fixed.contains(i)) continue;
    if (chosen.empty() ? spec.placed : !chosen.contains(i)) continue;
    if (i == k0 && alpha_free) {
      free.k0_kept = true;
      continue;
    }
    free.flat.push_back(i);
  }
  return free;
}

/// Returns 2.5 times the robust standard deviation of the residuals [mm]. This standard deviation is computed
/// from the median of the absolute residuals.
double huber_width_mm(const Residuals& residuals, const std::vector<double>& z) {
  std::vector<double> r(residuals.count());
  if (!residuals.evaluate(z, r, {}) || r.empty()) return std::numeric_limits<double>::infinity();
  for (double& value : r) value = std::abs(value);
  return std::max(2.5 * median_of(std::span(r)) / 0.6745, 1e-9);
}

/// Fits the model for one value of the Bouc-Wen exponent.
class Run {
 public:
  Run(std::vector<Record> records, model::Model start, const IdentifyOptions& options)
      : options_(options), start_(std::move(start)) {
    result_.records = std::move(records);
  }

  tl::expected<Identification, std::string> go() {
    const auto free = free_indices(start_, options_);
    if (!free) return Failure(free.error());
    const FitSpace space(start_, result_.records, free->flat);
    if (space.size() == 0)
      return Failure(
          "nothing can be fitted, because all parameters of the model are fixed, and the logs begin at rest "
          "with a reading of 0. Fix fewer parameters, or compute the error of the model with softgrip "
          "validate");
    const FitPoint given{start_, rest_starts(start_, result_.records)};
    std::vector<FitPoint> starts;
    for (const model::Model& point : options_.start_points) starts.push_back({point, given.starts});
    if (starts.empty())
      starts = draw_starts(space, given, result_.records, std::max<std::size_t>(1, options_.starts),
                           options_.seed);
    std::vector<SearchResult> found =
        search(space, result_.records, starts, options_.threads, options_.progress);
    const auto best =
        std::min_element(found.begin(), found.end(),
                         [](const SearchResult& a, const SearchResult& b) { return a.rmse_mm < b.rmse_mm; });
    if (!std::isfinite(best->rmse_mm))
      return Failure("the prediction of the model is infinite or NaN for every start point of the fit");
    for (const SearchResult& each : found) result_.multistart.rmse_mm.push_back(each.rmse_mm);
    order_branches(branch_time_constants_s(start_), best->point);
    polish(best->point, *free);
    return std::move(result_);
  }

 private:
  void polish(const FitPoint& from, const FreeIndices& free) {
    const auto residuals = residuals_for(result_.records, FitSpace(from.model, result_.records, free.flat));
    std::vector<double> z = residuals->space().z(from);
    MinimiseOptions options;
    Minimum minimum = minimise(*residuals, z, options);
    // The width of Huber's loss depends on the residuals of the fit, and the fit depends on this width. Two
    // iterations are sufficient.
    for (int pass = 0; pass < 2 && options_.robust; ++pass) {
      options.huber_mm = result_.huber_mm = huber_width_mm(*residuals, minimum.z);
      minimum = minimise(*residuals, minimum.z, options);
    }
    const FitPoint point = residuals->space().point(minimum.z);
    result_.fitted = point.model;
    result_.rmse_mm = minimum.rmse_mm;
    result_.iterations = minimum.iterations;
    result_.converged = minimum.converged;
    const Uncertainty uncertainty = uncertainty_at(*residuals, minimum.z, options.huber_mm);
    const FittedPoint fit{*residuals, minimum.z, uncertainty};
    result_.parameters = parameter_estimates(fit);
    result_.starts = start_estimates(fit);
    result_.combinations = combination_estimates(fit);
    result_.loose = uncertainty.loose;
    result_.noise = uncertainty.noise;
    if (options_.profile) {
      add_profiles(*residuals, minimum.z, uncertainty, options.huber_mm, options_.threads,
                   result_.parameters);
    }
    if (free.k0_kept) name_the_sum(result_.parameters);
    for (std::size_t k = 0; k < result_.records.size(); ++k) {
      const Record& record = result_.records[k];
      result_.scores.push_back(score_of(result_.fitted, record, point.starts[k], record.reading_mm));
    }
    result_.multistart = multistart_of(std::move(result_.multistart.rmse_mm));
  }

  const IdentifyOptions& options_;
  model::Model start_;
  Identification result_;
};

/// Returns the model with the exponent `exponent`. Scales gamma and eta, which multiply the exponentiated
/// hysteretic state h^n, so that the hysteresis loop keeps about its size.
model::Model with_exponent(model::Model model, int exponent) {
  const auto position = model::position_of<model::BoucWen>(model);
  if (!position) return model;
  std::vector<double>& v = model.blocks[*position].values;
  const double limit_mm = std::max(v[1], 1e-6) / std::max(v[2] + v[3], 1e-6);
  const double change = std::pow(limit_mm, v[4] - exponent);
  v[2] *= change;
  v[3] *= change;
  v[4] = exponent;
  return model;
}

/// Returns the complete start model with the fitted values. Blocks that are not part of `fitted` keep their
/// values.
model::Model put_back(const model::Model& start, const model::Model& fitted) {
  model::Model whole = start;
  // Index of the next fitted block; the fitted blocks have the same order as in `start`.
  std::size_t next = 0;
  for (model::BlockSpec& block : whole.blocks) {
    if (next < fitted.blocks.size() && fitted.blocks[next].type == block.type) {
      block.values = fitted.blocks[next++].values;
    }
  }
  return whole;
}

void add_warnings(Identification& result) {
  if (!result.converged) result.warnings.emplace_back("the last minimisation stopped before convergence");
  if (const double ratio = beta_over_gain(result.fitted); ratio > 1)
    result.warnings.push_back(wrong_way_sentence(ratio) + ". Run softgrip diagnose");
  for (std::string& sentence : start_warnings(result)) result.warnings.push_back(std::move(sentence));
  for (const Record& record : result.records) {
    if (record.offset_free && !record.start_unknown) {
      result.warnings.push_back(
          record.name +
          " does not begin with readings of 0 without pressure, so an offset of the sensor was estimated");
    }
  }
  if (result.noise.lag1_correlation > 0.5) {
    result.warnings.push_back("the residuals are correlated (" +
                              significant(result.noise.lag1_correlation, 3) +
                              " from one sample to the next), so the readings are equivalent to " +
                              fixed(result.noise.effective_samples, 0) + " independent samples");
  }
  if (result.multistart.starts >= 5 && result.multistart.share_at_best < 0.2) {
    result.warnings.push_back(
        "only " + fixed(100 * result.multistart.share_at_best, 0) +
        " % of the start points led to the best fit, so a better fit may exist: increase --starts");
  }
}

}  // namespace

MultiStart multistart_of(std::vector<double> rmse_mm) {
  // A search counts as successful if its RMSE is at most (1 + reached_share) times the smallest RMSE of all
  // searches, plus 1e-6 mm.
  constexpr double reached_share = 1e-3;
  const double lowest = *std::min_element(rmse_mm.begin(), rmse_mm.end());
  const auto reached = std::count_if(rmse_mm.begin(), rmse_mm.end(), [&](double one_mm) {
    return one_mm <= lowest * (1 + reached_share) + 1e-6;
  });
  const auto starts = static_cast<double>(rmse_mm.size());
  return {rmse_mm.size(), static_cast<double>(reached) / starts, std::move(rmse_mm)};
}

std::vector<std::string> start_warnings(const Identification& result) {
  std::vector<std::string> sentences;
  for (std::size_t k = 0; k < result.records.size(); ++k) {
    const Record& record = result.records[k];
    if (!record.start_unknown) continue;
    const double fitted_mm = result.scores[k].rmse_mm;
    const double predicted_mm =
        score_of(result.fitted, record, estimated_start(result.fitted, record), record.reading_mm).rmse_mm;
    std::string sentence =
        record.name + " does not start from rest, so the initial state of this log was estimated";
    if (!(predicted_mm <= limits::comparable_ratio * fitted_mm)) {
      sentence +=
          " from all its readings. From the first readings alone, which `softgrip validate` and `softgrip "
          "diagnose` use, the RMSE is " +
          significant(predicted_mm, 3) + " instead of " + significant(fitted_mm, 3) + " " +
          std::string(model::name_of(record.output_unit)) + ". Record a log that starts from rest";
    }
    sentences.push_back(std::move(sentence));
  }
  return sentences;
}

tl::expected<Identification, std::string> identify(const std::vector<Log>& logs, const model::Model& start,
                                                   const IdentifyOptions& options) {
  if (logs.empty()) return Failure("no logs to identify from");
  for (const Log& log : logs) {
    if (options.record.drive == Drive::measured && log.pressure_kpa.empty()) {
      return Failure(log.name + " has no measured pressure");
    }
  }
  return identify(make_records(logs, options.record), start, options);
}

tl::expected<Identification, std::string> identify(std::vector<Record> records, const model::Model& start,
                                                   const IdentifyOptions& options) {
  const auto began = std::chrono::steady_clock::now();
  const std::vector<Record> whole = records;
  if (options.fit_share < 1) records = with_first_readings(std::move(records), options.fit_share);
  const model::Model fitted_part = deterministic_part(start, options.record.drive);
  if (const auto wrong = model::validate(fitted_part); !wrong.empty()) return Failure(wrong.front());

  std::vector<int> exponents = options.exponents;
  if (exponents.empty()) exponents.push_back(0);
  std::optional<Identification> best;
  std::vector<std::pair<int, double>> tried;
  for (const int exponent : exponents) {
    const model::Model& from = best ? best->fitted : fitted_part;
    auto result = Run(records, exponent == 0 ? from : with_exponent(from, exponent), options).go();
    if (!result) return Failure(result.error());
    if (exponent != 0) tried.emplace_back(exponent, result->rmse_mm);
    // The result for the next exponent is accepted only if its RMSE is more than 1 % below that of the best
    // earlier exponent.
    if (!best || result->rmse_mm < (1 - limits::negligible_share) * best->rmse_mm) best = std::move(*result);
  }
  best->exponent_rmse_mm = std::move(tried);
  best->model = put_back(start, best->fitted);
  for (std::size_t k = 0; k < whole.size(); ++k) {
    best->fast_noise_mm = std::max(best->fast_noise_mm, fast_noise_mm(whole[k]));
    if (options.fit_share >= 1) continue;
    std::vector<double> rest = whole[k].reading_mm;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (std::isfinite(best->records[k].reading_mm[i])) rest[i] = std::numeric_limits<double>::quiet_NaN();
    }
    best->held_out.push_back(score_of(best->fitted, whole[k], best->scores[k].start, rest));
  }
  add_warnings(*best);
  best->wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return std::move(*best);
}

}  // namespace softgrip::sysid
