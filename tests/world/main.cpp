// softgrip-world: whole rigs under seeds.

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "tests/world/world.h"

namespace softgrip::world {
namespace {

struct Options {
  std::uint64_t first = 1;
  std::uint64_t count = 200;
  unsigned jobs = 1;
  double length_s = 60;
  bool trace = false;
  bool twice = false;
  bool stop_at_first = false;
};

struct Sum {
  std::uint64_t worlds = 0, failed = 0, ticks = 0, writes = 0, sequences = 0, holdings = 0, faults = 0,
                trips = 0, rows = 0, incidents = 0;
  /// The most of all worlds, not their sum.
  std::uint64_t growth_bytes = 0, descriptors = 0;
};

void add(Sum& sum, const Sum& other) {
  sum.worlds += other.worlds;
  sum.failed += other.failed;
  sum.ticks += other.ticks;
  sum.writes += other.writes;
  sum.sequences += other.sequences;
  sum.holdings += other.holdings;
  sum.faults += other.faults;
  sum.trips += other.trips;
  sum.rows += other.rows;
  sum.incidents += other.incidents;
  sum.growth_bytes = std::max(sum.growth_bytes, other.growth_bytes);
  sum.descriptors = std::max(sum.descriptors, other.descriptors);
}

void add(Sum& sum, const WorldResult& result) {
  add(sum, Sum{1, result.violation ? 1U : 0U, result.ticks, result.writes, result.sequences, result.holdings,
               result.faults, result.trips, result.rows, result.incidents.size(), result.growth_bytes,
               result.descriptors});
}

/// What a person needs to understand it: the fewest incidents, and what followed.
void explain(const Library& library, std::uint64_t seed, const WorldResult& failed,
             const WorldOptions& options) {
  WorldOptions again = options;
  again.incidents = shrink(library, seed, failed, options);
  again.trace = true;
  const WorldResult result = run_world(library, seed, again);
  std::string text = fmt::format("seed {}: {}\n  {}\n  of {} incidents these are enough:\n", seed,
                                 failed.violation->invariant, failed.shape, failed.incidents.size());
  for (const Incident& incident : *again.incidents) text += "    " + text_of(incident) + "\n";
  text += "  the last of the trace:\n";
  const std::size_t shown = std::min<std::size_t>(result.trace.size(), options.trace ? 100000 : 25);
  for (std::size_t i = result.trace.size() - shown; i < result.trace.size(); ++i)
    text += "    " + result.trace[i] + "\n";
  if (result.violation)
    text += "  VIOLATED: " + result.violation->invariant + ": " + result.violation->text + "\n";
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

Sum run_share(const Library& library, const Options& options, unsigned job) {
  WorldOptions world;
  world.length = nanoseconds(options.length_s);
  Sum sum;
  for (std::uint64_t k = job; k < options.count; k += options.jobs) {
    const std::uint64_t seed = options.first + k;
    world.trace = options.trace && options.count == 1;
    const WorldResult result = run_world(library, seed, world);
    add(sum, result);
    if (options.twice && run_world(library, seed, world).fingerprint != result.fingerprint) {
      fmt::print("seed {}: two runs differ\n", seed);
      ++sum.failed;
    }
    if (result.violation) {
      explain(library, seed, result, world);
      if (options.stop_at_first) break;
    } else if (world.trace) {
      for (const std::string& line : result.trace) fmt::print("{}\n", line);
    }
  }
  return sum;
}

/// Each job is a process of its own: what one world breaks, it breaks for itself.
Sum run_jobs(const Library& library, const Options& options) {
  if (options.jobs <= 1) return run_share(library, options, 0);
  std::vector<int> ends;
  std::vector<pid_t> children;
  for (unsigned job = 0; job < options.jobs; ++job) {
    int pipe_ends[2];
    if (pipe(pipe_ends) != 0) throw std::runtime_error("pipe");
    const pid_t child = fork();
    if (child == 0) {
      close(pipe_ends[0]);
      const Sum sum = run_share(library, options, job);
      std::fflush(stdout);
      const bool told = write(pipe_ends[1], &sum, sizeof sum) == sizeof sum;
      std::_Exit(told ? EXIT_SUCCESS : EXIT_FAILURE);
    }
    close(pipe_ends[1]);
    ends.push_back(pipe_ends[0]);
    children.push_back(child);
  }
  Sum all;
  for (unsigned job = 0; job < options.jobs; ++job) {
    Sum one;
    if (read(ends[job], &one, sizeof one) != sizeof one) {
      fmt::print("a job of the worlds broke off\n");
      one = {};
      one.failed = 1;
    }
    close(ends[job]);
    waitpid(children[job], nullptr, 0);
    add(all, one);
  }
  return all;
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Whole rigs in simulated worlds, each under a seed, watched by the invariants of docs/reliability.md");
  app.add_option("--first", options.first, "First seed")->capture_default_str();
  app.add_option("--count", options.count, "So many seeds")->capture_default_str();
  app.add_option("--jobs", options.jobs, "Processes")->capture_default_str();
  app.add_option("--seconds", options.length_s, "Simulated, each")->capture_default_str();
  app.add_flag("--trace", options.trace, "With --count 1: everything that happens");
  app.add_flag("--twice", options.twice, "Run each twice and compare");
  app.add_flag("--stop", options.stop_at_first, "At the first violation");
  CLI11_PARSE(app, argc, argv);
  const Library library = load_library();
  const Sum sum = run_jobs(library, options);
  fmt::print(
      "{} worlds of {} s from seed {}: {} violated\n"
      "{} ticks, {} writes, {} incidents, {} sequences, {} times HOLDING, {} faults, {} trips of a watchdog, "
      "{} recorded rows\n"
      "at most {} KiB more heap than after 5 s, at most {} descriptors\n",
      sum.worlds, options.length_s, options.first, sum.failed, sum.ticks, sum.writes, sum.incidents,
      sum.sequences, sum.holdings, sum.faults, sum.trips, sum.rows, sum.growth_bytes >> 10, sum.descriptors);
  return sum.failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace softgrip::world

int main(int argc, char** argv) {
  try {
    return softgrip::world::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "softgrip-world: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
