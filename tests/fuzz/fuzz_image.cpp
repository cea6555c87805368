// Pictures. The first byte says who reads the rest: the decoder of textures, or the reader of environment files by one
// of the endings that such files have.
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "renderer/image_io/environment_file.h"
#include "renderer/image_io/image_io.h"

namespace lightwell {
namespace {

constexpr std::uint64_t kMostPixels = 256 * 256;

void require(bool holds) {
  if (!holds) std::abort();
}

void read_texture(std::span<const std::byte> bytes) {
  const Result<Image> image = decode_image(bytes, kMostPixels);
  if (!image) return require(!image.error().what.empty());
  const auto pixels = static_cast<std::uint64_t>(image->size_px.x) * static_cast<std::uint64_t>(image->size_px.y);
  require(image->size_px.x > 0 && image->size_px.y > 0 && pixels <= kMostPixels && image->rgba.size() == 4 * pixels);
}

void read_environment_file(std::span<const std::byte> bytes, std::string_view ending) {
  static const std::filesystem::path folder = std::filesystem::temp_directory_path();
  const auto path = folder / ("fuzz_image-" + std::to_string(::getpid()) + std::string(ending));
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  const auto image = read_environment(path, kMostPixels);
  std::filesystem::remove(path);
  if (!image) return require(!image.error().what.empty());
  const glm::ivec2 size_px = (*image)->size_px;
  require((*image)->rgb.size() == 3 * static_cast<std::size_t>(size_px.x) * static_cast<std::size_t>(size_px.y));
  for (const float value : (*image)->rgb) require(value >= 0.0f && value <= kMaxEnvironmentRadiance);
}

}  // namespace
}  // namespace lightwell

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array<std::string_view, 4> kEndings{".hdr", ".exr", ".png", ".jpg"};
  if (size == 0) return 0;
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data + 1), size - 1);
  if (data[0] % 2 == 0)
    lightwell::read_texture(bytes);
  else
    lightwell::read_environment_file(bytes, kEndings[data[0] / 2 % kEndings.size()]);
  return 0;
}
