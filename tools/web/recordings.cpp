#include "tools/web/recordings.h"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/descriptor.h"
#include "base/files.h"

namespace softgrip::web {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t longest_file_name = 128;
constexpr std::size_t most_files = 50;

struct Kind {
  std::string_view ending;
  std::string_view content_type;
};
constexpr std::array<Kind, 6> kinds{{{".svg", "image/svg+xml"},
                                     {".png", "image/png"},
                                     {".html", "text/html; charset=utf-8"},
                                     {".csv", "text/csv; charset=utf-8"},
                                     {".json", "application/json"},
                                     {".md", "text/plain; charset=utf-8"}}};

/// Names that are plain, in the order of the alphabet.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::string name = entry->path().filename().string();
    if (is_plain_name(name)) names.push_back(std::move(name));
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

bool is_plain_name(std::string_view name) {
  const auto allowed = [](char character) {
    const auto within = [character](char first, char last) {
      return character >= first && character <= last;
    };
    return within('a', 'z') || within('A', 'Z') || within('0', '9') || character == '-' || character == '_' ||
           character == '.';
  };
  return !name.empty() && name.size() <= longest_file_name && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), allowed);
}

std::string_view content_type_of(std::string_view name) {
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [name](const Kind& kind) { return name.ends_with(kind.ending); });
  return found == kinds.end() ? std::string_view() : found->content_type;
}

Json Recordings::list() const {
  Json list = Json::array();
  if (folder_.empty()) return list;
  // Their names begin with the time.
  std::vector<std::string> names = names_in(folder_);
  std::reverse(names.begin(), names.end());
  for (const std::string& name : names) {
    if (list.size() == most_listed) break;
    Json files = Json::array();
    for (const std::string& file : names_in(fs::path(folder_) / name)) {
      if (!content_type_of(file).empty() && files.size() < most_files) files.push_back(file);
    }
    if (!files.empty()) list.push_back({{"name", name}, {"files", std::move(files)}});
  }
  return list;
}

std::optional<std::string> Recordings::read(std::string_view recording, std::string_view file) const {
  if (folder_.empty() || !is_plain_name(recording) || !is_plain_name(file) || content_type_of(file).empty())
    return std::nullopt;
  const Descriptor top{::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (!top) return std::nullopt;
  const Descriptor folder{
      ::openat(top.get(), std::string(recording).c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)};
  if (!folder) return std::nullopt;
  const auto opened = open_regular_in(folder, std::string(file));
  if (!opened || opened->size > largest_file) return std::nullopt;
  auto bytes = read_start(*opened, opened->size);
  if (!bytes) return std::nullopt;
  return std::move(*bytes);
}

}  // namespace softgrip::web
