#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include "renderer/image_io/codecs/codecs.h"

namespace lightwell::codecs {

namespace {

// Found by this name in the system's folders of fonts.
constexpr const char* kFont = "DejaVuSans";

Error no_font() {
  return Error{ErrorKind::kNotFound, "labels",
               std::string("the font ") + kFont + " is not installed; Debian has it in fonts-dejavu-core"};
}

}  // namespace

Result<int> label_width(const std::string& text, int font_px) {
  const OIIO::ROI extent = OIIO::ImageBufAlgo::text_size(text, font_px, kFont);
  if (extent.defined()) return extent.width();
  OIIO::geterror();  // fetched, or OpenImageIO prints it at exit
  return no_font();
}

Status draw_label(std::span<std::uint8_t> rgb, glm::ivec2 size_px, glm::ivec2 baseline_px, const std::string& text,
                  int font_px) {
  if (size_px.x < 1 || size_px.y < 1 ||
      rgb.size() != 3 * static_cast<std::size_t>(size_px.x) * static_cast<std::size_t>(size_px.y))
    return invalid_input("labels", std::to_string(rgb.size()) + " bytes are no RGB picture of " +
                                       std::to_string(size_px.x) + "x" + std::to_string(size_px.y));
  const OIIO::ImageSpec spec(size_px.x, size_px.y, 3, OIIO::TypeDesc::UINT8);
  OIIO::ImageBuf picture(spec, rgb.data());
  const float black[3] = {0.0f, 0.0f, 0.0f};
  if (OIIO::ImageBufAlgo::render_text(picture, baseline_px.x, baseline_px.y, text, font_px, kFont, black))
    return Done{};
  picture.geterror();
  return no_font();
}

}  // namespace lightwell::codecs
