#pragma once
// The steps of a calibration, in which a person reads the gauges.
// Asks a person at the terminal, or a script that writes to the standard input.

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "base/net/line_buffer.h"
#include "control/elements/limits.h"
#include "tools/commissioning/line_fit.h"
#include "tools/commissioning/motion_session.h"

namespace softgrip::rig {
struct RigFile;
}

namespace softgrip::tools::calibrate {

/// Answers questions during a calibration. The operator can be a person at a terminal, a script or a test.
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
  /// Returns the answer to the last question; nullopt if the answer has not arrived. Does not wait.
  [[nodiscard]] virtual std::optional<std::string> answer() = 0;
  /// Returns true if the operator cannot give any more answers.
  [[nodiscard]] virtual bool gone() const = 0;
  /// Returns true if the program may repeat a question without limit after invalid answers. If it returns
  /// false, the number of repetitions is limited.
  [[nodiscard]] virtual bool patient() const = 0;
};

struct Settings {
  std::size_t channel = 0;
  bool may_move = false;
  double low_kpa = 0;  ///< command of the lower position [kPa]; the two commands are used if the rig moves
                       ///< the finger
  double high_kpa = 0;
  double settle_s = 2;  ///< wait after every motion [s]
  double average_s = 2;
  std::size_t repeats = 1;  ///< number of visits to each position
  double ramp_s = 10;       ///< duration of the ramp with which the dead zone is searched [s]
};

/// Sets the pressures of the two positions. They are at 1/6 and at 2/3 of the way from the rest pressure to
/// the pressure limit that is farther from rest.
void set_places(Settings& settings, const control::LimitSettings& limits);

/// The reason why the calibration has no result, and the exit code of the program.
struct Refusal {
  ExitCode code = ExitCode::failed;
  std::string text;
};
template <class T>
using Expected = tl::expected<T, Refusal>;

/// Parses a number that a person typed, with decimal comma or point. Returns nullopt if the text is not a
/// number.
[[nodiscard]] std::optional<double> typed_number(std::string text);

/// Returns a ramp speed at which the pressure in the line can follow the command [kPa/s].
[[nodiscard]] double ramp_speed_kpa_per_s(const rig::RigFile& rig, std::size_t channel);

/// Calibrates the displacement sensor against a gauge. If `may_move` is true, the rig moves the finger to
/// both positions. Otherwise a person moves the sensor's target.
[[nodiscard]] Expected<Line> calibrate_sensor(const rig::RigFile& rig, MotionSession& session,
                                              Operator& person, const Settings& settings);

/// The mean reading of the sensor while its target was held at a position.
struct GaugeVisit {
  double position_mm = 0;  ///< position that the gauge shows
  double reading_mm = 0;   ///< mean reading of the sensor
  std::size_t count = 0;   ///< number of readings in reading_mm
};
/// Reads the sensor while a person holds its target at one position after the other. The person may enter a
/// different position or skip a position. The rig moves nothing. A position at which the sensor gives an
/// invalid reading is not part of the result.
[[nodiscard]] Expected<std::vector<GaugeVisit>> read_positions(MotionSession& session, Operator& person,
                                                               const Settings& settings,
                                                               const std::vector<double>& positions_mm);

struct ValveResult {
  Line valve;
  std::optional<Line> monitor;  ///< calibrated line of the pressure monitor; nullopt: the channel has no
                                ///< pressure monitor, or the pressure monitor was the reference
  bool by_monitor = false;      ///< true: the reference was the pressure monitor; false: the reference was a
                                ///< manometer
};
/// Calibrates the valve against a manometer. If `by_monitor` is true, calibrates it against the channel's
/// pressure monitor instead.
[[nodiscard]] Expected<ValveResult> calibrate_valve(const rig::RigFile& rig, MotionSession& session,
                                                    Operator& person, const Settings& settings,
                                                    bool by_monitor);

struct DeadZoneResult {
  std::optional<DeadZone> zone;  ///< dead zone of the valve; search_dead_zone() always sets it
  bool by_pressure = false;      ///< true: the pressure monitor has measured the response; false: the
                                 ///< displacement sensor has measured it, which is less reliable
  double highest_kpa = 0;        ///< pressure at the end of the ramp [kPa]
};
/// Searches for the dead zone of the valve. A slow ramp begins at the rest pressure and goes towards the
/// pressure limit that is farther from rest.
[[nodiscard]] Expected<DeadZoneResult> search_dead_zone(const rig::RigFile& rig, MotionSession& session,
                                                        Operator& person, const Settings& settings);

/// Returns the share of the valve's pressure range that lies within the limits of the channel. Below a share
/// of 20 %, the resolution and linearity of the pressure are poor.
[[nodiscard]] double share_of_valve(const rig::RigFile& rig, std::size_t channel);
inline constexpr double least_share_of_valve = 0.2;

/// Writes questions to the standard error. Answers come first from the prepared answers. After the last
/// prepared answer, they are read line by line from the standard input.
class TerminalOperator final : public Operator {
 public:
  TerminalOperator();

  void prepare(const std::vector<std::string>& answers) { prepared_.assign(answers.begin(), answers.end()); }
  void tell(const std::string& text) override;
  void ask(const std::string& question) override;
  std::optional<std::string> answer() override;
  [[nodiscard]] bool gone() const override { return closed_ && !pending_.has_line(); }
  [[nodiscard]] bool patient() const override { return interactive_; }

 private:
  std::optional<std::string> take_line();

  bool interactive_;
  bool closed_ = false;
  net::LineBuffer pending_;
  std::deque<std::string> prepared_;
};

}  // namespace softgrip::tools::calibrate
