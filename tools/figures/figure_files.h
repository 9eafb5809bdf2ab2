#pragma once
// Writes the figures of a report as files, for a paper or for other plotting programs.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "sysid/pages/figure.h"

namespace softgrip::tools {

/// Writes figure-N-NAME.svg, .pdf and .csv for each figure, with the number N of the page. Writes nothing if
/// `folder` is empty. The error is a sentence.
[[nodiscard]] tl::expected<void, std::string> write_figures(const std::string& folder,
                                                            const std::vector<sysid::Figure>& figures);

}  // namespace softgrip::tools
