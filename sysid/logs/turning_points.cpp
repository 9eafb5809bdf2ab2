#include "sysid/logs/turning_points.h"

#include <span>

namespace softgrip::sysid {
namespace {

/// Neighbouring values that are replaced by their mean.
struct Pool {
  double sum = 0;
  double count = 0;
};

void make_rising(std::span<double> values, double sign) {
  std::vector<Pool> pools;
  for (const double v : values) {
    Pool pool{sign * v, 1};
    while (!pools.empty() && pools.back().sum * pool.count >= pool.sum * pools.back().count) {
      pool.sum += pools.back().sum;
      pool.count += pools.back().count;
      pools.pop_back();
    }
    pools.push_back(pool);
  }
  std::size_t i = 0;
  for (const Pool& pool : pools) {
    for (auto left = static_cast<std::size_t>(pool.count); left > 0; --left)
      values[i++] = sign * pool.sum / pool.count;
  }
}

}  // namespace

std::vector<std::size_t> turning_points(const std::vector<double>& values, double least) {
  std::vector<std::size_t> turns{0};
  std::size_t highest = 0, lowest = 0;
  // The variables may_fall and may_rise are both true until the signal has moved by more than `least` in one
  // direction.
  bool may_fall = true, may_rise = true;
  const auto turn = [&](std::size_t at) {
    if (at > turns.back()) turns.push_back(at);
  };
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] > values[highest]) highest = i;
    if (values[i] < values[lowest]) lowest = i;
    if (may_fall && values[highest] - values[i] > least) {
      turn(highest);
      lowest = i;
      may_fall = false;
      may_rise = true;
    } else if (may_rise && values[i] - values[lowest] > least) {
      turn(lowest);
      highest = i;
      may_rise = false;
      may_fall = true;
    }
  }
  turn(values.size() - 1);
  return turns;
}

std::vector<double> steady_between_turns(std::vector<double> values, double least) {
  const std::vector<std::size_t> turns = turning_points(values, least);
  for (std::size_t k = 1; k < turns.size(); ++k) {
    const std::size_t from = turns[k - 1], to = turns[k];
    make_rising(std::span(values).subspan(from, to - from + 1), values[to] < values[from] ? -1 : 1);
  }
  return values;
}

}  // namespace softgrip::sysid
