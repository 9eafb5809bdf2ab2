#include "probes.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "world.h"

namespace textbook {
namespace {

void probe_flow() {
  std::puts("ratio,flow");
  for (int i = 0; i <= 100; ++i) std::printf("%.2f,%.12g\n", i / 100.0, flow_dm3_s(0.01, 0.3, 300, 3.0 * i));
}

void probe_rest() {
  std::puts("time_s,air_kpa_dm3");
  Valve valve({});
  valve.set(180, 120, true);
  for (int i = 0; i <= 4000; ++i) {
    if (i % 400 == 0) std::printf("%.4f,%.12g\n", i * 0.00025, valve.air_kpa_dm3());
    valve.step(40, 200, 0.00025);
  }
}

// Holds a constant command after a step, and prints the middle and the width of the range of the true
// pressure between 60 s and 70 s after the step. Some steps rise and others fall.
void probe_hold() {
  std::puts("seed,command_kpa,pressure_kpa,variation_kpa");
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Valve valve(draw_world("play", seed).valve);
    for (const double command : {20.0, 55.0, 30.0, 8.0, 0.0}) {
      double low = 1e9, high = -1e9;
      for (int i = 0; i < 280000; ++i) {
        valve.step(command, 190, 0.00025);
        if (i < 240000) continue;
        low = std::min(low, valve.gauge_kpa());
        high = std::max(high, valve.gauge_kpa());
      }
      std::printf("%d,%g,%.6g,%.6g\n", static_cast<int>(seed), command, (low + high) / 2, high - low);
    }
  }
}

// Prints two values for several fingers of each make: the displacement at working pressure after a very long
// hold, and the nominal span.
void probe_span() {
  std::puts("make,seed,span_mm,displacement_mm");
  for (const std::string& make : makes()) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const FingerNumbers numbers = draw_finger(make, seed);
      Finger finger(numbers);
      double y = 0;
      for (int i = 1; i <= 1000; ++i)
        y = finger.step(working_kpa * std::min(1.0, i / 200.0), i <= 200 ? 0.01 : 100);
      std::printf("%s,%d,%.9g,%.9g\n", make.c_str(), static_cast<int>(seed), numbers.span_mm, y);
    }
  }
}

// Unloads a finger from 55 kPa, once with and once without a minor loop 20 -> 40 -> 20 kPa. Prints the
// displacements after the minor loop in both cases. The displacements of the two cases must be equal.
void probe_loops() {
  std::puts("make,place,displacement_mm");
  for (const char* make : {"play", "maxwell_slip", "preisach"}) {
    for (const bool minor : {false, true}) {
      FingerNumbers numbers = draw_finger(make, 1);
      numbers.creep = 0;
      Finger finger(numbers);
      double p = 0, y = 0;
      const auto walk = [&](double to) {
        const double from = p;
        for (int i = 1; i <= 400; ++i) y = finger.step(p = from + (to - from) * i / 400, 0.002);
      };
      walk(55);
      walk(20);
      if (minor) {
        std::printf("%s,turn,%.12g\n", make, y);
        walk(40);
        std::printf("%s,inside,%.12g\n", make, y);
        walk(20);
        std::printf("%s,back,%.12g\n", make, y);
      }
      walk(5);
      std::printf("%s,%s,%.12g\n", make, minor ? "end" : "end_reference", y);
      walk(0);
      walk(40);
      std::printf("%s,%s,%.12g\n", make, minor ? "rising" : "rising_reference", y);
    }
  }
}

// Prints a varying pressure and the displacement of the Preisach model for this pressure. Another program
// compares the displacement with a sum over single relays.
void probe_relays() {
  FingerNumbers numbers = draw_finger("preisach", 1);
  numbers.creep = numbers.curvature = 0;
  Finger finger(numbers);
  std::puts("pressure_kpa,displacement_mm,span_mm,width,envelope");
  double p = 0;
  for (const double to : {50.0, 10.0, 40.0, 22.0, 33.0, 18.0, 45.0, 60.0, 5.0, 30.0, 0.0, 25.0}) {
    for (const double from = p; p != to;) {
      p = to > from ? std::min(to, p + 0.5) : std::max(to, p - 0.5);
      std::printf("%.9g,%.9g,%.9g,%.9g,%.9g\n", p, finger.step(p, 0.01), numbers.span_mm, numbers.width,
                  numbers.envelope);
    }
  }
}

void probe_creep() {
  std::puts("make,time_s,displacement_mm");
  for (const std::string& make : makes()) {
    Finger finger(draw_finger(make, 1));
    double next = 0.02;
    for (int i = 1; i <= 500000; ++i) {
      const double y = finger.step(40, 0.002);
      if (i * 0.002 < next) continue;
      std::printf("%s,%.3f,%.12g\n", make.c_str(), i * 0.002, y);
      next *= 2;
    }
  }
}

}  // namespace

void probe(const std::string& name) {
  if (name == "flow") return probe_flow();
  if (name == "rest") return probe_rest();
  if (name == "hold") return probe_hold();
  if (name == "loops") return probe_loops();
  if (name == "relays") return probe_relays();
  if (name == "span") return probe_span();
  if (name == "creep") return probe_creep();
  throw std::invalid_argument("unknown probe " + name);
}

}  // namespace textbook
