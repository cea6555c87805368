// The BRDF of the shaders, evaluated and sampled on the device for a test to judge.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "renderer/gl/device.h"
#include "renderer/gl/program.h"
#include "renderer/passes/brdf_table.h"

namespace lightwell::test {

/// What a BRDF is made of; as in brdf_lab.cpp's shader.
struct LabMaterial {
  glm::vec3 base_color{1.0f};
  float metallic = 0.0f;
  glm::vec3 f0_dielectric{0.04f};
  float roughness = 0.5f;
  glm::vec3 sheen_color{0.0f};
  float sheen_roughness = 0.5f;
  glm::vec3 clearcoat_normal{0.0f, 0.0f, 1.0f};
  float clearcoat = 0.0f;
  float specular_factor = 1.0f;
  float clearcoat_roughness = 0.1f;
  float transmission = 0.0f;
  float eta = 1.0f;
};

/// `direction` is where light comes from; `value` is f cos(theta).
struct LabSample {
  glm::vec3 direction;
  float pdf;
  glm::vec3 value;
  float padding;
};

/// The variants of shaders/brdf.glsl.
struct LabVariant {
  bool multiscatter = false;
  bool lobes = false;
};

class BrdfLab {
 public:
  BrdfLab();
  /// Values and densities of given directions, in the frame of the normal.
  std::vector<LabSample> evaluate(const LabMaterial& material, LabVariant variant, glm::vec3 out_direction,
                                  const std::vector<glm::vec3>& in_directions);
  /// Directions sampled with the given random numbers, with their values and densities.
  std::vector<LabSample> sample(const LabMaterial& material, LabVariant variant, glm::vec3 out_direction,
                                const std::vector<glm::vec3>& random);

 private:
  std::vector<LabSample> run(const LabMaterial& material, LabVariant variant, glm::vec3 out_direction,
                             const std::vector<glm::vec3>& queries, bool sampled);
  std::unique_ptr<gl::Context> context_;
  gl::ShaderLibrary shaders_;
  BrdfTable table_;
};

}  // namespace lightwell::test
