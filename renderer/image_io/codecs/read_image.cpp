#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>

#include "renderer/image_io/codecs/codecs.h"
#include "renderer/image_io/codecs/library_leaks.h"

namespace lightwell::codecs {
namespace {

// IEC 61966-2-1.
float linear_from_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

// Grey (1) becomes RGB, grey with alpha (2) becomes RGBA; three and more channels keep their first three or four.
void read_layout(FloatImage& image, int stored_channels, const std::vector<float>& stored) {
  image.channels = stored_channels == 2 || stored_channels >= 4 ? 4 : 3;
  const bool grey = stored_channels <= 2;
  const std::size_t source_stride = static_cast<std::size_t>(std::min(stored_channels, 4));
  const std::size_t pixels = stored.size() / source_stride;
  image.pixels.resize(pixels * static_cast<std::size_t>(image.channels));
  float* target = image.pixels.data();
  for (const float* source = stored.data(); source != stored.data() + stored.size(); source += source_stride) {
    for (std::size_t channel = 0; channel < 3; ++channel) *target++ = source[grey ? 0 : channel];
    if (image.channels == 4) *target++ = source[source_stride - 1];
  }
}

void decode_srgb(FloatImage& image) {
  const std::size_t stride = static_cast<std::size_t>(image.channels);
  for (std::size_t pixel = 0; pixel < image.pixels.size(); pixel += stride)
    for (std::size_t channel = 0; channel < 3; ++channel)
      image.pixels[pixel + channel] = linear_from_srgb(image.pixels[pixel + channel]);
}

Result<FloatImage> read(const std::string& file, std::uint64_t max_pixels) {
  OIIO::ImageSpec wanted;
  wanted.attribute("oiio:UnassociatedAlpha", 1);
  // The reader that the file's ending names, and no other: ImageInput::open would try every one there is, medical
  // pictures and films among them, and some of these take gigabytes at the word of a few broken bytes.
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(file);
  if (!input) return invalid_input(file, "the image cannot be opened: " + OIIO::geterror());
  OIIO::ImageSpec spec;
  if (!input->open(file, spec, wanted)) return invalid_input(file, "the image cannot be opened: " + input->geterror());
  if (spec.deep || spec.depth > 1 || spec.width < 1 || spec.height < 1 || spec.nchannels < 1)
    return Error{ErrorKind::kUnsupported, file, "deep, volume and empty images cannot be read"};
  if (static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height) > max_pixels)
    return Error{ErrorKind::kTooLarge, file,
                 "the image has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                     " pixels; at most " + std::to_string(max_pixels) + " are allowed"};

  FloatImage image;
  image.size_px = {spec.width, spec.height};
  const int channels = std::min(spec.nchannels, 4);
  std::vector<float> stored(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                            static_cast<std::size_t>(channels));
  const bool encoded = !spec.format.is_floating_point();
  if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, stored.data()))
    return invalid_input(file, "the image cannot be decoded: " + input->geterror());
  read_layout(image, channels, stored);
  if (encoded) decode_srgb(image);
  return image;
}

}  // namespace

Result<FloatImage> read_image(const std::filesystem::path& path, std::uint64_t max_pixels) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return Error{ErrorKind::kNotFound, path.string(), "no such file"};
  if (!std::filesystem::is_regular_file(path, error)) return invalid_input(path.string(), "not a file");
  const LibraryLeaks allowed;
  try {
    return read(path.string(), max_pixels);
  } catch (const std::exception& exception) {
    return invalid_input(path.string(), std::string("the image cannot be decoded: ") + exception.what());
  }
}

}  // namespace lightwell::codecs
