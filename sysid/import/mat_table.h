#pragma once
// MATLAB's .mat files, of versions 4, 5 and 7, through libmatio. Those of 7.3 are HDF5 (hdf5_table.h).

#include <optional>
#include <string>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Variables of real numbers, fields of structures as "name.field", elements of arrays of structures as
/// "name(2).field", and cells as "name{2}". A structure with Name and Data (dSPACE) or label and values
/// (Simulink) is a column of that name. Objects (timetable, timeseries, table, duration) and complex numbers
/// are passed over and said: MATLAB alone can read them. `path` names the file in messages, `opened` is where
/// libmatio opens it.
[[nodiscard]] std::optional<ForeignTable> read_mat_table(const std::string& path, const std::string& opened,
                                                         document::Problems& problems);

}  // namespace softgrip::sysid
