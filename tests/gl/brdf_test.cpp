// The BRDF against what any BRDF must keep: it gains no energy, works both ways alike, and is sampled as its density
// says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "tests/gl/brdf_lab.h"

namespace lightwell::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr LabVariant kPlain{false, false}, kMultiscatter{true, false}, kLobes{false, true}, kAll{true, true};

BrdfLab& lab() {
  static BrdfLab lab;
  return lab;
}

glm::vec3 viewer(float cosine, float phi = 0.3f) {
  const float sine = std::sqrt(1.0f - cosine * cosine);
  return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

std::vector<glm::vec3> random_numbers(std::size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 0.9999999f);
  std::vector<glm::vec3> numbers(count);
  for (glm::vec3& u : numbers) u = {uniform(generator), uniform(generator), uniform(generator)};
  return numbers;
}

// A lattice over the unit cube, far evener than chance: the generalised golden ratio's (Roberts 2018).
std::vector<glm::vec3> even_numbers(std::size_t count) {
  std::vector<glm::vec3> numbers(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double n = static_cast<double>(i) + 0.5;
    for (int d = 0; d < 3; ++d)
      numbers[i][d] = static_cast<float>(std::fmod(n * std::pow(1.2207440846057596, -(d + 1)), 1.0) * 0.9999999);
  }
  return numbers;
}

// What the surface makes of uniform light from all sides.
double furnace(const LabMaterial& material, LabVariant variant, float cos_out) {
  const std::vector<LabSample> samples = lab().sample(material, variant, viewer(cos_out), even_numbers(1 << 14));
  double sum = 0.0;
  for (const LabSample& sample : samples) {
    EXPECT_TRUE(std::isfinite(sample.pdf) && sample.pdf >= 0.0f) << sample.pdf;
    EXPECT_TRUE(std::isfinite(sample.value.g) && sample.value.g >= 0.0f) << sample.value.g;
    if (sample.pdf > 0.0f) sum += static_cast<double>(sample.value.g) / static_cast<double>(sample.pdf);
  }
  return sum / static_cast<double>(samples.size());
}

constexpr float kCosines[] = {0.05f, 0.2f, 0.5f, 0.8f, 1.0f};
constexpr float kRoughnesses[] = {0.0f, 0.1f, 0.3f, 0.5f, 0.7f, 0.85f, 1.0f};

TEST(BrdfFurnace, AWhiteSurfaceGivesNoMoreThanItGets) {
  for (const float roughness : kRoughnesses)
    for (const float metallic : {0.0f, 0.5f, 1.0f})
      for (const float cosine : kCosines) {
        const double given = furnace({.metallic = metallic, .roughness = roughness}, kPlain, cosine);
        EXPECT_LE(given, 1.004) << "roughness " << roughness << " metallic " << metallic << " cosine " << cosine;
      }
}

TEST(BrdfFurnace, AWhiteSurfaceGivesAllOfItBackWithMultipleScattering) {
  for (const float roughness : kRoughnesses)
    for (const float metallic : {0.0f, 0.3f, 0.5f, 1.0f})
      for (const float cosine : kCosines) {
        const double given = furnace({.metallic = metallic, .roughness = roughness}, kMultiscatter, cosine);
        EXPECT_NEAR(given, 1.0, 0.01) << "roughness " << roughness << " metallic " << metallic << " cosine " << cosine;
      }
}

TEST(BrdfFurnace, LobesOfExtensionsGiveNoMoreThanTheyGet) {
  const std::map<std::string, LabMaterial> materials = {
      {"clearcoat on white", {.clearcoat = 1.0f, .clearcoat_roughness = 0.2f}},
      {"clearcoat on metal", {.metallic = 1.0f, .roughness = 0.3f, .clearcoat = 1.0f, .clearcoat_roughness = 0.0f}},
      {"sheen", {.sheen_color = glm::vec3(1.0f), .sheen_roughness = 0.4f}},
      {"rough sheen", {.sheen_color = glm::vec3(1.0f), .sheen_roughness = 1.0f}},
      {"thin glass", {.roughness = 0.0f, .transmission = 1.0f}},
      {"rough thin glass", {.roughness = 0.6f, .transmission = 1.0f}},
      {"into glass", {.roughness = 0.2f, .transmission = 1.0f, .eta = 1.5f}},
      {"out of glass", {.roughness = 0.2f, .transmission = 1.0f, .eta = 1.0f / 1.5f}},
      {"half transmitting", {.roughness = 0.4f, .transmission = 0.5f, .eta = 1.5f}}};
  for (const auto& [name, material] : materials)
    for (const LabVariant variant : {kLobes, kAll})
      for (const float cosine : kCosines)
        EXPECT_LE(furnace(material, variant, cosine), 1.01) << name << ", cosine " << cosine;
}

// The lobes' variant without any of them is the plain BRDF.
TEST(Brdf, VariantsAgreeWhereNothingIsAsked) {
  for (const float roughness : kRoughnesses) {
    const LabMaterial material{.base_color = {0.8f, 0.5f, 0.2f}, .metallic = 0.4f, .roughness = roughness};
    std::vector<glm::vec3> directions;
    for (const glm::vec3& u : random_numbers(256, 5)) directions.push_back(viewer(u.x, 6.2831853f * u.y));
    const auto plain = lab().evaluate(material, kPlain, viewer(0.6f), directions);
    const auto lobes = lab().evaluate(material, kLobes, viewer(0.6f), directions);
    for (std::size_t i = 0; i < plain.size(); ++i)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(plain[i].value[c], lobes[i].value[c], 1e-4f + 2e-3f * plain[i].value[c]);
  }
}

struct Case {
  const char* name;
  LabMaterial material;
  LabVariant variant;
  float cos_out;
};

std::vector<Case> sampled_cases() {
  return {
      {"rough dielectric", {.base_color = glm::vec3(0.5f), .roughness = 0.6f}, kPlain, 0.7f},
      {"rough dielectric at grazing angles", {.base_color = glm::vec3(0.5f), .roughness = 0.5f}, kPlain, 0.15f},
      {"metal", {.metallic = 1.0f, .roughness = 0.5f}, kPlain, 0.6f},
      {"rough metal", {.metallic = 1.0f, .roughness = 1.0f}, kMultiscatter, 0.4f},
      {"glossy metal", {.metallic = 1.0f, .roughness = 0.35f}, kPlain, 0.8f},
      {"clearcoat", {.clearcoat_normal = viewer(0.95f), .clearcoat = 1.0f, .clearcoat_roughness = 0.5f}, kLobes, 0.5f},
      {"sheen", {.base_color = glm::vec3(0.3f), .sheen_color = {0.8f, 0.2f, 0.5f}}, kLobes, 0.5f},
      {"rough thin glass", {.roughness = 0.6f, .transmission = 0.9f}, kLobes, 0.6f},
      {"into rough glass", {.roughness = 0.6f, .transmission = 1.0f, .eta = 1.5f}, kLobes, 0.6f},
      {"out of rough glass", {.roughness = 0.6f, .transmission = 1.0f, .eta = 1.0f / 1.5f}, kLobes, 0.8f},
      {"everything",
       {.base_color = {0.6f, 0.5f, 0.4f},
        .metallic = 0.2f,
        .roughness = 0.5f,
        .sheen_color = glm::vec3(0.3f),
        .clearcoat_normal = viewer(0.98f),
        .clearcoat = 0.7f,
        .clearcoat_roughness = 0.4f,
        .transmission = 0.5f,
        .eta = 1.33f},
       kAll,
       0.7f}};
}

constexpr int kBinsZ = 24, kBinsPhi = 24, kSub = 24;  // over the whole sphere, uniform in z and phi

// Integral of the density over every bin, by the midpoint rule.
std::vector<double> bin_masses(const Case& c) {
  std::vector<glm::vec3> directions;
  directions.reserve(static_cast<std::size_t>(kBinsZ * kBinsPhi * kSub * kSub));
  for (int z = 0; z < kBinsZ * kSub; ++z)
    for (int phi = 0; phi < kBinsPhi * kSub; ++phi) {
      const double cosine = -1.0 + 2.0 * (z + 0.5) / (kBinsZ * kSub);
      const double sine = std::sqrt(1.0 - cosine * cosine), angle = 2.0 * kPi * (phi + 0.5) / (kBinsPhi * kSub);
      directions.emplace_back(sine * std::cos(angle), sine * std::sin(angle), cosine);
    }
  const auto samples = lab().evaluate(c.material, c.variant, viewer(c.cos_out), directions);
  std::vector<double> masses(kBinsZ * kBinsPhi);
  const double cell = 4.0 * kPi / static_cast<double>(directions.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t row = i / (kBinsPhi * kSub) / kSub, column = i % (kBinsPhi * kSub) / kSub;
    masses[row * kBinsPhi + column] += cell * static_cast<double>(samples[i].pdf);
  }
  return masses;
}

struct Histogram {
  std::vector<double> counts = std::vector<double>(kBinsZ * kBinsPhi);
  double lost = 0.0;  // samples that go nowhere
};

Histogram histogram_of(const Case& c, std::size_t count) {
  Histogram histogram;
  for (const LabSample& sample : lab().sample(c.material, c.variant, viewer(c.cos_out), random_numbers(count, 11))) {
    if (!(sample.pdf > 0.0f)) {
      histogram.lost += 1.0;
      continue;
    }
    const double phi = std::atan2(sample.direction.y, sample.direction.x);
    const int row = std::clamp(static_cast<int>((sample.direction.z + 1.0) / 2.0 * kBinsZ), 0, kBinsZ - 1);
    const int column = std::clamp(
        static_cast<int>((phi < 0.0 ? phi / (2.0 * kPi) + 1.0 : phi / (2.0 * kPi)) * kBinsPhi), 0, kBinsPhi - 1);
    histogram.counts[static_cast<std::size_t>(row * kBinsPhi + column)] += 1.0;
  }
  return histogram;
}

// The density and what sampling loses below the horizon are all there is.
TEST(BrdfSampling, TheDensityIntegratesToOne) {
  constexpr std::size_t kCount = 1 << 17;
  for (const Case& c : sampled_cases()) {
    double total = 0.0;
    for (const double mass : bin_masses(c)) total += mass;
    const double lost = histogram_of(c, kCount).lost / kCount;
    const double sigma = std::sqrt(std::max(lost * (1.0 - lost), 1e-6) / kCount);
    EXPECT_NEAR(total + lost, 1.0, 2e-3 + 4.0 * sigma) << c.name << ", lost " << lost;
  }
}

// Wilson and Hilferty 1931: a chi-square variable as a standard normal one.
double normal_score(double chi_square, double degrees) {
  const double spread = 2.0 / (9.0 * degrees);
  return (std::cbrt(chi_square / degrees) - (1.0 - spread)) / std::sqrt(spread);
}

TEST(BrdfSampling, SamplesFollowTheDensityByChiSquare) {
  constexpr std::size_t kCount = 1 << 17;
  for (const Case& c : sampled_cases()) {
    const std::vector<double> masses = bin_masses(c);
    const Histogram histogram = histogram_of(c, kCount);
    // Bins of few expected samples are taken together.
    double chi_square = 0.0, rest_expected = 0.0, rest_count = 0.0;
    int bins = 0;
    for (std::size_t i = 0; i < masses.size(); ++i) {
      const double expected = masses[i] * kCount;
      if (expected < 10.0) {
        rest_expected += expected;
        rest_count += histogram.counts[i];
        continue;
      }
      chi_square += (histogram.counts[i] - expected) * (histogram.counts[i] - expected) / expected;
      ++bins;
    }
    if (rest_expected > 10.0) {
      chi_square += (rest_count - rest_expected) * (rest_count - rest_expected) / rest_expected;
      ++bins;
    }
    EXPECT_LT(normal_score(chi_square, bins - 1), 4.0) << c.name << ": " << chi_square << " over " << bins << " bins";
  }
}

TEST(Brdf, WorksBothWaysAlike) {
  const std::vector<glm::vec3> u = random_numbers(64, 3);
  for (Case c : sampled_cases()) {
    if (c.material.transmission > 0.0f && c.material.eta < 1.0f) continue;  // its other way is the case before
    c.material.clearcoat_normal = {0.0f, 0.0f, 1.0f};  // the cosines of two normals cannot both be divided out
    for (std::size_t i = 0; i + 1 < u.size(); i += 2) {
      const glm::vec3 a = viewer(0.02f + 0.98f * u[i].x, 6.2831853f * u[i].y);
      const glm::vec3 b = viewer(0.02f + 0.98f * u[i + 1].x, 6.2831853f * u[i + 1].y);
      const glm::vec3 there = lab().evaluate(c.material, c.variant, a, {b})[0].value / b.z;
      const glm::vec3 back = lab().evaluate(c.material, c.variant, b, {a})[0].value / a.z;
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(there[k], back[k], 1e-4f + 5e-3f * std::max(there[k], back[k])) << c.name;
    }
  }
}

// Light through a surface: the same both ways, seen from the other side, but for the change of solid angle.
TEST(Brdf, TransmitsBothWaysAlike) {
  const std::vector<glm::vec3> u = random_numbers(256, 9);
  for (const float eta : {1.0f, 1.5f}) {
    const LabMaterial into{.roughness = 0.5f, .transmission = 1.0f, .eta = eta};
    const LabMaterial out_of{.roughness = 0.5f, .transmission = 1.0f, .eta = 1.0f / eta};
    int seen = 0;
    for (std::size_t i = 0; i + 1 < u.size(); i += 2) {
      const glm::vec3 flip(1.0f, 1.0f, -1.0f);
      const glm::vec3 a = viewer(0.05f + 0.95f * u[i].x, 6.2831853f * u[i].y);
      const glm::vec3 b = flip * viewer(0.05f + 0.95f * u[i + 1].x, 6.2831853f * u[i + 1].y);
      const float there = lab().evaluate(into, kLobes, a, {b})[0].value.g / std::abs(b.z) / (eta * eta);
      const float back = lab().evaluate(out_of, kLobes, flip * b, {flip * a})[0].value.g / a.z;
      EXPECT_NEAR(there, back, 1e-4f + 5e-3f * std::max(there, back)) << "eta " << eta;
      if (there > 0.0f) ++seen;
    }
    EXPECT_GT(seen, 20) << "eta " << eta;
  }
}

// Both faces of a slab at normal incidence let pass what Fresnel's equations say: 1 - ((n - 1) / (n + 1))^2 each.
TEST(Brdf, ASmoothFaceOfGlassTransmitsByFresnelAtNormalIncidence) {
  const float ior = 1.5f, reflected = std::pow((ior - 1.0f) / (ior + 1.0f), 2.0f);
  for (const float eta : {ior, 1.0f / ior}) {
    const LabMaterial glass{.f0_dielectric = glm::vec3(reflected), .roughness = 0.0f, .transmission = 1.0f, .eta = eta};
    double below = 0.0, above = 0.0;
    const auto samples = lab().sample(glass, kLobes, {0, 0, 1}, even_numbers(1 << 14));
    for (const LabSample& sample : samples) {
      if (!(sample.pdf > 0.0f)) continue;
      (sample.direction.z < 0.0f ? below : above) += static_cast<double>(sample.value.g / sample.pdf);
      EXPECT_GT(std::abs(sample.direction.z), 0.99f);
    }
    EXPECT_NEAR(below / static_cast<double>(samples.size()), 1.0 - reflected, 2e-3) << "eta " << eta;
    EXPECT_NEAR(above / static_cast<double>(samples.size()), reflected, 2e-3) << "eta " << eta;
  }
}

// Snell's law, and nothing beyond the critical angle.
TEST(Brdf, RefractsBySnellsLaw) {
  LabMaterial glass{.roughness = 0.0f, .transmission = 1.0f, .eta = 1.5f};
  const glm::vec3 out = viewer(0.5f);
  double sine = 0.0, weight = 0.0;
  for (const LabSample& sample : lab().sample(glass, kLobes, out, even_numbers(1 << 12))) {
    if (!(sample.pdf > 0.0f) || sample.direction.z > 0.0f) continue;
    sine += static_cast<double>(std::sqrt(1.0f - sample.direction.z * sample.direction.z));
    weight += 1.0;
  }
  EXPECT_NEAR(sine / weight, std::sqrt(0.75) / 1.5, 1e-3);
  glass.eta = 1.0f / 1.5f;
  for (const LabSample& sample : lab().sample(glass, kLobes, out, even_numbers(1 << 12)))
    EXPECT_TRUE(sample.pdf == 0.0f || sample.direction.z > 0.0f) << sample.direction.z;
  EXPECT_NEAR(furnace(glass, kLobes, 0.5f), 1.0, 5e-3);
}

}  // namespace
}  // namespace lightwell::test
