// A ZIP of files that exist already, made while it is sent: nothing is compressed (pictures are), nothing is held.
#pragma once

#include <filesystem>
#include <fstream>
#include <vector>

#include "server/net/application.h"
#include "server/sequences/job_table.h"

namespace lightwell {

inline constexpr std::uint64_t kLargestZip = 0xffff'fffe;  // without ZIP64's extensions
inline constexpr std::size_t kMostZipEntries = 0xfffe;

/// How long the ZIP of these files is.
std::uint64_t zip_bytes(const std::vector<FrameFile>& files);

/// The same files give the same bytes. A file that has changed or gone ends it before its time, which a reader notices
/// by the length announced.
class ZipStream : public net::BodySource {
 public:
  ZipStream(std::filesystem::path folder, std::vector<FrameFile> files);

  std::optional<std::string> next() override;
  bool is_whole() const override { return ended_; }
  void set_waker(std::function<void()>) override {}

 private:
  std::string begin_file();
  std::string directory() const;

  const std::filesystem::path folder_;
  const std::vector<FrameFile> files_;
  std::vector<std::uint64_t> offsets_;
  std::size_t index_ = 0;
  std::uint64_t sent_ = 0;  // bytes so far
  std::uint64_t left_ = 0;  // of the file being sent
  bool in_file_ = false, ended_ = false;
  std::ifstream file_;
};

}  // namespace lightwell
