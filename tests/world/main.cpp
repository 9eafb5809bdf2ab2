// softgrip-world simulates whole rigs. A seed determines each simulation completely.

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
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
  std::string tool = tool_names.front();
  std::uint64_t first = 1;
  std::uint64_t count = 200;
  unsigned jobs = 1;
  double length_s = 60;
  bool trace = false;
  bool twice = false;
  bool stop_at_first = false;
  bool habits = false;
};

/// Number of simulated worlds of a tool from which on each count of the tool (struct Met) must be above 0.
constexpr std::uint64_t enough_worlds = 10;

struct Sum {
  std::uint64_t worlds = 0, failed = 0, ticks = 0, writes = 0, sequences = 0, holdings = 0, faults = 0,
                trips = 0, rows = 0, incidents = 0;
  /// growth_bytes is the largest growth of the heap, and descriptors the largest number of descriptors, over
  /// all worlds. The other members are sums.
  std::uint64_t growth_bytes = 0, descriptors = 0;
  struct Tools {
    std::uint64_t worlds = 0, failed = 0;
    Met met;
  };
  std::array<Tools, tool_count> tools{};
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
  for (std::size_t i = 0; i < tool_count; ++i) {
    sum.tools[i].worlds += other.tools[i].worlds;
    sum.tools[i].failed += other.tools[i].failed;
    sum.tools[i].met += other.tools[i].met;
  }
}

void add(Sum& sum, Tool tool, const WorldResult& result) {
  const std::uint64_t failed = result.violation ? 1U : 0U;
  Sum one{1,
          failed,
          result.ticks,
          result.writes,
          result.sequences,
          result.holdings,
          result.faults,
          result.trips,
          result.rows,
          result.incidents.size(),
          result.growth_bytes,
          result.descriptors};
  one.tools[static_cast<std::size_t>(tool)] = {1, failed, result.met};
  add(sum, one);
}

/// Option value for which the seed selects a tool from the list `turns`. Tool::baseline and Tool::experiment
/// take the longest time, so the list contains each of them only once.
constexpr const char* all_tools = "tools";
constexpr std::array turns{
    Tool::calibrate, Tool::plc,    Tool::doctor,     Tool::run, Tool::blocks, Tool::plc,
    Tool::calibrate, Tool::doctor, Tool::baseline,   Tool::run, Tool::plc,    Tool::blocks,
    Tool::calibrate, Tool::doctor, Tool::experiment, Tool::run, Tool::plc};

/// Factor on --seconds for each tool. Tool::baseline and Tool::experiment play experiments, which take
/// minutes, so their factors are larger.
constexpr std::array<double, tool_count> lives{1, 1, 1, 1, 5, 3, 1, 1};

/// Returns the tool that the user has requested. If the user has requested no tool, returns the tool that
/// `turns` contains for this seed.
Tool tool_of(const Options& options, std::uint64_t seed) {
  const auto found = std::find(tool_names.begin(), tool_names.end(), options.tool);
  if (found != tool_names.end()) return static_cast<Tool>(found - tool_names.begin());
  return turns[seed % turns.size()];
}

std::string of_tool(Tool tool) {
  return tool == Tool::none ? "" : fmt::format("{}; ", tool_names[static_cast<std::size_t>(tool)]);
}

/// Prints an explanation of a violation: the shortest list of incidents that causes this violation, and the
/// end of the trace.
void explain(const Library& library, std::uint64_t seed, const WorldResult& failed,
             const WorldOptions& options) {
  WorldOptions again = options;
  again.incidents = shrink(library, seed, failed, options);
  again.trace = true;
  const WorldResult result = run_world(library, seed, again);
  std::string text = fmt::format(
      "seed {}: {}\n  {}{}\n  {} incidents; the following incidents alone cause the violation:\n", seed,
      failed.violation->invariant, of_tool(options.tool), failed.shape, failed.incidents.size());
  for (const Incident& incident : *again.incidents) text += "    " + text_of(incident) + "\n";
  text += "  end of the trace:\n";
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
  Sum sum;
  for (std::uint64_t k = job; k < options.count; k += options.jobs) {
    const std::uint64_t seed = options.first + k;
    world.trace = options.trace && options.count == 1;
    world.always_habits = options.habits;
    world.tool = tool_of(options, seed);
    world.length = nanoseconds(options.length_s * lives[static_cast<std::size_t>(world.tool)]);
    const WorldResult result = run_world(library, seed, world);
    add(sum, world.tool, result);
    if (options.twice && run_world(library, seed, world).fingerprint != result.fingerprint) {
      fmt::print("seed {}: two runs with this seed differ\n", seed);
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

/// Runs each job in a separate process, so that a crash in one world does not affect the other jobs.
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
      fmt::print("a process ended before all of its worlds were simulated\n");
      one = {};
      one.failed = 1;
    }
    close(ends[job]);
    waitpid(children[job], nullptr, 0);
    add(all, one);
  }
  return all;
}

/// Prints one line per tool. Returns false if the simulated worlds do not test a tool sufficiently. This is
/// the case if at least `enough_worlds` worlds have run the tool and one of its counts (calls, results,
/// pauses, gaps or faults) is 0. If the option value is `tools` and the number of seeds is sufficient, each
/// tool must also have run in at least `enough_worlds` worlds.
bool tell_tools(const Options& options, const Sum& sum) {
  bool eventful = true;
  for (std::size_t i = 1; i < tool_count; ++i) {
    const auto& [worlds, failed, met] = sum.tools[i];
    if (worlds == 0) continue;
    fmt::print(
        "{}: {} worlds, {} of them violated an invariant; {} calls, {} with a result; {} pauses, {} gaps, {} "
        "faults\n",
        tool_names[i], worlds, failed, met.calls, met.results, met.pauses, met.gaps, met.faults);
    const bool whole = met.whole() || worlds < enough_worlds;
    if (!whole)
      fmt::print("{}: one of these counts is 0, so these simulated worlds do not test this event\n",
                 tool_names[i]);
    eventful = eventful && whole;
  }
  if (options.tool == all_tools && options.count >= turns.size() * enough_worlds) {
    for (std::size_t i = 1; i < tool_count; ++i) eventful = eventful && sum.tools[i].worlds >= enough_worlds;
  }
  return eventful;
}

int run(int argc, char** argv) {
  Options options;
  std::vector<std::string> known(tool_names.begin(), tool_names.end());
  known.emplace_back(all_tools);
  CLI::App app("Simulates one complete rig for each seed and checks the invariants of docs/reliability.md");
  app.add_option("--first", options.first, "First seed")->capture_default_str();
  app.add_option("--count", options.count, "Number of seeds")->capture_default_str();
  app.add_option("--jobs", options.jobs, "Number of processes")->capture_default_str();
  app.add_option("--tool", options.tool,
                 "Program that is tested on the simulated rig; `tools` tests all tools one after the other")
      ->check(CLI::IsMember(known))
      ->capture_default_str();
  app.add_option(
         "--seconds", options.length_s,
         "Simulated time of each world [s]; 5 times as long for the tool baseline, 3 times for experiment")
      ->capture_default_str();
  app.add_flag("--trace", options.trace, "With --count 1: print all events");
  app.add_flag("--twice", options.twice, "Run each seed twice and compare the results");
  app.add_flag("--habits", options.habits,
               "Give every board the unusual properties that otherwise only the boards of 1 seed in 5 have");
  app.add_flag("--stop", options.stop_at_first, "Stop at the first violation");
  CLI11_PARSE(app, argc, argv);
  const Library library = load_library();
  const Sum sum = run_jobs(library, options);
  fmt::print(
      "{} simulated worlds of {} s, first seed {}: {} worlds violated an invariant\n"
      "{} ticks, {} writes, {} incidents, {} sequences, {} times HOLDING, {} faults, {} watchdog trips, "
      "{} recorded rows\n"
      "largest growth of the heap after the first 5 s: {} KiB; largest number of open descriptors: {}\n",
      sum.worlds, options.length_s, options.first, sum.failed, sum.ticks, sum.writes, sum.incidents,
      sum.sequences, sum.holdings, sum.faults, sum.trips, sum.rows, sum.growth_bytes >> 10, sum.descriptors);
  const bool eventful = tell_tools(options, sum);
  return sum.failed == 0 && eventful ? EXIT_SUCCESS : EXIT_FAILURE;
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
