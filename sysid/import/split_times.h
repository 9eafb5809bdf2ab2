#pragma once
// Times in two columns, as in a header of ROS: whole seconds, and the nanoseconds after them.

#include <string>
#include <vector>

#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Adds the nanoseconds to the seconds if the names of two columns differ only in their last word:
/// "stamp.sec" and "stamp.nanosec", "secs" and "nsecs". Nanoseconds must be whole numbers from 0 to below
/// 1e9, and seconds must be whole numbers. The column of the nanoseconds is marked. Each pair is named in
/// `notes`.
void combine_split_times(std::vector<TableColumn>& columns, std::vector<std::string>& notes);

}  // namespace softgrip::sysid
