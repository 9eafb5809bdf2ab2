#include "tools/web/recordings.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <utility>

#include <nlohmann/json.hpp>

#include "tools/web/access/tokens.h"

namespace softgrip::web {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t longest_file_name = 128;
constexpr std::size_t most_files = 50;
/// Largest resolution of a file system's time stamps. For most file systems, the resolution is several
/// milliseconds; for FAT, it is two seconds.
constexpr Nanoseconds stamp_resolution = 2 * ns_per_s;
/// Number of directory entries that are read between two pauses.
constexpr std::size_t entries_at_once = 256;

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

bool is_shown(std::string_view name) {
  return is_plain_name(name) && !content_type_of(name).empty();
}

/// Sorts the names in the order that `last_first` gives, and removes all names after the first `most`.
void keep_first(std::vector<std::string>& names, bool last_first, std::size_t most) {
  const auto before = [last_first](const std::string& one, const std::string& other) {
    return last_first ? one > other : one < other;
  };
  if (names.size() > most) {
    std::nth_element(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(most), names.end(), before);
    names.resize(most);
  }
  std::sort(names.begin(), names.end(), before);
}

Descriptor open_folder_in(const Descriptor& parent, const std::string& name) {
  return Descriptor{::openat(parent.get(), name.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)};
}

}  // namespace

bool is_plain_name(std::string_view name) {
  const auto allowed = [](char character) { return is_name_character(character) || character == '.'; };
  return !name.empty() && name.size() <= longest_file_name && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), allowed);
}

std::string_view content_type_of(std::string_view name) {
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [name](const Kind& kind) { return name.ends_with(kind.ending); });
  return found == kinds.end() ? std::string_view() : found->content_type;
}

Json Recordings::list(Nanoseconds wall_now, const std::function<void()>& on_interval) {
  wall_now_ = wall_now;
  on_interval_ = on_interval;
  Json list = Json::array();
  const Descriptor top{folder_.empty() ? -1 : ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (!top) {
    newest_ = {};
    files_.clear();
    return list;
  }
  // The name of a recording begins with its start time, so sorted names are in the order of time.
  refresh(newest_, top, ".", {is_plain_name, true, most_considered});
  std::map<std::string, Names> files;
  for (const std::string& name : newest_.names) {
    if (list.size() == most_listed) break;
    call_on_interval();
    Names& shown = files[name];
    if (const auto known = files_.find(name); known != files_.end()) shown = std::move(known->second);
    refresh(shown, top, name, {is_shown, false, most_files});
    if (!shown.names.empty()) list.push_back({{"name", name}, {"files", shown.names}});
  }
  files_ = std::move(files);
  return list;
}

void Recordings::refresh(Names& known, const Descriptor& parent, const std::string& name,
                         const NameSelection& selection) {
  struct stat about {};
  const auto stamp = [&about] {
    return Stamp{about.st_dev, about.st_ino, about.st_ctim.tv_sec * ns_per_s + about.st_ctim.tv_nsec};
  };
  if (::fstatat(parent.get(), name.c_str(), &about, AT_SYMLINK_NOFOLLOW) == 0 && known.stamp_reliable &&
      known.stamp == stamp()) {
    return;
  }
  known = {};
  Descriptor folder = open_folder_in(parent, name);
  if (!folder || ::fstat(folder.get(), &about) != 0) return;
  known.stamp = stamp();
  const bool complete = read_names(std::move(folder), selection, known.names);
  known.stamp_reliable = complete && wall_now_ - known.stamp.changed_at > stamp_resolution;
}

/// Reads the names in a folder. Returns true if all names were read. Returns false after an error.
bool Recordings::read_names(Descriptor folder, const NameSelection& selection,
                            std::vector<std::string>& names) {
  ++folders_read_;
  const std::unique_ptr<DIR, int (*)(DIR*)> entries(::fdopendir(folder.get()), &::closedir);
  if (!entries) return false;
  static_cast<void>(folder.release());  // closedir() closes the descriptor, so the object gives up its
                                        // ownership
  std::size_t count = 0;
  errno = 0;
  while (const dirent* const entry = ::readdir(entries.get())) {
    if (selection.is_wanted(entry->d_name)) names.emplace_back(entry->d_name);
    if (names.size() >= 2 * selection.most) keep_first(names, selection.last_first, selection.most);
    if (++count % entries_at_once == 0) call_on_interval();
    errno = 0;
  }
  const bool complete = errno == 0;
  keep_first(names, selection.last_first, selection.most);
  return complete;
}

std::optional<RegularFile> Recordings::open(std::string_view recording, std::string_view file) const {
  if (folder_.empty() || !is_plain_name(recording) || !is_shown(file)) return std::nullopt;
  const Descriptor top{::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (!top) return std::nullopt;
  const Descriptor folder = open_folder_in(top, std::string(recording));
  if (!folder) return std::nullopt;
  auto opened = open_regular_in(folder, std::string(file));
  if (!opened || opened->size > largest_file) return std::nullopt;
  return std::move(*opened);
}

}  // namespace softgrip::web
