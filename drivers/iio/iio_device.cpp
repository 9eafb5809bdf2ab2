#include "drivers/iio/iio_device.h"

#include <fstream>

namespace softgrip::drivers {

std::string name_of_converter(const std::filesystem::path& folder) {
  std::string word;
  std::ifstream(folder / "name") >> word;
  return word;
}

bool is_converter(const std::filesystem::path& folder, const std::string& device) {
  return !device.empty() && (folder.filename() == device || name_of_converter(folder) == device);
}

}  // namespace softgrip::drivers
