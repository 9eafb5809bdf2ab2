#pragma once
// Contains the parts that the programs that simulate worlds have in common: logs, effects as numbers, command
// lines and files. It contains no physics of a finger.

#include <cstddef>
#include <functional>
#include <map>
#include <ostream>
#include <string>
#include <vector>

namespace worlds {

/// Parameters of a hidden effect, by the name of the parameter. The map Effects contains the parameters of
/// each effect, by the id of the effect. The id of an effect is the id of a cause in the catalogue, or the id
/// of an effect that the catalogue does not contain.
using Numbers = std::map<std::string, double>;
using Effects = std::map<std::string, Numbers>;

/// An effect that is scaled to a requested error.
struct Scaled {
  Numbers numbers;
  double excess_mm = 0;   ///< RMS error [mm] of a model that is refitted without the scaled effect
  bool reachable = true;  ///< false: no amplitude of the effect causes the requested error
};

/// Inputs of one log, one value per sample.
struct Log {
  double rate_hz = 100;
  std::vector<double> command_kpa;  // command [kPa], linear between samples
  std::vector<double> temperature_c;
  std::vector<double> supply_kpa;  // gauge pressure
  // Run-to-run variation of this log, see variation.h.
  double gain = 1, offset_mm = 0;
  std::size_t unrecorded = 0;  // number of samples at the start that are simulated but not recorded
  // Only in closed loop: a controller follows this reference from the first recorded sample on. `noise_mm` is
  // the noise of the controller's sensor, one value per recorded sample.
  std::vector<double> reference_mm, noise_mm;
};

/// Outputs of one log.
struct Answer {
  std::vector<double> command_kpa;      // command that was played [kPa]; in closed loop, the command of the
                                        // controller
  std::vector<double> pressure_kpa;     // true pressure at the actuator [kPa]
  std::vector<double> displacement_mm;  // displacement [mm], without noise and quantisation
};

/// Removes the first `log.unrecorded` samples from a log and from its outputs. These samples are simulated,
/// but the recording begins after them.
void drop_unrecorded(Log& log, Answer& answer);
double duration_s(const std::vector<Log>& logs);
/// Returns the RMS [mm] of the displacement change between two simulations, over all recorded samples. The
/// mean change of each log is subtracted first. Must be called before drop_unrecorded().
double recorded_change_mm(const std::vector<Log>& logs, const std::vector<Answer>& changed,
                          const std::vector<Answer>& unchanged);

/// Returns the ids in a list with commas.
std::vector<std::string> ids_in(const std::string& list);

/// Reads a command line. Each option has its own function.
class Options {
 public:
  /// Adds an option without a value.
  void flag(const std::string& name, std::function<void()> set) { flags_[name] = std::move(set); }
  void flag(const std::string& name, bool& value, bool to = true) {
    flag(name, [&value, to] { value = to; });
  }
  /// Adds an option with a value.
  void value(const std::string& name, std::function<void(const std::string&)> set) {
    values_[name] = std::move(set);
  }
  void value(const std::string& name, std::string& into) {
    value(name, [&into](const std::string& text) { into = text; });
  }
  void value(const std::string& name, double& into) {
    value(name, [&into](const std::string& text) { into = std::stod(text); });
  }
  void value(const std::string& name, std::size_t& into) {
    value(name, [&into](const std::string& text) { into = std::stoull(text); });
  }
  /// Calls the functions of all given options. Throws std::invalid_argument for an unknown option and for a
  /// missing value.
  void read(int argc, char** argv) const;

 private:
  std::map<std::string, std::function<void()>> flags_;
  std::map<std::string, std::function<void(const std::string&)>> values_;
};

/// Writes the members "recorded_change_mm" and "effects" of a file with the truth, and the end of this file.
/// @param change_mm  result of recorded_change_mm() for these effects.
void write_effects(std::ostream& file, const std::map<std::string, Scaled>& hidden, double change_mm);

/// Returns the exit code of a program: the result of `run`, or 2 with a message if `run` throws.
int exit_code_of(const char* program, const std::function<int()>& run);

}  // namespace worlds
