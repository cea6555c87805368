// RFC 6902's operations on objects of the object model.
#pragma once

#include "renderer/scene/gltf/object_model/object_kind.h"
#include "renderer/scene/gltf/object_model/pointer.h"

namespace lightwell::object_model {

enum class Operator { kAdd, kRemove, kReplace, kTest };

struct Operation {
  Operator op = Operator::kTest;
  Pointer path;
  const Json* value = nullptr;  // null for kRemove
};

/// One operation of a patch, its shape checked. An error's `where` is its path, or empty if it has none.
Result<Operation> read_operation(const Json& json);

/// Applies one operation. After an error the scene of `editing` is of no use.
Status apply(Editing& editing, const Operation& operation);

}  // namespace lightwell::object_model
