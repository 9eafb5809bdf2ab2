#include "base/scratch_folder.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace softgrip {

namespace fs = std::filesystem;

ScratchFolder::ScratchFolder() {
  std::error_code none;
  const fs::path temporary = fs::temp_directory_path(none);
  if (none) return;
  path_ = (temporary / "softgrip-XXXXXX").string();
  if (::mkdtemp(path_.data()) == nullptr) path_.clear();
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

}  // namespace softgrip
