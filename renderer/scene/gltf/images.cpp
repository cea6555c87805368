#include "renderer/scene/gltf/images.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <thread>

#include "renderer/image_io/encoded_image.h"
#include "renderer/image_io/image_io.h"

namespace lightwell::gltf {
namespace {

struct Encoded {
  std::string name, where;
  Bytes fetched;  // what `bytes` shows of an image outside the file
  std::span<const std::byte> bytes;
};

std::vector<bool> used_textures(const Scene& scene) {
  std::vector<bool> used(scene.textures.size(), false);
  for (const Material& material : scene.materials)
    for (const TextureUse* use :
         {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
          &material.occlusion_texture, &material.emissive_texture, &material.specular_texture,
          &material.specular_color_texture, &material.transmission_texture, &material.clearcoat_texture,
          &material.clearcoat_roughness_texture, &material.clearcoat_normal_texture, &material.sheen_color_texture,
          &material.sheen_roughness_texture})
      if (use->texture != kNone) used[static_cast<std::size_t>(use->texture)] = true;
  return used;
}

/// Numbers the images in use in the order of the textures, and makes the textures refer to them by these numbers. Gives
/// the images' numbers in the file.
std::vector<std::size_t> number_used_images(const Document& document, Scene& scene) {
  const std::vector<bool> used = used_textures(scene);
  std::vector<int> number(document.images.size(), kNone);
  std::vector<std::size_t> sources;
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    Texture& texture = scene.textures[i];
    if (!used[i]) texture.image = kNone;
    if (texture.image == kNone) continue;
    const auto source = static_cast<std::size_t>(texture.image);
    if (number[source] == kNone) {
      number[source] = static_cast<int>(sources.size());
      sources.push_back(source);
    }
    texture.image = number[source];
  }
  return sources;
}

/// The bytes of an image, whose pixels are claimed.
Encoded find_encoded(Context& context, std::size_t index) {
  const ImageSource& source = context.document.images[index];
  Encoded encoded{source.name, join("images", index), {}, {}};
  if (source.uri.empty()) {
    encoded.bytes = bytes_of_view(context.document, source.buffer_view, encoded.where);
  } else {
    encoded.fetched = context.files.fetch(source.uri, join(encoded.where, "uri"));
    encoded.bytes = encoded.fetched;
  }
  // Many images may be views of the same bytes; what is claimed here bounds the time that decoding them takes.
  context.encoded_image_bytes.claim(encoded.bytes.size(), encoded.where);
  const Result<EncodedImage> header = inspect_image(encoded.bytes);
  if (!header) fail(encoded.where, header.error().what, header.error().kind);
  const std::uint64_t pixels = std::uint64_t{header->width_px} * header->height_px;
  if (pixels <= context.limits.max_image_pixels)  // larger ones are refused by decode_image
    context.decoded_image_bytes.claim(pixels * 4, encoded.where);
  return encoded;
}

/// Decodes on all cores: this is where most of a textured scene's loading time goes.
std::vector<Result<Image>> decode_all(const std::vector<Encoded>& encoded, std::uint64_t max_pixels) {
  std::vector<Result<Image>> images(encoded.size(), Result<Image>(Error{}));
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < encoded.size(); i = next++) images[i] = decode_image(encoded[i].bytes, max_pixels);
  };
  std::vector<std::jthread> threads;
  const std::size_t helpers = std::min<std::size_t>(std::max(std::thread::hardware_concurrency(), 1u), encoded.size());
  for (std::size_t i = 1; i < helpers; ++i) threads.emplace_back(work);
  work();
  threads.clear();
  return images;
}

}  // namespace

void read_images(Context& context, Scene& scene) {
  std::vector<Encoded> encoded;
  for (const std::size_t source : number_used_images(context.document, scene))
    encoded.push_back(find_encoded(context, source));
  std::vector<Result<Image>> images = decode_all(encoded, context.limits.max_image_pixels);
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (!images[i]) fail(encoded[i].where, images[i].error().what, images[i].error().kind);
    images[i]->name = std::move(encoded[i].name);
    scene.images.push_back(std::make_shared<const Image>(std::move(*images[i])));
  }
}

}  // namespace lightwell::gltf
