#include "tests/world/recordings.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

namespace softgrip::world {
namespace {

/// Returns the first column of a CSV file, converted from seconds to nanoseconds.
std::vector<Nanoseconds> times_of(const std::filesystem::path& file) {
  std::vector<Nanoseconds> times;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) times.push_back(nanoseconds(std::strtod(line.c_str(), nullptr)));
  return times;
}

}  // namespace

RecordingsRead check_recordings(const std::string& folder, const std::vector<Nanoseconds>& ticks,
                                std::size_t channels) {
  RecordingsRead read;
  if (!std::filesystem::exists(folder)) return read;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().filename() != "run.csv") continue;
    const std::vector<Nanoseconds> times = times_of(entry.path());
    read.rows += times.size();
    if (times.empty()) continue;
    // The times of a recording are relative to its first row, but the ticks have the time of the daemon.
    // Therefore only time differences are compared.
    bool found = false;
    for (std::size_t first = 0; first < ticks.size() && !found; ++first) {
      bool all = true;
      for (std::size_t row = 0; row < times.size() && all; row += channels) {
        const std::size_t tick = first + row / channels;
        // The last row of each channel is written at shutdown, and no tick exists for it.
        if (tick >= ticks.size()) {
          all = row + channels >= times.size();
          break;
        }
        all = std::llabs(times[row] - times[0] - (ticks[tick] - ticks[first])) <= 2000;
      }
      found = all;
    }
    if (!found)
      read.lack = fmt::format("{}: its {} rows do not match consecutive ticks",
                              entry.path().parent_path().filename().string(), times.size());
  }
  return read;
}

}  // namespace softgrip::world
