#include "tools/command_line/output.h"

#include <fnmatch.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <memory>

#include "base/files.h"
#include "tools/command_line/command.h"

namespace softgrip::tools {
namespace {

bool put(std::FILE* file, std::string_view text) {
  return std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
}

namespace fs = std::filesystem;

/// Returns the number of the open descriptor of this process to which a path leads, for example 1 for
/// /dev/stdout. Returns nullopt for any other path. Only the links up to the descriptor are followed, and not
/// the link to its file.
std::optional<int> descriptor_at(fs::path path) {
  constexpr int most_links = 40;  // the kernel follows as many links
  std::error_code error;
  const fs::path descriptors = fs::canonical("/proc/self/fd", error);
  for (int links = 0; !error && links < most_links; ++links) {
    const fs::path folder = fs::canonical(path.has_parent_path() ? path.parent_path() : ".", error);
    if (error) break;
    if (folder == descriptors) {
      const std::string name = path.filename().string();
      int number = 0;
      const auto [end, failed] = std::from_chars(name.data(), name.data() + name.size(), number);
      if (failed != std::errc() || end != name.data() + name.size()) break;
      return number;
    }
    if (!fs::is_symlink(path, error)) break;
    const fs::path target = fs::read_symlink(path, error);
    path = target.is_absolute() ? target : folder / target;
  }
  return std::nullopt;
}

/// Returns the files that a command reads if its input is the file or folder `input`.
std::vector<std::string> files_of(const std::string& input) {
  if (!is_folder(input)) return {input};
  return {input + "/run.csv", input + "/run.json"};
}

/// Returns the file that occupies the path of a folder in which `output` would be written, or "".
std::string file_instead_of_folder(const std::string& output) {
  std::error_code error;
  for (fs::path folder = fs::path(output).parent_path(); !folder.empty(); folder = folder.parent_path()) {
    const fs::file_status status = fs::status(folder, error);
    if (fs::is_directory(status) || folder == folder.root_path()) return {};
    if (fs::exists(status)) return folder.string();
  }
  return {};
}

}  // namespace

std::optional<ExitCode> refuse_overwriting(const std::vector<std::string>& outputs,
                                           const std::vector<std::string>& inputs) {
  for (const std::string& output : outputs) {
    const std::string file = output == "-" ? "" : file_instead_of_folder(output);
    if (file.empty()) continue;
    if (const auto code = refuse_overwriting({file}, inputs)) return code;
    return fail(ExitCode::io,
                "cannot write into " + file + ": it is a file, not a folder. Name another folder");
  }
  for (const std::string& input : inputs) {
    for (const std::string& file : files_of(input)) {
      for (const std::string& output : outputs) {
        if (!is_stream(output) && same_file(output, file))
          return fail(ExitCode::usage, output + " is an input of this command (" + input +
                                           "), so this file is not overwritten. Name another output");
      }
    }
  }
  return std::nullopt;
}

std::vector<std::string> files_in(const std::string& folder, const std::vector<std::string>& patterns) {
  std::vector<std::string> found;
  std::error_code error;
  if (folder.empty()) return found;
  if (!is_folder(folder)) {
    for (const std::string& pattern : patterns) found.push_back((fs::path(folder) / pattern).string());
    return found;
  }
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (entry.depth() > 0) entry.disable_recursion_pending();
    const std::string name = entry->path().lexically_relative(folder).string();
    const bool matches = std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
      return ::fnmatch(pattern.c_str(), name.c_str(), FNM_PATHNAME) == 0;
    });
    if (matches) found.push_back(entry->path().string());
  }
  return found;
}

// write_output() opens a stream for writing, because a rename would replace the stream by a file.
bool is_stream(const std::string& path) {
  if (path == "-" || descriptor_at(path)) return true;
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
         !std::filesystem::is_directory(status);
}

tl::expected<void, std::string> write_output(const std::string& path, std::string_view text) {
  if (!is_stream(path)) return write_file(path, text);
  int error = 0;
  if (const std::optional<int> descriptor = path == "-" ? STDOUT_FILENO : descriptor_at(path)) {
    // The output continues at the current position, after the text that was printed before.
    (void)std::fflush(stdout);
    error = write_all(*descriptor, text);
  } else {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file{
        std::fopen(path.c_str(), "w"), [](std::FILE* opened) { return std::fclose(opened); }};
    if (file == nullptr || !put(file.get(), text)) error = errno;
  }
  if (error != 0) return tl::unexpected{"cannot write " + path + ": " + std::strerror(error)};
  return {};
}

tl::expected<void, std::string> prepare_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return tl::unexpected{"cannot create " + folder + ": " + error.message()};
  if (::access(folder.c_str(), W_OK) != 0) {
    return tl::unexpected{"cannot write into " + folder + ": " + std::strerror(errno)};
  }
  return {};
}

tl::expected<void, std::string> prepare_parent(const std::string& path) {
  if (is_stream(path)) return {};
  const std::string parent = std::filesystem::path(path).parent_path().string();
  return prepare_folder(parent.empty() ? "." : parent);
}

std::FILE* report_stream(const std::string& path) {
  return is_stream(path) ? stderr : stdout;
}

}  // namespace softgrip::tools
