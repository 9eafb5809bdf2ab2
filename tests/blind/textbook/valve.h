#pragma once
// A model of an electro-pneumatic pressure regulator from textbook equations. It consists of a spool with ISO
// 6358 ports, a tube, and the volume of the finger. Pressures are absolute, in kPa; volumes are in dm3;
// conductances are in dm3/(s kPa) at the reference state.

namespace textbook {

inline constexpr double atmosphere_kpa = 101.325;
inline constexpr double reference_kpa = 100;  // reference pressure of ISO 8778

/// Returns the flow of ISO 6358-1 [dm3/s at the reference state] from `from_kpa` to `to_kpa`. The flow is
/// negative if the gas flows from `to_kpa` to `from_kpa`. At and below the critical pressure ratio `b`, the
/// flow is choked. Above a pressure ratio of 0.995, the function is linear, because the slope of the standard
/// becomes infinite at the ratio 1.
double flow_dm3_s(double conductance, double b, double from_kpa, double to_kpa) noexcept;

struct ValveNumbers {
  double port_conductance = 0.006;
  double tube_conductance = 0.012;
  double leak_conductance = 0;
  double critical_ratio = 0.3;
  double valve_volume_dm3 = 0.02, finger_volume_dm3 = 0.08;
  double proportional_per_kpa = 0.08, integral_per_kpa_s = 0.25;
  double spool_lag_s = 0.012;
  double overlap = 0.04;               // overlap of the spool in each direction, as a fraction of the spool
                                       // travel
  double pilot_hysteresis_kpa = 0.15;  // half the width of the hysteresis loop of the pilot stage
};

/// A valve with isothermal chambers. The pressure p of a chamber with the volume V follows V dp/dt =
/// reference pressure x flow.
class Valve {
 public:
  explicit Valve(const ValveNumbers& numbers) noexcept : numbers_(numbers) {}
  /// Simulates one step of `step_s`, which may be at most 0.25 ms with the default parameters.
  void step(double command_kpa, double supply_kpa, double step_s) noexcept;
  double gauge_kpa() const noexcept { return finger_kpa_ - atmosphere_kpa; }
  double air_kpa_dm3() const noexcept {
    return valve_kpa_ * numbers_.valve_volume_dm3 + finger_kpa_ * numbers_.finger_volume_dm3;
  }
  /// Sets the pressures for a test. If `shut` is true, the spool remains closed after this call.
  void set(double valve_kpa, double finger_kpa, bool shut) noexcept;

 private:
  ValveNumbers numbers_;
  double valve_kpa_ = atmosphere_kpa, finger_kpa_ = atmosphere_kpa;
  double pilot_kpa_ = 0, integral_ = 0, spool_ = 0;
  bool shut_ = false;
};

}  // namespace textbook
