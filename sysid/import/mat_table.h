#pragma once
// MATLAB's .mat files, of versions 4, 5 and 7, through libmatio. Those of 7.3 are HDF5 (hdf5_table.h).

#include <optional>
#include <string>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Variables of real numbers, and fields of single structures as "name.field". Objects (timetable,
/// timeseries, table, duration), cells and complex numbers are passed over and said: MATLAB alone can read
/// them. `path` names the file in messages, `opened` is where libmatio opens it.
[[nodiscard]] std::optional<ForeignTable> read_mat_table(const std::string& path, const std::string& opened,
                                                         document::Problems& problems);

}  // namespace softgrip::sysid
