#pragma once
// The structures that a finger's base may have. With q the driving pressure behind dead time and lag:
//
//   z = hysteresis(b(q)) + sum_j c_j creep_j(q),   tau_j creep_j' = q - creep_j,   y = g(z) + offset
//
// b: the envelopes of model::EnvelopeMap, of generalised plays, or b(q) = q.
// hysteresis: play operators, sum_i w_i play_(r_i)(q) (Prandtl-Ishlinskii; Kuhnen, European Journal of
// Control 9, 2003), or Bouc-Wen's element with exponent 1. Weights are not negative, so that every fitted
// model is monotone in its newest pressure and has an inverse. g is the block `characteristic`.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace softgrip::sysid {

enum class HysteresisForm { bouc_wen, play };

/// Which ingredients a structure has.
struct BaseStructure {
  HysteresisForm hysteresis = HysteresisForm::play;
  bool hysteretic = true;      ///< false: the elastic gain alone
  bool creep = true;           ///< a ladder of Kelvin-Voigt branches
  bool slow_creep = true;      ///< the ladder reaches beyond a tenth of the longest record
  bool delay = true;           ///< dead time between the drive and the finger
  bool lag = true;             ///< a first-order lag behind it
  bool two_way = true;         ///< filling and venting have a time constant each
  bool second_lag = false;     ///< another lag in front of the first, both directions alike
  bool regulator = false;      ///< the lag is that of a regulator with an overlap, see RegulatedPressure
  bool characteristic = true;  ///< a bent, monotone map behind the sum
  bool resonance = false;      ///< a second-order mode behind the map, see with_resonance()
  bool envelopes = false;      ///< the plays are generalised ones: their envelopes are bent
  bool hinged_creep = false;   ///< creep that depends on the pressure: a short ladder behind every hinge
  bool wandering = false;      ///< beside it every record's zero wanders as it likes; no part of the finger
  /// The published element: Bouc-Wen and two Kelvin-Voigt branches whose time constants are searched too, one
  /// lag.
  bool published = false;

  bool operator==(const BaseStructure&) const = default;
};

/// "prandtl_ishlinskii" or "bouc_wen", as `softgrip identify --structure` calls it.
[[nodiscard]] std::string_view name_of(HysteresisForm form);
/// "play operators, creep ladder, delay, lag (filling and venting), characteristic"
[[nodiscard]] std::string description_of(const BaseStructure& structure);

/// What stays fixed while a structure is fitted: where its operators stand.
struct StructureGrid {
  double largest_kpa = 0;              ///< of the drive's magnitude
  double span_mm = 0;                  ///< of the readings, from zero
  std::vector<double> thresholds_kpa;  ///< of the plays besides the elastic one, ascending
  std::vector<double> ladder_s;        ///< time constants of the creep branches, ascending
  double slow_from_s = 0;              ///< branches from here on are slow creep
  std::vector<double> hinges_kpa;      ///< where pressure-dependent creep begins, ascending
  std::vector<double> hinge_ladder_s;  ///< its time constants
};

/// The numbers of a structure that its reading does not depend on linearly.
struct NonlinearNumbers {
  double delay_s = 0;
  double filling_s = 0;  ///< time constant while the pressure rises; 0: none
  double venting_s = 0;
  double second_s = 0;        ///< of the second lag
  double pilot_band_kpa = 0;  ///< regulator: of the command, ignored after a reversal
  double overlap_kpa = 0;     ///< regulator: as in RegulatorNumbers, like the next two
  double integral_s = 0;
  double full_open_kpa = 0;
  double curvature = 0;        ///< of the characteristic
  double growing_per_kpa = 0;  ///< Bouc-Wen: gamma + eta
  double narrowing = 0.5;      ///< Bouc-Wen: eta / (gamma + eta), in (0, 1]
  double trained_kpa = 0;      ///< plays: the largest load before the logs
  double envelope_bend = 0;    ///< as in model::EnvelopeMap, like the next one
  double envelope_skew = 0;
  std::vector<double> peak_before_kpa;  ///< by record, see StartState; of records that start from rest 0

  bool operator==(const NonlinearNumbers&) const = default;
};

}  // namespace softgrip::sysid
