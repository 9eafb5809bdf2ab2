#pragma once
// Wrong readings taken out of logs, before a fit and its errors contain them.

#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Takes out the readings that hide_outliers() finds (NaN: no reading), unless they are few and small: what
/// adds less than a quarter of the noise to the error stays. A sentence for each log that lost some, with
/// their number and the first of them.
[[nodiscard]] std::vector<std::string> take_out_wrong_readings(std::vector<Log>& logs);

}  // namespace softgrip::sysid
