#pragma once
// Defines the possible model structures of a finger. With the pressure q after dead time and lag:
//
//   z = hysteresis(b(q)) + sum_j c_j creep_j(q),   tau_j creep_j' = q - creep_j,   y = g(z) + offset
//
// Here b is the envelope function model::EnvelopeMap of generalised play operators, or b(q) = q. The
// hysteresis consists of play operators, sum_i w_i play_(r_i)(q) (Prandtl-Ishlinskii; Kuhnen, European
// Journal of Control 9, 2003), or is the Bouc-Wen element with exponent 1. g is the block `characteristic`.
// The weights are not negative, so that each fitted model is monotonic in the current pressure and has an
// inverse.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace softgrip::sysid {

enum class HysteresisForm { bouc_wen, play };

/// The components that a structure has.
struct BaseStructure {
  HysteresisForm hysteresis = HysteresisForm::play;
  bool hysteretic = true;      ///< true: hysteresis; false: only the elastic gain
  bool creep = true;           ///< a chain of Kelvin-Voigt branches with fixed time constants
  bool slow_creep = true;      ///< the chain has time constants above 10 % of the longest record
  bool delay = true;           ///< dead time between the drive and the finger
  bool lag = true;             ///< a first-order lag after the delay
  bool two_way = true;         ///< filling and venting have different time constants
  bool second_lag = false;     ///< a second lag before the first one, with one time constant for both
                               ///< directions
  bool rate_limit = false;     ///< a rate limit behind the lag, see model::RateLimit
  bool regulator = false;      ///< the lag is that of a regulator with an overlap, see RegulatedPressure
  bool characteristic = true;  ///< a nonlinear, monotonic map after the sum
  bool resonance = false;      ///< a second-order mode after the map, see with_resonance()
  bool envelopes = false;      ///< generalised play operators with nonlinear envelopes
  bool hinged_creep =
      false;               ///< pressure-dependent creep: a short chain above each threshold pressure (hinge)
  bool wandering = false;  ///< a piecewise linear drift of the zero of each record, which is not a part of
                           ///< the finger
  /// The published element: one lag, Bouc-Wen, and two Kelvin-Voigt branches with fitted time constants.
  bool published = false;

  bool operator==(const BaseStructure&) const = default;
};

/// Returns the name of a form in `softgrip identify --structure`: "prandtl_ishlinskii" or "bouc_wen".
[[nodiscard]] std::string_view name_of(HysteresisForm form);
/// Returns a description such as "play operators, creep ladder, delay, lag (filling and venting),
/// characteristic".
[[nodiscard]] std::string description_of(const BaseStructure& structure);

/// Parameters of the operators that a fit does not change. These are thresholds, time constants and threshold
/// pressures of creep (hinges).
struct StructureGrid {
  double largest_kpa = 0;              ///< largest magnitude of the drive
  double span_mm = 0;                  ///< largest magnitude of the readings
  std::vector<double> thresholds_kpa;  ///< thresholds of the play operators in increasing order, without that
                                       ///< of the elastic operator (0)
  std::vector<double> ladder_s;        ///< time constants of the creep branches, in increasing order
  double slow_from_s = 0;              ///< branches with this or a larger time constant count as slow creep
  std::vector<double> hinges_kpa;  ///< threshold pressures of pressure-dependent creep, in increasing order
  std::vector<double> hinge_ladder_s;  ///< time constants of pressure-dependent creep
};

/// The nonlinear parameters of a structure.
struct NonlinearNumbers {
  double delay_s = 0;
  double filling_s = 0;  ///< time constant while the pressure rises; 0: no lag
  double venting_s = 0;
  double second_s = 0;           ///< time constant of the second lag
  double filling_s_per_kpa = 0;  ///< rate limit: shortest time in which the pressure rises by 1 kPa
  double venting_s_per_kpa = 0;
  double pilot_band_kpa = 0;  ///< regulator: change of the command that the regulator ignores after a
                              ///< reversal
  double overlap_kpa = 0;     ///< regulator: this and the next two parameters are those of RegulatorNumbers
  double integral_s = 0;
  double full_open_kpa = 0;
  double curvature = 0;        ///< curvature of the characteristic
  double growing_per_kpa = 0;  ///< Bouc-Wen: gamma + eta
  double narrowing = 0.5;      ///< Bouc-Wen: eta / (gamma + eta), in (0, 1]
  double trained_kpa = 0;      ///< play operators: the largest pressure before the logs
  double envelope_bend = 0;    ///< this and the next parameter are those of model::EnvelopeMap
  double envelope_skew = 0;
  std::vector<double> peak_before_kpa;  ///< for each record, see StartState; 0 for records that start from
                                        ///< rest

  bool operator==(const NonlinearNumbers&) const = default;
};

}  // namespace softgrip::sysid
