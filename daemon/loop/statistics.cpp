#include "daemon/loop/statistics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace softgrip::daemon {

namespace {

constexpr std::int64_t ns_per_us = 1000;

/// Only one thread writes the counters, so a load and a store can replace an atomic addition.
void add_to(std::atomic<std::uint64_t>& counter, std::uint64_t amount) noexcept {
  counter.store(counter.load(std::memory_order_relaxed) + amount, std::memory_order_relaxed);
}

}  // namespace

std::size_t Histogram::index_of(std::uint64_t duration_ns) noexcept {
  if (duration_ns < sub_count) return static_cast<std::size_t>(duration_ns);
  const int shift = static_cast<int>(std::bit_width(duration_ns)) - 1 - sub_bits;
  const std::size_t index =
      static_cast<std::size_t>(shift) * sub_count + static_cast<std::size_t>(duration_ns >> shift);
  return std::min(index, bin_count - 1);
}

std::int64_t Histogram::lower_of(std::size_t index) noexcept {
  if (index < 2 * sub_count) return static_cast<std::int64_t>(index);
  const std::size_t shift = index / sub_count - 1;
  return static_cast<std::int64_t>((index - shift * sub_count) << shift);
}

void Histogram::add(std::int64_t duration_ns) noexcept {
  const std::int64_t duration = std::max<std::int64_t>(duration_ns, 0);
  const auto value = static_cast<std::uint64_t>(duration);
  const bool first = count_.load(std::memory_order_relaxed) == 0;
  if (first || duration < min_ns_.load(std::memory_order_relaxed)) {
    min_ns_.store(duration, std::memory_order_relaxed);
  }
  if (duration > max_ns_.load(std::memory_order_relaxed)) max_ns_.store(duration, std::memory_order_relaxed);
  add_to(bins_[index_of(value)], 1);
  add_to(sum_ns_, value);
  add_to(count_, 1);
}

std::vector<Histogram::Bin> Histogram::bins() const {
  std::vector<Bin> result;
  for (std::size_t i = 0; i < bin_count; ++i) {
    const std::uint64_t count = bins_[i].load(std::memory_order_relaxed);
    if (count > 0) result.push_back({lower_of(i), count});
  }
  return result;
}

std::int64_t Histogram::quantile_ns(double q) const {
  std::uint64_t total = 0;
  for (const auto& bin : bins_) total += bin.load(std::memory_order_relaxed);
  if (total == 0) return 0;
  const auto rank = static_cast<std::uint64_t>(
      std::clamp(std::ceil(q * static_cast<double>(total)), 1.0, static_cast<double>(total)));
  const std::int64_t largest = max_ns_.load(std::memory_order_relaxed);
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < bin_count; ++i) {
    seen += bins_[i].load(std::memory_order_relaxed);
    if (seen >= rank) return i + 1 == bin_count ? largest : std::min(lower_of(i + 1) - 1, largest);
  }
  return largest;
}

Histogram::Summary Histogram::summary() const {
  Summary result;
  result.count = count_.load(std::memory_order_relaxed);
  if (result.count == 0) return result;
  result.min_ns = min_ns_.load(std::memory_order_relaxed);
  result.max_ns = max_ns_.load(std::memory_order_relaxed);
  result.mean_ns =
      static_cast<double>(sum_ns_.load(std::memory_order_relaxed)) / static_cast<double>(result.count);
  result.p50_ns = quantile_ns(0.5);
  result.p99_ns = quantile_ns(0.99);
  result.p999_ns = quantile_ns(0.999);
  return result;
}

std::string Histogram::cyclictest_text(std::string_view title) const {
  std::map<std::int64_t, std::uint64_t> by_microsecond;
  for (const Bin& bin : bins()) by_microsecond[bin.lower_ns / ns_per_us] += bin.count;
  const Summary all = summary();
  std::string text = fmt::format("# Histogram ({})\n", title);
  for (const auto& [us, count] : by_microsecond) text += fmt::format("{:06} {:06}\n", us, count);
  text += fmt::format(
      "# Total: {:09}\n# Min Latencies: {:05}\n# Avg Latencies: {:05}\n# Max Latencies: {:05}\n", all.count,
      all.min_ns / ns_per_us, std::llround(all.mean_ns / ns_per_us), all.max_ns / ns_per_us);
  return text;
}

}  // namespace softgrip::daemon
