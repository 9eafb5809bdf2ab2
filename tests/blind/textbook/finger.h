#pragma once
// Soft fingers of five makes, each with its own hysteresis, creep over decades and slight curvature.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace textbook {

inline constexpr double working_kpa = 60;

struct FingerNumbers {
  std::string make = "play";  // play, maxwell_slip, preisach, hyperelastic_tube, fractional
  double span_mm = 16;        // at working_kpa, held until nothing creeps any more
  double width = 0.1;         // of the hysteretic part; 0: no loops
  double curvature = 0.1;
  double creep = 0.15;           // share of the creeping part
  double creep_tilt = 0;         // weight of the branch with time constant tau: tau^tilt
  double envelope = 0.1;         // how far the loops are bent (generalised play, Preisach density)
  double longest_creep_s = 1e9;  // branches slower than this are left out
};

const std::vector<std::string>& makes();
FingerNumbers draw_finger(const std::string& make, std::uint64_t seed);

/// What differs from finger to finger of one make, and within which bounds it is drawn.
struct OwnNumber {
  double FingerNumbers::*member;
  double low, high;
};
/// Width, curvature, creep and its tilt: what a recalibrated twin may take up.
std::vector<OwnNumber> own_numbers(const std::string& make);

/// Starts without load and without memory.
class Finger {
 public:
  explicit Finger(const FingerNumbers& numbers);
  /// Displacement [mm] after `step_s` at `pressure_kpa` (gauge).
  double step(double pressure_kpa, double step_s);

 private:
  static constexpr std::size_t branches = 16;  // 0.02 to 2000 s: five decades, three to a decade
  static constexpr std::size_t slices = 8;
  double raw(double pressure_kpa, double step_s);
  double play(double q) noexcept;
  double maxwell_slip(double q) noexcept;
  double preisach(double q) noexcept;
  double tube(double q, double step_s) noexcept;
  double creep(double q, double step_s) noexcept;

  FingerNumbers numbers_;
  std::array<double, branches> weight_{}, tau_s_{}, branch_{};
  double full_ = 1;             // what `raw` reaches at working_kpa after a long hold
  std::vector<double> memory_;  // plays, anchors of the slip elements, or turning points of the input
  double input_ = 0;            // of the relays, before this step
  double balance_ = 0;          // strain of the slip elements' spring
  std::array<double, slices> stretch_{}, thickness_{};
  std::array<std::array<double, 3>, slices> relaxed_{};
};

}  // namespace textbook
