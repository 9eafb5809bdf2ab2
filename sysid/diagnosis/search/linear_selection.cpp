#include "sysid/diagnosis/search/linear_selection.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "sysid/diagnosis/search/linear_holdout.h"
#include "sysid/diagnosis/search/scan.h"
#include "sysid/diagnosis/search/scored.h"
#include "sysid/fitting/minimise.h"
#include "sysid/fitting/residuals.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t fewest_looks = 2;
/// Candidates that are judged held out.
constexpr std::size_t finalists = 4;
constexpr int look_iterations = 15;
/// The weight of the structures with a cause that stands alone; it shares its own with a twin.
constexpr double least_inclusion = 0.95;
constexpr FitEffort finish{.most_iterations = 8, .tolerance = 1e-6};

/// Residuals over the numbers of one cause, less what the base could take away of them.
class ResidualsBesideBase final : public Residuals {
 public:
  ResidualsBesideBase(const Scan& base, const std::vector<Record>& records, const FitSpace& of_the_cause)
      : Residuals(records, of_the_cause), base_(base), inner_(residuals_for(records, of_the_cause)) {}

  bool evaluate(std::span<const double> z, std::span<double> r, std::span<double> jacobian) const override {
    if (!inner_->evaluate(z, r, jacobian)) return false;
    const auto rows = static_cast<Eigen::Index>(count());
    if (!r.empty()) {
      Eigen::Map<Eigen::VectorXd> values(r.data(), rows);
      values = base_.left_of(values);
    }
    if (!jacobian.empty()) {
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      Eigen::Map<RowMajor> slopes(jacobian.data(), rows, static_cast<Eigen::Index>(space().size()));
      slopes = base_.left_of(slopes);
    }
    return true;
  }
  [[nodiscard]] const Residuals& inner() const { return *inner_; }

 private:
  const Scan& base_;
  std::unique_ptr<Residuals> inner_;
};

/// One cause upon a base, on thinned records.
struct Look {
  FitPoint point;  ///< the base moved as it answers, with the cause
  double mean_square_mm2 = std::numeric_limits<double>::infinity();
};

Look look_from(const SearchData& data, const StructureFit& base, const Scan& scan, const Cause& cause,
               const FitPoint& start) {
  const FitSpace numbers = cause_space(data.thinned, start, cause);
  const ResidualsBesideBase residuals(scan, data.thinned, numbers);
  MinimiseOptions options;
  options.normal_equations = true;
  options.most_iterations = look_iterations;
  options.tolerance = 1e-5;
  const Minimum minimum = minimise(residuals, numbers.z(start), options);
  Look look;
  look.mean_square_mm2 = minimum.rmse_mm * minimum.rmse_mm;

  std::vector<double> left(residuals.count());
  if (!residuals.inner().evaluate(minimum.z, left, {})) return {};
  const Eigen::VectorXd answer =
      scan.answer_to(Eigen::Map<const Eigen::VectorXd>(left.data(), static_cast<Eigen::Index>(left.size())));
  const FitSpace space = structure_space(data.thinned, base.point.model, base.causes);
  std::vector<double> z = space.z(base.point);
  for (std::size_t i = 0; i < z.size(); ++i) {
    z[i] = std::clamp(z[i] + answer(static_cast<Eigen::Index>(i)), space.free()[i].lower_z(),
                      space.free()[i].upper_z());
  }
  look.point = space.point(z);
  const FitPoint with_cause = numbers.point(minimum.z);
  look.point.model =
      model::with_block(look.point.model, with_cause.model.blocks[*position_of(with_cause.model, cause)]);
  return look;
}

class SelectorUpon {
 public:
  SelectorUpon(const SearchData& data, StructureFit base, double noise_mm, const Division& division,
               const SelectionOptions& options)
      : data_(data), noise_mm_(noise_mm), division_(division), options_(options) {
    result_.base = std::move(base);
    result_.base_losses = linear_held_out_losses(data.records, division, result_.base);
    result_.base_structure = structure_of(result_.base.residual_mm, noise_mm);
    result_.extended = result_.base;
    result_.extended_losses = result_.base_losses;
    result_.left = result_.base_structure;
  }

  Selection run() {
    while (result_.left.present && result_.chosen.size() < options_.most_causes && add_one()) {
    }
    return std::move(result_);
  }

 private:
  /// Every cause that the structure lacks, with the best of its looks; best first.
  std::vector<std::pair<Cause, Look>> looks() {
    const StructureFit& current = result_.extended;
    const std::vector<Scan> scans = [&] {
      std::vector<Scan> one;
      one.emplace_back(data_.thinned, current.causes, current.point);
      return one;
    }();
    std::vector<std::pair<Cause, Look>> list;
    if (!scans.front().usable()) return list;
    for (const Cause& cause : all_causes()) {
      if (cause.found_by_fitting && !position_of(current.point.model, cause) &&
          unanswerable(cause, data_.scales).empty())
        list.emplace_back(cause, Look{});
    }
    parallel_for(list.size(), data_.threads, [&](std::size_t i) {
      auto& [cause, best] = list[i];
      for (const FitPoint& start : best_starts(scans, cause, data_.scales, fewest_looks)) {
        Look look = look_from(data_, current, scans.front(), cause, start);
        if (look.mean_square_mm2 < best.mean_square_mm2) best = std::move(look);
      }
      if (options_.progress) options_.progress("tried " + std::string(cause.id));
    });
    std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) {
      return a.second.mean_square_mm2 < b.second.mean_square_mm2;
    });
    return list;
  }

  std::vector<ScoredCandidate> score() {
    std::vector<std::pair<Cause, Look>> found = looks();
    std::vector<ScoredCandidate> scored(std::min(finalists, found.size()));
    parallel_for(scored.size(), data_.threads, [&](std::size_t i) {
      auto& [cause, look] = found[i];
      scored[i].candidate.cause = cause;
      if (look.point.model.blocks.empty()) {
        scored[i].candidate.why_not = "no start led to a fit";
        return;
      }
      std::vector<Cause> causes = result_.extended.causes;
      causes.push_back(cause);
      scored[i].candidate.fit = fit_structure(data_.records, causes, look.point, finish);
      scored[i].losses = linear_held_out_losses(data_.records, division_, *scored[i].candidate.fit);
    });
    std::erase_if(scored, [](const ScoredCandidate& s) { return !s.candidate.fit; });
    std::stable_sort(scored.begin(), scored.end(), [](const ScoredCandidate& a, const ScoredCandidate& b) {
      return rmse_mm(a.losses) < rmse_mm(b.losses);
    });
    return scored;
  }

  bool add_one() {
    std::vector<ScoredCandidate> scored = score();
    result_.last_candidates = describe(scored, result_.extended_losses, options_.seed);
    if (scored.empty()) return false;
    const ScoredCandidate& best = scored.front();
    const Spread gain = mean_difference(result_.extended_losses, best.losses, options_.seed);
    if (!(gain.lower > 0 && gain.value > 0.01 * noise_mm_ * noise_mm_)) return false;
    ChosenCause chosen =
        weigh(best.candidate.cause,
              {*best.candidate.fit, best.losses, result_.extended_losses, noise_mm_, options_.seed}, scored);
    if (!stands(chosen)) return false;
    result_.extended = *best.candidate.fit;
    result_.extended_losses = best.losses;
    result_.left = structure_of(result_.extended.residual_mm, noise_mm_);
    result_.chosen.push_back(std::move(chosen));
    return true;
  }

  /// By itself or, where others explain as much, as one of them.
  [[nodiscard]] static bool stands(const ChosenCause& chosen) {
    const bool has_twin = std::any_of(chosen.rivals.begin(), chosen.rivals.end(),
                                      [&](const Cause& rival) { return rival.id == chosen.cause.twin; });
    if (chosen.rivals.size() > (has_twin ? 1U : 0U)) return true;
    return chosen.inclusion >= (has_twin ? least_inclusion / 2 : least_inclusion);
  }

  const SearchData& data_;
  double noise_mm_;
  const Division& division_;
  const SelectionOptions& options_;
  Selection result_;
};

}  // namespace

Selection select_causes_upon(const SearchData& data, StructureFit base, double noise_mm,
                             const Division& division, const SelectionOptions& options) {
  return SelectorUpon(data, std::move(base), noise_mm, division, options).run();
}

}  // namespace softgrip::sysid
