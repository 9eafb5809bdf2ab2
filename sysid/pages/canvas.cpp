#include "sysid/pages/canvas.h"

#include <algorithm>

#include "base/numbers.h"
#include "base/result/table.h"

namespace softgrip::sysid {
namespace {

constexpr double character_px = 6.4;

std::string_view name_of(Anchor anchor) {
  return anchor == Anchor::start ? "start" : anchor == Anchor::middle ? "middle" : "end";
}

std::string place(double x, double y, double width, double height) {
  return "<rect x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" width=\"" +
         fixed(std::max(0.0, width), 1) + "\" height=\"" + fixed(std::max(0.0, height), 1) + '"';
}

std::string text_at(Pixel at, Anchor anchor, std::string_view text, std::string_view attributes) {
  return "<text x=\"" + fixed(at.x, 1) + "\" y=\"" + fixed(at.y, 1) + "\" text-anchor=\"" +
         std::string(name_of(anchor)) + '"' + std::string(attributes) + '>' + result::escaped(text) +
         "</text>";
}

}  // namespace

double text_width(std::string_view text) {
  const auto characters = std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80; });
  return character_px * static_cast<double>(characters);
}

void Canvas::line(Pixel from, Pixel to, Colour colour, std::string_view more) {
  markup_ += "<path d=\"" + path_data({from, to}) + '"' + stroked(colour) + std::string(more) + "/>";
}

void Canvas::box(double x, double y, double width, double height, Colour fill, std::string_view more) {
  markup_ += place(x, y, width, height) + filled(fill) + std::string(more) + "/>";
}

void Canvas::framed_box(double x, double y, double width, double height, Colour fill, Colour edge,
                        std::string_view more) {
  markup_ += place(x, y, width, height) + filled(fill, edge) + std::string(more) + "/>";
}

void Canvas::words(Pixel at, Anchor anchor, std::string_view text, Colour colour, std::string_view more) {
  markup_ += text_at(at, anchor, text, filled(colour) + std::string(more));
}

void Canvas::words_on_curve(Pixel at, Anchor anchor, std::string_view text) {
  markup_ += text_at(at, anchor, text,
                     filled(Colour::text, Colour::paper) + " paint-order=\"stroke\" stroke-width=\"3\"");
}

}  // namespace softgrip::sysid
