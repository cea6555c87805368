#include "renderer/image_io/exr_header.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

namespace lightwell {

namespace {

constexpr std::uint32_t kMagic = 20000630, kMultiPart = 0x1000;
constexpr std::size_t kLongestName = 255;

std::optional<std::uint32_t> read_u32(std::istream& file) {
  std::array<unsigned char, 4> bytes{};
  if (!file.read(reinterpret_cast<char*>(bytes.data()), bytes.size())) return {};
  return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}

/// Up to its zero, which is taken too.
std::optional<std::string> read_name(std::istream& file) {
  std::string name;
  for (char c = 0; name.size() <= kLongestName && file.get(c);) {
    if (c == 0) return name;
    name.push_back(c);
  }
  return {};
}

/// One part's attributes, to the empty name that ends them. `attributes`: how many there were.
bool pass_over_header(std::istream& file, std::uint64_t file_bytes, std::size_t& attributes) {
  for (attributes = 0;; ++attributes) {
    const auto name = read_name(file);
    if (!name) return false;
    if (name->empty()) return true;
    const auto type = read_name(file);
    const auto bytes = read_u32(file);
    if (!type || !bytes) return false;
    if (*bytes > file_bytes - static_cast<std::uint64_t>(file.tellg())) return false;
    file.seekg(*bytes, std::ios::cur);
  }
}

}  // namespace

// The layout: https://openexr.com/en/latest/OpenEXRFileLayout.html
Status check_exr_header(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (read_u32(file) != kMagic) return Done{};
  const auto version = read_u32(file);
  std::error_code gone;
  const std::uint64_t file_bytes = std::filesystem::file_size(path, gone);
  bool good = version.has_value() && !gone;
  for (std::size_t attributes = 1; good && attributes > 0;) {
    good = pass_over_header(file, file_bytes, attributes);
    if (good && (*version & kMultiPart) == 0) break;  // else an empty header is the last
  }
  if (good) return Done{};
  return invalid_input(path.string(), "the image cannot be opened: its header is cut off or longer than the file");
}

}  // namespace lightwell
