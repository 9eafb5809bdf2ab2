#include "drivers/board/round_trip.h"

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "base/statistics.h"

namespace softgrip::drivers {
namespace {

// Assumed durations of a round trip [s]. Each is the upper end of a range: 0.02 to 0.15 ms on loopback
// (measured), and 1 to 10 ms in a switched network (common figure, not measured).
constexpr double assumed_loopback_s = 0.15e-3;
constexpr double assumed_network_s = 10e-3;

bool is_loopback(const std::string& host) {
  return host.rfind("127.", 0) == 0 || host == "::1";
}

}  // namespace

double RoundTrip::median_s() const noexcept {
  if (count_ == 0) return 0;
  std::array<Nanoseconds, 32> all = durations_;
  return seconds(median_of(std::span(all).first(count_)));
}

double RoundTrip::slowest_s() const noexcept {
  if (count_ == 0) return 0;
  return seconds(
      *std::max_element(durations_.begin(), durations_.begin() + static_cast<std::ptrdiff_t>(count_)));
}

std::string milliseconds(double duration_s) {
  return significant(duration_s * 1e3, 3) + " ms";
}

Board::Budget tcp_cost(std::size_t transactions, const std::string& plan, const std::string& host,
                       const RoundTrip& measured) {
  const bool known = measured.count() > 0;
  const double assumed_s = is_loopback(host) ? assumed_loopback_s : assumed_network_s;
  const double round_trip_s = known ? measured.median_s() : assumed_s;
  const std::string source =
      known ? "median of " + std::to_string(measured.count()) +
                  " round trips measured when connecting, slowest " + milliseconds(measured.slowest_s())
            : std::string("assumed for ") + (is_loopback(host) ? "loopback" : "a network") +
                  ", not measured because the board has not been connected yet";
  Board::Budget cost;
  cost.exchange_s = static_cast<double>(transactions) * round_trip_s;
  cost.explanation = "Modbus TCP, " + std::to_string(transactions) +
                     (transactions == 1 ? " round trip" : " round trips") + " (" + plan + ") of " +
                     milliseconds(round_trip_s) + " (" + source + ")";
  return cost;
}

Board::Budget sum_of(std::span<const Board::Budget> costs) {
  Board::Budget budget;
  for (const Board::Budget& cost : costs) {
    budget.exchange_s += cost.exchange_s;
    budget.explanation += (budget.explanation.empty() ? "" : "; then ") + cost.explanation;
  }
  budget.explanation += ": " + milliseconds(budget.exchange_s);
  if (budget.exchange_s > 0) {
    budget.explanation +=
        ", at most " + std::to_string(std::lround(std::floor(1 / budget.exchange_s))) + " Hz";
  }
  return budget;
}

}  // namespace softgrip::drivers
