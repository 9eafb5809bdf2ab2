#pragma once
/// @file
/// Measured logs of a finger, from arrays or from a file. The changelog announces every incompatible change.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <softgrip/export.h>
#include <softgrip/model.h>

namespace softgrip {

/// A measured log of one finger. All columns have one value per time. Optional columns may be empty. Fill the
/// arrays directly, or use read_log(). Each function that gets a log checks it.
struct Log {
  std::string name = {};                          ///< short name of the log for results and reports
  std::vector<double> time_s = {};                ///< times [s], increasing; the first time counts as 0
  std::vector<double> pressure_command_kpa = {};  ///< commanded pressure [kPa]; all values must be finite
  std::vector<double> displacement = {};          ///< readings in `unit`; NaN: the reading is missing
  std::vector<double> pressure_kpa = {};          ///< measured pressure [kPa], optional; NaN: the reading is
                                                  ///< missing
  std::vector<double> temperature_c = {};         ///< measured temperature [degrees Celsius], optional
  std::vector<double> supply_kpa = {};            ///< measured supply pressure [kPa], optional
  Unit unit = Unit::mm;                           ///< unit of the displacement readings
  std::string path = {};                          ///< path of the file of the log; empty: the log was created
                                                  ///< in memory
  std::string sha256 = {};                        ///< hash of the file; empty: the log was created in memory
  std::vector<std::string> notes = {};  ///< notes of the reader, such as the columns that an import assigned
};

/// Settings of read_log().
struct ReadOptions {
  std::string channel = {};  ///< name of the finger to read; empty if the file has only one finger
  bool import_file = true;   ///< true: a file that is not a log is converted as `softgrip import` proposes
  /// Column for each role (`time`, `command`, `pressure`, `displacement`, `temperature`, `supply`), given by
  /// its name or by its number from 1. For a role that is missing here, a column is proposed from the names
  /// and units of the columns. If the map is not empty, the file is always imported.
  std::map<std::string, std::string> columns = {};
  std::map<std::string, std::string> units =
      {};  ///< unit for each role whose unit the file does not state, for example `pressure`: `psi`
  std::optional<double> rate_hz = {};  ///< sampling rate of a file without times [Hz]
  std::string sheet = {};              ///< name of the sheet in a workbook
};

/// Reads a log of softgrip (CSV, or the folder of a recording). Converts a file of another program (text,
/// XLSX, TDMS, MCAP, MATLAB, HDF5); the notes of the result describe the conversion. Throws FileError with
/// all problems of the file. Throws InvalidArgument for options that do not exist.
[[nodiscard]] SOFTGRIP_API Log read_log(const std::string& path, const ReadOptions& options = {});

/// Writes a log as CSV. If this file is read, the columns are equal to those of `log`. Throws FileError and
/// InvalidArgument.
SOFTGRIP_API void write_log(const std::string& path, const Log& log);

/// Checks a log as `softgrip identify` does. Throws InvalidArgument, whose text names the column, the
/// expected values and the unit.
SOFTGRIP_API void check(const Log& log);

/// The input signal of the model.
enum class Drive : std::uint8_t {
  command,   ///< the commanded pressure, which is the input of the whole model
  measured,  ///< the measured pressure, which replaces the output of the valve blocks
};

/// The initial state of a log.
enum class Begin : std::uint8_t {
  automatic,  ///< the initial state is determined from the log
  rest,       ///< the finger is at rest under the first pressure
  unknown,    ///< the state is unknown and is estimated from the readings
};

/// Settings for the use of logs. They correspond to the options --drive, --begin and --held of `softgrip`.
struct LogUse {
  Drive drive = Drive::command;    ///< pressure that is the input of the model
  Begin begin = Begin::automatic;  ///< initial state of each log
  bool held = false;               ///< true: the command keeps its value until the next sample; false: it is
                                   ///< linear between samples
};

}  // namespace softgrip
