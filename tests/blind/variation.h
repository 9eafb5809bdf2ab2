#pragma once
// Random differences between runs of an unchanged finger, for both families of simulated fingers. A diagnosis
// must not report any of these differences as a cause.

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <vector>

namespace variation {

/// Standard deviations of the run-to-run variation at strength 1.
inline constexpr double offset_share = 0.003;  // zero offset, as a share of the finger's span
inline constexpr double gain_share = 0.01;
inline constexpr double temperature_c = 2;
inline constexpr double supply_share = 0.02;

/// The random variation of one run. The default values mean no variation.
struct Run {
  double offset_share = 0;  // offset that is added to every reading, as a share of the span
  double gain = 1;          // factor on the displacement
  double warmer_c = 0;
  double supply = 1;     // factor on the supply pressure
  double amplitude = 1;  // factor on the commands, at most 1
  double rate_hz = 0;    // sample rate [Hz]; 0: the default rate of the family
  // A pulse before the recording begins. It leaves creep and hysteresis in the first readings.
  double pulse_share = 0, pulse_s = 0,
         rest_s = 0;  // pulse height as a share of the working pressure, pulse duration [s], and rest after
                      // the pulse [s]
};

/// Draws the variation of run `run` of a campaign. `strength` scales the size of the variation. At every
/// strength above 0, the sample rate is drawn, too.
Run draw_run(double strength, std::uint64_t seed, std::size_t run);

/// Prints the variations of runs as CSV. A test compares them with the standard deviations above.
void list_runs(std::ostream& out, double strength, std::uint64_t seed, std::size_t runs);

/// Returns the index of the kind of input signal with which a campaign begins. The index is below `kinds`;
/// without variation it is 0.
std::size_t first_kind(double strength, std::uint64_t seed, std::size_t kinds);

/// Resamples values to a different sample rate with linear interpolation.
std::vector<double> resampled(const std::vector<double>& values, double from_hz, double to_hz);

/// Returns the unrecorded pressures before a run, sampled at `rate_hz`. They consist of a pulse and a rest.
/// The list is empty if the run has no pulse.
std::vector<double> pulse(const Run& run, double working_kpa, double rate_hz);

/// A proportional-integral controller with a static feedforward. A rig without a model uses such a
/// controller.
class Controller {
 public:
  /// `mm_per_kpa` is the gain of the finger that the controller assumes.
  Controller(double mm_per_kpa, double most_kpa, double rate_hz)
      : mm_per_kpa_(mm_per_kpa), most_kpa_(most_kpa), rate_hz_(rate_hz) {}
  /// Returns the next command [kPa], which is between 0 and the largest pressure. While the command is at one
  /// of these limits, the integral is held.
  double step(double reference_mm, double reading_mm);

 private:
  double mm_per_kpa_, most_kpa_, rate_hz_, integral_kpa_ = 0;
};

}  // namespace variation
