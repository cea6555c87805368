// What needs OpenImageIO, which brings 250 shared libraries and a third of a second to link them: a module of its own,
// so that programs start without it and load it when a picture is read or written. renderer/image_io/image_io.h and
// label.h say what the functions do; all but these files call them there.
#pragma once

#include "renderer/image_io/encoded_image.h"
#include "renderer/image_io/image_io.h"

namespace lightwell::codecs {

/// `encoded` is what the bytes say of themselves.
Result<Image> decode_image(std::span<const std::byte> bytes, const EncodedImage& encoded);
/// The header of an .exr has been checked.
Result<FloatImage> read_image(const std::filesystem::path& path, std::uint64_t max_pixels);
Result<std::vector<std::byte>> encode_exr(const FloatImage& image, const std::map<std::string, std::string>& metadata,
                                          bool float32);
Result<std::vector<std::byte>> encode_exr_layers(glm::ivec2 size_px, std::span<const ExrLayer> layers,
                                                 const std::map<std::string, std::string>& metadata);
Result<std::vector<std::byte>> encode_ldr(const std::string& format, glm::ivec2 size_px,
                                          std::span<const std::uint8_t> rgb, int jpeg_quality);
Result<int> label_width(const std::string& text, int font_px);
Status draw_label(std::span<std::uint8_t> rgb, glm::ivec2 size_px, glm::ivec2 baseline_px, const std::string& text,
                  int font_px);

/// The functions of the module.
struct Table {
  decltype(&codecs::decode_image) decode_image;
  decltype(&codecs::read_image) read_image;
  decltype(&codecs::encode_exr) encode_exr;
  decltype(&codecs::encode_exr_layers) encode_exr_layers;
  decltype(&codecs::encode_ldr) encode_ldr;
  decltype(&codecs::label_width) label_width;
  decltype(&codecs::draw_label) draw_label;
};

}  // namespace lightwell::codecs

/// What the module is asked for by name.
extern "C" __attribute__((visibility("default"))) const lightwell::codecs::Table* lightwell_image_codecs();
