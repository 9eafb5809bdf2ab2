#include "sysid/diagnosis/evidence/boosting.h"

#include <algorithm>
#include <cmath>

namespace softgrip::sysid {
namespace {

struct Cell {
  double sum = 0;
  double count = 0;
};

/// The best question at one node.
struct Split {
  double gain = 0;
  std::size_t feature = 0;
  std::uint8_t bin = 255;  ///< nothing is above: all go left
};

Split best_split(std::span<const Cell> cells, std::size_t features, const BoostedTrees::Options& options) {
  constexpr std::size_t bins = BinnedFeatures::most_bins;
  const auto worth = [&](double sum, double count) { return sum * sum / (count + options.penalty); };
  Split best;
  for (std::size_t f = 0; f < features; ++f) {
    const std::span<const Cell> row = cells.subspan(f * bins, bins);
    Cell all, low;
    for (const Cell& c : row) {
      all.sum += c.sum;
      all.count += c.count;
    }
    for (std::size_t b = 0; b + 1 < bins; ++b) {
      low.sum += row[b].sum;
      low.count += row[b].count;
      const double above = all.count - low.count;
      if (low.count < options.fewest_in_leaf) continue;
      if (above < options.fewest_in_leaf) break;
      const double gain =
          worth(low.sum, low.count) + worth(all.sum - low.sum, above) - worth(all.sum, all.count);
      if (gain > best.gain) best = {gain, f, static_cast<std::uint8_t>(b)};
    }
  }
  return best;
}

}  // namespace

BinnedFeatures::BinnedFeatures(const std::vector<std::vector<double>>& columns) {
  for (const std::vector<double>& column : columns) {
    std::vector<double> sorted;
    for (const double v : column) {
      if (std::isfinite(v)) sorted.push_back(v);
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<double> edges;
    for (std::size_t k = 1; k + 1 < most_bins && !sorted.empty(); ++k)
      edges.push_back(sorted[sorted.size() * k / (most_bins - 1)]);
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    std::vector<std::uint8_t>& binned = columns_.emplace_back();
    for (const double v : column) {
      const auto above = std::upper_bound(edges.begin(), edges.end(), v) - edges.begin();
      binned.push_back(std::isfinite(v) ? static_cast<std::uint8_t>(above + 1) : std::uint8_t{0});
    }
  }
}

void BinnedFeatures::permute(std::size_t feature, std::span<const std::size_t> from) {
  const std::vector<std::uint8_t> old = columns_[feature];
  for (std::size_t s = 0; s < old.size(); ++s) columns_[feature][s] = old[from[s]];
}

BoostedTrees::Tree BoostedTrees::grow(const BinnedFeatures& x, std::span<const double> left,
                                      std::span<const std::size_t> rows, const Options& options) {
  constexpr std::size_t bins = BinnedFeatures::most_bins;
  Tree tree;
  tree.bin.fill(255);
  std::vector<std::uint8_t> node(rows.size(), 0);
  for (std::size_t level = 0; level < depth; ++level) {
    const std::size_t first = (1U << level) - 1, count = 1U << level;
    std::vector<Cell> cells(count * x.features() * bins);
    for (std::size_t f = 0; f < x.features(); ++f) {
      const std::vector<std::uint8_t>& column = x.column(f);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        Cell& cell = cells[((node[i] - first) * x.features() + f) * bins + column[rows[i]]];
        cell.sum += left[rows[i]];
        cell.count += 1;
      }
    }
    for (std::size_t n = 0; n < count; ++n) {
      const Split split = best_split(std::span(cells).subspan(n * x.features() * bins, x.features() * bins),
                                     x.features(), options);
      tree.feature[first + n] = static_cast<std::uint16_t>(split.feature);
      tree.bin[first + n] = split.bin;
    }
    for (std::size_t i = 0; i < rows.size(); ++i)
      node[i] = static_cast<std::uint8_t>(next(tree, x, node[i], rows[i]));
  }
  std::array<Cell, inner + 1> leaves{};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    leaves[node[i] - inner].sum += left[rows[i]];
    leaves[node[i] - inner].count += 1;
  }
  for (std::size_t n = 0; n < leaves.size(); ++n)
    tree.leaf[n] = options.rate * leaves[n].sum / (leaves[n].count + options.penalty);
  return tree;
}

double BoostedTrees::predict(const BinnedFeatures& x, std::size_t sample, std::size_t rounds) const {
  double sum = 0;
  for (std::size_t r = 0; r < std::min(rounds, trees_.size()); ++r) sum += value(trees_[r], x, sample);
  return sum;
}

}  // namespace softgrip::sysid
