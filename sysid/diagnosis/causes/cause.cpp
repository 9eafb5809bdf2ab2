#include "sysid/diagnosis/causes/cause.h"

#include <algorithm>
#include <array>
#include <concepts>
#include <utility>
#include <variant>

#include "model/catalogue.h"
#include "sysid/diagnosis/causes/registry.h"

namespace softgrip::sysid {
namespace {

template <class C>
struct FormsOf {
  using Type = List<C>;
};
template <class C>
requires requires {
  typename C::Forms;
}
struct FormsOf<C> {
  using Type = typename C::Forms;
};
template <class C>
using Forms = typename FormsOf<C>::Type;

template <class F>
concept HasStarts = requires(const Scales& scales) {
  { F::starts(scales) } -> std::same_as<typename F::Starts>;
};

template <class F>
std::vector<model::BlockSpec> starts_as_blocks(const Scales& scales) {
  const std::size_t type = model::block_type<typename F::BlockType>();
  const model::BlockDescriptor& descriptor = model::catalogue()[type];
  std::vector<model::BlockSpec> blocks;
  for (typename F::Values& values : F::starts(scales)) {
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = std::clamp(values[i], descriptor.spec(i).lower, descriptor.spec(i).upper);
    blocks.push_back({type, std::move(values)});
  }
  return blocks;
}

template <class F>
bool is_fitted(std::size_t index) {
  if constexpr (requires { F::fitted; }) {
    if (index < F::BlockType::parameters.size()) {
      return std::any_of(F::fitted.begin(), F::fitted.end(), [&](const auto& p) { return p.index == index; });
    }
  }
  return true;
}

template <class F>
Range range_of(std::size_t index, const Scales& scales, const model::Model& model) {
  if constexpr (requires { F::bounds(scales, model); }) {
    for (const typename F::Bound& bound : F::bounds(scales, model)) {
      if (bound.parameter.index == index) return {bound.lower, bound.upper};
    }
  }
  return {};
}

template <class F>
double shown_mm(const model::BlockSpec& block, double displacement_mm) {
  typename F::BlockType sensor(block.values, {});
  return sensor.sample(displacement_mm, 0.0, {});
}

template <class C, class F>
constexpr CauseForm form() {
  CauseForm form;
  form.type = model::block_type<typename F::BlockType>();
  form.is_fitted = &is_fitted<F>;
  form.range = &range_of<F>;
  if constexpr (requires { C::found_by_fitting; }) {
    static_assert(!HasStarts<F>, "a cause that is not found by a fit has no start points");
  } else {
    static_assert(HasStarts<F>,
                  "this block form of a cause lacks the function `static Starts starts(const Scales&)`");
    form.starts = &starts_as_blocks<F>;
  }
  if constexpr (requires { F::free_form; }) form.free_form = F::free_form;
  if constexpr (requires { F::holds; }) form.holds = &F::holds;
  if constexpr (requires { C::sensor_shape; }) form.shown_mm = &shown_mm<F>;
  return form;
}

template <class C, class... F>
constexpr std::array<CauseForm, sizeof...(F)> forms_from(List<F...>) {
  return {form<C, F>()...};
}
template <class C>
constexpr auto forms = forms_from<C>(Forms<C>{});

template <class First, class... More>
typename First::BlockType first_block(List<First, More...>);

template <class C>
constexpr Cause cause() {
  using Block = decltype(first_block(Forms<C>{}));
  Cause cause;
  cause.id = Block::info.id;
  cause.title = Block::info.title;
  cause.station = Block::info.station;
  cause.forms = forms<C>;
  static_assert(
      requires { C::when_changed; },
      "this cause lacks `static constexpr WhenChanged when_changed`, the words and the next steps for the "
      "operator");
  cause.when_changed = C::when_changed;
  if constexpr (requires { C::id; }) cause.id = C::id;
  if constexpr (requires { C::title; }) cause.title = C::title;
  if constexpr (requires { C::found_by_fitting; }) cause.found_by_fitting = C::found_by_fitting;
  if constexpr (requires { C::needs; }) cause.needs = C::needs;
  if constexpr (requires { C::advice; }) cause.advice = C::advice;
  if constexpr (requires { C::indistinguishable; }) cause.indistinguishable = C::indistinguishable;
  if constexpr (requires { C::counterparts; }) cause.counterparts = C::counterparts;
  if constexpr (requires { C::confounded_with; }) cause.confounded_with = C::confounded_with;
  if constexpr (requires { C::is_stop; }) cause.is_stop = C::is_stop;
  if constexpr (requires { C::makes_distinguishable; })
    cause.makes_distinguishable = C::makes_distinguishable;
  if constexpr (requires { C::is_ideal; }) cause.is_ideal = C::is_ideal;
  if constexpr (requires { C::appears; }) cause.appears = C::appears;
  if constexpr (requires { C::sensor_shape; }) cause.sensor_shape = C::sensor_shape;
  return cause;
}

template <class... C>
constexpr auto table_from(List<C...>) {
  std::array<Cause, sizeof...(C)> all{cause<C>()...};
  std::sort(all.begin(), all.end(),
            [](const Cause& a, const Cause& b) { return a.forms.front().type < b.forms.front().type; });
  return all;
}
constexpr auto table = table_from(causes::All{});

// The templates below check each block of the catalogue at compile time. A block must either be a form of
// exactly one cause, or be listed once in NoCauses (registry.h).

template <class Block, class... F>
constexpr bool is_block_of(List<F...>) {
  return (std::same_as<typename F::BlockType, Block> || ...);
}
template <class Block, class... C>
constexpr std::size_t causes_with(List<C...>) {
  return (std::size_t{is_block_of<Block>(Forms<C>{})} + ...);
}
template <class Block, class... Other>
constexpr std::size_t count_in(List<Other...>) {
  return (std::size_t{std::same_as<Other, Block>} + ...);
}

template <class Block>
constexpr bool has_its_place() {
  constexpr std::size_t places = causes_with<Block>(causes::All{}) + count_in<Block>(causes::NoCauses{});
  static_assert(places > 0,
                "no cause uses this block as its form: write sysid/diagnosis/causes/<id>.h and list the new "
                "cause in registry.h (docs/how-to/add-a-cause.md)");
  static_assert(places < 2, "sysid/diagnosis/causes/registry.h lists this block more than once");
  return places == 1;
}
template <class... Block>
constexpr bool all_have_their_places(const std::variant<Block...>*) {
  return (has_its_place<Block>() && ...);
}
static_assert(all_have_their_places(static_cast<const model::AnyBlock<double>*>(nullptr)));

constexpr const Cause* find(std::string_view id) {
  const auto* const found =
      std::find_if(table.begin(), table.end(), [&](const Cause& c) { return c.id == id; });
  return found == table.end() ? nullptr : found;
}

static_assert(std::all_of(table.begin(), table.end(), [](const Cause& c) { return find(c.id) == &c; }),
              "two causes have the same id");
static_assert(
    std::all_of(table.begin(), table.end(),
                [](const Cause& c) {
                  return c.indistinguishable.empty() ||
                         (find(c.indistinguishable) != nullptr &&
                          find(c.indistinguishable)->indistinguishable == c.id);
                }),
    "if a cause lists another cause as indistinguishable, the other cause must list the first cause, too");
static_assert(std::all_of(table.begin(), table.end(),
                          [](const Cause& c) {
                            const auto known = [](std::string_view id) { return find(id) != nullptr; };
                            return std::all_of(c.counterparts.begin(), c.counterparts.end(), known) &&
                                   std::all_of(c.confounded_with.begin(), c.confounded_with.end(), known);
                          }),
              "the related ids of a cause must be ids of existing causes");

}  // namespace

std::span<const Cause> all_causes() {
  return table;
}

std::optional<Cause> find_cause(std::string_view id) {
  const Cause* const found = find(id);
  return found == nullptr ? std::nullopt : std::optional(*found);
}

const Cause* cause_of(std::size_t block_type) {
  for (const Cause& cause : table) {
    for (const CauseForm& form : cause.forms) {
      if (form.type == block_type) return &cause;
    }
  }
  return nullptr;
}

const CauseForm* form_among(std::span<const Cause> causes, const model::BlockSpec& block) {
  for (const Cause& cause : causes) {
    for (const CauseForm& form : cause.forms) {
      if (form.type == block.type && (form.holds == nullptr || form.holds(block))) return &form;
    }
  }
  return nullptr;
}

const CauseForm& form_of(const Cause& cause, const model::BlockSpec& block) {
  const CauseForm* const form = form_among({&cause, 1}, block);
  return form == nullptr ? cause.forms.back() : *form;
}

std::optional<std::size_t> position_of(const model::Model& model, const Cause& cause) {
  for (const CauseForm& form : cause.forms) {
    if (const auto position = model::position_of(model, form.type)) return position;
  }
  return std::nullopt;
}

model::Model without(model::Model model, const Cause& cause) {
  for (const CauseForm& form : cause.forms) model = model::without_block(std::move(model), form.type);
  return model;
}

std::string unanswerable(const Cause& cause, const Scales& scales) {
  if (!scales.has(cause.needs)) return "needs a " + std::string(name_of(cause.needs)) + " column that varies";
  if (cause.station == model::Station::valve && !scales.has_valve) {
    return "not tested, because the measured pressure drives the model and already contains the effects of "
           "the valve";
  }
  return {};
}

std::vector<model::BlockSpec> starts_of(const Cause& cause, const Scales& scales) {
  std::vector<model::BlockSpec> all;
  for (const CauseForm& form : cause.forms) {
    if (form.starts == nullptr) continue;
    std::vector<model::BlockSpec> own = form.starts(scales);
    all.insert(all.end(), std::make_move_iterator(own.begin()), std::make_move_iterator(own.end()));
  }
  return all;
}

std::optional<Cause> indistinguishable_from(const Cause& cause, const model::Model& model) {
  const bool between = std::any_of(model.blocks.begin(), model.blocks.end(), [](const model::BlockSpec& b) {
    const Cause* const other = cause_of(b.type);
    return other != nullptr && other->makes_distinguishable;
  });
  return between ? std::nullopt : find_cause(cause.indistinguishable);
}

std::vector<Cause> sensor_counterparts(const Cause& cause) {
  std::vector<Cause> list;
  for (const std::string_view id : cause.counterparts) list.push_back(*find_cause(id));
  return list;
}

bool are_indistinguishable(const Cause& one, const Cause& other, const model::Model& model) {
  const auto indistinguishable = indistinguishable_from(one, model);
  return indistinguishable && *indistinguishable == other;
}

}  // namespace softgrip::sysid
