// The lobes of photon guides: a density that is one, and samples that follow it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <span>

#include "renderer/gl/buffer.h"
#include "renderer/gl/device.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/bindings.glsl"

namespace lightwell::test {

extern const char* const kGuidesLabShader;  // guides_lab.comp, made a source by the build

namespace {

constexpr double kPi = std::numbers::pi;

class Guides : public testing::Test {
 protected:
  static void SetUpTestSuite() { context_ = gl::Context::create(); }
  static void TearDownTestSuite() { context_.reset(); }

  /// Directions with their densities. Three lobes: near and far ones, and one below the horizon that is none.
  static std::vector<glm::vec4> run(const std::vector<glm::vec4>& queries, bool sampled) {
    gl::ShaderLibrary shaders;
    const gl::ProgramPtr program = shaders.compute_text("guides_lab.comp", kGuidesLabShader, {});
    const std::vector<glm::vec4> origins{
        {0.5f, 0.0f, 0.5f, 0}, {-1.0f, 1.0f, 2.0f, 0}, {0, 0, -1, 0}, {0, -3, 0.5f, 0}};
    std::vector<glm::uvec4> cells(GUIDE_CELLS, {0, 0xabcd0001u, 2, 3});
    const std::vector<std::uint32_t> fluxes(GUIDE_CELLS, 7);
    gl::Buffer origin_buffer("origins", origins.size() * 16), cell_buffer("cells", cells.size() * 16);
    gl::Buffer flux_buffer("fluxes", fluxes.size() * 4), in("queries", queries.size() * 16),
        out("results", queries.size() * 16);
    origin_buffer.upload(std::span(origins));
    cell_buffer.upload(std::span<const glm::uvec4>(cells));
    flux_buffer.upload(std::span(fluxes));
    in.upload(std::span(queries));
    const gl::BufferTexture origin_texels("origins", GL_RGBA32F), cell_texels("cells", GL_RGBA32UI),
        flux_texels("fluxes", GL_R32UI);
    origin_texels.attach(origin_buffer);
    cell_texels.attach(cell_buffer);
    flux_texels.attach(flux_buffer);
    origin_texels.bind(UNIT_PHOTON_ORIGINS);
    cell_texels.bind(UNIT_GUIDE_CELLS);
    flux_texels.bind(UNIT_GUIDE_FLUXES);
    in.bind_storage(0);
    out.bind_storage(1);
    const auto count = static_cast<std::uint32_t>(queries.size());
    gl::Uniform<std::uint32_t>(program, "count") = count;
    gl::Uniform<int>(program, "sampled") = sampled ? 1 : 0;
    gl::Uniform<float>(program, "guide_cell_m") = 1.0f;
    program->dispatch(count);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<glm::vec4> results(queries.size());
    out.download(std::as_writable_bytes(std::span(results)));
    return results;
  }

  /// Density at a lattice of equal solid angles over the sphere.
  static std::vector<glm::vec4> over_the_sphere(int count) {
    std::vector<glm::vec4> directions;
    for (int i = 0; i < count; ++i) {
      const double z = 1.0 - (2.0 * i + 1.0) / count, phi = 2.0 * kPi * std::fmod(i * 0.6180339887498949, 1.0);
      const double sine = std::sqrt(1.0 - z * z);
      directions.emplace_back(sine * std::cos(phi), sine * std::sin(phi), z, 0.0);
    }
    return run(directions, false);
  }

  static inline std::unique_ptr<gl::Context> context_;
};

TEST_F(Guides, TheirDensityIntegratesToOne) {
  double sum = 0.0;
  const std::vector<glm::vec4> densities = over_the_sphere(1 << 18);
  for (const glm::vec4& density : densities) sum += static_cast<double>(density.w);
  EXPECT_NEAR(sum * 4.0 * kPi / static_cast<double>(densities.size()), 1.0, 1e-3);
}

TEST_F(Guides, SamplesFollowTheDensity) {
  constexpr int kCount = 1 << 16;
  std::vector<glm::vec4> random;
  for (int i = 0; i < kCount; ++i)  // the generalised golden ratio's lattice: Roberts 2018
    random.emplace_back(std::fmod(i * 0.8191725133961645, 1.0), std::fmod(i * 0.6710436067037893, 1.0),
                        std::fmod(i * 0.5497004779019703, 1.0), 0.0);
  const std::vector<glm::vec4> samples = run(random, true), densities = over_the_sphere(1 << 18);
  for (const glm::vec3 axis : {glm::vec3(0.7071f, 0, 0.7071f), glm::vec3(-0.4082f, 0.4082f, 0.8165f),
                               glm::vec3(0, -0.9864f, 0.1644f), glm::vec3(0, 0, -1)})
    for (const float cosine : {0.999f, 0.98f, 0.8f, 0.0f}) {
      double found = 0.0, expected = 0.0;
      for (const glm::vec4& sample : samples) found += glm::dot(glm::vec3(sample), axis) > cosine ? 1.0 / kCount : 0.0;
      for (const glm::vec4& density : densities)
        if (glm::dot(glm::vec3(density), axis) > cosine)
          expected += static_cast<double>(density.w) * 4.0 * kPi / static_cast<double>(densities.size());
      EXPECT_NEAR(found, expected, 0.005) << axis.x << " " << axis.y << " " << axis.z << ", cosine " << cosine;
    }
  for (const glm::vec4& sample : samples) {
    ASSERT_NEAR(glm::length(glm::vec3(sample)), 1.0f, 1e-3f);
    ASSERT_TRUE(std::isfinite(sample.w) && sample.w > 0.0f);
  }
}

}  // namespace
}  // namespace lightwell::test
