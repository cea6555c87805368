#include "renderer/image_io/environment_file.h"

#include <algorithm>
#include <cmath>

#include "renderer/image_io/image_io.h"

namespace lightwell {

namespace {

std::string pixel_name(std::size_t pixel, int width) {
  const auto columns = static_cast<std::size_t>(width);
  return "pixel " + std::to_string(pixel % columns) + ", " + std::to_string(pixel / columns);
}

}  // namespace

Result<std::shared_ptr<const ImageHdr>> read_environment(const std::filesystem::path& path, std::uint64_t max_pixels) {
  const Result<FloatImage> picture = read_image(path, max_pixels);
  if (!picture) return picture.error();
  const glm::ivec2 size_px = picture->size_px;
  const auto pixels = static_cast<std::uint64_t>(size_px.x) * static_cast<std::uint64_t>(size_px.y);
  auto image = std::make_shared<ImageHdr>();
  image->name = path.filename().string();
  image->size_px = size_px;
  image->rgb.reserve(pixels * 3);
  const auto channels = static_cast<std::size_t>(picture->channels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const float value = picture->pixels[pixel * channels + channel];
      if (!std::isfinite(value) || value > kMaxEnvironmentRadiance)
        return invalid_input(path.string(), "the light at " + pixel_name(pixel, size_px.x) + " is " +
                                                std::to_string(value) + "; it must be a number up to 1e9");
      image->rgb.push_back(std::max(value, 0.0f));
    }
  return std::shared_ptr<const ImageHdr>(std::move(image));
}

Status apply_environment(const EnvironmentChoice& choice, Environment& environment) {
  if (!choice.file.empty()) {
    Result<std::shared_ptr<const ImageHdr>> image = read_environment(choice.file);
    if (!image) return image.error();
    environment.image = std::move(image).value();
    environment.strength = 1.0f;
    environment.rotation = 0.0f;
  }
  environment.rotation = choice.rotation.value_or(environment.rotation);
  environment.strength = choice.strength.value_or(environment.strength);
  return Done{};
}

}  // namespace lightwell
