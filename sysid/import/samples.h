#pragma once
// The samples of a foreign file on their way into a log, and the rules by which some of them are left out.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sysid/import/mapping.h"

namespace softgrip::sysid {

/// All vectors that are not empty are equally long. NaN: nothing was there.
struct ForeignSamples {
  std::array<std::vector<double>, role_count>
      values;                    ///< in the units of a log; empty: the role is not there
  std::vector<std::size_t> row;  ///< of the table

  [[nodiscard]] std::vector<double>& operator[](Role role) { return values[static_cast<std::size_t>(role)]; }
  [[nodiscard]] const std::vector<double>& operator[](Role role) const {
    return values[static_cast<std::size_t>(role)];
  }
  [[nodiscard]] std::size_t size() const noexcept { return row.size(); }
};

/// Why no log can be made of the samples.
struct SampleProblem {
  std::size_t row = 0;
  std::string message;
  std::string hint;
};

/// Times from the first sample on, on whole steps of what a double of their size resolves (1e-9 s at best);
/// samples without a time are left out, those at the time of the one before too, and those outside of the
/// mapping's stretch. A time that goes back is a problem. What was done is added to `notes`.
[[nodiscard]] std::optional<SampleProblem> order_in_time(const Mapping& mapping, ForeignSamples& samples,
                                                         std::vector<std::string>& notes);

/// Where more than a fifth of the samples have no displacement, the sensor is slower than the log: those
/// without are left out. A command that is missing is the one before, and samples before the first are left
/// out. Without a command the measured pressure stands for it. There is a sample at least.
void complete_drive(ForeignSamples& samples, std::vector<std::string>& notes);

/// A hole: longer than 0.5 s and than twenty usual intervals, while the command changed by more than 2 % of
/// its range. What the finger did there nobody knows: the longest piece between holes is kept, the others are
/// said.
void cut_at_holes(ForeignSamples& samples, std::vector<std::string>& notes);

}  // namespace softgrip::sysid
