// What a glTF file's URIs lead to: bytes within the URI, or a file in the asset's own folder and nowhere else.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lightwell::gltf {

using Bytes = std::vector<std::byte>;

/// The whole of a regular file of at most `max_bytes`. Throws Failure with kNotFound, kTooLarge or kInvalidInput.
Bytes read_file(const std::filesystem::path& path, std::uint64_t max_bytes, const std::string& where);

/// The bytes of "data:<media type>;base64,<data>". Throws Failure on anything else.
Bytes decode_data_uri(std::string_view uri, const std::string& where);

/// The file that a relative URI means below `folder`. Throws Failure with kInvalidInput on absolute paths, "..", other
/// schemes, percent-encoded separators and links that lead out of the folder, and with kNotFound if there is no file.
std::filesystem::path resolve_uri(const std::filesystem::path& folder, std::string_view uri, const std::string& where);

/// Fetches what URIs mean for one asset, up to a number of bytes in all.
class AssetFiles {
 public:
  /// Without a folder only data: URIs can be fetched.
  AssetFiles(std::optional<std::filesystem::path> folder, std::uint64_t max_bytes)
      : folder_(std::move(folder)), bytes_left_(max_bytes) {}

  /// Throws Failure naming `where`.
  Bytes fetch(std::string_view uri, const std::string& where);

 private:
  std::optional<std::filesystem::path> folder_;
  std::uint64_t bytes_left_;
};

}  // namespace lightwell::gltf
