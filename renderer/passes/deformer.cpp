#include "renderer/passes/deformer.h"

#include <algorithm>
#include <map>

#include "renderer/passes/bindings.glsl"
#include "renderer/passes/device_types.h"

namespace lightwell {

namespace {

constexpr std::uint32_t kGroup = 64;

template <class T>
void fill(gl::Buffer& buffer, const std::vector<T>& values) {
  buffer.reserve(values.size() * sizeof(T));
  buffer.upload(std::span<const T>(values));
}

}  // namespace

Deformer::Deformer(gl::ShaderLibrary& shaders)
    : vertices_program_(shaders.compute("passes/deform_vertices.comp")),
      triangles_program_(shaders.compute("passes/deform_triangles.comp")) {}

void Deformer::Dispatch::add(DeviceTask task) {
  task.first_group = static_cast<std::uint32_t>(groups.size());
  groups.insert(groups.end(), (task.count + kGroup - 1) / kGroup, static_cast<std::uint32_t>(tasks.size()));
  tasks.push_back(task);
}

void Deformer::run(const std::vector<DeformTask>& tasks, DeviceGeometry& geometry) {
  const auto* positions = reinterpret_cast<const glm::vec3*>(geometry.positions().host());
  if (!geometry.becomes(tasks)) {
    deform(tasks, geometry);
    if (positions) gl::wait_for_device();
  }
  if (!positions) return;
  for (const DeformTask& task : tasks)
    task.shape->take_positions({positions + task.first_vertex, task.shape->vertex_count()});
}

void Deformer::deform(const std::vector<DeformTask>& tasks, const DeviceGeometry& geometry) {
  prepare(tasks, geometry);
  fill(morph_buffer_, morphs_);
  fill(matrix_buffer_, matrix_rows_);
  matrix_texels_.attach(matrix_buffer_);
  matrix_texels_.bind(UNIT_JOINT_MATRICES);
  geometry.deformation_sources().bind();
  morph_buffer_.bind_storage(BINDING_DEFORM_MORPHS);
  geometry.positions().bind_storage(BINDING_DEFORM_POSITIONS);
  geometry.vertices().bind_storage(BINDING_DEFORM_VERTICES);
  geometry.triangles().bind_storage(BINDING_DEFORM_TRIANGLES);
  dispatch(vertices_program_, vertices_);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  dispatch(triangles_program_, triangles_);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                  GL_SHADER_STORAGE_BARRIER_BIT);
}

void Deformer::prepare(const std::vector<DeformTask>& tasks, const DeviceGeometry& geometry) {
  vertices_ = triangles_ = {};
  matrix_rows_.clear();
  morphs_.clear();
  std::map<const glm::mat4*, std::uint32_t> first_matrices;  // the primitives of a mesh share theirs
  for (const DeformTask& task : tasks) {
    const std::span<const glm::mat4> matrices = task.shape->world_from_mesh();
    const auto [known, is_new] = first_matrices.try_emplace(matrices.data(), matrix_rows_.size() / 3);
    if (is_new)
      for (const glm::mat4& matrix : matrices) {
        const glm::mat4 rows = glm::transpose(matrix);
        matrix_rows_.insert(matrix_rows_.end(), {rows[0], rows[1], rows[2]});
      }
    DeviceTask packed{};
    packed.count = static_cast<std::uint32_t>(task.shape->vertex_count());
    packed.first_source = packed.source_vertex = geometry.first_vertex(task.primitive);
    packed.first_target = packed.target_vertex = task.first_vertex;
    packed.first_influence =
        matrices.empty() ? DeformationSources::kNone : geometry.deformation_sources().first_influence(task.primitive);
    packed.first_matrix = known->second;
    packed.last_joint = static_cast<std::uint32_t>(std::max<std::size_t>(matrices.size(), 1) - 1);
    packed.first_morph = static_cast<std::uint32_t>(morphs_.size());
    const auto& targets = geometry.deformation_sources().targets(task.primitive);
    const std::span<const float> weights = task.shape->morph_weights();
    for (std::size_t i = 0; i < std::min(weights.size(), targets.size()); ++i)
      if (weights[i] != 0.0f)
        morphs_.push_back({targets[i].first_position, targets[i].first_normal, targets[i].first_tangent, weights[i]});
    packed.morphs = static_cast<std::uint32_t>(morphs_.size()) - packed.first_morph;
    vertices_.add(packed);
    packed.count = static_cast<std::uint32_t>(geometry.primitives()[task.primitive]->indices.size() / 3);
    packed.first_source = geometry.first_index(task.primitive) / 3;
    packed.first_target = task.first_triangle;
    triangles_.add(packed);
  }
}

void Deformer::dispatch(const gl::ProgramPtr& program, const Dispatch& dispatch) {
  fill(task_buffer_, dispatch.tasks);
  fill(group_buffer_, dispatch.groups);
  task_buffer_.bind_storage(BINDING_DEFORM_TASKS);
  group_buffer_.bind_storage(BINDING_DEFORM_GROUPS);
  program->dispatch(static_cast<std::uint32_t>(dispatch.groups.size()) * kGroup, kGroup);
}

}  // namespace lightwell
