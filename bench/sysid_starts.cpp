// Runs the fits of softgrip for the comparison in bench/sysid_peers.sh. Creates three logs and the start
// points, fits the logs from each start point, and prints the durations of the fits.
//
//   Usage: sysid_starts FOLDER [STARTS [SAMPLES]]
//
// The program writes log1.csv to log3.csv, starts.txt and ours.txt into FOLDER. starts.txt has one start
// point per line: alpha beta gamma eta k1 c1 k2 c2. ours.txt contains the RMSE of the fit from each start
// point [mm], followed by the CPU time of all fits on one thread [s].

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/numbers.h"
#include "sysid/identification/identify.h"
#include "tests/sysid/simulated.h"

namespace {

using namespace softgrip;
using namespace softgrip::sysid;

/// Returns start points for the fits. Each parameter except k0 and the exponent is multiplied by a random
/// factor of its own between 1/e and e.
std::vector<model::Model> start_points(std::size_t count) {
  std::mt19937_64 random(2025);
  std::uniform_real_distribution<double> logarithm(-1, 1);
  std::vector<model::Model> starts;
  for (std::size_t i = 0; i < count; ++i) {
    model::Model start = loaded("zhang2025");
    std::vector<double> values = model::flat_values(start);
    for (std::size_t j = 0; j < values.size(); ++j) {
      const bool kept = model::parameter_spec(start, j).whole ||
                        model::parameter_path(start, j) == "kelvin_voigt.k0_kpa_per_mm";
      if (!kept) values[j] *= std::exp(logarithm(random));
    }
    starts.push_back(model::with_values(std::move(start), values));
  }
  return starts;
}

/// Duration of a fit: the elapsed time and the CPU time. The CPU time depends less on other programs on the
/// machine than the elapsed time does.
struct Seconds {
  double wall;
  double processor;
};

Seconds seconds(const std::vector<Log>& logs, const std::vector<model::Model>& starts, unsigned threads,
                std::optional<Identification>& result) {
  IdentifyOptions options;
  options.start_points = starts;
  options.threads = threads;
  const auto began = std::chrono::steady_clock::now();
  const std::clock_t used = std::clock();
  auto found = identify(logs, loaded("zhang2025"), options);
  const Seconds taken{std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(),
                      static_cast<double>(std::clock() - used) / CLOCKS_PER_SEC};
  if (!found) {
    std::fprintf(stderr, "%s\n", found.error().c_str());
    std::exit(1);
  }
  result = std::move(*found);
  return taken;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: %s FOLDER [STARTS [SAMPLES]]\n", argv[0]);
    return 2;
  }
  const std::string folder = argv[1];
  const std::size_t count = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 20;
  const double samples = argc > 3 ? std::strtod(argv[3], nullptr) : 12000;
  const model::Model truth = scattered(loaded("zhang2025"), 0.05, 7);
  std::vector<Log> logs;
  for (const auto signal : {model::SignalName::tp1, model::SignalName::sp1, model::SignalName::tp2}) {
    logs.push_back(
        simulated(truth, signal, (samples - 1) / model::duration_s(signal), 0.05, 10 + logs.size()));
  }
  const std::vector<model::Model> starts = start_points(count);
  std::string text;
  for (const model::Model& start : starts) {
    const std::vector<double>& bw = start.blocks[0].values;
    const std::vector<double>& kv = start.blocks[1].values;
    for (const double v : {bw[0], bw[1], bw[2], bw[3], kv[1], kv[2], kv[3], kv[4]}) text += shortest(v) + ' ';
    text.back() = '\n';
  }
  std::optional<Identification> result;
  const Seconds one = seconds(logs, starts, 1, result);
  const Seconds two = seconds(logs, starts, 2, result);
  std::string ours;
  for (const double rmse_mm : result->multistart.rmse_mm) ours += shortest(rmse_mm) + '\n';
  ours += shortest(one.processor) + '\n';
  bool written = write_file(folder + "/starts.txt", text) && write_file(folder + "/ours.txt", ours);
  for (std::size_t i = 0; i < logs.size(); ++i) {
    written = written && write_file(folder + "/log" + std::to_string(i + 1) + ".csv", format_log(logs[i]));
  }
  if (!written) return 4;
  std::printf(
      "softgrip: %zu starts on 3 logs of %zu samples: %.3f s on one thread, %.3f s on two (CPU %.3f s)\n",
      count, logs.front().size(), one.wall, two.wall, one.processor);
  std::printf("softgrip: best RMSE %.6f mm, reached by %.0f %% of the starts\n", result->rmse_mm,
              100 * result->multistart.share_at_best);
}
