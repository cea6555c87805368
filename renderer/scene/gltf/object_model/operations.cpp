#include "renderer/scene/gltf/object_model/operations.h"

#include <array>

namespace lightwell::object_model {
namespace {

/// The object an operation is about, and what of it.
struct Target {
  Editing& editing;
  const ObjectKind& kind;
  std::size_t object;
  std::string path;   // of the property, below the object; empty: the object itself
  std::string where;  // the whole pointer
};

std::string one_of(const ObjectKind& kind) {
  return (kind.singular.starts_with('e') ? "an " : "a ") + kind.singular;  // "environment"
}

Error is_missing(const Target& target) {
  const std::string of_what = target.kind.singular + ' ' + std::to_string(target.object);
  return Error{ErrorKind::kNotFound, target.where, target.kind.is_single ? "is not there" : of_what + " has none"};
}

std::optional<Property> find_property(const Target& target) {
  for (const Property& property : target.kind.properties)
    if (property.path == target.path) return property;
  if (target.kind.indexed_property)
    return target.kind.indexed_property(target.editing.scene, target.object, target.path);
  return std::nullopt;
}

bool is_below(const std::string& path, const std::string& group) {
  return path.size() > group.size() && path.starts_with(group) && path[group.size()] == '/';
}

/// Whether the path names an object that holds properties.
bool is_group(const Target& target) {
  for (const Property& property : target.kind.properties)
    if (is_below(property.path, target.path)) return true;
  return false;
}

Target member_of(const Target& target, const std::string& name) {
  const std::string step = '/' + escape_token(name);
  return {target.editing, target.kind, target.object, target.path + step, target.where + step};
}

Status check(const Target& target) {
  return target.kind.check ? target.kind.check(target.editing.scene, target.object, target.where) : Done{};
}

Status set_members(const Target& group, const Json& value) {
  if (!value.is_object()) return invalid_input(group.where, "must be an object, not " + in_words(value));
  for (const auto& [name, member] : value.items()) {
    const Target target = member_of(group, name);
    Status done = Done{};
    if (const std::optional<Property> property = find_property(target))
      done = property->set(target.editing, target.object, member, target.where);
    else if (is_group(target))
      done = set_members(target, member);
    else if (name != "extras")  // glTF: the application's own
      done = Error{ErrorKind::kNotFound, target.where, "is not known here"};
    if (!done) return done;
  }
  return Done{};
}

Status reset_members(const Target& group) {
  for (const Property& property : group.kind.properties) {
    if (!is_below(property.path, group.path)) continue;
    const Status done = property.reset(group.editing, group.object, group.where);
    if (!done) return done;
  }
  return Done{};
}

Status test(const Target& target, const std::optional<Json>& found, const Json& expected) {
  if (!found) return is_missing(target);
  if (same_value(*found, expected)) return Done{};
  return invalid_input(target.where, "is " + in_words(*found) + ", not " + in_words(expected));
}

/// An object, or one within it like pbrMetallicRoughness: all of it at once.
Status apply_to_group(const Target& target, const Operation& operation) {
  if (operation.op == Operator::kTest) {
    const Json described = describe(target.kind, target.editing.scene, target.object);
    const Json::json_pointer path(target.path);
    return test(target, described.contains(path) ? std::optional<Json>(described[path]) : std::nullopt,
                *operation.value);
  }
  Status done = reset_members(target);
  if (!done || operation.op == Operator::kRemove) return done;
  if (target.path.empty() && target.kind.check_whole) done = target.kind.check_whole(*operation.value, target.where);
  if (done) done = set_members(target, *operation.value);
  return done ? check(target) : done;
}

Status apply_to_property(const Target& target, const Property& property, const Operation& operation) {
  if (operation.op == Operator::kTest)
    return test(target, property.get(target.editing.scene, target.object), *operation.value);
  Status done = Done{};
  if (operation.op != Operator::kRemove)
    done = property.set(target.editing, target.object, *operation.value, target.where);
  else if (property.get(target.editing.scene, target.object))
    done = property.reset(target.editing, target.object, target.where);
  else
    done = is_missing(target);
  return done ? check(target) : done;
}

/// Adds to, removes from or replaces in `array` what stands at `token`.
Status change_element(Json& array, const Target& target, const std::string& token, bool is_list,
                      const Operation& operation) {
  const bool adds = operation.op == Operator::kAdd;
  if (!is_list && (adds || operation.op == Operator::kRemove))
    return invalid_input(target.where, "has a fixed number of elements: none can be added or removed");
  const std::optional<std::size_t> index =
      adds && token == "-" ? std::optional<std::size_t>(array.size()) : index_of_token(token);
  const std::size_t end = adds ? array.size() + 1 : array.size();
  if (!index || *index >= end)
    return Error{ErrorKind::kNotFound, target.where,
                 "there is no such element; there are " + std::to_string(array.size())};
  const auto place = array.begin() + static_cast<std::ptrdiff_t>(*index);
  switch (operation.op) {
    case Operator::kAdd:
      array.insert(place, *operation.value);
      return Done{};
    case Operator::kRemove:
      array.erase(place);
      return Done{};
    case Operator::kReplace:
      *place = *operation.value;
      return Done{};
    case Operator::kTest:
      return test(target, *place, *operation.value);
  }
  return Done{};
}

/// An element of a property that is an array. `parent` is the property's target.
Status apply_to_element(const Target& parent, const Target& target, const Property& property,
                        const Operation& operation) {
  std::optional<Json> array = property.get(parent.editing.scene, parent.object);
  if (!array || !array->is_array()) return is_missing(target);
  const Status affordable = parent.editing.spend(16 * array->size(), target.where);
  if (!affordable) return affordable;
  const std::string& token = operation.path.token(operation.path.size() - 1);
  const Status changed = change_element(*array, target, token, property.is_list, operation);
  if (!changed || operation.op == Operator::kTest) return changed;
  const Status set = property.set(parent.editing, parent.object, *array, parent.where);
  return set ? check(parent) : set;
}

Status apply_to_object(const Target& target, const Operation& operation) {
  if (const std::optional<Property> property = find_property(target))
    return apply_to_property(target, *property, operation);
  if (is_group(target)) return apply_to_group(target, operation);
  const std::size_t last_slash = target.path.rfind('/');
  if (last_slash != std::string::npos) {
    const std::size_t step = target.path.size() - last_slash;
    const Target parent{target.editing, target.kind, target.object, target.path.substr(0, last_slash),
                        target.where.substr(0, target.where.size() - step)};
    if (const std::optional<Property> property = find_property(parent))
      return apply_to_element(parent, target, *property, operation);
  }
  return Error{ErrorKind::kNotFound, target.where, "no such property of " + one_of(target.kind) + " can be edited"};
}

/// `add` of a whole object: before the one at `token`, or at the end.
Status add_object(Editing& editing, const ObjectKind& kind, const std::string& token, const Operation& operation) {
  const std::string& where = operation.path.text();
  const std::size_t count = kind.count(editing.scene);
  const std::optional<std::size_t> index = token == "-" ? std::optional<std::size_t>(count) : index_of_token(token);
  if (!index || *index > count)
    return Error{ErrorKind::kNotFound, where,
                 "a " + kind.singular + " is added at - or at 0 to " + std::to_string(count)};
  if (count >= editing.limits.*kind.most)
    return Error{ErrorKind::kTooLarge, where, "the scene has " + std::to_string(count) + " already, as many as it may"};
  const Status affordable = editing.spend(2 * editing.scene.nodes.size(), where);
  if (!affordable) return affordable;
  kind.insert(editing, *index);
  return apply_to_group({editing, kind, *index, "", where}, operation);
}

/// An element of the array of a kind, or something within it.
Status apply_to_kind(Editing& editing, const ObjectKind& kind, std::size_t depth, const Operation& operation) {
  const Pointer& path = operation.path;
  const std::string& where = path.text();
  if (kind.is_single) return apply_to_object({editing, kind, 0, path.from(depth), where}, operation);
  if (path.size() == depth) return invalid_input(where, "cannot be edited as a whole; edit its elements");
  const bool is_whole = path.size() == depth + 1;
  const bool comes_or_goes = operation.op == Operator::kAdd || operation.op == Operator::kRemove;
  if (is_whole && comes_or_goes && !kind.insert)
    return Error{ErrorKind::kUnsupported, where, "a " + kind.singular + " can neither be added nor removed"};
  if (is_whole && operation.op == Operator::kAdd) return add_object(editing, kind, path.token(depth), operation);
  const Result<std::size_t> object = find_object(editing, kind, path.token(depth), where);
  if (!object) return object.error();
  if (is_whole && operation.op == Operator::kRemove) return kind.erase(editing, *object, where);
  return apply_to_object({editing, kind, *object, path.from(depth + 1), where}, operation);
}

bool leads_to(const Pointer& path, const std::string& pointer) {
  return path.text() == pointer || is_below(path.text(), pointer);
}

}  // namespace

Result<Operation> read_operation(const Json& json) {
  if (!json.is_object()) return invalid_input("", "must be an object, not " + in_words(json));
  if (!json.contains("path") || !json["path"].is_string()) return invalid_input("", "has no path");
  Result<Pointer> path = Pointer::parse(json["path"].get<std::string>());
  if (!path) return path.error();

  constexpr std::array<std::pair<const char*, Operator>, 4> kOperators{{{"add", Operator::kAdd},
                                                                        {"remove", Operator::kRemove},
                                                                        {"replace", Operator::kReplace},
                                                                        {"test", Operator::kTest}}};
  const Json op = json.value("op", Json());
  if (op == "move" || op == "copy")
    return Error{ErrorKind::kUnsupported, path->text(), "\"move\" and \"copy\" are not supported"};
  for (const auto& [name, found] : kOperators) {
    if (op != name) continue;
    if (found == Operator::kRemove) return Operation{found, std::move(*path), nullptr};
    if (!json.contains("value")) return invalid_input(path->text(), "has no value");
    return Operation{found, std::move(*path), &json["value"]};
  }
  return invalid_input(path->text(), "op must be \"add\", \"remove\", \"replace\" or \"test\", not " + in_words(op));
}

Status apply(Editing& editing, const Operation& operation) {
  for (const ObjectKind* kind : {&nodes(), &materials(), &lights(), &cameras(), &meshes(), &scenes(), &environment()}) {
    if (!leads_to(operation.path, kind->pointer)) continue;
    const Result<Pointer> prefix = Pointer::parse(kind->pointer);
    return apply_to_kind(editing, *kind, prefix->size(), operation);
  }
  return Error{ErrorKind::kNotFound, operation.path.text(),
               "can not be edited: a path begins with /nodes, /materials, /cameras, /meshes, /scenes/0/nodes, "
               "/extensions/KHR_lights_punctual/lights or /extensions/LIGHTWELL_environment"};
}

}  // namespace lightwell::object_model
