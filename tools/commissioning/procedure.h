#pragma once
// The steps of a calibration, with somebody who reads gauges.

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "control/elements/limits.h"
#include "tools/commissioning/line_fit.h"
#include "tools/commissioning/motion_session.h"

namespace softgrip::rig {
struct RigFile;
}

namespace softgrip::tools::calibrate {

/// Whoever is asked: a person at a terminal, a script, a test.
class Operator {
 public:
  Operator() = default;
  Operator(const Operator&) = delete;
  Operator& operator=(const Operator&) = delete;
  Operator(Operator&&) = delete;
  Operator& operator=(Operator&&) = delete;
  virtual ~Operator() = default;
  virtual void tell(const std::string& text) = 0;
  virtual void ask(const std::string& question) = 0;
  /// What was answered to the last question; nothing yet: nothing. Does not wait.
  [[nodiscard]] virtual std::optional<std::string> answer() = 0;
  /// No answer will come any more.
  [[nodiscard]] virtual bool gone() const = 0;
  /// A nonsensical answer is asked for again as often as it takes; else some times.
  [[nodiscard]] virtual bool patient() const = 0;
};

struct Settings {
  std::size_t channel = 0;
  bool may_move = false;
  double low_kpa = 0;  ///< commands of the two places, where the rig moves by itself
  double high_kpa = 0;
  double settle_s = 2;  ///< after every motion
  double average_s = 2;
  std::size_t repeats = 1;  ///< visits to each place
  double ramp_s = 10;       ///< of the dead zone's ramp
};

/// Sets the two places a sixth and two thirds of the way from rest to the further limit.
void set_places(Settings& settings, const control::LimitSettings& limits);

/// Why there is no calibration, and what the program exits with.
struct Refusal {
  ExitCode code = ExitCode::failed;
  std::string text;
};
template <class T>
using Expected = tl::expected<T, Refusal>;

/// The number that somebody typed, decimal comma or point; nothing if it is none.
[[nodiscard]] std::optional<double> typed_number(std::string text);

/// How fast a finger is moved: so slowly that the line follows.
[[nodiscard]] double ramp_speed_kpa_per_s(const rig::RigFile& rig, std::size_t channel);

/// The displacement sensor against a gauge: the finger is moved to both places, or, without `may_move`,
/// somebody puts the target there.
[[nodiscard]] Expected<Line> calibrate_sensor(const rig::RigFile& rig, MotionSession& session,
                                              Operator& person, const Settings& settings);

/// What the sensor read while its target was held at a position.
struct GaugeVisit {
  double position_mm = 0;  ///< by the gauge
  double reading_mm = 0;   ///< mean
  std::size_t count = 0;   ///< readings in the mean
};
/// Somebody holds the target at each of these positions in turn, or says where else it is, or leaves one out;
/// nothing moves by itself. Positions where the sensor cannot measure are left out.
[[nodiscard]] Expected<std::vector<GaugeVisit>> read_positions(MotionSession& session, Operator& person,
                                                               const Settings& settings,
                                                               const std::vector<double>& positions_mm);

struct ValveResult {
  Line valve;
  std::optional<Line> monitor;  ///< if there is one and a manometer told the truth
  bool by_monitor = false;      ///< the pressure monitor was the reference
};
/// The valve against a manometer, or against the rig's own pressure monitor (`by_monitor`).
[[nodiscard]] Expected<ValveResult> calibrate_valve(const rig::RigFile& rig, MotionSession& session,
                                                    Operator& person, const Settings& settings,
                                                    bool by_monitor);

struct DeadZoneResult {
  std::optional<DeadZone> zone;  ///< nothing: the response did not rise
  bool by_pressure = false;      ///< judged by the pressure monitor; else by the finger, which is weaker
  double highest_kpa = 0;        ///< how far the ramp went
};
/// A slow ramp from the rest pressure, on the larger side of it.
[[nodiscard]] Expected<DeadZoneResult> search_dead_zone(const rig::RigFile& rig, MotionSession& session,
                                                        Operator& person, const Settings& settings);

/// Share of the valve's range that the limits use; below a fifth resolution and linearity suffer.
[[nodiscard]] double share_of_valve(const rig::RigFile& rig, std::size_t channel);
inline constexpr double least_share_of_valve = 0.2;

}  // namespace softgrip::tools::calibrate
