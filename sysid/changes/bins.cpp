#include "sysid/changes/bins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "sysid/evidence/signature.h"

namespace softgrip::sysid {
namespace {

/// Shares of all bins at which one class of the input rate ends and the next class begins. The bins are
/// sorted by their input rate. The fourth class has no upper limit.
constexpr std::array class_ends{0.4, 0.7, 0.9};

/// Subtracts the mean of the finite values from the series, because a separate step estimates the zero offset
/// of a run.
void subtract_mean(std::vector<double>& series) {
  double sum = 0, count = 0;
  for (const double v : series) {
    if (!std::isfinite(v)) continue;
    sum += v;
    count += 1;
  }
  for (double& v : series) v -= sum / std::max(count, 1.0);
}

/// Computes the standard deviation of the residual for each class of the input rate.
void add_classes(const Binned& residual, const Binned& peak_rate, Whitener& whitener) {
  const WhiteRows rows(residual, peak_rate, whitener);
  const Eigen::VectorXd white = rows(residual);
  std::vector<double> all;
  for (const WhiteRows::Row& row : rows.rows()) all.push_back(peak_rate[row.record][row.bin]);
  if (all.empty()) return;
  std::vector<double> sorted = all;
  std::sort(sorted.begin(), sorted.end());
  for (const double share : class_ends)
    whitener.peak_rate_kpa_per_s.push_back(
        sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size()))]);
  std::vector<double> sum(class_ends.size() + 1, 0), count(class_ends.size() + 1, 0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t c = whitener.class_of(all[i]);
    sum[c] += std::pow(white(static_cast<Eigen::Index>(i)), 2);
    count[c] += 1;
  }
  const double whole = std::sqrt(white.squaredNorm() / static_cast<double>(all.size()));
  whitener.spread.clear();
  constexpr double fewest = 30;
  for (std::size_t c = 0; c < sum.size(); ++c)
    whitener.spread.push_back(count[c] > fewest && sum[c] > 0 ? std::sqrt(sum[c] / count[c]) : whole);
}

}  // namespace

std::size_t Whitener::class_of(double peak_rate) const {
  return static_cast<std::size_t>(
      std::lower_bound(peak_rate_kpa_per_s.begin(), peak_rate_kpa_per_s.end(), peak_rate) -
      peak_rate_kpa_per_s.begin());
}

double rms_of(const Binned& series) {
  double sum = 0, count = 0;
  for (const std::vector<double>& part : series) {
    for (const double v : part) {
      if (!std::isfinite(v)) continue;
      sum += v * v;
      count += 1;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

std::vector<double> peak_rate_of(const Record& record, double bin_s) {
  return binned(record, rates_of(record), bin_s);
}

std::vector<double> with_bins(std::vector<double> series, std::size_t bins) {
  series.resize(bins, series.empty() ? 0.0 : series.back());
  return series;
}

std::vector<std::vector<double>> minus(std::vector<std::vector<double>> from,
                                       const std::vector<std::vector<double>>& what) {
  for (std::size_t r = 0; r < from.size(); ++r) {
    for (std::size_t i = 0; i < from[r].size(); ++i) from[r][i] -= what[r][i];
  }
  return from;
}

double bin_s(const std::vector<Record>& records, double least_s) {
  double longest_s = 0;
  for (const Record& record : records) longest_s = std::max(longest_s, record.mean_interval_s());
  return std::max(least_s, 2 * longest_s);
}

std::size_t bin_count(const Record& record, double bin_s) {
  return static_cast<std::size_t>(record.length_s() / bin_s) + 1;
}

std::vector<double> binned(const Record& record, const std::vector<double>& series, double bin_s) {
  const std::size_t bins = bin_count(record, bin_s);
  std::vector<double> sum(bins, 0), count(bins, 0);
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!std::isfinite(series[i])) continue;
    const std::size_t bin = std::min(bin_of(record, i, bin_s), bins - 1);
    sum[bin] += series[i];
    count[bin] += 1;
  }
  for (std::size_t b = 0; b < bins; ++b)
    sum[b] = count[b] > 0 ? sum[b] / count[b] : std::numeric_limits<double>::quiet_NaN();
  return sum;
}

Whitener whitener_of(Binned residual, const Binned& peak_rate, std::size_t order) {
  for (std::vector<double>& series : residual) subtract_mean(series);
  Eigen::VectorXd correlation = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(order) + 1);
  for (const std::vector<double>& series : residual) {
    for (Eigen::Index lag = 0; lag < correlation.size(); ++lag) {
      for (std::size_t i = static_cast<std::size_t>(lag); i < series.size(); ++i) {
        const double product = series[i] * series[i - static_cast<std::size_t>(lag)];
        if (std::isfinite(product)) correlation(lag) += product;
      }
    }
  }
  const auto n = static_cast<Eigen::Index>(order);
  Eigen::MatrixXd toeplitz(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) toeplitz(i, j) = correlation(std::abs(i - j));
  }
  toeplitz.diagonal().array() += 1e-6 * correlation(0);
  const Eigen::VectorXd weights = toeplitz.ldlt().solve(correlation.tail(n));
  Whitener whitener;
  whitener.before.assign(weights.begin(), weights.end());
  whitener.spread = {1.0};
  add_classes(residual, peak_rate, whitener);
  return whitener;
}

WhiteRows::WhiteRows(const Binned& residual, const Binned& peak_rate, Whitener whitener)
    : whitener_(std::move(whitener)) {
  const std::size_t order = whitener_.before.size();
  for (std::size_t r = 0; r < residual.size(); ++r) {
    std::size_t finite = 0;
    for (std::size_t b = 0; b < residual[r].size(); ++b) {
      finite = std::isfinite(residual[r][b]) ? finite + 1 : 0;
      if (finite > order) rows_.push_back({r, b, whitener_.spread_at(peak_rate[r][b])});
    }
  }
}

Eigen::VectorXd WhiteRows::operator()(const Binned& series) const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(rows_.size()));
  Eigen::Index at = 0;
  for (const auto& [r, b, spread] : rows_) {
    double value = std::isfinite(series[r][b]) ? series[r][b] : 0;
    for (std::size_t i = 0; i < whitener_.before.size(); ++i) {
      const double earlier = series[r][b - 1 - i];
      if (std::isfinite(earlier)) value -= whitener_.before[i] * earlier;
    }
    out(at++) = value / spread;
  }
  return out;
}

}  // namespace softgrip::sysid
