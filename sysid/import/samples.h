#pragma once
// The samples of an external file before they become a log, and the rules that leave out some of these
// samples.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sysid/import/account.h"
#include "sysid/import/mapping.h"

namespace softgrip::sysid {

/// All vectors that are not empty are equally long. NaN is a missing value.
struct ForeignSamples {
  std::array<std::vector<double>, role_count>
      values;                    ///< in the units of a log; empty: the file has no column for this role
  std::vector<std::size_t> row;  ///< row of the table for each sample

  [[nodiscard]] std::vector<double>& operator[](Role role) { return values[static_cast<std::size_t>(role)]; }
  [[nodiscard]] const std::vector<double>& operator[](Role role) const {
    return values[static_cast<std::size_t>(role)];
  }
  [[nodiscard]] std::size_t size() const noexcept { return row.size(); }
};

/// The reason why the samples cannot become a log, and the row that causes it.
struct SampleProblem {
  std::size_t row = 0;
  std::string message;
  std::string hint;
};

/// The account, notes and warnings of an import.
struct ImportRemarks {
  RowAccount account;
  std::vector<std::string> notes;
  std::vector<std::string> warnings;
};

/// Makes the times relative to the first sample. Rounds them to the resolution of a double of this size (1e-9
/// s or coarser). Leaves out samples without a time and samples outside from_s to to_s of the mapping. Merges
/// samples at one time if no role has a value in more than one of them; otherwise keeps only the first. A
/// time that decreases is a problem.
[[nodiscard]] std::optional<SampleProblem> order_in_time(const Mapping& mapping, ForeignSamples& samples,
                                                         ImportRemarks& remarks);

/// Completes the command. A missing value is replaced by the previous command, and samples before the first
/// command are left out. If the file has no command, the measured pressure is used instead. Samples without a
/// displacement are kept. `samples` must not be empty.
void complete_drive(ForeignSamples& samples, ImportRemarks& remarks);

/// Keeps the longest segment between gaps and reports the other segments. A gap is an interval that is longer
/// than 0.5 s and longer than 20 usual intervals, and over which the command changes by more than 2 % of its
/// range. The motion of the finger during a gap is unknown.
void cut_at_holes(ForeignSamples& samples, ImportRemarks& remarks);

}  // namespace softgrip::sysid
