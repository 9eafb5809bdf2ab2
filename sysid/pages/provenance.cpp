#include "sysid/pages/provenance.h"

#include "base/numbers.h"
#include "model/file/model_file.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

std::vector<std::pair<std::string, std::string>> provenance_of(
    const std::vector<Log>& logs, const std::vector<std::pair<std::string, const model::Model*>>& models) {
  std::vector<std::pair<std::string, std::string>> entries{{"software", software_and_version()}};
  for (const Log& log : logs) {
    const double duration_s = log.time_s.empty() ? 0 : log.time_s.back() - log.time_s.front();
    entries.emplace_back("log " + log.name, log.path + ", " + std::to_string(log.size()) + " samples, " +
                                                significant(duration_s) + " s, sha256 " + log.sha256);
  }
  for (const auto& [role, model] : models) {
    entries.emplace_back(role, model->name + ", hash " + model::model_hash(*model));
  }
  return entries;
}

}  // namespace softgrip::sysid
