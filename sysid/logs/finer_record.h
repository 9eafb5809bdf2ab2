#pragma once
// A record with samples between its samples, for what bends there.

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Every step in so many equal parts. Between samples drive and surroundings go straight, a held drive stays
/// where it was; readings are known at the samples alone.
/// @param parts  1 and more: sample i of the record is sample i parts of the finer one.
[[nodiscard]] Record finer_record(const Record& record, std::size_t parts);

}  // namespace softgrip::sysid
