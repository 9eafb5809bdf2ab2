// Generates the page docs/reference/blocks.md from the catalogue.
//   model_blocks_page            prints the page
//   model_blocks_page --check    exits with 1 if the file in the source tree differs from the generated page
//   model_blocks_page --write    writes the file

#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "base/numbers.h"
#include "model/catalogue.h"
#include "tests/support/files.h"

namespace softgrip::model {
namespace {

const std::string file_name = std::string(SOFTGRIP_SOURCE_DIR) + "/docs/reference/blocks.md";

std::string_view what_it_does(const BlockInfo& info) {
  // A block whose equation begins in this way has no output of its own.
  if (info.equation.starts_with("bouc_wen:")) return "The block modifies the block `bouc_wen` of the model.";
  switch (info.kind) {
    case Kind::pressure:
      return "The block changes the pressure [kPa], in series with the other blocks.";
    case Kind::element:
      return "The block computes a displacement [mm] from the pressure [kPa]. The model adds the "
             "displacements of all blocks that compute a displacement.";
    case Kind::displacement:
      return "The block changes the displacement [mm], in series with the other blocks.";
    case Kind::reading:
      return "The block changes each reading [mm].";
  }
  return "";
}

std::string_view how_undone(Inverse inverse) {
  switch (inverse) {
    case Inverse::implicit:
      return "The feedforward inverts the block and the blocks of the actuator together.";
    case Inverse::lead:
      return "The feedforward compensates the block with a lead term, so that the output of the block is the "
             "planned pressure.";
    case Inverse::preview:
      return "The feedforward compensates the dead time of the block with the future value of the reference.";
    case Inverse::play:
      return "To compensate the block, the feedforward adds half of the band to the command, in the "
             "direction of motion.";
    case Inverse::bound:
      return "The feedforward does not invert the block. The block sets a limit for the reference.";
    case Inverse::none:
      return "The block has no inverse. The feedforward `planned` uses the block. The feedforward "
             "`full_model` refuses a model that contains the block.";
    case Inverse::ignored:
      return "The feedforward does not compensate the block.";
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
      << (spec.whole ? ", whole" : "") << " | " << (spec.neutral == spec.neutral ? range(spec.neutral) : "-")
      << " | " << spec.meaning;
  if (spec.if_left_out == spec.if_left_out) out << " (optional, default " << range(spec.if_left_out) << ")";
  if (!spec.formerly.empty()) out << "; deprecated name: `" << spec.formerly << "`";
  out << " |\n";
}

void write_block(std::ostream& out, const BlockDescriptor& descriptor) {
  const BlockInfo& info = descriptor.info;
  out << "\n### `" << info.id << "`: " << info.title << "\n\n" << info.meaning << "\n\n";
  if (!info.formerly.empty()) out << "Deprecated name: `" << info.formerly << "`.\n\n";
  out << "    " << info.equation << "\n\n";
  out << what_it_does(info) << " " << how_undone(info.inverse)
      << (info.repeatable ? " A model may contain the block more than once." : "") << "\n\n";
  out << "| key | unit | typical | allowed | no effect at | meaning |\n|---|---|---|---|---|---|\n";
  for (const ParameterSpec& spec : descriptor.parameters) write_parameter(out, spec);
  for (const ParameterSpec& spec : descriptor.repeated) write_parameter(out, spec);
  if (descriptor.max_parts > 0) {
    out << "\nReplace `#` by consecutive numbers from 1. The largest number is at most "
        << descriptor.max_parts << ".\n";
  }
}

std::string page() {
  std::ostringstream out;
  out << "# Blocks\n\n"
         "A model file lists the blocks of each component of the gripper: the valve, the actuator, the "
         "load and the sensor. The signal passes through valve, actuator, load and sensor in this order. "
         "Inside a component, "
         "the signal passes through the blocks in the order of the model file:\n\n"
         "    command [kPa] -> valve -> actuator -> load -> sensor -> reading [mm]\n\n"
         "In the equations, u is the commanded pressure, p the pressure, y the input displacement of the "
         "block, and z the output displacement of the block. The symbol t is the time since the start of the "
         "first log. An apostrophe denotes the derivative with respect to time. For each component, this "
         "page lists the blocks in this "
         "order: blocks that change the pressure, blocks that compute a displacement from the pressure, "
         "blocks that change the displacement, and blocks that change the reading.\n\n"
         "The column \"typical\" contains a parameter value at which the block has a visible effect. "
         "The column \"no effect at\" contains the parameter value at which the block has no effect. A \"-\" "
         "in the column \"no effect at\" means that the block has an effect at every value of the parameter. "
         "A model file must state every parameter "
         "that is"
         " not marked as optional. softgrip refuses a model file with a value outside the allowed range.\n\n"
         "Some blocks and parameters have a deprecated name. Model files and the options `--fix` and "
         "`--free` "
         "of `softgrip identify` accept the name and the deprecated name. A block must not contain both "
         "names "
         "of a parameter. softgrip writes model files without deprecated names. In `identify.json` and "
         "`diagnosis.json`, a parameter with a deprecated name has two keys with the same content.\n\n"
         "If a model file has `output_unit: deg`, the output of the model is a bending angle, "
         "and mm means deg in all keys and units on this page. Without the key `output_unit`, the output of "
         "the model is a displacement in mm."
         " A rig accepts only models in mm.\n\n"
         "`model_blocks_page --write` writes this page from the declarations in "
         "`model/blocks/`.\n";
  Station station = Station::valve;
  bool first = true;
  for (const BlockDescriptor& descriptor : catalogue()) {
    if (first || descriptor.info.station != station) {
      station = descriptor.info.station;
      out << "\n## Component `" << name_of(station) << "`\n";
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
    if (softgrip::test::text_of(file_name) == text) return 0;
    std::cerr << file_name << " differs from the declarations; run model_blocks_page --write\n";
    return 1;
  }
  std::cout << text;
  return 0;
}
