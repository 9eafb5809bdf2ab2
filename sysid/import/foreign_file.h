#pragma once
// Reads external files in all supported formats.

#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Reads text (plain or gzip), XLSX, TDMS, MCAP, MATLAB or HDF5. The first bytes of the file determine its
/// format; the file name has no influence. If `path` is a folder, the function reads run.csv in this folder.
/// The reasons for a refusal are added to `problems`. `unreadable` becomes true if the file could not be
/// opened.
[[nodiscard]] std::optional<ForeignTable> read_foreign_file(const std::string& path,
                                                            const TableOptions& options,
                                                            document::Problems& problems, bool& unreadable);

/// Returns the decompressed gzip data if they have at most `bound` bytes. On failure, returns a sentence that
/// describes the error.
[[nodiscard]] tl::expected<std::string, std::string> gunzipped(std::string_view bytes, std::size_t bound);

}  // namespace softgrip::sysid
