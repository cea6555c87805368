#include "server/scenes/digest.h"

#include <openssl/evp.h>

#include <stdexcept>

#include "protocol/json_text.h"
#include "renderer/scene/gltf/edit.h"

namespace lightwell {
namespace {

void check(int succeeded) {
  if (succeeded != 1) throw std::runtime_error("OpenSSL gives no SHA-256");
}

void add_primitive(Digest& digest, const Primitive& primitive) {
  digest.add(primitive.positions);
  digest.add(primitive.normals);
  digest.add(primitive.tangents);
  digest.add(primitive.uv0);
  digest.add(primitive.uv1);
  digest.add(primitive.colors);
  digest.add(primitive.joints);
  digest.add(primitive.weights);
  digest.add(primitive.indices);
  for (const MorphTarget& target : primitive.morph_targets) {
    digest.add(target.positions);
    digest.add(target.normals);
    digest.add(target.tangents);
  }
}

/// The object model has the channels' targets, not their keys.
void add_animation(Digest& digest, const Animation& animation) {
  for (const AnimationChannel& channel : animation.channels) {
    digest.add(std::to_string(channel.node) + ":" + std::to_string(static_cast<int>(channel.property)) + ":" +
               std::to_string(static_cast<int>(channel.interpolation)));
    digest.add(channel.times_s);
    digest.add(channel.values);
  }
  for (const LightChannel& channel : animation.light_channels) {
    digest.add(std::to_string(channel.light) + ":" + std::to_string(static_cast<int>(channel.property)) + ":" +
               std::to_string(static_cast<int>(channel.interpolation)));
    digest.add(channel.times_s);
    digest.add(channel.values);
  }
}

}  // namespace

struct Digest::State {
  State() : context(EVP_MD_CTX_new()) {
    check(context ? 1 : 0);
    check(EVP_DigestInit_ex(context, EVP_sha256(), nullptr));
  }
  ~State() { EVP_MD_CTX_free(context); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  EVP_MD_CTX* context;
};

Digest::Digest() : state_(std::make_unique<State>()) {}

Digest::~Digest() = default;

void Digest::add_bytes(std::span<const std::byte> bytes) {
  const std::string length = std::to_string(bytes.size()) + ":";
  check(EVP_DigestUpdate(state_->context, length.data(), length.size()));
  check(EVP_DigestUpdate(state_->context, bytes.data(), bytes.size()));
}

std::string Digest::hex() {
  unsigned char bytes[EVP_MAX_MD_SIZE];
  unsigned size = 0;
  check(EVP_DigestFinal_ex(state_->context, bytes, &size));
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (unsigned i = 0; i < size; ++i) text.append({kDigits[bytes[i] >> 4], kDigits[bytes[i] & 15]});
  return text;
}

std::string scene_digest(const Scene& scene) {
  Digest digest;
  digest.add(protocol::json_text(describe_scene(scene)));
  for (const auto& mesh : scene.meshes) {
    digest.add(mesh->name);
    digest.add(mesh->weights);
    for (const Primitive& primitive : mesh->primitives) add_primitive(digest, primitive);
  }
  for (const auto& image : scene.images) {
    digest.add(std::to_string(image->size_px.x));
    digest.add(image->rgba);
  }
  for (const Skin& skin : scene.skins) digest.add(skin.joint_from_mesh);
  for (const Animation& animation : scene.animations) add_animation(digest, animation);
  if (scene.environment.image) digest.add(scene.environment.image->rgb);
  return digest.hex();
}

}  // namespace lightwell
