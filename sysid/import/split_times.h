#pragma once
// Combines a time that is split into two columns, whole seconds and remaining nanoseconds, as in a ROS
// message header.

#include <string>
#include <vector>

#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Adds the nanoseconds of one column to the seconds of another column if the column names differ only in
/// their last word: "stamp.sec" and "stamp.nanosec", or "secs" and "nsecs". Both columns must contain whole
/// numbers, and the nanoseconds must be from 0 to below 1e9. The column of the nanoseconds is marked as part
/// of a time (TableColumn::is_part_of_time). A note is added to `notes` for each pair of combined columns.
void combine_split_times(std::vector<TableColumn>& columns, std::vector<std::string>& notes);

}  // namespace softgrip::sysid
