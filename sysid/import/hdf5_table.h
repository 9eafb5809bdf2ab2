#pragma once
// Reads HDF5 files, and MATLAB files of version 7.3, whose format is HDF5. Uses libhdf5.

#include <optional>
#include <string>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Reads datasets of numbers with one or two dimensions, named by their path ("run1/pressure"), and members
/// of compounds ("table.pressure"). An attribute `units` or `unit` of a dataset states its unit. All other
/// objects are skipped, and a note names them. If `matlab` is true, names are written as "run.pressure", and
/// texts, cells and objects are skipped. A file that refers to other files is refused. Otherwise the log
/// could contain data of any file that the user may read. References to other files are external links,
/// external storage and virtual datasets. `path` is the name of the file in messages; libhdf5 opens the path
/// `opened`.
[[nodiscard]] std::optional<ForeignTable> read_hdf5_table(const std::string& path, const std::string& opened,
                                                          bool matlab, document::Problems& problems);

}  // namespace softgrip::sysid
