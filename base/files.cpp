#include "base/files.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <unistd.h>

namespace softgrip {

tl::expected<std::string, std::string> read_file(const std::string& path, std::size_t bound) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return tl::unexpected(path + " is a folder");
  std::ifstream file(path, std::ios::binary);
  if (!file) return tl::unexpected("cannot open " + path + ": " + std::strerror(errno));
  std::string contents;
  std::string chunk(std::size_t{1} << 16, '\0');
  while (file) {
    file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    contents.append(chunk, 0, static_cast<std::size_t>(file.gcount()));
    if (contents.size() > bound) {
      return tl::unexpected(path + " is larger than " + std::to_string(bound) + " bytes");
    }
  }
  if (file.bad()) return tl::unexpected("cannot read " + path + ": " + std::strerror(errno));
  return contents;
}

tl::expected<void, std::string> write_file(const std::string& path, std::string_view contents) {
  namespace fs = std::filesystem;
  const fs::path target(path);
  std::error_code error;
  if (target.has_parent_path()) fs::create_directories(target.parent_path(), error);
  if (error) return tl::unexpected("cannot create " + target.parent_path().string() + ": " + error.message());
  const std::string temporary = path + ".part" + std::to_string(::getpid());
  {
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file.write(contents.data(), static_cast<std::streamsize>(contents.size()));
    file.close();
    if (!file) {
      const std::string reason = std::strerror(errno);
      fs::remove(temporary, error);
      return tl::unexpected("cannot write " + path + ": " + reason);
    }
  }
  fs::rename(temporary, target, error);
  if (error) {
    const std::string reason = error.message();
    fs::remove(temporary, error);
    return tl::unexpected("cannot write " + path + ": " + reason);
  }
  return {};
}

}  // namespace softgrip
