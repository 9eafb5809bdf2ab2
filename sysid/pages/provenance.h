#pragma once
// States the provenance of a result: software, logs and models.

#include <string>
#include <utility>
#include <vector>

#include "model/model.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Returns the entries for Page::provenance(): the software, each log and each named model with its hash.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> provenance_of(
    const std::vector<Log>& logs, const std::vector<std::pair<std::string, const model::Model*>>& models);

}  // namespace softgrip::sysid
