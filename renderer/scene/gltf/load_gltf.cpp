#include "renderer/scene/gltf/load_gltf.h"

#include <exception>
#include <new>

#include "renderer/scene/gltf/animations.h"
#include "renderer/scene/gltf/context.h"
#include "renderer/scene/gltf/glb.h"
#include "renderer/scene/gltf/images.h"
#include "renderer/scene/gltf/lights_and_cameras.h"
#include "renderer/scene/gltf/materials.h"
#include "renderer/scene/gltf/meshes.h"
#include "renderer/scene/gltf/nodes.h"

namespace lightwell {
namespace {

/// Turns whatever a reader throws into an Error.
template <class Load>
Result<Scene> without_exceptions(Load load) {
  try {
    return load();
  } catch (const gltf::Failure& failure) {
    return failure.error();
  } catch (const std::bad_alloc&) {
    return Error{ErrorKind::kTooLarge, "", "there is not enough memory to load the file"};
  } catch (const std::exception& exception) {
    return Error{ErrorKind::kInternal, "", std::string("the file cannot be loaded: ") + exception.what()};
  }
}

Scene load(std::span<const std::byte> bytes, gltf::AssetFiles& files, const LoadLimits& limits) {
  gltf::Warnings warnings;
  const gltf::GlbChunks chunks = gltf::is_glb(bytes)
                                     ? gltf::split_glb(bytes)
                                     : gltf::GlbChunks{{reinterpret_cast<const char*>(bytes.data()), bytes.size()}, {}};
  const gltf::Document document = gltf::read_document(chunks.json, chunks.binary, files, limits, warnings);
  gltf::Context context{document, files, limits, warnings};
  Scene scene;
  gltf::read_materials(context, scene);
  gltf::read_lights(context, scene);
  gltf::read_cameras(context, scene);
  gltf::read_meshes(context, scene);
  gltf::read_nodes(context, scene);
  gltf::read_animations(context, scene);
  gltf::read_images(context, scene);
  scene.warnings = warnings.take();
  return scene;
}

}  // namespace

Result<Scene> load_gltf(const std::filesystem::path& path, const LoadLimits& limits) {
  return without_exceptions([&] {
    const gltf::Bytes bytes = gltf::read_file(path, limits.max_file_bytes, path.string());
    gltf::AssetFiles files(path.parent_path(), limits.max_file_bytes);
    Scene scene = load(bytes, files, limits);
    if (scene.name.empty()) scene.name = path.stem().string();
    return scene;
  });
}

Result<Scene> load_glb(std::span<const std::byte> bytes, const LoadLimits& limits) {
  return without_exceptions([&] {
    if (bytes.size() > limits.max_file_bytes)
      gltf::fail("glb",
                 std::to_string(bytes.size()) + " bytes are more than the " + std::to_string(limits.max_file_bytes) +
                     " allowed",
                 ErrorKind::kTooLarge);
    if (!gltf::is_glb(bytes)) gltf::fail("glb", "the data does not begin with 'glTF'");
    gltf::AssetFiles files(std::nullopt, limits.max_file_bytes);
    return load(bytes, files, limits);
  });
}

}  // namespace lightwell
