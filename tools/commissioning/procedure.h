#pragma once
// The steps of a calibration. A person reads the gauges.

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

/// Answers questions: a person at a terminal, a script or a test.
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
  /// Returns the answer to the last question, or nullopt if there is none yet. Does not wait.
  [[nodiscard]] virtual std::optional<std::string> answer() = 0;
  /// Returns true if no further answer can come.
  [[nodiscard]] virtual bool gone() const = 0;
  /// Returns true if a question is repeated without limit after invalid answers. Otherwise the number of
  /// repetitions is limited.
  [[nodiscard]] virtual bool patient() const = 0;
};

struct Settings {
  std::size_t channel = 0;
  bool may_move = false;
  double low_kpa = 0;  ///< commands of the two positions; used if the rig moves the finger
  double high_kpa = 0;
  double settle_s = 2;  ///< wait after every motion
  double average_s = 2;
  std::size_t repeats = 1;  ///< visits to each position
  double ramp_s = 10;       ///< duration of the ramp for the dead zone
};

/// Sets the two positions to 1/6 and 2/3 of the way from the rest pressure to the pressure limit that is
/// further away.
void set_places(Settings& settings, const control::LimitSettings& limits);

/// The reason why there is no calibration, and the exit code of the program.
struct Refusal {
  ExitCode code = ExitCode::failed;
  std::string text;
};
template <class T>
using Expected = tl::expected<T, Refusal>;

/// Parses a typed number with decimal comma or point. Returns nullopt if the text is not a number.
[[nodiscard]] std::optional<double> typed_number(std::string text);

/// Returns a ramp speed that is slow enough for the pressure in the line to follow the command [kPa/s].
[[nodiscard]] double ramp_speed_kpa_per_s(const rig::RigFile& rig, std::size_t channel);

/// Calibrates the displacement sensor against a gauge. With `may_move`, the rig moves the finger to both
/// positions. Otherwise a person moves the sensor's target.
[[nodiscard]] Expected<Line> calibrate_sensor(const rig::RigFile& rig, MotionSession& session,
                                              Operator& person, const Settings& settings);

/// The mean reading of the sensor while its target was held at a position.
struct GaugeVisit {
  double position_mm = 0;  ///< position by the gauge
  double reading_mm = 0;   ///< mean reading
  std::size_t count = 0;   ///< number of readings in the mean
};
/// Reads the sensor while a person holds the target at each of these positions in turn. The person may enter
/// another position or skip one. The rig moves nothing. Positions where the sensor cannot measure are left
/// out.
[[nodiscard]] Expected<std::vector<GaugeVisit>> read_positions(MotionSession& session, Operator& person,
                                                               const Settings& settings,
                                                               const std::vector<double>& positions_mm);

struct ValveResult {
  Line valve;
  std::optional<Line> monitor;  ///< nullopt: there is no pressure monitor, or it was the reference itself
  bool by_monitor = false;      ///< the pressure monitor was the reference
};
/// Calibrates the valve against a manometer, or against the rig's own pressure monitor (`by_monitor`).
[[nodiscard]] Expected<ValveResult> calibrate_valve(const rig::RigFile& rig, MotionSession& session,
                                                    Operator& person, const Settings& settings,
                                                    bool by_monitor);

struct DeadZoneResult {
  std::optional<DeadZone> zone;  ///< nullopt: the response did not rise
  bool by_pressure = false;  ///< true: found in the pressure monitor; false: found in the displacement, which
                             ///< is less reliable
  double highest_kpa = 0;    ///< end of the ramp [kPa]
};
/// Searches for the dead zone with a slow ramp from the rest pressure towards the pressure limit that is
/// further away.
[[nodiscard]] Expected<DeadZoneResult> search_dead_zone(const rig::RigFile& rig, MotionSession& session,
                                                        Operator& person, const Settings& settings);

/// Returns the share of the valve's pressure range that lies within the limits. Below 20 %, resolution and
/// linearity suffer.
[[nodiscard]] double share_of_valve(const rig::RigFile& rig, std::size_t channel);
inline constexpr double least_share_of_valve = 0.2;

}  // namespace softgrip::tools::calibrate
