#include "renderer/tracing/embree/embree_scene.h"

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include "renderer/check.h"

namespace lightwell {
namespace {

constexpr std::uint64_t kFramesUntilDropped = 120;
constexpr float kRefitAreaLimit = 2.0f;  // growth of the bounds' area after which a refitted hierarchy is rebuilt

// Embree's watertight edge test costs 15 to 20 % of the rate. Without it 1 to 7 rays in a million slip between two
// triangles (70k and 600k of them), and a shadow ray that does lights a dark room with a pixel of full sun.
constexpr int kSceneFlags = RTC_SCENE_FLAG_ROBUST;

bool count_memory(void* counter, ssize_t bytes, bool) {
  static_cast<std::atomic<std::int64_t>*>(counter)->fetch_add(bytes, std::memory_order_relaxed);
  return true;
}

// Called for every candidate hit of a filtered geometry.
void reject_uncovered(const RTCFilterFunctionNArguments* arguments) {
  const EmbreeScene& scene = *reinterpret_cast<const EmbreeContext*>(arguments->context)->scene;
  const unsigned width = arguments->N;
  for (unsigned i = 0; i < width; ++i) {
    if (arguments->valid[i] == 0) continue;
    const std::uint32_t instance =
        scene.instance_of(RTCHitN_instID(arguments->hit, width, i, 0), RTCHitN_geomID(arguments->hit, width, i));
    if (!scene.is_covered(instance, RTCHitN_primID(arguments->hit, width, i), RTCHitN_u(arguments->hit, width, i),
                          RTCHitN_v(arguments->hit, width, i)))
      arguments->valid[i] = 0;
  }
}

// `deformed`: null if it is rigid.
EmbreeGeometry make_triangles(RTCDevice device, const Primitive& primitive, const DeformedShape* deformed,
                              bool filtered) {
  EmbreeGeometry geometry{rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE)};
  const std::span<const glm::vec3> positions = positions_of(primitive, deformed);
  // Embree's own vertex buffer: it reads beyond the last vertex, which a std::vector does not allow.
  void* vertices = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(glm::vec3), positions.size());
  if (!vertices) throw std::runtime_error("out of memory for the vertices of a hierarchy");
  std::memcpy(vertices, positions.data(), positions.size() * sizeof(glm::vec3));
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, primitive.indices.data(), 0,
                             3 * sizeof(std::uint32_t), primitive.indices.size() / 3);
  if (filtered) {
    rtcSetGeometryIntersectFilterFunction(geometry.get(), reject_uncovered);
    rtcSetGeometryOccludedFilterFunction(geometry.get(), reject_uncovered);
  }
  // Deformed geometry keeps its tree and moves the boxes.
  rtcSetGeometryBuildQuality(geometry.get(), deformed ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_MEDIUM);
  rtcCommitGeometry(geometry.get());
  return geometry;
}

glm::vec3 extent_m(RTCScene scene) {
  RTCBounds bounds;
  rtcGetSceneBounds(scene, &bounds);
  return {bounds.upper_x - bounds.lower_x, bounds.upper_y - bounds.lower_y, bounds.upper_z - bounds.lower_z};
}

float bounds_area_m2(RTCScene scene) {
  const glm::vec3 size = extent_m(scene);
  return 2.0f * (size.x * size.y + size.y * size.z + size.z * size.x);
}

// The inverse transpose times the determinant's magnitude.
glm::mat3 normal_matrix(const glm::mat4& world_from_object) {
  const glm::vec3 x(world_from_object[0]), y(world_from_object[1]), z(world_from_object[2]);
  const glm::mat3 cofactor(glm::cross(y, z), glm::cross(z, x), glm::cross(x, y));
  return glm::dot(x, cofactor[0]) < 0.0f ? -cofactor : cofactor;
}

}  // namespace

EmbreeScene::EmbreeScene(unsigned threads) {
  // Debian's Embree 3.13.5 is miscompiled for AVX-512: rtcOccluded16 with the coherent flag stores a 16-bit mask and
  // reads 64 bits of it back, and so loops without end or reads beyond the packet. AVX2 costs 5 to 8 % of the rate.
  std::string configuration = "max_isa=avx2";
  if (threads != 0) configuration += ",threads=" + std::to_string(threads);
  device_.reset(rtcNewDevice(configuration.c_str()));
  if (!device_) throw std::runtime_error("Embree cannot start on this machine");
  rtcSetDeviceMemoryMonitorFunction(device_.get(), count_memory, &memory_bytes_);
  top_level_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(top_level_.get(), static_cast<RTCSceneFlags>(kSceneFlags | RTC_SCENE_FLAG_DYNAMIC));
  rtcSetSceneBuildQuality(top_level_.get(), RTC_BUILD_QUALITY_LOW);
  rtcCommitScene(top_level_.get());
  throw_on_error();
}

void EmbreeScene::update(const TraceScene& scene, ThreadPool& threads) {
  LIGHTWELL_CHECK_OP(scene.instances.size(), ==, scene.coverage.size());
  ++frame_;
  std::vector<bool> filtered;
  prepare_coverage_tests(scene, filtered);
  placed_.clear();
  for (const Instance& instance : scene.instances)
    placed_.push_back({positions_of(instance).data(), instance.primitive->indices.data(), instance.world_from_object});
  const std::vector<GeometryGroup> groups = group_instances(scene.instances, filtered);
  std::vector<BottomLevel*> levels;
  levels.reserve(groups.size());
  for (const GeometryGroup& group : groups) levels.push_back(&bottom_level(group, scene.instances));
  refit_deformed(groups, levels, scene.instances, threads);
  rebuild_top_level(groups, levels);
  drop_unused();
  throw_on_error();
}

void EmbreeScene::prepare_coverage_tests(const TraceScene& scene, std::vector<bool>& filtered) {
  coverage_.clear();
  primitives_.clear();
  double_sided_.clear();
  images_.clear();
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Primitive& primitive = *scene.instances[i].primitive;
    coverage_.push_back(prepare_coverage(scene.coverage[i], primitive, alpha_ranges_));
    primitives_.push_back(&primitive);
    double_sided_.push_back(scene.coverage[i].double_sided);
    if (coverage_.back().image) images_.push_back(scene.coverage[i].image);
    filtered.push_back(coverage_.back().outcome != CoverageTest::Outcome::kAlwaysHit);
  }
}

EmbreeScene::BottomLevel& EmbreeScene::bottom_level(const GeometryGroup& group, std::span<const Instance> instances) {
  const auto known = bottom_levels_.find(group.key);
  if (known == bottom_levels_.end()) {
    auto built = std::make_unique<BottomLevel>();
    build(*built, group, instances);
    built->last_used = frame_;
    return *bottom_levels_.emplace(group.key, std::move(built)).first->second;
  }
  known->second->last_used = frame_;
  return *known->second;
}

void EmbreeScene::build(BottomLevel& level, const GeometryGroup& group, std::span<const Instance> instances) {
  level.scene.reset(rtcNewScene(device_.get()));
  const int dynamic = group.deformed ? RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_NONE;
  rtcSetSceneFlags(level.scene.get(), static_cast<RTCSceneFlags>(kSceneFlags | dynamic));
  level.primitives.clear();
  for (std::uint32_t i = 0; i < group.key.primitives.size(); ++i) {
    const Primitive& primitive = *group.key.primitives[i];
    level.primitives.push_back(instances[group.first_instance + i].primitive);
    const EmbreeGeometry geometry = make_triangles(device_.get(), primitive, group.deformed.get(), group.key.filtered);
    rtcAttachGeometryByID(level.scene.get(), geometry.get(), i);
  }
  rtcCommitScene(level.scene.get());
  throw_on_error();
  level.shape = group.deformed;
  level.built_area_m2 = bounds_area_m2(level.scene.get());
  level.built_in = frame_;
}

// Embree builds a small mesh with a single thread: several at once.
void EmbreeScene::refit_deformed(const std::vector<GeometryGroup>& groups, const std::vector<BottomLevel*>& levels,
                                 std::span<const Instance> instances, ThreadPool& threads) {
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (!same_shape(groups[i].deformed, levels[i]->shape)) changed.push_back(i);
  std::vector<RTCError> errors(changed.size(), RTC_ERROR_NONE);
  threads.parallel_for(static_cast<std::uint32_t>(changed.size()), 1, [&](std::uint32_t i, std::uint32_t) {
    refit(*levels[changed[i]], groups[changed[i]]);
    errors[i] = rtcGetDeviceError(device_.get());  // it keeps one for each thread
  });
  for (const RTCError error : errors) throw_on(error);
  for (const std::size_t i : changed)
    if (bounds_area_m2(levels[i]->scene.get()) > kRefitAreaLimit * levels[i]->built_area_m2)
      build(*levels[i], groups[i], instances);
}

void EmbreeScene::refit(BottomLevel& level, const GeometryGroup& group) const {
  const RTCGeometry geometry = rtcGetGeometry(level.scene.get(), 0);
  const std::span<const glm::vec3> positions = group.deformed->positions();
  void* vertices = rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  std::memcpy(vertices, positions.data(), positions.size() * sizeof(glm::vec3));
  rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(geometry);
  rtcCommitScene(level.scene.get());
  level.shape = group.deformed;
  level.built_in = frame_;
}

void EmbreeScene::rebuild_top_level(const std::vector<GeometryGroup>& groups, const std::vector<BottomLevel*>& levels) {
  bool changed = slots_.size() != groups.size();
  for (std::size_t i = groups.size(); i < slots_.size(); ++i)
    rtcDetachGeometry(top_level_.get(), static_cast<unsigned>(i));
  slots_.resize(groups.size());
  first_instances_.clear();
  for (std::uint32_t i = 0; i < groups.size(); ++i) {
    first_instances_.push_back(groups[i].first_instance);
    changed |= show(slots_[i], i, *levels[i], groups[i].world_from_object);
  }
  if (!changed) return;
  rtcCommitScene(top_level_.get());
  double triangles = 0.0;
  for (const GeometryGroup& group : groups)
    for (const Primitive* primitive : group.key.primitives)
      triangles += static_cast<double>(primitive->indices.size() / 3);
  triangle_size_m_ =
      groups.empty() ? 0.0f : glm::length(extent_m(top_level_.get())) / static_cast<float>(std::sqrt(triangles));
}

bool EmbreeScene::show(Slot& slot, std::uint32_t id, const BottomLevel& level, const glm::mat4& world_from_object) {
  if (slot.geometry && slot.shows == &level && slot.shown_build == level.built_in &&
      slot.world_from_object == world_from_object)
    return false;
  if (!slot.geometry) {
    slot.geometry.reset(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
    rtcAttachGeometryByID(top_level_.get(), slot.geometry.get(), id);
  }
  rtcSetGeometryInstancedScene(slot.geometry.get(), level.scene.get());
  rtcSetGeometryTransform(slot.geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &world_from_object[0][0]);
  rtcCommitGeometry(slot.geometry.get());
  slot.shows = &level;
  slot.shown_build = level.built_in;
  slot.world_from_object = world_from_object;
  slot.normal_from_object = normal_matrix(world_from_object);
  return true;
}

void EmbreeScene::drop_unused() {
  std::erase_if(bottom_levels_,
                [&](const auto& entry) { return entry.second->last_used + kFramesUntilDropped < frame_; });
  alpha_ranges_.drop_unused();
}

void EmbreeScene::throw_on_error() const {
  throw_on(rtcGetDeviceError(device_.get()));
}

void EmbreeScene::throw_on(RTCError error) {
  if (error == RTC_ERROR_NONE) return;
  throw std::runtime_error(error == RTC_ERROR_OUT_OF_MEMORY ? "Embree ran out of memory for its hierarchies"
                                                            : "Embree failed with error " + std::to_string(error));
}

}  // namespace lightwell
