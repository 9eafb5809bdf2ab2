#include "strength.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace textbook {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double near_enough = 0.02, reachable_within = 0.15;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

std::vector<double> difference(std::vector<double> of, const std::vector<double>& from) {
  for (std::size_t k = 0; k < of.size(); ++k) of[k] -= from[k];
  return of;
}

// Solves a linear system by Gaussian elimination with pivoting. If one direction is a linear combination of
// others, the coefficient of this direction is 0.
std::vector<double> solved(std::vector<std::vector<double>> a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t pivot = i;
    for (std::size_t r = i + 1; r < n; ++r)
      if (std::abs(a[r][i]) > std::abs(a[pivot][i])) pivot = r;
    std::swap(a[i], a[pivot]);
    std::swap(b[i], b[pivot]);
    if (std::abs(a[i][i]) < 1e-12) continue;
    for (std::size_t r = i + 1; r < n; ++r) {
      const double share = a[r][i] / a[i][i];
      for (std::size_t c = i; c < n; ++c) a[r][c] -= share * a[i][c];
      b[r] -= share * b[i];
    }
  }
  std::vector<double> x(n, 0);
  for (std::size_t i = n; i-- > 0;) {
    if (std::abs(a[i][i]) < 1e-12) continue;
    double rest = b[i];
    for (std::size_t c = i + 1; c < n; ++c) rest -= a[i][c] * x[c];
    x[i] = rest / a[i][i];
  }
  return x;
}

}  // namespace

Recalibration::Recalibration(const std::vector<double>& displacement_mm) {
  add(std::vector<double>(displacement_mm.size(), 1.0), -infinite, infinite);
  add(displacement_mm, -infinite, infinite);
}

void Recalibration::add(std::vector<double> change_mm, double low, double high) {
  const double length = std::sqrt(dot(change_mm, change_mm));
  if (length == 0) return;
  for (double& value : change_mm) value /= length;
  directions_.push_back({std::move(change_mm), low * length, high * length});
  products_.emplace_back();
  for (const Direction& other : directions_)
    products_.back().push_back(dot(directions_.back().unit, other.unit));
  for (std::size_t i = 0; i + 1 < directions_.size(); ++i) products_[i].push_back(products_.back()[i]);
}

// At the optimum, every bounded parameter is either between its bounds or at one of its two bounds. There are
// only a few parameters, so the function tries all combinations of these three cases. It takes the best
// combination within the bounds.
double Recalibration::left_mm(const std::vector<double>& difference_mm) const {
  const std::size_t n = directions_.size();
  const double square = dot(difference_mm, difference_mm);
  std::vector<double> along;
  std::size_t combinations = 1;
  for (const Direction& d : directions_) {
    along.push_back(dot(difference_mm, d.unit));
    if (d.high < infinite) combinations *= 3;
  }
  double best = square;
  for (std::size_t combination = 0; combination < combinations; ++combination) {
    std::vector<double> x(n, 0), wanted;
    std::vector<std::size_t> free;
    std::size_t code = combination;
    for (std::size_t i = 0; i < n; ++i) {
      const bool bounded = directions_[i].high < infinite;
      const std::size_t state = bounded ? code % 3 : 0;
      if (bounded) code /= 3;
      if (state == 0) free.push_back(i);
      if (state > 0) x[i] = state == 1 ? directions_[i].low : directions_[i].high;
    }
    std::vector<std::vector<double>> matrix;
    for (const std::size_t i : free) {
      wanted.push_back(along[i] - dot(products_[i], x));
      matrix.emplace_back();
      for (const std::size_t j : free) matrix.back().push_back(products_[i][j]);
    }
    const std::vector<double> moved = solved(matrix, wanted);
    for (std::size_t k = 0; k < free.size(); ++k) x[free[k]] = moved[k];
    bool within = true;
    double left = square - 2 * dot(along, x);
    for (std::size_t i = 0; i < n; ++i) {
      within = within && x[i] >= directions_[i].low - 1e-9 && x[i] <= directions_[i].high + 1e-9;
      left += x[i] * dot(products_[i], x);
    }
    if (within) best = std::min(best, left);
  }
  return std::sqrt(std::max(0.0, best) / static_cast<double>(difference_mm.size()));
}

Excess::Excess(const World& world, const std::vector<Log>& logs, std::uint64_t seed)
    : setting_{world, 0, duration_s(logs)},
      logs_(logs),
      seed_(seed),
      plain_kpa_(simulate_pressures(world, {}, logs)),
      plain_mm_(displacements(world, {}, logs, seed, plain_kpa_)),
      twin_(plain_mm_) {
  setting_.largest_mm = *std::max_element(plain_mm_.begin(), plain_mm_.end());
  for (const OwnNumber& own : own_numbers(world.finger.make)) {
    const double value = world.finger.*own.member, unit = 0.1 * (own.high - own.low);
    const bool up = value + unit <= own.high;
    World moved = world;
    moved.finger.*own.member += up ? unit : -unit;
    auto change = difference(displacements(moved, {}, logs, seed, plain_kpa_), plain_mm_);
    for (double& c : change) c /= up ? unit : -unit;
    twin_.add(std::move(change), own.low - value, own.high - value);
  }
}

double Excess::of_mm(const Effects& effects) const {
  const auto moved_mm = acts_on_pressure(effects)
                            ? displacements(setting_.world, effects, logs_, seed_)
                            : displacements(setting_.world, effects, logs_, seed_, plain_kpa_);
  const auto added = difference(moved_mm, plain_mm_);
  if (effects.count("leak") > 0) return std::sqrt(dot(added, added) / static_cast<double>(added.size()));
  return twin_.left_mm(added);
}

Scaled Excess::scaled(const std::string& id, double target_mm) const {
  Scaled best;
  double nearest = infinite;
  const auto at = [&](double log_amplitude) {
    const Numbers numbers = draw_effect(id, std::min(1.0, std::exp(log_amplitude)), setting_, seed_);
    const double excess_mm = of_mm({{id, numbers}});
    const double miss = std::abs(std::log(std::max(excess_mm, 1e-9) / target_mm));
    if (miss < nearest) {
      nearest = miss;
      best = {numbers, excess_mm, std::abs(excess_mm / target_mm - 1) <= reachable_within};
    }
    return excess_mm;
  };
  // The search begins at a small amplitude and raises it until the error reaches the target. It does not
  // begin at the largest amplitude, because a change of the gain may explain most of such a large effect.
  double low = std::log(1e-3), high = low, below = 0, above = at(low);
  while (above < target_mm && high < 0) {
    low = high;
    below = above;
    high = std::min(0.0, low + std::clamp(std::log(target_mm / std::max(below, 1e-9)), 0.2, 1.4));
    above = at(high);
  }
  for (int i = 0; i < 24 && nearest > near_enough && above >= target_mm; ++i) {
    const double share =
        std::log(target_mm / std::max(below, 1e-9)) / std::log(above / std::max(below, 1e-9));
    const double middle = low + (i % 3 == 2 ? 0.5 : std::clamp(share, 0.05, 0.95)) * (high - low);
    const double reached = at(middle);
    (reached < target_mm ? low : high) = middle;
    (reached < target_mm ? below : above) = reached;
  }
  return best;
}

}  // namespace textbook
