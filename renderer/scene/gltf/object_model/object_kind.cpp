#include "renderer/scene/gltf/object_model/object_kind.h"

#include "renderer/scene/gltf/object_model/pointer.h"

namespace lightwell::object_model {
namespace {

Error no_such_index(const ObjectKind& kind, std::size_t index, std::size_t count, const std::string& where) {
  return Error{
      ErrorKind::kNotFound, where,
      "there is no " + kind.singular + ' ' + std::to_string(index) + "; the scene has " + std::to_string(count)};
}

Result<std::size_t> find_name(Editing& editing, const ObjectKind& kind, std::string_view name,
                              const std::string& where) {
  const std::size_t count = kind.name ? kind.count(editing.scene) : 0;
  const Status affordable = editing.spend(count, where);
  if (!affordable) return affordable.error();
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < count; ++i) {
    if (kind.name(editing.scene, i) != name) continue;
    if (found)
      return invalid_input(where,
                           "more than one " + kind.singular + " is called " + in_words(name) + "; use its number");
    found = i;
  }
  if (found) return *found;
  return Error{ErrorKind::kNotFound, where, "no " + kind.singular + " is called " + in_words(name)};
}

}  // namespace

Result<std::size_t> find_object(Editing& editing, const ObjectKind& kind, std::string_view token,
                                const std::string& where) {
  const std::optional<std::size_t> index = index_of_token(token);
  if (!index) return find_name(editing, kind, token, where);
  const std::size_t count = kind.count(editing.scene);
  if (*index >= count) return no_such_index(kind, *index, count, where);
  return *index;
}

Result<int> read_reference(Editing& editing, const ObjectKind& kind, const Json& value, const std::string& where) {
  if (value.is_string()) {
    const Result<std::size_t> found = find_name(editing, kind, value.get_ref<const std::string&>(), where);
    return found ? Result<int>(static_cast<int>(*found)) : Result<int>(found.error());
  }
  int index = 0;
  const Status read = read_value(value, Range{0.0, 1e9}, where, index);
  if (!read) return read.error();
  const std::size_t count = kind.count(editing.scene);
  if (static_cast<std::size_t>(index) >= count)
    return no_such_index(kind, static_cast<std::size_t>(index), count, where);
  return index;
}

Json describe(const ObjectKind& kind, const Scene& scene, std::size_t i) {
  Json object = Json::object();
  for (const Property& property : kind.properties) {
    const std::optional<Json> value = property.get(scene, i);
    if (value && *value != property.standard) object[Json::json_pointer(property.path)] = *value;
  }
  return object;
}

}  // namespace lightwell::object_model
