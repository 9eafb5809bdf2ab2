#pragma once
// A file of other people's, whatever its format.

#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Reads text (gzip around it or not), XLSX, TDMS, MCAP, MATLAB or HDF5, by what the file begins with and not
/// by its name; a folder stands for the run.csv in it. What is refused is added to `problems`; `unreadable`
/// is set where the file could not be opened at all.
[[nodiscard]] std::optional<ForeignTable> read_foreign_file(const std::string& path,
                                                            const TableOptions& options,
                                                            document::Problems& problems, bool& unreadable);

/// What gzip packed, at most `bound` bytes of it; the error is a sentence.
[[nodiscard]] tl::expected<std::string, std::string> gunzipped(std::string_view bytes, std::size_t bound);

}  // namespace softgrip::sysid
