#include "server/command_line/output_file.h"

#include <algorithm>
#include <cctype>

#include "renderer/check.h"
#include "renderer/image_io/image_io.h"

namespace lightwell {

namespace {

std::string lower_case_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char character) { return static_cast<char>(std::tolower(character)); });
  return ending;
}

std::vector<std::uint8_t> rgb_from_rgbx(const std::vector<std::uint8_t>& rgbx) {
  std::vector<std::uint8_t> rgb(rgbx.size() / 4 * 3);
  for (std::size_t pixel = 0; pixel < rgbx.size() / 4; ++pixel)
    std::copy_n(rgbx.begin() + static_cast<std::ptrdiff_t>(4 * pixel), 3,
                rgb.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
  return rgb;
}

}  // namespace

std::optional<OutputFormat> output_format_of(const std::filesystem::path& path) {
  const std::string ending = lower_case_ending(path);
  if (ending == ".exr") return OutputFormat::kExr;
  if (ending == ".png") return OutputFormat::kPng;
  if (ending == ".jpg" || ending == ".jpeg") return OutputFormat::kJpeg;
  return std::nullopt;
}

bool is_scene_referred(const std::filesystem::path& path) {
  const std::string ending = lower_case_ending(path);
  return ending == ".exr" || ending == ".hdr";
}

Status check_folder_of(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  std::error_code error;
  if (std::filesystem::is_directory(folder, error)) return Done{};
  return Error{ErrorKind::kInternal, path.string(), "cannot be written: there is no folder " + folder.string()};
}

Status write_frame(const std::filesystem::path& path, const Frame& frame,
                   const std::map<std::string, std::string>& metadata) {
  const std::size_t pixels = static_cast<std::size_t>(frame.size_px.x) * static_cast<std::size_t>(frame.size_px.y);
  if (output_format_of(path) == OutputFormat::kExr) {
    LIGHTWELL_CHECK_OP(frame.linear_rgb.size(), ==, 3 * pixels);
    return write_exr(path, FloatImage{frame.size_px, 3, frame.linear_rgb}, metadata);
  }
  LIGHTWELL_CHECK_OP(frame.display_rgbx.size(), ==, 4 * pixels);
  return write_ldr(path, frame.size_px, rgb_from_rgbx(frame.display_rgbx));
}

}  // namespace lightwell
