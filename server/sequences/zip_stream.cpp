#include "server/sequences/zip_stream.h"

#include <algorithm>

namespace lightwell {
namespace {

// APPNOTE.TXT 4.3: sizes without names.
constexpr std::uint64_t kLocalBytes = 30, kCentralBytes = 46, kEndBytes = 22;
constexpr std::size_t kPieceBytes = 256 << 10;
constexpr std::uint16_t kVersion = 20;
constexpr std::uint16_t kDate = 0x0021;  // 1980-01-01, the earliest: when it was packed is nobody's business

void add16(std::string& bytes, std::uint16_t value) {
  bytes.append({static_cast<char>(value & 0xff), static_cast<char>(value >> 8)});
}

void add32(std::string& bytes, std::uint32_t value) {
  add16(bytes, static_cast<std::uint16_t>(value & 0xffff));
  add16(bytes, static_cast<std::uint16_t>(value >> 16));
}

/// The fields that a local and a central header share, from "version needed" to the length of the extra field.
void add_common(std::string& bytes, const FrameFile& file) {
  add16(bytes, kVersion);
  add16(bytes, 0);  // flags
  add16(bytes, 0);  // stored
  add16(bytes, 0);  // time
  add16(bytes, kDate);
  add32(bytes, file.crc32);
  add32(bytes, static_cast<std::uint32_t>(file.bytes));
  add32(bytes, static_cast<std::uint32_t>(file.bytes));
  add16(bytes, static_cast<std::uint16_t>(file.name.size()));
  add16(bytes, 0);  // extra field
}

}  // namespace

std::uint64_t zip_bytes(const std::vector<FrameFile>& files) {
  std::uint64_t bytes = kEndBytes;
  for (const FrameFile& file : files) bytes += kLocalBytes + kCentralBytes + 2 * file.name.size() + file.bytes;
  return bytes;
}

ZipStream::ZipStream(std::filesystem::path folder, std::vector<FrameFile> files)
    : folder_(std::move(folder)), files_(std::move(files)) {}

std::optional<std::string> ZipStream::next() {
  if (ended_) return {};
  std::string piece;
  if (in_file_ && left_ > 0) {
    piece.resize(std::min<std::uint64_t>(left_, kPieceBytes));
    file_.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    if (file_.gcount() != static_cast<std::streamsize>(piece.size())) return {};
    left_ -= piece.size();
  } else if (index_ < files_.size()) {
    piece = begin_file();
  } else {
    piece = directory();
    ended_ = true;
  }
  sent_ += piece.size();
  return piece;
}

std::string ZipStream::begin_file() {
  const FrameFile& file = files_[index_++];
  offsets_.push_back(sent_);
  file_ = std::ifstream(folder_ / file.name, std::ios::binary);
  left_ = file.bytes;
  in_file_ = true;
  std::string header = "PK\x03\x04";
  add_common(header, file);
  return header + file.name;
}

std::string ZipStream::directory() const {
  std::string bytes;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    bytes += "PK\x01\x02";
    add16(bytes, kVersion);
    add_common(bytes, files_[i]);
    add16(bytes, 0);  // comment
    add16(bytes, 0);  // disk
    add16(bytes, 0);  // internal attributes
    add32(bytes, 0);  // external attributes
    add32(bytes, static_cast<std::uint32_t>(offsets_[i]));
    bytes += files_[i].name;
  }
  const auto size = static_cast<std::uint32_t>(bytes.size());
  bytes += "PK\x05\x06";
  add32(bytes, 0);  // disks
  add16(bytes, static_cast<std::uint16_t>(files_.size()));
  add16(bytes, static_cast<std::uint16_t>(files_.size()));
  add32(bytes, size);
  add32(bytes, static_cast<std::uint32_t>(sent_));
  add16(bytes, 0);  // comment
  return bytes;
}

}  // namespace lightwell
