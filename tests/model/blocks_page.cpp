// Writes docs/reference/blocks.md from the catalogue.
//   model_blocks_page            prints the page
//   model_blocks_page --check    exits with 1 if the file in the source tree differs from the page
//   model_blocks_page --write    writes the file

#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "base/numbers.h"
#include "model/catalogue.h"

namespace softgrip::model {
namespace {

const std::string file_name = std::string(SOFTGRIP_SOURCE_DIR) + "/docs/reference/blocks.md";

std::string_view what_it_does(Kind kind) {
  switch (kind) {
    case Kind::pressure:
      return "kPa to kPa, in series";
    case Kind::element:
      return "kPa to mm; the displacements of all elements add";
    case Kind::displacement:
      return "mm to mm, in series";
    case Kind::reading:
      return "mm to mm, once per reading";
  }
  return "";
}

std::string_view how_undone(Inverse inverse) {
  switch (inverse) {
    case Inverse::implicit:
      return "inverted together with the actuator";
    case Inverse::lead:
      return "compensated by a lead, so that its output is the planned pressure";
    case Inverse::preview:
      return "compensated with the future value of the reference";
    case Inverse::play:
      return "half the band is added in the direction of motion";
    case Inverse::bound:
      return "no inverse; limits the reference";
    case Inverse::ignored:
      return "not compensated";
  }
  return "";
}

std::string range(double value) {
  if (value == 0) return "0";
  return shortest(value);
}

void write_parameter(std::ostream& out, const ParameterSpec& spec) {
  out << "| `" << spec.name << "` | " << (spec.unit.empty() ? "-" : spec.unit) << " | "
      << range(spec.default_value) << " | " << range(spec.lower) << " to " << range(spec.upper)
      << (spec.whole ? ", whole" : "") << " | "
      << (spec.neutral == spec.neutral ? range(spec.neutral) : "any") << " | " << spec.meaning;
  if (spec.if_left_out == spec.if_left_out) out << " (may be left out: " << range(spec.if_left_out) << ")";
  out << " |\n";
}

void write_block(std::ostream& out, const BlockDescriptor& descriptor) {
  const BlockInfo& info = descriptor.info;
  out << "\n### `" << info.id << "`: " << info.title << "\n\n" << info.meaning << "\n\n";
  out << "    " << info.equation << "\n\n";
  out << "Acts on: " << what_it_does(info.kind) << ". In the feedforward: " << how_undone(info.inverse) << "."
      << (info.repeatable ? " A chain may contain this block more than once." : "") << "\n\n";
  out << "| key | unit | default | allowed | no effect at | meaning |\n|---|---|---|---|---|---|\n";
  for (const ParameterSpec& spec : descriptor.parameters) write_parameter(out, spec);
  for (const ParameterSpec& spec : descriptor.repeated) write_parameter(out, spec);
  if (descriptor.max_parts > 0) {
    out << "\n`#` counts the branches from 1, at most " << descriptor.max_parts << ".\n";
  }
}

std::string page() {
  std::ostringstream out;
  out << "# Blocks\n\n"
         "A model file lists blocks by station. The signal passes them from top to bottom:\n\n"
         "    command [kPa] -> valve -> actuator -> load -> sensor -> reading [mm]\n\n"
         "u is the command, p the pressure, y the input displacement, z the output, t the time of "
         "the"
         " campaign, ' a derivative with respect to time. Inside a station, blocks are sorted by their input:"
         " pressure, elements, displacement, reading. Every parameter of a block must be given,"
         " except those with a default (may be left out). A model file with a value outside the allowed "
         "range is"
         " refused.\n\n"
         "The output of a model whose file has `output_unit: deg` is a bending angle. mm then means deg in "
         "all "
         "keys and units below. Without this key, the unit is mm. A rig accepts only models in mm.\n\n"
         "This page is written by `model_blocks_page --write` from the declarations in `model/blocks/`.\n";
  Station station = Station::valve;
  bool first = true;
  for (const BlockDescriptor& descriptor : catalogue()) {
    if (first || descriptor.info.station != station) {
      station = descriptor.info.station;
      out << "\n## Station `" << name_of(station) << "`\n";
      first = false;
    }
    write_block(out, descriptor);
  }
  return out.str();
}

}  // namespace
}  // namespace softgrip::model

int main(int argc, char** argv) {
  using namespace softgrip::model;
  const std::string mode = argc > 1 ? argv[1] : "";
  const std::string text = page();
  if (mode == "--write") {
    std::ofstream file(file_name, std::ios::binary);
    file << text;
    return file.flush() ? 0 : 4;
  }
  if (mode == "--check") {
    std::ifstream file(file_name, std::ios::binary);
    std::ostringstream found;
    found << file.rdbuf();
    if (found.str() == text) return 0;
    std::cerr << file_name << " differs from the declarations; run model_blocks_page --write\n";
    return 1;
  }
  std::cout << text;
  return 0;
}
