// The files of sequences' frames in a folder: there whole or not at all, whatever happens while they are written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "renderer/error.h"

namespace lightwell {

class FrameFolder {
 public:
  /// Makes the folder where there is none. Throws std::runtime_error that names it.
  explicit FrameFolder(std::filesystem::path root);

  std::filesystem::path path(const std::string& sequence, const std::string& file) const {
    return root_ / sequence / file;
  }

  /// Writes beside its place, makes sure that it is on the disk, and moves it there.
  Status write(const std::string& sequence, const std::string& file, std::span<const std::byte> bytes) const;
  /// kNotFound if it is not there.
  Result<std::string> read(const std::string& sequence, const std::string& file) const;
  /// All files of a sequence.
  void remove(const std::string& sequence) const;

 private:
  std::filesystem::path root_;
};

/// CRC-32 as ZIP has it.
std::uint32_t crc32_of(std::span<const std::byte> bytes);

}  // namespace lightwell
