#include "sysid/changes/drive_choice.h"

#include <cmath>
#include <numeric>

#include "base/statistics.h"
#include "sysid/changes/base.h"
#include "sysid/changes/filter_fit.h"
#include "sysid/evidence/tolerance.h"

namespace softgrip::sysid {
namespace {

double rms(const std::vector<double>& squares, const std::vector<double>& rows) {
  const double count = std::accumulate(rows.begin(), rows.end(), 0.0);
  return count > 0 ? std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0) / count) : 0;
}

}  // namespace

DriveChoice chosen_drive(const std::vector<Record>& by_pressure, const std::vector<Record>& by_command,
                         std::uint64_t seed, unsigned threads) {
  const double bin_s = finger_bin_s(by_pressure);
  const Units units(by_pressure);
  const PairedLosses losses =
      losses_of(left_out_by_play(by_pressure, Drive::measured, bin_s, threads),
                left_out_by_play(by_command, Drive::command, bin_s, threads), units, bin_s);
  DriveChoice choice{Drive::measured, rms(losses.worse, losses.rows), rms(losses.better, losses.rows)};
  const bool beyond_spread =
      square(choice.by_pressure_mm) > run_to_run_factor(units.runs()) * square(choice.by_command_mm);
  if (beyond_spread && is_better(compare(losses, 0, seed))) choice.drive = Drive::command;
  return choice;
}

}  // namespace softgrip::sysid
