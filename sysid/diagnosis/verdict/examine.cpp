#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/fitting/trajectory.h"

namespace softgrip::sysid {
namespace {

Reference reference_of(const Diagnosis& d, const StructureFit& fit, const DiagnosisOptions& options) {
  std::vector<std::vector<double>> prediction;
  for (std::size_t k = 0; k < d.records.size(); ++k)
    prediction.push_back(predict(fit.point.model, d.records[k], fit.point.starts[k]));
  ReferenceOptions how;
  how.seed = options.seed;
  how.threads = options.threads;
  return smooth_reference(d.records, prediction, fit.residual_mm, d.noise_mm, how);
}

}  // namespace

void examine(Diagnosis& d, const DiagnosisOptions& options) {
  StageClock clock(d);
  d.evidence = examine_fits(d.records, d.as_given, d.recalibrated, d.extended, d.noise_mm, options.seed);
  clock.ended("evidence");
  d.reference = reference_of(d, d.recalibrated, options);
  if (!d.extended.causes.empty()) d.reference_left = reference_of(d, d.extended, options);
  clock.ended("reference");
}

}  // namespace softgrip::sysid
