#pragma once
// Computes random numbers as a function of seed and index. The functions have no state, and their results are
// equal on all machines.

#include <cmath>
#include <cstdint>
#include <numbers>

namespace softgrip {

/// Returns a number of which each bit depends on all bits of `x`. The function is a bijection: the finaliser
/// of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014).
[[nodiscard]] constexpr std::uint64_t scattered(std::uint64_t x) noexcept {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Returns the seed of the part with the number `part` of an object that has the seed `seed`.
[[nodiscard]] constexpr std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t part) noexcept {
  return scattered(scattered(seed) ^ (part * 0xd1342543de82ef95ULL + 1));
}

/// Returns the n-th uniform random number of a seed. The number is in the open interval (0, 1).
[[nodiscard]] constexpr double uniform_at(std::uint64_t seed, std::uint64_t n) noexcept {
  return (static_cast<double>(scattered(seed ^ scattered(n)) >> 11) + 0.5) * 0x1.0p-53;
}

/// Returns the n-th standard normal random number of a seed (Box-Muller).
[[nodiscard]] inline double normal_at(std::uint64_t seed, std::uint64_t n) noexcept {
  const double radius = std::sqrt(-2.0 * std::log(uniform_at(seed, 2 * n)));
  return radius * std::cos(2.0 * std::numbers::pi * uniform_at(seed, 2 * n + 1));
}

}  // namespace softgrip
