#include "sysid/evidence/tolerance.h"

#include <algorithm>

#include "sysid/evidence/f_quantile.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {

double run_to_run_factor(std::size_t runs) {
  constexpr double directions = limits::run_directions;
  if (runs < 2) return f_quantile(limits::probability, directions, directions);
  const auto n = static_cast<double>(runs);
  return f_quantile(limits::probability, directions, directions * (n - 1)) * (1 - 1 / (n * n));
}

Tolerance::Tolerance(const std::vector<NullGains>& units, std::size_t runs, double more)
    : factor_(run_to_run_factor(runs)), more_(more) {
  for (const NullGains& unit : units) {
    for (const auto& [cause, gain] : unit)
      usual_[cause] += std::max(gain, 0.0) / static_cast<double>(units.size());
  }
  for (const auto& [cause, gain] : usual_) average_ += gain / static_cast<double>(usual_.size());
}

double Tolerance::usual(std::string_view cause) const {
  const auto found = usual_.find(cause);
  return found == usual_.end() ? average_ : found->second;
}

double Tolerance::of(std::string_view cause) const {
  return factor_ * (std::max(usual(cause), average_) + more_);
}

}  // namespace softgrip::sysid
