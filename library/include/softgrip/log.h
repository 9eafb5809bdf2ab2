#pragma once
/// @file
/// Declares the measured logs of a finger, from arrays or from a file. The changelog announces every
/// incompatible change of this interface.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <softgrip/export.h>
#include <softgrip/model.h>

namespace softgrip {

/// A measured log of one finger. Each column has one value per time. Optional columns may be empty. Fill the
/// columns directly, or use read_log(). Each function of the library that gets a log checks the log first.
struct Log {
  std::string name = {};                          ///< short name of the log for results and reports
  std::vector<double> time_s = {};                ///< times of the samples [s], increasing; the first time is
                                                  ///< taken as 0
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
  std::vector<std::string> notes = {};  ///< notes of read_log(), such as the columns that an import assigned
                                        ///< to the roles
};

/// Settings of read_log().
struct ReadOptions {
  std::string channel = {};  ///< name of the finger to read; empty if the file has only one finger
  bool import_file = true;   ///< true: a file that is not a log of softgrip is converted with the assignment
                             ///< that `softgrip import` proposes
  /// Column for each role (`time`, `command`, `pressure`, `displacement`, `temperature`, `supply`). A column
  /// is given by its name or by its number, counted from 1. For a role that is not in the map, a column is
  /// chosen by the names and units of the columns. If `columns`, `rate_hz` or `sheet` is given, the file is
  /// always imported.
  std::map<std::string, std::string> columns = {};
  std::map<std::string, std::string> units =
      {};  ///< unit for each role whose unit is not in the file, for example `pressure`: `psi`
  std::optional<double> rate_hz = {};  ///< sampling rate of a file without times [Hz]
  std::string sheet = {};              ///< name of the sheet in a workbook
};

/// Reads a log of softgrip (CSV, or the folder of a recording). Converts a file of another program (text,
/// XLSX, TDMS, MCAP, MATLAB, HDF5); the notes of the result describe the conversion. Throws FileError with
/// all problems of the file. Throws InvalidArgument for an unknown role and for an invalid sampling rate.
[[nodiscard]] SOFTGRIP_API Log read_log(const std::string& path, const ReadOptions& options = {});

/// Writes a log as a CSV file. If read_log() reads this file, it returns columns that are equal to those of
/// `log`. The times of a log file start at 0, so the first time of `log` is subtracted from all times. Throws
/// FileError if the file cannot be written, and InvalidArgument if the log is invalid.
SOFTGRIP_API void write_log(const std::string& path, const Log& log);

/// Checks a log as `softgrip identify` does. Throws InvalidArgument if the log is invalid. The text of the
/// exception names the column, the expected values and the unit.
SOFTGRIP_API void check(const Log& log);

/// The input signal of the model.
enum class Drive : std::uint8_t {
  command,   ///< the commanded pressure is the input of the whole model
  measured,  ///< the measured pressure takes the place of the output of the valve blocks
};

/// The initial state of a log.
enum class Begin : std::uint8_t {
  automatic,  ///< `rest` if the first pressure is nearly 0, otherwise `unknown`
  rest,       ///< the finger is at rest under the first pressure
  unknown,    ///< the state is unknown and is estimated from the readings
};

/// Settings for the use of logs. They correspond to the options --drive, --begin and --held of `softgrip`.
struct LogUse {
  Drive drive = Drive::command;    ///< pressure that is the input of the model
  Begin begin = Begin::automatic;  ///< initial state of each log
  bool held = false;               ///< true: the command keeps its value until the next sample; false: the
                                   ///< command is linear between samples
};

}  // namespace softgrip
