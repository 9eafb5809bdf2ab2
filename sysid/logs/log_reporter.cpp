#include "sysid/logs/log_reporter.h"

namespace softgrip::sysid {
namespace {

constexpr int shown = 3;

}  // namespace

void LogReporter::add(const std::string& kind, document::Location at, std::string_view line,
                      std::string message, std::string hint) {
  if (int& count = counts_[kind]; ++count <= shown) {
    problems_.add({file_, at, std::string(line.substr(0, 200)), std::move(message), std::move(hint)});
  } else {
    last_[kind] = {at, std::string(line.substr(0, 200))};
  }
}

void LogReporter::finish() {
  for (const auto& [kind, last] : last_) {
    problems_.add({file_,
                   last.first,
                   last.second,
                   kind + ": " + std::to_string(counts_[kind] - shown) +
                       " more problems of this kind, the last one here",
                   {}});
  }
  last_.clear();
}

}  // namespace softgrip::sysid
