#include "tests/gl/brdf_lab.h"

#include <span>

#include "renderer/gl/buffer.h"

namespace lightwell::test {

extern const char* const kBrdfLabShader;  // brdf_lab.comp, made a source by the build

namespace {

struct DeviceMaterial {
  LabMaterial material;
  glm::vec4 out_direction;
};
static_assert(sizeof(DeviceMaterial) == 96);

}  // namespace

BrdfLab::BrdfLab() : context_(gl::Context::create()), table_(shaders_) {}

std::vector<LabSample> BrdfLab::evaluate(const LabMaterial& material, LabVariant variant, glm::vec3 out_direction,
                                         const std::vector<glm::vec3>& in_directions) {
  return run(material, variant, out_direction, in_directions, false);
}

std::vector<LabSample> BrdfLab::sample(const LabMaterial& material, LabVariant variant, glm::vec3 out_direction,
                                       const std::vector<glm::vec3>& random) {
  return run(material, variant, out_direction, random, true);
}

std::vector<LabSample> BrdfLab::run(const LabMaterial& material, LabVariant variant, glm::vec3 out_direction,
                                    const std::vector<glm::vec3>& queries, bool sampled) {
  std::vector<std::string> defines;
  if (variant.multiscatter) defines.push_back("MULTISCATTER 1");
  if (variant.lobes) defines.push_back("HAS_LOBES 1");
  const gl::ProgramPtr program = shaders_.compute_text("brdf_lab.comp", kBrdfLabShader, defines);
  table_.bind();
  const DeviceMaterial packed{material, glm::vec4(out_direction, 0.0f)};
  gl::Buffer materials("material", sizeof packed);
  materials.upload(std::span<const DeviceMaterial>(&packed, 1));
  std::vector<glm::vec4> padded;
  for (const glm::vec3& query : queries) padded.emplace_back(query, 0.0f);
  gl::Buffer query_buffer("queries", padded.size() * sizeof(glm::vec4));
  query_buffer.upload(std::span<const glm::vec4>(padded));
  gl::Buffer results("results", queries.size() * sizeof(LabSample));
  materials.bind_storage(0);
  query_buffer.bind_storage(1);
  results.bind_storage(2);
  const auto count = static_cast<std::uint32_t>(queries.size());
  gl::Uniform<std::uint32_t>(program, "count") = count;
  gl::Uniform<int>(program, "sampled") = sampled ? 1 : 0;
  program->dispatch(count);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<LabSample> samples(queries.size());
  results.download(std::as_writable_bytes(std::span(samples)));
  return samples;
}

}  // namespace lightwell::test
