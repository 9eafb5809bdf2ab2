#pragma once
// Combines times that are split into two columns, as in a header of ROS: whole seconds, and the remaining
// nanoseconds.

#include <string>
#include <vector>

#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Adds the nanoseconds of one column to the seconds of another if the names of the columns differ only in
/// their last word: "stamp.sec" and "stamp.nanosec", "secs" and "nsecs". Both columns must contain whole
/// numbers, and nanoseconds must be from 0 to below 1e9. The column of the nanoseconds is marked as used.
/// `notes` names each pair.
void combine_split_times(std::vector<TableColumn>& columns, std::vector<std::string>& notes);

}  // namespace softgrip::sysid
