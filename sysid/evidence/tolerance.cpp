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
  const double share = 1 / std::max(1.0, static_cast<double>(units.size()));
  for (const NullGains& unit : units) {
    double largest = 0;
    for (const auto& [cause, gain] : unit) {
      usual_[cause] += share * std::max(gain, 0.0);
      largest = std::max(largest, gain);
    }
    search_ += share * largest;
  }
  for (const auto& [cause, gain] : usual_) average_ += gain / static_cast<double>(usual_.size());
}

double Tolerance::usual(std::string_view cause) const {
  const auto found = usual_.find(cause);
  return found == usual_.end() ? average_ : found->second;
}

}  // namespace softgrip::sysid
