#include "renderer/scene/gltf/glb.h"

#include <cstdint>
#include <string>

#include "renderer/scene/gltf/diagnostics.h"

namespace lightwell::gltf {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::uint32_t kMagic = 0x46546c67;        // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004e4942;  // "BIN"
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

std::uint32_t little_endian_32(Bytes bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>(bytes[offset + i]);
  return value;
}

struct Chunk {
  std::uint32_t type;
  Bytes data;
};

/// The chunk at the front of `bytes`, which then begin after it.
Chunk take_chunk(Bytes& bytes) {
  if (bytes.size() < kChunkHeaderBytes) fail("glb", "the file ends within a chunk's header");
  const std::uint32_t length = little_endian_32(bytes, 0), type = little_endian_32(bytes, 4);
  bytes = bytes.subspan(kChunkHeaderBytes);
  if (length > bytes.size())
    fail("glb", "a chunk of " + std::to_string(length) + " bytes begins where only " + std::to_string(bytes.size()) +
                    " are left");
  const Chunk chunk{type, bytes.first(length)};
  bytes = bytes.subspan(length);
  return chunk;
}

}  // namespace

bool is_glb(Bytes bytes) {
  return bytes.size() >= 4 && little_endian_32(bytes, 0) == kMagic;
}

GlbChunks split_glb(Bytes bytes) {
  if (!is_glb(bytes)) fail("glb", "the file does not begin with 'glTF'");
  if (bytes.size() < kHeaderBytes) fail("glb", "the file ends within its header");
  if (const std::uint32_t version = little_endian_32(bytes, 4); version != 2)
    fail("glb", "the container has version " + std::to_string(version) + "; only 2 is known", ErrorKind::kUnsupported);
  const std::uint32_t length = little_endian_32(bytes, 8);
  if (length < kHeaderBytes || length > bytes.size())
    fail("glb",
         "the header tells of " + std::to_string(length) + " bytes, the file has " + std::to_string(bytes.size()));

  Bytes rest = bytes.first(length).subspan(kHeaderBytes);
  const Chunk json = take_chunk(rest);
  if (json.type != kJsonChunk) fail("glb", "the first chunk is not JSON");
  GlbChunks chunks{{reinterpret_cast<const char*>(json.data.data()), json.data.size()}, {}};
  while (!rest.empty()) {
    const Chunk chunk = take_chunk(rest);
    if (chunk.type == kBinaryChunk && chunks.binary.empty()) chunks.binary = chunk.data;
  }
  return chunks;
}

}  // namespace lightwell::gltf
