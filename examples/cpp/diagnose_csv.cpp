// Diagnoses a finger from a file of another program. `diagnose_csv FILE [REPORT.html]` converts the file with
// the column roles that `softgrip import` proposes. The program then fits the default model structure and
// prints the causes of the model error.

#include <cstdio>
#include <exception>
#include <fstream>

#include <softgrip/diagnose.h>
#include <softgrip/identify.h>
#include <softgrip/log.h>

int main(int count, char** arguments) try {
  if (count < 2) {
    std::fprintf(stderr, "usage: diagnose_csv FILE [REPORT.html]\n");
    return 2;
  }
  const softgrip::Log log = softgrip::read_log(arguments[1]);
  for (const std::string& note : log.notes) std::printf("note: %s\n", note.c_str());

  softgrip::IdentifyOptions fit;
  fit.starts = 5;
  const softgrip::Identification fitted = softgrip::identify({log}, fit);
  std::printf("%s\n", fitted.verdict.c_str());

  const softgrip::Diagnosis diagnosis = softgrip::diagnose(fitted.model, {log});
  std::printf("%s\n", diagnosis.sentence.c_str());
  for (const softgrip::Cause& cause : diagnosis.causes) {
    std::printf("%s: held-out error reduced by %.1f %%\n", cause.id.c_str(), cause.error_reduction_percent);
    for (const softgrip::Estimate& parameter : cause.parameters) {
      std::printf("  %s = %.4g %s", parameter.name.c_str(), parameter.value, parameter.unit.c_str());
      if (parameter.ci95) std::printf(" (95 %%: %.4g to %.4g)", parameter.ci95->lower, parameter.ci95->upper);
      std::printf("\n");
    }
  }
  if (count > 2) std::ofstream(arguments[2]) << diagnosis.html;
} catch (const std::exception& error) {
  std::fprintf(stderr, "diagnose_csv: %s\n", error.what());
  return 1;
}
