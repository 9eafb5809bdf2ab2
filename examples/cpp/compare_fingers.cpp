// Compares two fingers. `compare_fingers LOG_A LOG_B` fits the same model structure to one log of each
// finger. The program prints the parameters whose 95 % intervals for the two fingers do not overlap.

#include <cstdio>
#include <exception>

#include <softgrip/identify.h>
#include <softgrip/log.h>

int main(int count, char** arguments) try {
  if (count != 3) {
    std::fprintf(stderr, "usage: compare_fingers LOG_A LOG_B\n");
    return 2;
  }
  softgrip::IdentifyOptions fit;
  fit.starts = 5;
  const softgrip::Identification one = softgrip::identify({softgrip::read_log(arguments[1])}, fit);
  const softgrip::Identification other = softgrip::identify({softgrip::read_log(arguments[2])}, fit);
  std::printf("%s\n%s\n", one.verdict.c_str(), other.verdict.c_str());

  int different = 0;
  for (std::size_t i = 0; i < one.parameters.size(); ++i) {
    const softgrip::Estimate& a = one.parameters[i];
    const softgrip::Estimate& b = other.parameters[i];
    if (!a.ci95 || !b.ci95) continue;
    const bool overlap = a.ci95->lower <= b.ci95->upper && b.ci95->lower <= a.ci95->upper;
    if (overlap) continue;
    ++different;
    std::printf("%-32s %10.4g %10.4g %s\n", a.name.c_str(), a.value, b.value, a.unit.c_str());
  }
  std::printf("%d of %zu parameters differ between the two fingers\n", different, one.parameters.size());
} catch (const std::exception& error) {
  std::fprintf(stderr, "compare_fingers: %s\n", error.what());
  return 1;
}
