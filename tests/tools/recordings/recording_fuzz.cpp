// Fuzz target of the readers of recordings and of the daemon's lines. Reads the bytes as run.json of a
// recording, and as a status line and an event line of the daemon. No bytes may cause a crash.
//
//   Command: scripts/fuzz.sh recording_fuzz 30

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "sysid/recordings/recording.h"
#include "tools/client/daemon_text.h"

namespace {

using namespace softgrip;

/// A folder in memory with a recording. The file run.json contains the bytes of the fuzzer.
class Folder {
 public:
  Folder() : path_("/dev/shm/softgrip_recording_fuzz_" + std::to_string(getpid())) {
    std::filesystem::create_directories(path_);
    std::ofstream(path_ + "/run.csv") << "time_s,channel,pressure_command_kpa,displacement_mm\n"
                                         "0,left,0,0\n0.005,left,1,0.1\n0.01,left,2,0.2\n";
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  Folder(Folder&&) = delete;
  Folder& operator=(Folder&&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

void show(const nlohmann::ordered_json& json) {
  if (!json.is_object()) return;
  // Invalid lines of a daemon may cause an exception of the JSON library. They must have no other effect.
  try {
    for (const std::string& line : tools::view_of(json, {80, true, true})) {
      if (line.find('\n') != std::string::npos) std::abort();
    }
  } catch (const nlohmann::json::exception&) {
  }
  try {
    (void)tools::line_of_status(json);
    (void)tools::line_of_event(json);
  } catch (const nlohmann::json::exception&) {
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  const std::string text(reinterpret_cast<const char*>(data), size);
  std::ofstream(folder.path() + "/run.json", std::ios::binary) << text;
  document::Problems problems;
  const auto recording = sysid::read_recording(folder.path(), problems);
  // The rows of run.csv are complete, so the recording must be readable with any run.json.
  if (!recording || recording->channels.size() != 1 || recording->channels.front().size() != 3) std::abort();
  show(nlohmann::ordered_json::parse(text, nullptr, false));
  return 0;
}
