#pragma once
// Defines the possible model structures of a finger. With the pressure q after dead time and lag:
//
//   z = hysteresis(b(q)) + sum_j c_j creep_j(q),   tau_j creep_j' = q - creep_j,   y = g(z) + offset
//
// Here b is the envelope function model::EnvelopeMap of generalised play operators, or b(q) = q. The
// hysteresis consists of play operators, sum_i w_i play_(r_i)(q) (Prandtl-Ishlinskii; Kuhnen, European
// Journal of Control 9, 2003), or is the Bouc-Wen element with exponent 1. g is the block `characteristic`.
// The weights are not negative, so that each fitted model is monotonic in the current pressure and has an
// inverse. Linear modes are the exception: they add weights of either sign to z (model::LinearModes). An
// ablation removes each component of a structure once. The parameters of the operators that are fixed before
// a fit are chosen for the records.

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

enum class HysteresisForm { bouc_wen, play };

/// The components of a model structure.
struct BaseStructure {
  HysteresisForm hysteresis = HysteresisForm::play;
  bool hysteretic = true;  ///< true: the structure has hysteresis; false: it has an elastic gain instead of
                           ///< hysteresis
  /// True: the structure has a chain of creep branches with fixed time constants.
  bool creep = true;
  bool slow_creep = true;  ///< true: the chain includes time constants from StructureGrid::slow_from_s on
  bool delay = true;       ///< true: there is a dead time between the drive and the finger
  bool lag = true;         ///< true: there is a first-order lag after the dead time
  bool two_way = true;     ///< true: the lag has different time constants for filling and venting
  /// True: a second lag precedes the first lag. It has the same time constant for filling and venting.
  bool second_lag = false;
  bool rate_limit = false;     ///< true: a rate limit follows the lag (model::RateLimit)
  bool regulator = false;      ///< true: a regulator with an overlap replaces the lag (RegulatedPressure)
  bool characteristic = true;  ///< true: the sum of all operators passes a nonlinear, monotonic map
  bool resonance = false;      ///< true: a second-order mode follows the characteristic (with_resonance())
  bool envelopes = false;      ///< true: the play operators are generalised ones with nonlinear envelopes
  bool hinged_creep =
      false;  ///< pressure-dependent creep: a short chain above each threshold pressure (hinge)
  /// Number of linear modes (model::LinearModes). They are added to the other operators, before the
  /// characteristic. Their gains have either sign.
  std::size_t modes = 0;
  /// True: the elastic gain may have either sign too. Such a structure has no hysteresis, lag or
  /// characteristic.
  bool linear = false;
  bool zero_drift = false;  ///< a piecewise linear drift of the zero offset of each record, which is not a
                            ///< part of the finger
  /// The published element: one lag, Bouc-Wen, and two Kelvin-Voigt branches with fitted time constants.
  bool published = false;

  bool operator==(const BaseStructure&) const = default;
};

/// Returns the name of a hysteresis form as the option `--structure` of softgrip identify expects it:
/// "prandtl_ishlinskii" or "bouc_wen".
[[nodiscard]] std::string_view name_of(HysteresisForm form);
/// Returns the name of the main element of a structure: its form of hysteresis, or "linear_modes" for a
/// linear structure.
[[nodiscard]] std::string_view name_of(const BaseStructure& structure);
/// Returns a description of the structure, for example "play operators, creep ladder, delay, lag (filling and
/// venting), characteristic".
[[nodiscard]] std::string description_of(const BaseStructure& structure);

/// The two parameters of a linear mode that affect the displacement nonlinearly, as in model::LinearModes.
struct ModeNumbers {
  double period_s = 0;
  double damping_ratio = 0;

  bool operator==(const ModeNumbers&) const = default;
};

/// Parameters of a structure on which the displacement depends nonlinearly.
struct NonlinearNumbers {
  double delay_s = 0;
  double filling_s = 0;  ///< time constant of the lag while the pressure rises; 0: no lag
  double venting_s = 0;
  double second_s = 0;           ///< time constant of the second lag
  double filling_s_per_kpa = 0;  ///< rate limit: shortest time in which the pressure rises by 1 kPa
  double venting_s_per_kpa = 0;  ///< rate limit: shortest time in which the pressure falls by 1 kPa
  /// Width of the dead band of the regulator: after a reversal, the regulator does not respond until the
  /// command has changed by this amount.
  double pilot_band_kpa = 0;
  /// Overlap of the regulator. The members overlap_kpa, integral_s and full_open_kpa are parameters of
  /// RegulatorNumbers.
  double overlap_kpa = 0;
  double integral_s = 0;
  double full_open_kpa = 0;
  double curvature = 0;        ///< curvature of the characteristic
  double growing_per_kpa = 0;  ///< gamma + eta of the Bouc-Wen element
  double narrowing = 0.5;      ///< eta / (gamma + eta) of the Bouc-Wen element, in (0, 1]
  double trained_kpa = 0;      ///< largest pressure before the logs; the play operators have been loaded to
                               ///< this pressure
  double envelope_bend = 0;    ///< bend of the envelopes; envelope_bend and envelope_skew are parameters of
                               ///< model::EnvelopeMap
  double envelope_skew = 0;
  /// For each record, the last peak of the pressure before the start of the record (StartState); 0 if the
  /// record starts from rest.
  std::vector<double> peak_before_kpa;
  std::vector<ModeNumbers> modes = {};  ///< linear modes
  /// For each record of a linear structure, the pressure at which the finger was at rest before the record.
  /// At the first sample, the pressure jumped from this value to the first pressure of the record. Empty: the
  /// records begin at rest at the first pressure.
  std::vector<double> jumped_from_kpa = {};

  bool operator==(const NonlinearNumbers&) const = default;
};

/// Parameters of the operators that are fixed before a fit: thresholds, time constants, and threshold
/// pressures of creep (hinges).
struct StructureGrid {
  double time_unit_s = 1;  ///< result of time_unit_s() for the records
  double largest_kpa = 0;  ///< largest magnitude of the drive
  double span_mm = 0;      ///< largest magnitude of the readings
  /// Thresholds of the play operators in increasing order. The elastic operator (threshold 0) is not in the
  /// list.
  std::vector<double> thresholds_kpa;
  std::vector<double> ladder_s;  ///< time constants of the creep branches, in increasing order
  /// Smallest time constant that counts as slow creep.
  double slow_from_s = 0;
  std::vector<double> hinges_kpa;  ///< threshold pressures of pressure-dependent creep, in increasing order
  std::vector<double> hinge_ladder_s;  ///< time constants of the creep branches above each threshold pressure
                                       ///< (hinge)
  double shortest_period_s = 0;        ///< shortest period of a linear mode
};

/// Returns the thresholds, time constants and hinges that are used for these records. If the records contain
/// at most two cycles, the number of play operators is smaller.
[[nodiscard]] StructureGrid grid_for(const std::vector<Record>& records);

/// Returns the smallest instantaneous elastic gain of a structure that has an inverse [mm/kPa].
[[nodiscard]] double least_elastic_mm_per_kpa(const StructureGrid& grid);
/// Returns the longest period of a linear mode in a fit [s].
[[nodiscard]] double longest_mode_s(const StructureGrid& grid);

/// Components of a structure. An ablation removes each component once, to measure the error reduction by this
/// component.
enum class Ingredient {
  hysteresis,
  play_operators,  ///< play operators; after their removal, the structure has the Bouc-Wen element
  creep,
  slow_creep,
  pressure_dependent_creep,
  delay,
  lag,
  second_lag,
  rate_limit,
  latency,      ///< delay, lags and rate limit together, because delay and lag can largely replace each other
  regulator,    ///< regulator; after its removal, the structure has a lag
  venting_lag,  ///< separate time constant for venting; after its removal, the lag has one time constant
  /// Characteristic and envelopes together, because each of them can largely replace the other.
  characteristic,
  resonance,
  linear_modes,
  envelopes  ///< nonlinear envelopes of the play operators; after their removal, the operators are ordinary
             ///< ones
};
inline constexpr std::array all_ingredients{Ingredient::hysteresis,
                                            Ingredient::play_operators,
                                            Ingredient::creep,
                                            Ingredient::slow_creep,
                                            Ingredient::pressure_dependent_creep,
                                            Ingredient::delay,
                                            Ingredient::lag,
                                            Ingredient::second_lag,
                                            Ingredient::rate_limit,
                                            Ingredient::latency,
                                            Ingredient::regulator,
                                            Ingredient::venting_lag,
                                            Ingredient::characteristic,
                                            Ingredient::resonance,
                                            Ingredient::linear_modes,
                                            Ingredient::envelopes};
[[nodiscard]] std::string_view name_of(Ingredient ingredient);

/// Returns a copy of the structure without this component. If the structure does not contain the component,
/// returns the structure unchanged.
[[nodiscard]] BaseStructure without(BaseStructure s, Ingredient ingredient);

/// Returns true if the structure contains the component. For Ingredient::latency, returns true only if the
/// structure has both a delay and a lag. With only one of them, `latency` would repeat the entry for this
/// component.
[[nodiscard]] bool has(const BaseStructure& s, Ingredient ingredient);

}  // namespace softgrip::sysid
