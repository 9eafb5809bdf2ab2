#include "bench/studies/study_text.h"

namespace softgrip::studies {

std::string cell(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

result::Fields parameters_of(const model::Model& model) {
  result::Fields fields;
  const std::vector<double> values = model::flat_values(model);
  for (std::size_t i = 0; i < values.size(); ++i)
    fields.emplace_back(model::parameter_path(model, i), values[i]);
  return fields;
}

}  // namespace softgrip::studies
