#pragma once
// Soft fingers of five makes. Each make has its own type of hysteresis, creep with time constants over
// several decades, and a slight curvature.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace textbook {

inline constexpr double working_kpa = 60;

struct FingerNumbers {
  std::string make = "play";  // make of the finger: play, maxwell_slip, preisach, hyperelastic_tube or
                              // fractional
  double span_mm = 16;        // displacement at the pressure working_kpa when all creep has ended
  double width = 0.1;         // width of the hysteresis; 0: no hysteresis
  double curvature = 0.1;
  double creep = 0.15;           // fraction of the displacement that is caused by creep
  double creep_tilt = 0;         // exponent of the weight of a creep branch: a branch with time constant tau
                                 // has the weight tau^creep_tilt
  double envelope = 0.1;         // nonlinearity of the hysteresis loops (generalised play, Preisach density)
  double longest_creep_s = 1e9;  // largest time constant of creep [s]; branches with a larger time constant
                                 // are omitted
};

const std::vector<std::string>& makes();
FingerNumbers draw_finger(const std::string& make, std::uint64_t seed);

/// A parameter that differs between fingers of the same make. Its value is drawn at random between two
/// bounds.
struct OwnNumber {
  double FingerNumbers::*member;
  double low, high;
};
/// Returns the parameters that a refit may change: width, curvature, creep and tilt of the creep. Such a
/// change can explain a part of an effect.
std::vector<OwnNumber> own_numbers(const std::string& make);

/// A finger that has never been loaded.
class Finger {
 public:
  explicit Finger(const FingerNumbers& numbers);
  /// Simulates a step of duration `step_s`. `pressure_kpa` is the gauge pressure at the end of the step.
  /// Returns the displacement [mm].
  double step(double pressure_kpa, double step_s);

 private:
  // The time constants of creep range from 0.02 to 2000 s, with three branches per decade.
  static constexpr std::size_t branches = 16;
  static constexpr std::size_t slices = 8;
  double raw(double pressure_kpa, double step_s);
  double play(double q) noexcept;
  double maxwell_slip(double q) noexcept;
  double preisach(double q) noexcept;
  double tube(double q, double step_s) noexcept;
  double creep(double q, double step_s) noexcept;

  FingerNumbers numbers_;
  std::array<double, branches> weight_{}, tau_s_{}, branch_{};
  double full_ = 1;             // output of raw() after a long hold at working_kpa, when all creep has ended
  std::vector<double> memory_;  // states of the play operators, anchors of the slip elements, or turning
                                // points of the input
  double input_ = 0;            // input of the hysteresis model before this step
  double balance_ = 0;          // strain of the spring of the Maxwell-slip model
  std::array<double, slices> stretch_{}, thickness_{};
  std::array<std::array<double, 3>, slices> relaxed_{};
};

}  // namespace textbook
