#pragma once
// Reads MATLAB files of versions 4, 5 and 7. Uses libmatio. Files of version 7.3 are HDF5 files
// (hdf5_table.h).

#include <optional>
#include <string>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Reads variables with real numbers. Fields of structures are named "name.field", elements of arrays of
/// structures "name(2).field", and cells "name{2}". A structure with Name and Data (dSPACE) or with label and
/// values (Simulink) becomes a column with the name that the structure states. Complex numbers are skipped.
/// Objects (timetable, timeseries, table, duration) are skipped too, because only MATLAB can read them. A
/// note names all skipped variables. `path` is the name of the file in messages; libmatio opens the path
/// `opened`.
[[nodiscard]] std::optional<ForeignTable> read_mat_table(const std::string& path, const std::string& opened,
                                                         document::Problems& problems);

}  // namespace softgrip::sysid
