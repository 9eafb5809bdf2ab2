#include "sysid/structure/held_out_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sysid/fitting/trajectory.h"

namespace softgrip::sysid {
namespace {

constexpr double blocks_in_all = 10;
/// Readings so near to a held-out block, in parts of it, are not fitted either.
constexpr double gap_share = 0.1;

void hide(Record& record, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) record.reading_mm[i] = std::numeric_limits<double>::quiet_NaN();
  record.readings = static_cast<std::size_t>(std::count_if(record.reading_mm.begin(), record.reading_mm.end(),
                                                           [](double y) { return std::isfinite(y); }));
}

}  // namespace

HeldOutBlocks::HeldOutBlocks(const std::vector<Record>& records)
    : records_(records), fitted_(folds, records) {
  double total_s = 0;
  for (const Record& record : records) total_s += record.length_s();
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Record& record = records[r];
    std::size_t end = record.size();
    while (end > 0 && !std::isfinite(record.reading_mm[end - 1])) --end;
    const double fewest = records.size() > 1 ? 2 : static_cast<double>(folds);
    const auto count =
        static_cast<std::size_t>(std::max(fewest, std::round(blocks_in_all * record.length_s() / total_s)));
    for (std::size_t b = 0; b < count; ++b) blocks_.push_back({r, b * end / count, (b + 1) * end / count});
  }
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto [record, first, last] = blocks_[b];
    const auto gap = static_cast<std::size_t>(gap_share * static_cast<double>(last - first));
    hide(fitted_[b % folds][record], first > gap ? first - gap : 0,
         std::min(last + gap, records[record].size()));
  }
}

void HeldOutBlocks::judge(const FitPoint& point, std::size_t fold, std::vector<double>& losses_mm2) const {
  for (std::size_t r = 0; r < records_.size(); ++r) {
    const std::vector<double> left =
        residual(records_[r], predict(point.model, records_[r], point.starts[r]));
    for (std::size_t b = fold; b < blocks_.size(); b += folds) {
      if (blocks_[b].record != r) continue;
      const double root = rms(std::span(left).subspan(blocks_[b].first, blocks_[b].last - blocks_[b].first));
      losses_mm2[b] = root * root;
    }
  }
}

HeldOutContinuation::HeldOutContinuation(const std::vector<Record>& records)
    : records_(records), fitted_(records) {
  for (Record& record : fitted_) hide(record, record.size() / 2, record.size());
}

std::vector<double> HeldOutContinuation::judge(const FitPoint& point) const {
  constexpr std::size_t parts = 5;
  std::vector<double> losses;
  for (std::size_t r = 0; r < records_.size(); ++r) {
    const std::vector<double> left =
        residual(records_[r], predict(point.model, records_[r], point.starts[r]));
    const std::size_t begin = left.size() / 2, length = left.size() - begin;
    for (std::size_t k = 0; k < parts; ++k) {
      const std::size_t first = begin + k * length / parts, last = begin + (k + 1) * length / parts;
      const double root = rms(std::span(left).subspan(first, last - first));
      losses.push_back(root * root);
    }
  }
  return losses;
}

double held_out_rmse_mm(const std::vector<double>& losses_mm2) {
  double sum = 0;
  for (const double loss : losses_mm2) sum += loss;
  return std::sqrt(sum / static_cast<double>(losses_mm2.size()));
}

LossDifference loss_difference(const std::vector<double>& worse, const std::vector<double>& better) {
  const auto n = static_cast<double>(worse.size());
  double mean = 0, square = 0;
  for (std::size_t i = 0; i < worse.size(); ++i) mean += (worse[i] - better[i]) / n;
  for (std::size_t i = 0; i < worse.size(); ++i) square += std::pow(worse[i] - better[i] - mean, 2) / (n - 1);
  return {mean, std::sqrt(square / n)};
}

bool is_clearly_less(const std::vector<double>& better, const std::vector<double>& worse) {
  constexpr double clearly = 2;  // standard errors
  const LossDifference plain = loss_difference(worse, better);
  if (!(plain.mean_mm2 > 0)) return false;
  if (plain.mean_mm2 > clearly * plain.standard_error_mm2) return true;
  const auto logarithms = [](std::vector<double> losses) {
    for (double& loss : losses) loss = std::log(std::max(loss, 1e-300));
    return losses;
  };
  const LossDifference by_ratio = loss_difference(logarithms(worse), logarithms(better));
  return by_ratio.mean_mm2 > clearly * by_ratio.standard_error_mm2;
}

}  // namespace softgrip::sysid
