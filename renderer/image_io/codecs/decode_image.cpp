#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <exception>
#include <memory>

#include "renderer/image_io/codecs/codecs.h"
#include "renderer/image_io/codecs/library_leaks.h"

namespace lightwell::codecs {
namespace {

constexpr std::size_t kRgba = 4;

// Grey, and grey with alpha, arrive in the first one or two channels of each pixel.
void spread_grey(std::vector<std::uint8_t>& rgba, bool has_alpha) {
  for (std::size_t i = 0; i < rgba.size(); i += kRgba) {
    const std::uint8_t grey = rgba[i], alpha = has_alpha ? rgba[i + 1] : 255;
    rgba[i + 1] = rgba[i + 2] = grey;
    rgba[i + 3] = alpha;
  }
}

/// The first line of what the library says: the rest names the library.
Error broken(OIIO::ImageInput& input) {
  const std::string reason = input.geterror();
  return invalid_input("", "the image cannot be decoded: " + reason.substr(0, reason.find('\n')));
}

Result<Image> decode(std::span<const std::byte> bytes, const EncodedImage& encoded) {
  const char* format = encoded.format == ImageFormat::kPng ? "png" : "jpeg";
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
  if (!input) return Error{ErrorKind::kInternal, "", "OpenImageIO cannot read " + std::string(format)};

  OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
  void* proxy = &reader;
  OIIO::ImageSpec wanted, spec;
  wanted.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  wanted.attribute("oiio:UnassociatedAlpha", 1);
  if (!input->open(std::string("memory.") + format, spec, wanted)) return broken(*input);
  if (spec.width != static_cast<int>(encoded.width_px) || spec.height != static_cast<int>(encoded.height_px) ||
      spec.nchannels < 1)
    return invalid_input("", "the image's headers contradict each other");

  Image image;
  image.size_px = {spec.width, spec.height};
  image.rgba.assign(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) * kRgba, 255);
  const int channels = std::min(spec.nchannels, 4);
  if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, image.rgba.data(), kRgba)) return broken(*input);
  if (channels <= 2) spread_grey(image.rgba, channels == 2);
  return image;
}

}  // namespace

Result<Image> decode_image(std::span<const std::byte> bytes, const EncodedImage& encoded) {
  const LibraryLeaks allowed;
  try {
    return decode(bytes, encoded);
  } catch (const std::exception& exception) {
    return invalid_input("", std::string("the image cannot be decoded: ") + exception.what());
  }
}

}  // namespace lightwell::codecs
