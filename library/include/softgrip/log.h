#pragma once
/// @file
/// Logs: measured runs of a finger, from arrays or from a file. Stable.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <softgrip/export.h>
#include <softgrip/model.h>

namespace softgrip {

/// One measured run of one finger. All columns have one value per time; optional columns may be empty.
/// Fill the arrays directly, or use read_log(). Functions that take logs check them.
struct Log {
  std::string name = {};                          ///< short name for results and reports
  std::vector<double> time_s = {};                ///< times [s], increasing. The first one counts as 0
  std::vector<double> pressure_command_kpa = {};  ///< commanded pressure [kPa], finite
  std::vector<double> displacement = {};          ///< readings in `unit`; NaN: no reading
  std::vector<double> pressure_kpa = {};          ///< measured pressure [kPa], optional; NaN: no reading
  std::vector<double> temperature_c = {};         ///< temperature [degrees Celsius], optional
  std::vector<double> supply_kpa = {};            ///< supply pressure [kPa], optional
  Unit unit = Unit::mm;                           ///< unit of the displacement
  std::string path = {};                          ///< file of the log; empty: created in memory
  std::string sha256 = {};                        ///< hash of the file; empty: created in memory
  std::vector<std::string> notes = {};  ///< findings of the reader, such as the mapping of an import
};

/// Settings of read_log().
struct ReadOptions {
  std::string channel = {};  ///< the finger to read; empty if the file has only one
  bool import_file = true;   ///< if the file is not a log, convert it as `softgrip import` proposes
  /// Column for each role (`time`, `command`, `pressure`, `displacement`, `temperature`, `supply`), as its
  /// name or its number from 1. For absent roles, names and units of the columns determine a proposal. If the
  /// map is not empty, the file is always imported.
  std::map<std::string, std::string> columns = {};
  std::map<std::string, std::string> units =
      {};  ///< unit for each role, if the file does not state it: `pressure`: `psi`
  std::optional<double> rate_hz = {};  ///< sampling rate of a file without times [Hz]
  std::string sheet = {};              ///< name of the sheet in a workbook
};

/// Reads a log of softgrip (CSV, a folder of a recording), or converts a file of another program (text, XLSX,
/// TDMS, MCAP, MATLAB, HDF5). The notes of the result state how a file was converted.
/// Throws FileError with all problems, and InvalidArgument for options that do not exist.
[[nodiscard]] SOFTGRIP_API Log read_log(const std::string& path, const ReadOptions& options = {});

/// Writes a log as CSV. Reading it back gives equal columns. Throws FileError and InvalidArgument.
SOFTGRIP_API void write_log(const std::string& path, const Log& log);

/// Checks a log as `softgrip identify` does. Throws InvalidArgument, which names the column, the expected
/// values and the unit.
SOFTGRIP_API void check(const Log& log);

/// Input signal of the model.
enum class Drive : std::uint8_t {
  command,   ///< the commanded pressure, the input of the whole model
  measured,  ///< the measured pressure, the input after the blocks of the valve
};

/// Known initial state of a log.
enum class Begin : std::uint8_t {
  automatic,  ///< determined from the log
  rest,       ///< at rest under the first pressure
  unknown,    ///< estimated from the readings
};

/// Interpretation of logs. The options --drive, --begin and --held of `softgrip` have the same meaning.
struct LogUse {
  Drive drive = Drive::command;    ///< input signal of the model
  Begin begin = Begin::automatic;  ///< the initial state
  bool held = false;               ///< the command keeps its value until the next sample
};

}  // namespace softgrip
