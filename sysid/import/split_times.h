#pragma once
// Times in two columns, as a header of ROS has them: whole seconds, and the nanoseconds after them.

#include <string>
#include <vector>

#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Adds the nanoseconds to the seconds where two columns differ in their last word alone: "stamp.sec" and
/// "stamp.nanosec", "secs" and "nsecs". The values decide, too: nanoseconds are from 0 to below 1e9, and
/// seconds are whole. The column of the nanoseconds is marked. Each pair is named in `notes`.
void combine_split_times(std::vector<TableColumn>& columns, std::vector<std::string>& notes);

}  // namespace softgrip::sysid
