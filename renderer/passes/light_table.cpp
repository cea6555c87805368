#include "renderer/passes/light_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

constexpr double kPi = std::numbers::pi;

// What a light's record is; as in shaders/light_sampling.glsl, the punctual ones as in shaders/lights.glsl.
constexpr std::uint32_t kTriangle = 3, kEnvironment = 4;

struct DeviceLightRecord {
  glm::vec3 position_ws{0.0f};  // or the first corner
  std::uint32_t kind = 0;
  glm::vec3 direction_ws{0.0f};  // or the edge to the second corner
  std::uint32_t inverse_range_or_instance = 0;
  glm::vec3 intensity{0.0f};  // or the edge to the third corner
  std::uint32_t spot_scale_or_triangle = 0;
  glm::vec3 radiance{0.0f};             // of a triangle
  float spot_offset_or_density = 0.0f;  // density of samples, per m2
};
static_assert(sizeof(DeviceLightRecord) == 64);

std::uint32_t bits_of(float value) {
  return std::bit_cast<std::uint32_t>(value);
}

double luminance(const glm::vec3& color) {
  return glm::dot(glm::dvec3(color), glm::dvec3(0.2126, 0.7152, 0.0722));
}

double disk_area_m2(const Pose& pose) {
  const glm::dvec3 size = glm::dvec3(pose.bounds_max) - glm::dvec3(pose.bounds_min);
  return kPi * std::max(0.25 * glm::dot(size, size), 1e-12);
}

// Lumens over a constant: of a point or spot light all it emits, of a directional one what meets the scene.
double power_of(const Light& light, double scene_disk_m2) {
  const double intensity = luminance(light.color * light.intensity);
  if (light.kind == LightKind::kDirectional) return intensity * scene_disk_m2;
  if (light.kind == LightKind::kPoint) return intensity * 4.0 * kPi;
  return intensity * 2.0 * kPi * (1.0 - std::cos(static_cast<double>(light.outer_cone_angle)));
}

// What order equal lights come in never changes.
std::vector<PlacedLight> strongest_first(std::vector<PlacedLight> lights, double scene_disk_m2) {
  std::stable_sort(lights.begin(), lights.end(), [&](const PlacedLight& a, const PlacedLight& b) {
    return power_of(a.light, scene_disk_m2) > power_of(b.light, scene_disk_m2);
  });
  return lights;
}

DeviceLightRecord record_of(const PlacedLight& placed) {
  const Light& light = placed.light;
  DeviceLightRecord record;
  record.kind = light.kind == LightKind::kDirectional ? 0u : light.kind == LightKind::kPoint ? 1u : 2u;
  record.position_ws = placed.position_ws;
  record.direction_ws = placed.direction_ws;
  record.intensity = light.color * light.intensity;
  record.inverse_range_or_instance = bits_of(light.range_m > 0.0f ? 1.0f / light.range_m : 0.0f);
  // KHR_lights_punctual, "Inner and outer cone angles".
  const float cos_inner = std::cos(light.inner_cone_angle), cos_outer = std::cos(light.outer_cone_angle);
  const float spot_scale = 1.0f / std::max(0.001f, cos_inner - cos_outer);
  record.spot_scale_or_triangle = bits_of(spot_scale);
  record.spot_offset_or_density = -cos_outer * spot_scale;
  return record;
}

DeviceLightRecord record_of(const Emitter& emitter, std::size_t instance, std::size_t triangle, float probability) {
  DeviceLightRecord record;
  record.kind = kTriangle;
  record.position_ws = emitter.corner;
  record.direction_ws = emitter.edge_u;
  record.intensity = emitter.edge_v;
  record.radiance = emitter.radiance;
  record.inverse_range_or_instance = static_cast<std::uint32_t>(instance);
  record.spot_scale_or_triangle = static_cast<std::uint32_t>(triangle);
  const double density = emitter.area_m2 > 0.0 ? static_cast<double>(probability) / emitter.area_m2 : 0.0;
  record.spot_offset_or_density = static_cast<float>(std::min(density, 1e30));
  return record;
}

template <class T>
void fill(gl::Buffer& buffer, const gl::BufferTexture& texels, const std::vector<T>& values) {
  buffer.reserve(values.size() * sizeof(T));
  buffer.upload(std::span<const T>(values));
  texels.attach(buffer);
}

}  // namespace

bool LightTable::EmitterKey::operator==(const EmitterKey& other) const {
  return primitive == other.primitive && same_shape(deformed, other.deformed) && image == other.image &&
         world_from_object == other.world_from_object && radiance == other.radiance && instance == other.instance &&
         texture.texture == other.texture.texture && texture.uv_set == other.texture.uv_set &&
         texture.offset == other.texture.offset && texture.rotation == other.texture.rotation &&
         texture.scale == other.texture.scale;
}

LightTable::LightTable(PlainSky plain_sky)
    : plain_sky_(plain_sky),
      lights_("lights", 0),
      choices_("light choices", 0),
      instance_lights_("lights of instances", 0),
      light_texels_("lights", GL_RGBA32UI),
      choice_texels_("light choices", GL_RGBA32UI),
      instance_light_texels_("lights of instances", GL_R32UI) {}

void LightTable::prepare(const Scene& scene, const Pose& pose) {
  const bool new_emitters = update_emitters(scene, pose);
  const bool new_environment = update_environment(scene.environment);
  // Punctual lights are few: they go up with every frame unless there are none and never were.
  const bool punctual = !pose.lights.empty() || counts_.punctual > 0;
  if (new_emitters || new_environment || punctual || uploaded_instances_ != pose.instances.size()) upload(pose);
}

bool LightTable::update_emitters(const Scene& scene, const Pose& pose) {
  std::vector<EmittingInstance> now;
  bool changed = false;
  for (std::size_t i = 0; i < pose.instances.size(); ++i) {
    const Instance& instance = pose.instances[i];
    if (instance.material < 0) continue;
    const Material& material = scene.materials[static_cast<std::size_t>(instance.material)];
    if (!is_emitter(material)) continue;
    std::shared_ptr<const Image> image;
    if (material.emissive_texture.texture >= 0) {
      const Texture& texture = scene.textures[static_cast<std::size_t>(material.emissive_texture.texture)];
      if (texture.image >= 0) image = scene.images[static_cast<std::size_t>(texture.image)];
    }
    EmittingInstance next{
        {instance.primitive.get(), instance.deformed, instance.world_from_object,
         material.emissive_factor * material.emissive_strength, material.emissive_texture, std::move(image), i},
        instance.primitive,
        {}};
    if (now.size() < emitting_.size() && emitting_[now.size()].key == next.key) {
      next.emitters = std::move(emitting_[now.size()].emitters);
    } else {
      next.emitters = emitters_of(scene, instance, emissive_textures_);
      changed = true;
    }
    now.push_back(std::move(next));
  }
  changed = changed || now.size() != emitting_.size();
  emitting_ = std::move(now);
  return changed;
}

bool LightTable::update_environment(const Environment& environment) {
  EnvironmentKey key{environment.zenith_radiance, environment.horizon_radiance, environment.ground_radiance,
                     environment.strength, environment.image};
  if (environment_key_ && *environment_key_ == key) return false;
  environment_key_ = std::move(key);
  const bool sampled = plain_sky_ == PlainSky::kSampled || environment.image;
  cells_ = sampled ? make_environment_cells(environment) : EnvironmentCells{};
  return true;
}

void LightTable::upload(const Pose& pose) {
  const double scene_disk_m2 = disk_area_m2(pose);
  const std::vector<PlacedLight> lights = strongest_first(pose.lights, scene_disk_m2);
  std::vector<double> powers;
  for (const PlacedLight& light : lights) powers.push_back(power_of(light.light, scene_disk_m2));
  const std::vector<AliasEntry> punctual = make_alias_table(powers);
  for (const EmittingInstance& instance : emitting_)
    for (const Emitter& emitter : instance.emitters) powers.push_back(emitter.power);
  powers.push_back(std::accumulate(cells_.weights.begin(), cells_.weights.end(), 0.0) * scene_disk_m2);
  std::vector<AliasEntry> choices = make_alias_table(powers);
  power_ = std::accumulate(powers.begin(), powers.end(), 0.0);

  std::vector<DeviceLightRecord> records;
  for (const PlacedLight& light : lights) records.push_back(record_of(light));
  std::vector<std::uint32_t> instance_lights(pose.instances.size(), 0);
  has_emitters_ = false;
  for (const EmittingInstance& instance : emitting_) {
    instance_lights[instance.key.instance] = static_cast<std::uint32_t>(records.size()) + 1;
    for (std::size_t t = 0; t < instance.emitters.size(); ++t) {
      const float probability = choices.empty() ? 0.0f : choices[records.size()].probability;
      has_emitters_ = has_emitters_ || probability > 0.0f;
      records.push_back(record_of(instance.emitters[t], instance.key.instance, t, probability));
    }
  }
  records.emplace_back().kind = kEnvironment;

  counts_.lights = choices.empty() ? 0 : static_cast<std::uint32_t>(records.size());
  counts_.punctual = static_cast<std::uint32_t>(punctual.size());
  counts_.environment_cells = cells_.size;
  counts_.environment_probability = choices.empty() ? 0.0f : choices.back().probability;
  choices.insert(choices.end(), punctual.begin(), punctual.end());
  const std::vector<AliasEntry> cell_choices = make_alias_table(cells_.weights);
  choices.insert(choices.end(), cell_choices.begin(), cell_choices.end());
  append_sized_lights(powers, lights.size(), choices);
  append_other_punctual(powers, lights.size(), choices);
  fill(lights_, light_texels_, records);
  fill(choices_, choice_texels_, choices);
  fill(instance_lights_, instance_light_texels_, instance_lights);
  uploaded_instances_ = pose.instances.size();
}

// The lights after the first `punctual` ones.
void LightTable::append_sized_lights(std::vector<double> powers, std::size_t punctual,
                                     std::vector<AliasEntry>& choices) {
  // Scaled, for a sum of numbers near the end of the range would be infinite.
  const double greatest = *std::max_element(powers.begin(), powers.end());
  for (double& power : powers) power /= std::max(greatest, 1e-300);
  const double all = std::accumulate(powers.begin(), powers.end(), 0.0);
  std::fill_n(powers.begin(), punctual, 0.0);
  const double sized = std::accumulate(powers.begin(), powers.end(), 0.0);
  counts_.sized_first = static_cast<std::uint32_t>(choices.size());
  counts_.sized_share = all > 0.0 ? static_cast<float>(sized / all) : 0.0f;
  const std::vector<AliasEntry> sized_choices = make_alias_table(powers);
  choices.insert(choices.end(), sized_choices.begin(), sized_choices.end());
}

// The first `punctual` lights without the strongest of them.
void LightTable::append_other_punctual(std::vector<double> powers, std::size_t punctual,
                                       std::vector<AliasEntry>& choices) {
  powers.resize(punctual);
  std::fill_n(powers.begin(), std::min<std::size_t>(punctual, kStrongestLights), 0.0);
  const std::vector<AliasEntry> other_choices = make_alias_table(powers);
  counts_.others = static_cast<std::uint32_t>(other_choices.size());
  counts_.others_first = static_cast<std::uint32_t>(choices.size());
  choices.insert(choices.end(), other_choices.begin(), other_choices.end());
}

gl::Defines LightTable::sized_defines() const {
  gl::Defines defines;
  if (has_emitters()) defines.emplace_back("LIGHTS_TRIANGLES 1");
  if (has_environment()) defines.emplace_back("LIGHTS_ENVIRONMENT 1");
  return defines;
}

gl::Defines LightTable::defines() const {
  gl::Defines defines = sized_defines();
  if (has_punctual()) defines.emplace_back("LIGHTS_PUNCTUAL 1");
  return defines;
}

void LightTable::bind() const {
  light_texels_.bind(UNIT_LIGHT_TABLE);
  choice_texels_.bind(UNIT_LIGHT_CHOICES);
  instance_light_texels_.bind(UNIT_INSTANCE_LIGHTS);
  lights_.bind_uniform(BINDING_STRONGEST_LIGHTS);
}

LightTableUniforms::LightTableUniforms(const gl::ProgramPtr& program)
    : lights_(program, "table_lights"),
      punctual_(program, "table_punctual_lights"),
      sized_first_(program, "table_sized_first"),
      sized_share_(program, "table_sized_share"),
      cells_(program, "environment_cells"),
      environment_probability_(program, "environment_probability") {}

void LightTableUniforms::set(const LightCounts& counts) const {
  lights_ = counts.lights;
  punctual_ = counts.punctual;
  sized_first_ = counts.sized_first;
  sized_share_ = counts.sized_share;
  cells_ = counts.environment_cells;
  environment_probability_ = counts.environment_probability;
}

}  // namespace lightwell
