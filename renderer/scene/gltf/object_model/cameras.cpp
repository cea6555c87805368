#include "renderer/scene/gltf/object_model/fields.h"

namespace lightwell::object_model {
namespace {

const auto camera_at = [](auto& scene, std::size_t i) -> auto& {
  return scene.cameras[i];
};

/// A property of perspective or of orthographic cameras; of the other kind it is kept, but not shown.
Property of_type(bool perspective, Property property) {
  property.get = [perspective, get = property.get](const Scene& scene, std::size_t i) {
    return scene.cameras[i].perspective == perspective ? get(scene, i) : std::nullopt;
  };
  property.standard = nullptr;  // glTF has no defaults here
  return property;
}

Property camera_field(std::string path, float Camera::*member, Range range) {
  const bool perspective = path.starts_with("/perspective/");
  return of_type(perspective, field(camera_at, std::move(path), member, range));
}

Property camera_field_or_none(std::string path, float Camera::*member, Range range) {
  const bool perspective = path.starts_with("/perspective/");
  return of_type(perspective, absent_at_standard(field(camera_at, std::move(path), member, range)));
}

Property type() {
  Property property;
  property.path = "/type";
  property.get = [](const Scene& scene, std::size_t i) -> std::optional<Json> {
    return scene.cameras[i].perspective ? "perspective" : "orthographic";
  };
  property.set = [](Editing& editing, std::size_t i, const Json& value, const std::string& where) -> Status {
    if (value != "perspective" && value != "orthographic")
      return invalid_input(where, "must be \"perspective\" or \"orthographic\", not " + in_words(value));
    editing.scene.cameras[i].perspective = value == "perspective";
    return Done{};
  };
  property.reset = [](Editing& editing, std::size_t i, const std::string&) -> Status {
    editing.scene.cameras[i].perspective = true;
    return Done{};
  };
  return property;
}

Status check_camera(const Scene& scene, std::size_t i, const std::string& where) {
  const Camera& camera = scene.cameras[i];
  if (camera.zfar == 0.0f || camera.znear < camera.zfar) return Done{};
  return invalid_input(where, "znear (" + in_words(write_value(camera.znear)) + ") must be less than zfar (" +
                                  in_words(write_value(camera.zfar)) + ')');
}

}  // namespace

const ObjectKind& cameras() {
  static const ObjectKind kind = [] {
    ObjectKind cameras;
    cameras.singular = "camera";
    cameras.pointer = "/cameras";
    cameras.properties = {
        field(camera_at, "/name", &Camera::name),
        type(),
        camera_field("/perspective/yfov", &Camera::yfov, Range{0.0, 3.14, true}),
        camera_field("/perspective/znear", &Camera::znear, kPositive),
        camera_field_or_none("/perspective/zfar", &Camera::zfar, kPositive),
        camera_field_or_none("/perspective/aspectRatio", &Camera::aspect_ratio, kPositive),
        camera_field("/orthographic/xmag", &Camera::xmag, kPositive),
        camera_field("/orthographic/ymag", &Camera::ymag, kPositive),
        camera_field("/orthographic/znear", &Camera::znear, kNotNegative),
        camera_field_or_none("/orthographic/zfar", &Camera::zfar, kPositive),
    };
    cameras.count = [](const Scene& scene) { return scene.cameras.size(); };
    cameras.name = [](const Scene& scene, std::size_t i) -> const std::string& { return scene.cameras[i].name; };
    cameras.insert = insert_camera;
    cameras.erase = erase_camera;
    cameras.most = &EditLimits::max_cameras;
    cameras.check = check_camera;
    return cameras;
  }();
  return kind;
}

}  // namespace lightwell::object_model
