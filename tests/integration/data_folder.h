// A folder for a server's files, gone after the test.
#pragma once

#include <filesystem>
#include <string>

#include "server/random_id.h"

namespace lightwell::test {

/// Declared before the server that has it, which may write into it until its own end.
class DataFolder {
 public:
  DataFolder() = default;
  ~DataFolder() { std::filesystem::remove_all(path_); }
  DataFolder(const DataFolder&) = delete;
  DataFolder& operator=(const DataFolder&) = delete;

  /// Nobody has made it yet.
  const std::filesystem::path& path() const { return path_; }

 private:
  const std::filesystem::path path_ = std::filesystem::temp_directory_path() / ("lightwell-" + random_id());
};

}  // namespace lightwell::test
