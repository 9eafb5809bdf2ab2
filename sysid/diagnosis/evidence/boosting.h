#pragma once
// Regression by gradient boosting of small trees (Friedman 2001) on binned features, as LightGBM and its
// relatives do it (Ke et al. 2017).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace softgrip::sysid {

/// Features by column, each value replaced by the number of its quantile bin. NaN has a bin of its own, 0.
class BinnedFeatures {
 public:
  static constexpr std::size_t most_bins = 33;

  /// @param columns  all of one length.
  explicit BinnedFeatures(const std::vector<std::vector<double>>& columns);

  [[nodiscard]] std::size_t features() const noexcept { return columns_.size(); }
  [[nodiscard]] std::size_t samples() const noexcept {
    return columns_.empty() ? 0 : columns_.front().size();
  }
  [[nodiscard]] const std::vector<std::uint8_t>& column(std::size_t feature) const {
    return columns_[feature];
  }
  /// Moves the values of a column to other samples: sample s takes what `from[s]` had.
  void permute(std::size_t feature, std::span<const std::size_t> from);

 private:
  std::vector<std::vector<std::uint8_t>> columns_;
};

/// Trees with three questions from root to leaf.
class BoostedTrees {
 public:
  struct Options {
    std::size_t rounds = 120;
    double rate = 0.1;           ///< share of a tree's correction that is taken
    double fewest_in_leaf = 40;  ///< samples
    double penalty = 20;         ///< samples at zero that every leaf's mean includes
  };

  /// Fits `target` at the samples `rows`. After every round `after(rounds so far)` may look at
  /// predict_last().
  template <class After>
  void fit(const BinnedFeatures& x, std::span<const double> target, std::span<const std::size_t> rows,
           const Options& options, After&& after) {
    trees_.clear();
    std::vector<double> left(target.begin(), target.end());
    for (std::size_t round = 1; round <= options.rounds; ++round) {
      trees_.push_back(grow(x, left, rows, options));
      for (const std::size_t s : rows) left[s] -= value(trees_.back(), x, s);
      after(round);
    }
  }

  /// What the newest tree adds at a sample.
  [[nodiscard]] double predict_last(const BinnedFeatures& x, std::size_t sample) const {
    return value(trees_.back(), x, sample);
  }
  /// The sum of the first `rounds` trees.
  [[nodiscard]] double predict(const BinnedFeatures& x, std::size_t sample, std::size_t rounds) const;

 private:
  static constexpr std::size_t depth = 3;
  static constexpr std::size_t inner = (1U << depth) - 1;
  /// A complete tree: node n asks whether the bin is above `bin[n]`; its children are 2n+1 and 2n+2.
  struct Tree {
    std::array<std::uint16_t, inner> feature{};
    std::array<std::uint8_t, inner> bin{};
    std::array<double, inner + 1> leaf{};
  };

  [[nodiscard]] static std::size_t next(const Tree& tree, const BinnedFeatures& x, std::size_t node,
                                        std::size_t sample) {
    return 2 * node + 1 + (x.column(tree.feature[node])[sample] > tree.bin[node] ? 1 : 0);
  }
  [[nodiscard]] static double value(const Tree& tree, const BinnedFeatures& x, std::size_t sample) {
    std::size_t node = 0;
    for (std::size_t level = 0; level < depth; ++level) node = next(tree, x, node, sample);
    return tree.leaf[node - inner];
  }
  static Tree grow(const BinnedFeatures& x, std::span<const double> left, std::span<const std::size_t> rows,
                   const Options& options);

  std::vector<Tree> trees_;
};

}  // namespace softgrip::sysid
