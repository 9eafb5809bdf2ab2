#pragma once
// Writes the figures of a report as files, for a paper or for other plotting programs.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "sysid/pages/figure.h"

namespace softgrip::tools {

/// Writes figure-N-NAME.svg, .pdf and .csv for each figure. N is the number of the figure on the page of the
/// report. Writes nothing if `folder` is empty. The error is a sentence.
[[nodiscard]] tl::expected<void, std::string> write_figures(const std::string& folder,
                                                            const std::vector<sysid::Figure>& figures);

}  // namespace softgrip::tools
