#pragma once
// The samples of a foreign file on their way into a log, and the rules by which some of them are left out.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sysid/import/account.h"
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

/// What was done with the samples.
struct ImportRemarks {
  RowAccount account;
  std::vector<std::string> notes;
  std::vector<std::string> warnings;
};

/// Times from the first sample on, on whole steps of what a double of their size resolves (1e-9 s at best);
/// samples without a time are left out, and those outside of the mapping's stretch. Samples at one time that
/// complete each other become one; of others the first stays. A time that goes back is a problem.
[[nodiscard]] std::optional<SampleProblem> order_in_time(const Mapping& mapping, ForeignSamples& samples,
                                                         ImportRemarks& remarks);

/// A command that is missing is the one before, and samples before the first are left out. Without a command
/// the measured pressure stands for it. A sample without a reading stays. There is a sample at least.
void complete_drive(ForeignSamples& samples, ImportRemarks& remarks);

/// A hole: longer than 0.5 s and than twenty usual intervals, while the command changed by more than 2 % of
/// its range. What the finger did there nobody knows: the longest piece between holes is kept, the others are
/// said.
void cut_at_holes(ForeignSamples& samples, ImportRemarks& remarks);

}  // namespace softgrip::sysid
