// Checks the health of all fingers; run this program once per night. `nightly_health RECORDINGS BASELINE OUT`
// prints the health of each finger and writes a page per finger into the folder OUT. The program also stores
// the indicators in OUT, so that it reads each recording only once. The exit code 1 means that an alarm of a
// finger is active.

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include <softgrip/health.h>

int main(int count, char** arguments) try {
  if (count != 4) {
    std::fprintf(stderr, "usage: nightly_health RECORDINGS BASELINE OUT\n");
    return 2;
  }
  const std::filesystem::path out = arguments[3];
  std::filesystem::create_directories(out);
  softgrip::HealthOptions options;
  options.scores = out / "health-scores.jsonl";
  if (std::filesystem::exists(out / "notes.yaml")) options.notes = out / "notes.yaml";  // maintenance records
  const softgrip::Health health = softgrip::health({arguments[1]}, arguments[2], options);

  for (const softgrip::FingerHealth& finger : health.fingers) {
    std::printf("%s: %s\n", finger.finger.c_str(), finger.sentence.c_str());
    for (const softgrip::Suspect& suspect : finger.suspects)
      std::printf("  %s: %s\n", suspect.id.c_str(), suspect.next_steps.front().c_str());
    std::ofstream(out / ("health-" + finger.finger + ".html")) << finger.html;
  }
  for (const std::string& text : health.warnings) std::printf("%s\n", text.c_str());
  for (const softgrip::SkippedRecording& one : health.skipped)
    std::printf("%s was not used: %s\n", one.recording.c_str(), one.reason.c_str());
  return health.alarm ? 1 : 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "nightly_health: %s\n", error.what());
  return 3;
}
