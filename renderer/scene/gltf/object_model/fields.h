// Properties that are plainly a member of a plain struct.
#pragma once

#include <functional>
#include <type_traits>
#include <utility>

#include "renderer/scene/gltf/object_model/object_kind.h"

namespace lightwell::object_model {

/// The property at `path` that is `access(locate(scene, i))`. `locate` and `access` give references, to const or not as
/// what they are given; `access` may be a pointer to a member.
template <class Locate, class Access>
Property field(Locate locate, std::string path, Access access, Range range = {}) {
  using Object = std::remove_reference_t<std::invoke_result_t<Locate, Scene&, std::size_t>>;
  Property property;
  property.path = std::move(path);
  property.get = [=](const Scene& scene, std::size_t i) -> std::optional<Json> {
    return write_value(std::invoke(access, locate(scene, i)));
  };
  property.set = [=](Editing& editing, std::size_t i, const Json& value, const std::string& where) {
    return read_value(value, range, where, std::invoke(access, locate(editing.scene, i)));
  };
  property.reset = [=](Editing& editing, std::size_t i, const std::string&) -> Status {
    const Object fresh{};
    std::invoke(access, locate(editing.scene, i)) = std::invoke(access, fresh);
    return Done{};
  };
  const Object standard{};
  property.standard = write_value(std::invoke(access, standard));
  return property;
}

/// A property that is not there while it has its standard value: 0 stands for "no range", "no far plane".
inline Property absent_at_standard(Property property) {
  property.get = [get = property.get, standard = property.standard](const Scene& scene,
                                                                    std::size_t i) -> std::optional<Json> {
    std::optional<Json> value = get(scene, i);
    return value == standard ? std::nullopt : value;
  };
  property.standard = nullptr;
  return property;
}

/// A property whose every change is followed by `act(editing.scene, i)`.
template <class Act>
Property followed_by(Property property, Act act) {
  property.set = [set = property.set, act](Editing& editing, std::size_t i, const Json& value,
                                           const std::string& where) {
    const Status done = set(editing, i, value, where);
    if (done) act(editing.scene, i);
    return done;
  };
  property.reset = [reset = property.reset, act](Editing& editing, std::size_t i, const std::string& where) {
    const Status done = reset(editing, i, where);
    if (done) act(editing.scene, i);
    return done;
  };
  return property;
}

/// An index of another kind of object, -1 for none. `member` gives the int.
template <class Locate, class Access>
Property reference(Locate locate, std::string path, Access access, const ObjectKind& (*kind)()) {
  Property property;
  property.path = std::move(path);
  property.get = [=](const Scene& scene, std::size_t i) -> std::optional<Json> {
    const int index = std::invoke(access, locate(scene, i));
    return index < 0 ? std::nullopt : std::optional<Json>(index);
  };
  property.set = [=](Editing& editing, std::size_t i, const Json& value, const std::string& where) -> Status {
    const Result<int> index = read_reference(editing, kind(), value, where);
    if (!index) return index.error();
    std::invoke(access, locate(editing.scene, i)) = *index;
    return Done{};
  };
  property.reset = [=](Editing& editing, std::size_t i, const std::string&) -> Status {
    std::invoke(access, locate(editing.scene, i)) = -1;
    return Done{};
  };
  return property;
}

}  // namespace lightwell::object_model
