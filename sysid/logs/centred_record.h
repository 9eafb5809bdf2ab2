#pragma once
// The old name of resampled_record.h, for sysid/changes until it includes that one.

#include "sysid/logs/resampled_record.h"  // IWYU pragma: export
