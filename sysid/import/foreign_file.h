#pragma once
// Reader of external files in all supported formats.

#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Reads text (plain or in gzip), XLSX, TDMS, MCAP, MATLAB or HDF5. The first bytes of the file, not its
/// name, determine the format. For a folder, the function reads run.csv in it. Reasons for a refusal are
/// added to `problems`. `unreadable` is set if the file could not be opened.
[[nodiscard]] std::optional<ForeignTable> read_foreign_file(const std::string& path,
                                                            const TableOptions& options,
                                                            document::Problems& problems, bool& unreadable);

/// Decompresses gzip data to at most `bound` bytes. The error is a sentence.
[[nodiscard]] tl::expected<std::string, std::string> gunzipped(std::string_view bytes, std::size_t bound);

}  // namespace softgrip::sysid
