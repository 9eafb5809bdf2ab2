#pragma once
// The figures of a report as files: for a paper, and for those who draw them anew.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "sysid/pages/figure.h"

namespace softgrip::tools {

/// Writes figure-N-NAME.svg, .pdf and .csv for each, N as on the page; nothing where `folder` is empty. The
/// error is a sentence.
[[nodiscard]] tl::expected<void, std::string> write_figures(const std::string& folder,
                                                            const std::vector<sysid::Figure>& figures);

}  // namespace softgrip::tools
