#pragma once
// Defines the samples of an external file before their conversion to a log, and the rules by which some
// samples are left out.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sysid/import/account.h"
#include "sysid/import/mapping.h"

namespace softgrip::sysid {

/// Samples of an external file. All vectors that are not empty have the same length. NaN is a missing value.
struct ForeignSamples {
  std::array<std::vector<double>, role_count>
      values;  ///< values for each role, in the units of a log; empty: the file has no column for this role
  std::vector<std::size_t> row;  ///< for each sample, the index of its row in the table
  /// Time of the first sample, relative to the first sample of the file with a time [s].
  double begin_s = 0;

  [[nodiscard]] std::vector<double>& operator[](Role role) { return values[static_cast<std::size_t>(role)]; }
  [[nodiscard]] const std::vector<double>& operator[](Role role) const {
    return values[static_cast<std::size_t>(role)];
  }
  [[nodiscard]] std::size_t size() const noexcept { return row.size(); }
};

/// The reason why the samples cannot become a log, and the row in which the reason was found.
struct SampleProblem {
  std::size_t row = 0;
  std::string message;
  std::string hint;
};

/// Row counts, notes and warnings of an import.
struct ImportRemarks {
  RowAccount account;
  std::vector<std::string> notes;
  std::vector<std::string> warnings;
};

/// Makes the times relative to the first sample and rounds them. The rounding step is the resolution of a
/// double at the magnitude of the times, but at least 1e-9 s. Leaves out samples without a time and samples
/// outside the range from `from_s` to `to_s` of the mapping. Merges samples with the same time if one of them
/// has a value that the other does not have, and no role has two different values; otherwise keeps only the
/// first of them. A time that decreases is a problem.
/// @param groups  about_groups() (row_groups.h), if a column separates the rows of several runs or devices,
/// otherwise empty. Problems and warnings about decreasing and repeated times then contain this text.
[[nodiscard]] std::optional<SampleProblem> order_in_time(const Mapping& mapping, ForeignSamples& samples,
                                                         ImportRemarks& remarks,
                                                         const std::string& groups = {});

/// Completes the command. A missing command is replaced by the previous command. Samples before the first
/// command are left out. If the file has no command, the measured pressure is used as the command. Samples
/// without a displacement are kept.
/// @param samples  must not be empty.
void complete_drive(ForeignSamples& samples, ImportRemarks& remarks);

/// Keeps the longest segment between two gaps and reports the other segments. The reported times count from
/// the first sample of the file, as the options --from-s and --to-s do. A gap is an interval between
/// two samples that fulfils three conditions: it is longer than 0.5 s, it is longer than 20 usual intervals,
/// and the command changes during this interval by more than 2 % of the range of all commands. The usual
/// interval and the range of the kept segment differ from those of the file, so the kept segment is searched
/// for gaps again until it contains none. The motion of the finger during a gap is unknown.
void cut_at_holes(ForeignSamples& samples, ImportRemarks& remarks);

}  // namespace softgrip::sysid
