#pragma once
// How runs of one finger differ although nothing has changed: shared by both families of simulated fingers.
// Nothing here is an effect that a diagnosis may name.

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <vector>

namespace variation {

/// Standard deviations at strength 1.
inline constexpr double offset_share = 0.003;  // of the span
inline constexpr double gain_share = 0.01;
inline constexpr double temperature_c = 2;
inline constexpr double supply_share = 0.02;

/// One run. The default is a run without variation.
struct Run {
  double offset_share = 0;  // of the span, added to every reading
  double gain = 1;          // of the displacement
  double warmer_c = 0;
  double supply = 1;     // factor of the supply pressure
  double amplitude = 1;  // factor of the commands, at most 1
  double rate_hz = 0;    // 0: the family's own
  // A pulse before the recording begins: hysteresis and creep have not settled.
  double pulse_share = 0, pulse_s = 0, rest_s = 0;  // share of the working pressure
};

/// Run number `run` of a campaign. `strength` scales all that has a size; rates vary at every strength above
/// 0.
Run draw_run(double strength, std::uint64_t seed, std::size_t run);

/// Runs as CSV: what a test compares with the spreads above.
void list_runs(std::ostream& out, double strength, std::uint64_t seed, std::size_t runs);

/// With which of `kinds` input signals a campaign begins; 0 without variation.
std::size_t first_kind(double strength, std::uint64_t seed, std::size_t kinds);

/// Values at another rate, linear between the samples.
std::vector<double> resampled(const std::vector<double>& values, double from_hz, double to_hz);

/// The pressures of the pulse and of the rest after it, at `rate_hz`; none without a pulse.
std::vector<double> pulse(const Run& run, double working_kpa, double rate_hz);

/// A proportional-integral controller with a static feedforward, as a rig without a model has it.
class Controller {
 public:
  /// `mm_per_kpa`: the gain that the rig's operator assumes.
  Controller(double mm_per_kpa, double most_kpa, double rate_hz)
      : mm_per_kpa_(mm_per_kpa), most_kpa_(most_kpa), rate_hz_(rate_hz) {}
  /// The next command [kPa], within 0 and the largest pressure; the integral waits at the limits.
  double step(double reference_mm, double reading_mm);

 private:
  double mm_per_kpa_, most_kpa_, rate_hz_, integral_kpa_ = 0;
};

}  // namespace variation
