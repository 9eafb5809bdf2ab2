#include "tools/figures/figure_files.h"

#include <cmath>
#include <memory>

#include <cairo-pdf.h>
#include <cairo.h>
#include <librsvg/rsvg.h>

namespace softgrip::tools {
namespace {

struct Release {
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
  void operator()(GInputStream* stream) const { g_object_unref(stream); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
template <class T>
using Held = std::unique_ptr<T, Release>;
using Bytes = tl::expected<std::string, std::string>;

/// A parsed picture and its size [px].
struct Picture {
  Held<RsvgHandle> handle;
  double width = 0;
  double height = 0;
};

tl::expected<Picture, std::string> read(std::string_view svg) {
  const Held<GInputStream> stream(
      g_memory_input_stream_new_from_data(svg.data(), static_cast<gssize>(svg.size()), nullptr));
  GError* error = nullptr;
  Picture picture;
  // Without this flag, librsvg refuses a very long path, such as the curve of a long log.
  picture.handle.reset(
      rsvg_handle_new_from_stream_sync(stream.get(), nullptr, RSVG_HANDLE_FLAG_UNLIMITED, nullptr, &error));
  if (!picture.handle) {
    std::string why = error != nullptr ? error->message : "unknown reason";
    g_clear_error(&error);
    return tl::unexpected("librsvg cannot read the picture: " + why);
  }
  if (rsvg_handle_get_intrinsic_size_in_pixels(picture.handle.get(), &picture.width, &picture.height) == 0)
    return tl::unexpected(std::string("the picture has no size"));
  return picture;
}

cairo_status_t append(void* text, const unsigned char* bytes, unsigned int count) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

/// Draws the picture on a surface, scaled to `width` x `height`.
tl::expected<void, std::string> draw(const Picture& picture, cairo_surface_t* surface, double width,
                                     double height) {
  const Held<cairo_t> context(cairo_create(surface));
  const RsvgRectangle place{0, 0, width, height};
  GError* error = nullptr;
  if (rsvg_handle_render_document(picture.handle.get(), context.get(), &place, &error) == 0) {
    std::string why = error != nullptr ? error->message : "unknown reason";
    g_clear_error(&error);
    return tl::unexpected("librsvg cannot draw the picture: " + why);
  }
  if (cairo_status(context.get()) != CAIRO_STATUS_SUCCESS)
    return tl::unexpected(std::string("cairo cannot draw the picture: ") +
                          cairo_status_to_string(cairo_status(context.get())));
  return {};
}

}  // namespace

Bytes pdf_of(std::string_view svg) {
  constexpr double points_per_pixel = 0.75;
  const auto picture = read(svg);
  if (!picture) return tl::unexpected(picture.error());
  std::string bytes;
  const double width = points_per_pixel * picture->width;
  const double height = points_per_pixel * picture->height;
  {
    const Held<cairo_surface_t> surface(cairo_pdf_surface_create_for_stream(append, &bytes, width, height));
    // PDF 1.4 has no compressed objects, so all versions of cairo write equal files. The default of newer
    // cairo versions is PDF 1.7.
    cairo_pdf_surface_restrict_to_version(surface.get(), CAIRO_PDF_VERSION_1_4);
    if (const auto drawn = draw(*picture, surface.get(), width, height); !drawn)
      return tl::unexpected(drawn.error());
    cairo_surface_show_page(surface.get());
    cairo_surface_finish(surface.get());
  }
  return bytes;
}

Bytes png_of(std::string_view svg) {
  constexpr double scale = 2;
  const auto picture = read(svg);
  if (!picture) return tl::unexpected(picture.error());
  const double width = std::ceil(scale * picture->width);
  const double height = std::ceil(scale * picture->height);
  const Held<cairo_surface_t> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height)));
  if (const auto drawn = draw(*picture, surface.get(), width, height); !drawn)
    return tl::unexpected(drawn.error());
  std::string bytes;
  if (cairo_surface_write_to_png_stream(surface.get(), append, &bytes) != CAIRO_STATUS_SUCCESS)
    return tl::unexpected(std::string("cairo cannot write the picture as PNG"));
  return bytes;
}

}  // namespace softgrip::tools
