#include "renderer/scene/gltf/lights_and_cameras.h"

#include <glm/gtc/constants.hpp>

#include "renderer/scene/gltf/numbers.h"

namespace lightwell::gltf {
namespace {

LightKind read_kind(const std::string& type, const std::string& where) {
  if (type == "directional") return LightKind::kDirectional;
  if (type == "point") return LightKind::kPoint;
  if (type == "spot") return LightKind::kSpot;
  fail(join(where, "type"), in_quotes(type) + " is none of directional, point and spot");
}

void read_cone(Context& context, const tinygltf::SpotLight& spot, const std::string& where, Light& light) {
  // A cone without an inside, or an edge without width, would divide by zero.
  constexpr double kNarrowest = 1e-4;
  light.outer_cone_angle =
      clamped(context, spot.outerConeAngle, kNarrowest, glm::half_pi<double>(), where, "outerConeAngle");
  light.inner_cone_angle = clamped(context, spot.innerConeAngle, 0.0, light.outer_cone_angle, where, "innerConeAngle");
  if (light.inner_cone_angle >= light.outer_cone_angle)
    light.inner_cone_angle = light.outer_cone_angle * static_cast<float>(1.0 - kNarrowest);
}

Light read_light(Context& context, const tinygltf::Light& source, const std::string& where) {
  Light light;
  light.name = source.name;
  light.kind = read_kind(source.type, where);
  if (!source.color.empty())
    light.color = clamped_vector<glm::vec3>(context, source.color, 0.0, kMaxFloat, where, "color");
  light.intensity = clamped(context, source.intensity, 0.0, kMaxFloat, where, "intensity");
  light.range_m = clamped(context, source.range, 0.0, kMaxFloat, where, "range");
  if (light.kind == LightKind::kSpot) read_cone(context, source.spot, join(where, "spot"), light);
  return light;
}

/// `value` if it is more than zero, else what a camera has by default, with a warning.
float positive_or(Context& context, double value, float fallback, const std::string& where, std::string_view name) {
  if (value > 0.0) return to_float(value);
  context.warnings.add(where, std::string(name) + " is " + to_text(value) + "; " + to_text(fallback) + " is used");
  return fallback;
}

/// The far plane: 0, for infinitely far, where none is given or none is in front of the near plane.
float read_zfar(Context& context, double zfar, float znear, const std::string& where) {
  if (zfar == 0.0 || to_float(zfar) > znear) return to_float(zfar);
  context.warnings.add(where, "zfar " + to_text(zfar) + " is not beyond znear " + to_text(znear) + "; ignored");
  return 0.0f;
}

Camera read_perspective(Context& context, const tinygltf::PerspectiveCamera& source, const std::string& where) {
  Camera camera;
  camera.perspective = true;
  camera.yfov = positive_or(context, source.yfov, camera.yfov, where, "yfov");
  if (camera.yfov >= glm::pi<float>()) camera.yfov = clamped(context, source.yfov, 0.0, 3.1, where, "yfov");
  camera.aspect_ratio = clamped(context, source.aspectRatio, 0.0, kMaxFloat, where, "aspectRatio");
  camera.znear = positive_or(context, source.znear, camera.znear, where, "znear");
  camera.zfar = read_zfar(context, source.zfar, camera.znear, where);
  return camera;
}

Camera read_orthographic(Context& context, const tinygltf::OrthographicCamera& source, const std::string& where) {
  Camera camera;
  camera.perspective = false;
  camera.xmag = positive_or(context, source.xmag, camera.xmag, where, "xmag");
  camera.ymag = positive_or(context, source.ymag, camera.ymag, where, "ymag");
  camera.znear = clamped(context, source.znear, 0.0, kMaxFloat, where, "znear");
  camera.zfar = read_zfar(context, source.zfar, camera.znear, where);
  return camera;
}

}  // namespace

void read_lights(Context& context, Scene& scene) {
  const std::vector<tinygltf::Light>& lights = context.document.model.lights;
  for (std::size_t i = 0; i < lights.size(); ++i)
    scene.lights.push_back(read_light(context, lights[i], join("extensions/KHR_lights_punctual/lights", i)));
}

void read_cameras(Context& context, Scene& scene) {
  const std::vector<tinygltf::Camera>& cameras = context.document.model.cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::string where = join("cameras", i);
    const bool perspective = cameras[i].type == "perspective";
    scene.cameras.push_back(perspective
                                ? read_perspective(context, cameras[i].perspective, join(where, "perspective"))
                                : read_orthographic(context, cameras[i].orthographic, join(where, "orthographic")));
    scene.cameras.back().name = cameras[i].name;
  }
}

}  // namespace lightwell::gltf
