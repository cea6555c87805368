#include "renderer/scene/gltf/accessors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace lightwell::gltf {
namespace {

/// Where elements lie: `count` of them, `stride` bytes apart.
struct Elements {
  std::span<const std::byte> bytes;
  std::size_t count = 0, stride = 0;
  int components = 1;
};

std::string accessor_path(int index) {
  return join("accessors", static_cast<std::size_t>(index));
}

const char* type_name(int components) {
  switch (components) {
    case 1:
      return "SCALAR";
    case 2:
      return "VEC2";
    case 3:
      return "VEC3";
    case 4:
      return "VEC4";
    default:
      return "MAT4";
  }
}

int components_of(const tinygltf::Accessor& accessor) {
  return tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
}

bool is_component_type(int type) {
  return type >= TINYGLTF_COMPONENT_TYPE_BYTE && type <= TINYGLTF_COMPONENT_TYPE_FLOAT &&
         type != TINYGLTF_COMPONENT_TYPE_INT;
}

std::size_t component_bytes(int component_type) {
  return static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type)));
}

/// Elements in a buffer view, checked to lie within it. All counts and offsets are below 2^31, so that nothing
/// overflows.
Elements find_elements(const Context& context, int buffer_view, std::size_t offset, std::size_t count, int components,
                       int component_type, bool strided, const std::string& where) {
  const std::span<const std::byte> view = bytes_of_view(context.document, buffer_view, where);
  const std::size_t size = component_bytes(component_type) * static_cast<std::size_t>(components);
  const std::size_t given = context.document.model.bufferViews[static_cast<std::size_t>(buffer_view)].byteStride;
  const std::size_t stride = strided && given > 0 ? given : size;
  if (stride < size)
    fail(where, "has elements of " + std::to_string(size) + " bytes, but a stride of " + std::to_string(stride));
  const std::size_t end = count == 0 ? offset : offset + (count - 1) * stride + size;
  if (end > view.size())
    fail(where, std::to_string(count) + " elements end at byte " + std::to_string(end) + " of a buffer view of " +
                    std::to_string(view.size()));
  return {view.subspan(offset, end - offset), count, stride, components};
}

template <class Stored, class Value>
Value converted(Stored stored, [[maybe_unused]] bool normalized) {
  if constexpr (std::is_same_v<Value, float> && std::is_integral_v<Stored>)
    if (normalized)
      return std::max(static_cast<float>(stored) / static_cast<float>(std::numeric_limits<Stored>::max()), -1.0f);
  return static_cast<Value>(stored);
}

/// Element i goes to `target[slots[i]]`, or to `target[i]` without slots, counted in elements.
template <class Stored, class Value>
void copy_elements(const Elements& source, bool normalized, const std::vector<std::uint32_t>* slots, Value* target) {
  const auto components = static_cast<std::size_t>(source.components);
  for (std::size_t i = 0; i < source.count; ++i) {
    const std::byte* element = source.bytes.data() + i * source.stride;
    Value* out = target + (slots ? (*slots)[i] : i) * components;
    for (std::size_t c = 0; c < components; ++c) {
      Stored stored;
      std::memcpy(&stored, element + c * sizeof(Stored), sizeof(Stored));
      out[c] = converted<Stored, Value>(stored, normalized);
    }
  }
}

template <class Value>
void copy_elements(const Elements& source, int component_type, bool normalized, const std::vector<std::uint32_t>* slots,
                   Value* target) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return copy_elements<std::int8_t>(source, normalized, slots, target);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return copy_elements<std::uint8_t>(source, normalized, slots, target);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return copy_elements<std::int16_t>(source, normalized, slots, target);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return copy_elements<std::uint16_t>(source, normalized, slots, target);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return copy_elements<std::uint32_t>(source, normalized, slots, target);
    default:
      return copy_elements<float>(source, normalized, slots, target);
  }
}

std::vector<std::uint32_t> read_sparse_slots(const Context& context, const tinygltf::Accessor& accessor,
                                             const std::string& where) {
  const auto count = static_cast<std::size_t>(accessor.sparse.count);
  if (count > accessor.count)
    fail(where, "replaces " + std::to_string(count) + " of " + std::to_string(accessor.count) + " elements");
  const std::string path = join(where, "sparse/indices");
  const int type = accessor.sparse.indices.componentType;
  if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    fail(path, "component type " + std::to_string(type) + " is none for indices");
  const Elements elements =
      find_elements(context, accessor.sparse.indices.bufferView,
                    static_cast<std::size_t>(accessor.sparse.indices.byteOffset), count, 1, type, false, path);
  std::vector<std::uint32_t> slots(count);
  copy_elements(elements, type, false, nullptr, slots.data());
  for (const std::uint32_t slot : slots)
    if (slot >= accessor.count)
      fail(path, "index " + std::to_string(slot) + " is beyond the " + std::to_string(accessor.count) + " elements");
  return slots;
}

/// Reads into zeroed memory: what has no buffer view stays zero.
template <class Value>
void read_elements(const Context& context, int index, int components, Value* target) {
  const tinygltf::Accessor& accessor = context.document.model.accessors[static_cast<std::size_t>(index)];
  const std::string where = accessor_path(index);
  if (accessor.bufferView != kNone)
    copy_elements(find_elements(context, accessor.bufferView, accessor.byteOffset, accessor.count, components,
                                accessor.componentType, true, where),
                  accessor.componentType, accessor.normalized, nullptr, target);
  if (!accessor.sparse.isSparse) return;
  const std::vector<std::uint32_t> slots = read_sparse_slots(context, accessor, where);
  copy_elements(find_elements(context, accessor.sparse.values.bufferView,
                              static_cast<std::size_t>(accessor.sparse.values.byteOffset), slots.size(), components,
                              accessor.componentType, false, join(where, "sparse/values")),
                accessor.componentType, accessor.normalized, &slots, target);
}

void check_type(const tinygltf::Accessor& accessor, int components, const std::string& where) {
  if (components_of(accessor) != components || accessor.type == TINYGLTF_TYPE_MAT2)
    fail(where, std::string("the accessor must be of type ") + type_name(components));
}

}  // namespace

const tinygltf::Accessor& find_accessor(const Context& context, int index, const std::string& where) {
  const tinygltf::Accessor& accessor = at(context.document.model.accessors, index, where);
  if (!is_component_type(accessor.componentType))
    fail(accessor_path(index), "component type " + std::to_string(accessor.componentType) + " is not one of glTF's");
  return accessor;
}

void read_floats(const Context& context, int index, int components, const std::string& where, float* target,
                 bool keep_not_finite) {
  const tinygltf::Accessor& accessor = find_accessor(context, index, where);
  check_type(accessor, components, where);
  read_elements(context, index, components, target);
  if (keep_not_finite || accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) return;
  const std::size_t values = accessor.count * static_cast<std::size_t>(components);
  const float* bad = std::find_if_not(target, target + values, [](float value) { return std::isfinite(value); });
  if (bad != target + values)
    fail(where, "element " + std::to_string((bad - target) / components) + " is " + to_text(*bad));
}

std::vector<std::uint32_t> read_integers(const Context& context, int index, int components, std::size_t count,
                                         const std::string& where) {
  const tinygltf::Accessor& accessor = find_accessor(context, index, where);
  check_type(accessor, components, where);
  const int type = accessor.componentType;
  if (type == TINYGLTF_COMPONENT_TYPE_FLOAT || type == TINYGLTF_COMPONENT_TYPE_BYTE ||
      type == TINYGLTF_COMPONENT_TYPE_SHORT)
    fail(where, "the accessor must hold unsigned integers");
  if (accessor.count != count)
    fail(where, "has " + std::to_string(accessor.count) + " elements where " + std::to_string(count) + " are needed");
  std::vector<std::uint32_t> values(count * static_cast<std::size_t>(components));
  read_elements(context, index, components, values.data());
  return values;
}

}  // namespace lightwell::gltf
