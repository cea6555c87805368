// The object model as data: kinds of objects, each with its properties. Operations (operations.h) know no kind by name.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/error.h"
#include "renderer/scene/gltf/object_model/editing.h"
#include "renderer/scene/gltf/object_model/values.h"

namespace lightwell::object_model {

/// One property of the object `i` of a kind.
struct Property {
  std::string path;      // below the object: "/spot/innerConeAngle"
  bool is_list = false;  // an array whose elements may be added and removed

  /// None: the object has no such property now.
  std::function<std::optional<Json>(const Scene&, std::size_t i)> get;

  /// Refuses wrong types and values; what is refused changes nothing that outlives the patch.
  std::function<Status(Editing&, std::size_t i, const Json& value, const std::string& where)> set;

  /// Back to what glTF says for a property that is not given.
  std::function<Status(Editing&, std::size_t i, const std::string& where)> reset;

  /// Its value when it is not given; null for none. What has it is not written.
  Json standard;
};

struct ObjectKind {
  std::string singular;  // "node", for people
  std::string pointer;   // of the array, "/nodes"; of the object itself if `is_single`
  std::vector<Property> properties;
  bool is_single = false;

  /// A property whose path holds an index. Empty: there are none.
  std::function<std::optional<Property>(const Scene&, std::size_t i, std::string_view path)> indexed_property;

  std::function<std::size_t(const Scene&)> count;
  std::function<const std::string&(const Scene&, std::size_t)> name;  // empty: cannot be named

  /// Adds a default object before `i`, or at the end. Empty: objects of this kind are neither added nor removed.
  std::function<void(Editing&, std::size_t i)> insert;
  std::function<Status(Editing&, std::size_t i, const std::string& where)> erase;
  std::size_t EditLimits::*most = nullptr;

  /// What must hold between the properties of one object, and between the members of one given as a whole.
  /// Empty: nothing.
  std::function<Status(const Scene&, std::size_t i, const std::string& where)> check;
  std::function<Status(const Json& object, const std::string& where)> check_whole;
};

const ObjectKind& nodes();
const ObjectKind& materials();
const ObjectKind& lights();
const ObjectKind& cameras();
const ObjectKind& environment();
const ObjectKind& meshes();    // their primitives' materials; nothing else of them can be edited
const ObjectKind& skins();     // to be named
const ObjectKind& textures();  // to be named
const ObjectKind& scenes();    // the one scene: its roots

/// The object that a token of a pointer or a name means: an index, else the name of exactly one object.
Result<std::size_t> find_object(Editing& editing, const ObjectKind& kind, std::string_view token,
                                const std::string& where);

/// The object that a JSON value means: a number is an index, a string a name.
Result<int> read_reference(Editing& editing, const ObjectKind& kind, const Json& value, const std::string& where);

/// The object as glTF writes it: properties that have their standard value are left out.
Json describe(const ObjectKind& kind, const Scene& scene, std::size_t i);

}  // namespace lightwell::object_model
