#include "renderer/scene/gltf/asset_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>

#include "renderer/scene/gltf/diagnostics.h"

namespace lightwell::gltf {
namespace {

constexpr std::string_view kDataScheme = "data:";

bool is_data_uri(std::string_view uri) {
  return uri.size() >= kDataScheme.size() &&
         std::equal(kDataScheme.begin(), kDataScheme.end(), uri.begin(), [](char expected, char actual) {
           return expected == std::tolower(static_cast<unsigned char>(actual));
         });
}

/// The value of every base64 digit, and kNotADigit for all else.
constexpr std::uint8_t kNotADigit = 255;
constexpr std::array<std::uint8_t, 256> kBase64Values = [] {
  std::array<std::uint8_t, 256> values{};
  values.fill(kNotADigit);
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    values[static_cast<unsigned char>(kDigits[i])] = static_cast<std::uint8_t>(i);
  return values;
}();

Bytes decode_base64(std::string_view text, const std::string& where) {
  for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);
  if (text.size() % 4 == 1) fail(where, "the base64 data is cut off");
  Bytes bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (const char digit : text) {
    const std::uint8_t value = kBase64Values[static_cast<unsigned char>(digit)];
    if (value == kNotADigit) fail(where, "the base64 data holds " + in_quotes(std::string(1, digit)));
    bits = bits << 6 | value;
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> bit_count & 0xff));
  }
  return bytes;
}

int hex_digit(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
  if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
  return -1;
}

std::string decode_percent(std::string_view uri, const std::string& where) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      text += uri[i];
      continue;
    }
    const int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : -1;
    if (high < 0 || low < 0) fail(where, in_quotes(uri) + " has a '%' without two hexadecimal digits");
    const auto character = static_cast<char>(high * 16 + low);
    if (character == '/' || character == '\\') fail(where, in_quotes(uri) + " hides a separator behind a '%'");
    text += character;
    i += 2;
  }
  return text;
}

/// A relative path of plain names only.
std::filesystem::path relative_path(std::string_view uri, const std::string& where) {
  if (uri.empty()) fail(where, "the URI is empty");
  if (uri.front() == '/') fail(where, in_quotes(uri) + " is absolute; files must lie in the asset's own folder");
  if (uri.find(':') < uri.find('/'))
    fail(where, in_quotes(uri) + " has a scheme; only data: and files in the asset's own folder can be read");
  const std::string text = decode_percent(uri, where);
  if (std::any_of(text.begin(), text.end(), [](char c) { return c == '\\' || (c >= 0 && c < 0x20) || c == 0x7f; }))
    fail(where, in_quotes(uri) + " holds a character that no file name should have");
  const std::filesystem::path path(text);
  if (std::any_of(path.begin(), path.end(), [](const std::filesystem::path& name) { return name == ".."; }))
    fail(where, in_quotes(uri) + " has '..' in it; files must lie in the asset's own folder");
  return path;
}

bool is_within(const std::filesystem::path& folder, const std::filesystem::path& path) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

Bytes read_file(const std::filesystem::path& path, std::uint64_t max_bytes, const std::string& where) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found)
    fail(where, "there is no file " + in_quotes(path.filename().string()), ErrorKind::kNotFound);
  // Devices and pipes may never end, or never begin.
  if (!std::filesystem::is_regular_file(status)) fail(where, in_quotes(path.filename().string()) + " is not a file");
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error) fail(where, in_quotes(path.filename().string()) + " cannot be read: " + error.message());
  if (size > max_bytes)
    fail(where,
         in_quotes(path.filename().string()) + " has " + std::to_string(size) + " bytes; at most " +
             std::to_string(max_bytes) + " are allowed",
         ErrorKind::kTooLarge);
  Bytes bytes(size);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!file) fail(where, in_quotes(path.filename().string()) + " cannot be read");
  return bytes;
}

Bytes decode_data_uri(std::string_view uri, const std::string& where) {
  if (!is_data_uri(uri)) fail(where, in_quotes(uri) + " is not a data: URI");
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) fail(where, "the data: URI has no comma before its data");
  if (!uri.substr(0, comma).ends_with(";base64")) fail(where, "the data: URI is not in base64");
  return decode_base64(uri.substr(comma + 1), where);
}

std::filesystem::path resolve_uri(const std::filesystem::path& folder, std::string_view uri, const std::string& where) {
  const std::filesystem::path relative = relative_path(uri, where);
  std::error_code error;
  const std::filesystem::path home = std::filesystem::canonical(folder.empty() ? "." : folder, error);
  if (error) fail(where, "the asset's folder cannot be opened: " + error.message(), ErrorKind::kNotFound);
  // The canonical path has no links left in it: what is below the folder now is what will be opened.
  const std::filesystem::path file = std::filesystem::canonical(home / relative, error);
  if (error) fail(where, in_quotes(uri) + " cannot be opened: " + error.message(), ErrorKind::kNotFound);
  if (!is_within(home, file)) fail(where, in_quotes(uri) + " leads out of the asset's own folder");
  return file;
}

Bytes AssetFiles::fetch(std::string_view uri, const std::string& where) {
  Bytes bytes;
  if (is_data_uri(uri))
    bytes = decode_data_uri(uri, where);
  else if (folder_)
    bytes = read_file(resolve_uri(*folder_, uri, where), bytes_left_, where);
  else
    fail(where, in_quotes(uri) + " is outside the file, and only what is within it can be read here");
  if (bytes.size() > bytes_left_) fail(where, "the asset's files are too large in all", ErrorKind::kTooLarge);
  bytes_left_ -= bytes.size();
  return bytes;
}

}  // namespace lightwell::gltf
