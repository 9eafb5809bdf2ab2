#include "sysid/structure/published_element.h"

#include <algorithm>
#include <limits>

#include "model/blocks/bouc_wen.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_lag.h"
#include "model/named.h"
#include "sysid/fitting/minimise.h"
#include "sysid/fitting/multistart.h"
#include "sysid/fitting/residuals.h"
#include "sysid/identification/combinations.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {

std::vector<std::size_t> free_numbers(const model::Model& model) {
  std::vector<std::size_t> flat;
  for (std::size_t i = 0; i < model::parameter_count(model); ++i) {
    if (is_movable(model, i)) flat.push_back(i);
  }
  return flat;
}

bool rises_everywhere(const model::Model& model) {
  const std::vector<double>& v = model.blocks[*model::position_of<model::BoucWen>(model)].values;
  const double growing = v[2] + v[3];
  const double steepest =
      growing > 0 ? std::max(1.0, 2 * v[3] / growing) : std::numeric_limits<double>::infinity();
  return beta_over_gain(model) * steepest < 1;
}

PublishedElement fit_published(const std::vector<Record>& records, Drive drive, std::size_t starts,
                               std::uint64_t seed) {
  model::Model model = base_model(records, 2);
  if (drive == Drive::command) {
    model =
        model::with_block(std::move(model), model::default_block(model::block_type<model::TransportDelay>()));
    model = model::with_block(std::move(model), model::default_block(model::block_type<model::ValveLag>()));
  }
  const FitSpace space(model, records, free_numbers(model));
  const FitPoint given{model, rest_starts(model, records)};
  const std::vector<SearchResult> found =
      search(space, records, draw_starts(space, given, records, starts, seed), 1, {});
  PublishedElement best;
  const auto lowest =
      std::min_element(found.begin(), found.end(),
                       [](const SearchResult& a, const SearchResult& b) { return a.rmse_mm < b.rmse_mm; });
  const auto residuals = residuals_for(records, space);
  MinimiseOptions options;
  const Minimum minimum = minimise(*residuals, space.z(lowest->point), options);
  best.point = space.point(minimum.z);
  best.rmse_mm = minimum.rmse_mm;
  best.converged = minimum.converged;
  for (const SearchResult& each : found) best.start_rmse_mm.push_back(each.rmse_mm);
  return best;
}

FitPoint refit_published(const std::vector<Record>& records, const FitPoint& from) {
  const FitSpace space(from.model, records, free_numbers(from.model));
  MinimiseOptions options;
  options.most_iterations = 20;
  options.tolerance = 1e-7;
  const auto residuals = residuals_for(records, space);
  return space.point(minimise(*residuals, space.z(from), options).z);
}

}  // namespace softgrip::sysid
