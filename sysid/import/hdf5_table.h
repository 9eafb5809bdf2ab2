#pragma once
// HDF5 files, and MATLAB's of version 7.3, which are such; through libhdf5.

#include <optional>
#include <string>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Datasets of numbers in one or two dimensions, named by their path ("run1/pressure"), and members of
/// compounds
/// ("table.pressure"). An attribute `units` or `unit` is the unit. Everything else is passed over and said.
/// A file that refers to other files is refused: external links, external storage and virtual datasets would
/// copy any file that this user can read into the log. `path` names the file in messages, `opened` is where
/// libhdf5 opens it. Of a file of MATLAB's (`matlab`) names are "run.pressure", and texts, cells and objects
/// are passed over.
[[nodiscard]] std::optional<ForeignTable> read_hdf5_table(const std::string& path, const std::string& opened,
                                                          bool matlab, document::Problems& problems);

}  // namespace softgrip::sysid
