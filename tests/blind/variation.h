#pragma once
// Random differences between the runs of an unchanged finger, for both families of simulated worlds. A
// diagnosis must not report any of these differences as a cause.

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <vector>

namespace variation {

/// Standard deviations of the run-to-run variation at strength 1.
inline constexpr double offset_share = 0.003;  // zero offset, as a fraction of the finger's span
inline constexpr double gain_share = 0.01;
inline constexpr double temperature_c = 2;
inline constexpr double supply_share = 0.02;

/// The random variation of one run. The default values mean no variation.
struct Run {
  double offset_share = 0;  // offset to add to every reading, as a fraction of the span
  double gain = 1;          // factor on the displacement
  double warmer_c = 0;
  double supply = 1;     // factor on the supply pressure
  double amplitude = 1;  // factor on the commands, at most 1
  double rate_hz = 0;    // sample rate [Hz]; 0: the default rate of the family of simulated worlds
  // A pressure pulse before the recording begins. Because of creep and hysteresis, the pulse changes the
  // first readings.
  double pulse_share = 0, pulse_s = 0,
         rest_s = 0;  // height of the pulse as a fraction of the working pressure, duration of the pulse [s],
                      // and rest after it [s]
};

/// Draws the variation of the run with index `run` of a campaign. `strength` scales the variation. If
/// `strength` is above 0, the sample rate is drawn as well.
Run draw_run(double strength, std::uint64_t seed, std::size_t run);

/// Prints the variations of runs as CSV. A test compares their standard deviations with the constants above.
void list_runs(std::ostream& out, double strength, std::uint64_t seed, std::size_t runs);

/// Returns the index of the kind of input signal with which a campaign begins. The index is below `kinds`.
/// Without variation, the index is 0.
std::size_t first_kind(double strength, std::uint64_t seed, std::size_t kinds);

/// Resamples values to a different sample rate with linear interpolation.
std::vector<double> resampled(const std::vector<double>& values, double from_hz, double to_hz);

/// Returns the pressures before the recording of a run, sampled at `rate_hz`. They consist of a pulse and a
/// rest. If the run has no pulse, the list is empty.
std::vector<double> pulse(const Run& run, double working_kpa, double rate_hz);

/// A proportional-integral controller with a static feedforward. A rig without a model uses such a
/// controller.
class Controller {
 public:
  /// `mm_per_kpa` is the gain that the controller assumes for the finger.
  Controller(double mm_per_kpa, double most_kpa, double rate_hz)
      : mm_per_kpa_(mm_per_kpa), most_kpa_(most_kpa), rate_hz_(rate_hz) {}
  /// Returns the next command [kPa]. The command is between 0 and the largest pressure. While the command is
  /// at one of these limits, the integral is constant.
  double step(double reference_mm, double reading_mm);

 private:
  double mm_per_kpa_, most_kpa_, rate_hz_, integral_kpa_ = 0;
};

}  // namespace variation
