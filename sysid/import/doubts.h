#pragma once
// What is probably not meant in a log that can be read: signs, scales, units.

#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Sentences, each with what would mend it in the words of `softgrip import`: a reading that falls when the
/// pressure rises, a command and a measured pressure that differ by the factor of a unit or where the
/// measured one comes first, absolute pressure, spans that no soft finger has, samples too far apart.
[[nodiscard]] std::vector<std::string> doubts_about(const Log& log);

}  // namespace softgrip::sysid
