#include "server/data/frame_files.h"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "server/random_id.h"

namespace lightwell {
namespace {

/// An open file of the system's, closed when it goes.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags) : number_(::open(path.c_str(), flags | O_CLOEXEC, 0640)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool write_all(std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = ::write(number_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    return true;
  }
  bool open() const { return number_ >= 0; }
  bool sync() const { return ::fsync(number_) == 0; }

 private:
  int number_;
};

Error cannot_write(const std::filesystem::path& path) {
  return Error{ErrorKind::kInternal, path.string(), std::string("cannot be written: ") + std::strerror(errno)};
}

}  // namespace

FrameFolder::FrameFolder(std::filesystem::path root) : root_(std::move(root)) {
  std::error_code error;
  std::filesystem::create_directories(root_, error);
  if (error) throw std::runtime_error(root_.string() + " cannot be made: " + error.message());
}

Status FrameFolder::write(const std::string& sequence, const std::string& file,
                          std::span<const std::byte> bytes) const {
  const std::filesystem::path folder = root_ / sequence;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const std::filesystem::path beside = folder / ("." + file + "." + random_id());
  {
    const Descriptor descriptor(beside, O_WRONLY | O_CREAT | O_EXCL);
    if (!descriptor.open()) return cannot_write(beside);
    if (!descriptor.write_all(bytes) || !descriptor.sync()) {
      const Error failure = cannot_write(beside);
      std::filesystem::remove(beside, error);
      return failure;
    }
  }
  std::filesystem::rename(beside, folder / file, error);
  if (error) return Error{ErrorKind::kInternal, (folder / file).string(), "cannot be written: " + error.message()};
  const Descriptor entries(folder, O_RDONLY | O_DIRECTORY);
  if (!entries.open() || !entries.sync()) return cannot_write(folder);
  return Done{};
}

Result<std::string> FrameFolder::read(const std::string& sequence, const std::string& file) const {
  std::ifstream stream(path(sequence, file), std::ios::binary);
  if (!stream) return Error{ErrorKind::kNotFound, file, "is not there"};
  return std::string((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
}

void FrameFolder::remove(const std::string& sequence) const {
  std::error_code ignored;
  std::filesystem::remove_all(root_ / sequence, ignored);
}

std::uint32_t crc32_of(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace lightwell
