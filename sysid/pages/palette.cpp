#include "sysid/pages/palette.h"

#include <array>
#include <cstddef>

namespace softgrip::sysid {
namespace {

struct Role {
  std::string_view name;
  std::string_view light;
  std::string_view dark;
};

/// Names and colours of the roles, in the order of Colour. Blue and vermilion are lighter in the dark scheme
/// than in the light scheme.
constexpr std::array roles{
    Role{"measured", "#4d4d4d", "#c3ccd3"}, Role{"model", "#0072b2", "#56b4e9"},
    Role{"error", "#d55e00", "#f08a4b"},    Role{"other", "#a8578a", "#dd9cc1"},
    Role{"faint", "#9fadb7", "#6b7882"},    Role{"good", "#009e73", "#2fc79b"},
    Role{"bad", "#a3291f", "#ff8d83"},      Role{"text", "#20272c", "#e3e8eb"},
    Role{"muted", "#5b666e", "#a3afb8"},    Role{"axis", "#8a949c", "#75818a"},
    Role{"grid", "#e4e8eb", "#2b343b"},     Role{"paper", "#ffffff", "#14191d"},
    Role{"panel", "#f3f6f8", "#1e262c"},
};
static_assert(roles.size() == static_cast<std::size_t>(Colour::panel) + 1);

const Role& role_of(Colour colour) {
  return roles.at(static_cast<std::size_t>(colour));
}

std::string variables(std::string_view Role::*scheme) {
  std::string text;
  for (const Role& role : roles)
    text += "--" + std::string(role.name) + ':' + std::string(role.*scheme) + ';';
  return text;
}

}  // namespace

std::string stroked(Colour stroke) {
  const Role& role = role_of(stroke);
  return " class=\"s-" + std::string(role.name) + "\" stroke=\"" + std::string(role.light) + '"';
}

std::string filled(Colour fill, std::optional<Colour> stroke) {
  const Role& inside = role_of(fill);
  std::string classes = "f-" + std::string(inside.name);
  std::string attributes = " fill=\"" + std::string(inside.light) + '"';
  if (stroke) {
    const Role& edge = role_of(*stroke);
    classes += " s-" + std::string(edge.name);
    attributes += " stroke=\"" + std::string(edge.light) + '"';
  }
  return " class=\"" + classes + '"' + attributes;
}

std::string scheme_css(std::string_view selector) {
  const std::string scope(selector);
  std::string css = scope + '{' + variables(&Role::light) + "color-scheme:light dark}\n" +
                    "@media screen and (prefers-color-scheme:dark){" + scope + '{' + variables(&Role::dark) +
                    "}}\n";
  for (const Role& role : roles) {
    const std::string name(role.name);
    css += ".s-" + name + "{stroke:var(--" + name + ")}.f-" + name + "{fill:var(--" + name + ")}\n";
  }
  return css;
}

}  // namespace softgrip::sysid
