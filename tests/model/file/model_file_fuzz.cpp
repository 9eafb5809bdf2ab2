// Fuzz target: passes arbitrary bytes to the reader of model files. The reader must refuse the bytes or
// return a model. If a returned model is written and read again, the result must equal this model.
//
//   Command: scripts/fuzz.sh model_file_fuzz 30

#include <cstddef>
#include <cstdint>
#include <string>

#include "model/file/model_file.h"
#include "tests/support/require.h"

namespace {

using namespace softgrip;

using test::require;

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  document::Problems problems;
  const document::Document document =
      document::parse("fuzz.yaml", std::string(reinterpret_cast<const char*>(data), size), problems);
  const auto model = model::read_model(document, problems);
  (void)problems.format();
  require(model.has_value() || !problems.empty());
  if (!model || !problems.empty()) return 0;
  document::Problems again;
  const std::string text = model::to_yaml(*model);
  const auto copy = model::read_model(document::parse("again.yaml", text, again), again);
  require(copy.has_value() && again.empty());
  require(model::to_yaml(*copy) == text);
  require(model::model_hash(*copy) == model::model_hash(*model));
  return 0;
}
