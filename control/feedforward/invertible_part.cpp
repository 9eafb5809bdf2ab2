#include "control/feedforward/invertibility.h"

#include <array>
#include <utility>

#include "base/statistics.h"
#include "model/catalogue.h"
#include "model/chain.h"

namespace softgrip::control {
namespace {

/// Returns the displacements of the model while the pressure goes from 0 kPa to each end of the pressure
/// range and back.
std::vector<double> along_the_way(const model::Model& model, const LimitSettings& limits) {
  constexpr int steps = 100;
  constexpr double step_s = 0.05;
  model::Chain<double> chain(model, {}, step_s);
  chain.reset(0);
  std::vector<double> reading_mm;
  double from_kpa = 0;
  const auto go = [&](double to_kpa) {
    for (int i = 1; i <= steps; ++i) {
      chain.step(step_s, from_kpa + (to_kpa - from_kpa) * i / steps);
      reading_mm.push_back(chain.reading_mm());
    }
    from_kpa = to_kpa;
  };
  for (int cycle = 0; cycle < 2; ++cycle) {
    go(limits.pressure_max_kpa);
    go(0);
    if (limits.pressure_min_kpa >= 0) continue;
    go(limits.pressure_min_kpa);
    go(0);
  }
  return reading_mm;
}

double square_sum(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += square(a[i] - b[i]);
  return sum;
}

void omit(InvertiblePart& part, std::size_t type) {
  part.model = model::without_block(std::move(part.model), type);
  part.left_out.emplace_back(model::catalogue()[type].info.id);
}

}  // namespace

std::optional<InvertiblePart> invertible_part(const model::Model& model, const LimitSettings& limits,
                                              double tick_s) {
  const auto is_accepted = [&](const model::Model& one) {
    return check_feedforward(one, {FeedforwardKind::full_model, 0}, limits, tick_s).has_value();
  };
  InvertiblePart part{model, {}};
  for (const model::BlockSpec& block : model.blocks) {
    if (!not_undone(std::array{model::catalogue()[block.type].info}).empty() &&
        model::position_of(part.model, block.type))
      omit(part, block.type);
  }
  if (is_accepted(part.model)) {
    if (part.left_out.empty()) return std::nullopt;
    return part;
  }
  const std::vector<double> whole = along_the_way(part.model, limits);
  std::optional<std::size_t> least_missed;
  double least = 0;
  for (const model::BlockSpec& block : part.model.blocks) {
    const model::Model without = model::without_block(part.model, block.type);
    if (!is_accepted(without)) continue;
    const double missed = square_sum(whole, along_the_way(without, limits));
    if (least_missed && !(missed < least)) continue;
    least_missed = block.type;
    least = missed;
  }
  if (!least_missed) return std::nullopt;
  omit(part, *least_missed);
  return part;
}

}  // namespace softgrip::control
