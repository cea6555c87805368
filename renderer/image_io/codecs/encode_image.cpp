#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <exception>
#include <memory>

#include "renderer/image_io/codecs/codecs.h"

namespace lightwell::codecs {
namespace {

Status check_size(glm::ivec2 size_px, int channels, std::size_t values) {
  if (size_px.x < 1 || size_px.y < 1 || channels < 1)
    return invalid_input("size", std::to_string(size_px.x) + " x " + std::to_string(size_px.y) + " is not a size");
  const std::uint64_t expected = static_cast<std::uint64_t>(size_px.x) * static_cast<std::uint64_t>(size_px.y) *
                                 static_cast<std::uint64_t>(channels);
  if (values != expected)
    return invalid_input("pixels",
                         std::to_string(values) + " values given where the size needs " + std::to_string(expected));
  return Done{};
}

Result<std::vector<std::byte>> encode(const std::string& plugin, const std::string& ending, OIIO::ImageSpec spec,
                                      OIIO::TypeDesc type, const void* pixels) {
  const auto failed = [](const std::string& why) {
    return Error{ErrorKind::kInternal, "", "the image cannot be encoded: " + why};
  };
  try {
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(plugin);
    if (!output) return failed("OpenImageIO cannot write " + plugin);
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput writer(encoded);
    void* proxy = &writer;
    spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    if (!output->open("memory." + ending, spec) || !output->write_image(type, pixels) || !output->close())
      return failed(output->geterror());
    std::vector<std::byte> bytes(encoded.size());
    std::transform(encoded.begin(), encoded.end(), bytes.begin(), [](unsigned char byte) { return std::byte{byte}; });
    return bytes;
  } catch (const std::exception& exception) {
    return failed(exception.what());
  }
}

OIIO::ImageSpec exr_spec(glm::ivec2 size_px, int channels, const std::map<std::string, std::string>& metadata) {
  OIIO::ImageSpec spec(size_px.x, size_px.y, channels, OIIO::TypeDesc::FLOAT);
  spec.attribute("oiio:ColorSpace", "Linear");
  // Left to itself, OpenImageIO records the time of writing, and the same picture would give other bytes each time.
  spec.attribute("DateTime", "1970:01:01 00:00:00");
  for (const auto& [key, value] : metadata) spec.attribute(key, value);
  return spec;
}

}  // namespace

Result<std::vector<std::byte>> encode_exr(const FloatImage& image, const std::map<std::string, std::string>& metadata,
                                          bool float32) {
  if (image.channels != 3 && image.channels != 4)
    return invalid_input("channels", std::to_string(image.channels) + " channels given where 3 or 4 are needed");
  if (Status sized = check_size(image.size_px, image.channels, image.pixels.size()); !sized) return sized.error();
  OIIO::ImageSpec spec = exr_spec(image.size_px, image.channels, metadata);
  spec.set_format(float32 ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::HALF);
  return encode("openexr", "exr", std::move(spec), OIIO::TypeDesc::FLOAT, image.pixels.data());
}

Result<std::vector<std::byte>> encode_exr_layers(glm::ivec2 size_px, std::span<const ExrLayer> layers,
                                                 const std::map<std::string, std::string>& metadata) {
  if (layers.empty()) return invalid_input("layers", "there are none");
  const std::size_t channels = 3 * layers.size();
  OIIO::ImageSpec spec = exr_spec(size_px, static_cast<int>(channels), metadata);
  spec.channelnames.clear();
  for (const ExrLayer& layer : layers) {
    if (Status sized = check_size(size_px, 3, layer.rgb.size()); !sized) return sized.error();
    for (const char* channel : {"R", "G", "B"})
      spec.channelnames.push_back(layer.name.empty() ? channel : layer.name + "." + channel);
  }
  std::vector<float> pixels(channels * layers.front().rgb.size() / 3);
  for (std::size_t layer = 0; layer < layers.size(); ++layer)
    for (std::size_t i = 0; i < layers[layer].rgb.size(); ++i)
      pixels[i / 3 * channels + 3 * layer + i % 3] = layers[layer].rgb[i];
  return encode("openexr", "exr", std::move(spec), OIIO::TypeDesc::FLOAT, pixels.data());
}

Result<std::vector<std::byte>> encode_ldr(const std::string& format, glm::ivec2 size_px,
                                          std::span<const std::uint8_t> rgb, int jpeg_quality) {
  const bool jpeg = format == "jpg" || format == "jpeg";
  if (!jpeg && format != "png")
    return Error{ErrorKind::kUnsupported, "format", "'" + format + "' is neither png nor jpg"};
  if (Status sized = check_size(size_px, 3, rgb.size()); !sized) return sized.error();
  OIIO::ImageSpec spec(size_px.x, size_px.y, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (jpeg) {
    spec.attribute("CompressionQuality", std::clamp(jpeg_quality, 1, 100));
    spec.attribute("jpeg:subsampling", "4:4:4");
  }
  return encode(jpeg ? "jpeg" : "png", format, std::move(spec), OIIO::TypeDesc::UINT8, rgb.data());
}

}  // namespace lightwell::codecs
