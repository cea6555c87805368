// Typed reading of accessors: every component type, normalised integers, strides, sparse substitution.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "renderer/scene/gltf/context.h"

namespace lightwell::gltf {

/// The accessor with that index, of a known type and component type. Throws Failure if there is none.
const tinygltf::Accessor& find_accessor(const Context& context, int index, const std::string& where);

/// Reads `index` as elements of `components` floats each, which must be what its type says, into `target`, which has
/// room for find_accessor(index).count elements. Integers are normalised if the accessor says so. Throws Failure for
/// anything out of place, and for values that are not finite unless `keep_not_finite`.
void read_floats(const Context& context, int index, int components, const std::string& where, float* target,
                 bool keep_not_finite);

/// Elements of an accessor as `Element`: float, a vector or a 4 x 4 matrix of GLM. There must be exactly `count`, which
/// bounds what is allocated.
template <class Element>
std::vector<Element> read_accessor(const Context& context, int index, std::size_t count, const std::string& where,
                                   bool keep_not_finite = false) {
  static_assert(sizeof(Element) % sizeof(float) == 0);
  const std::size_t stored = find_accessor(context, index, where).count;
  if (stored != count)
    fail(where, "has " + std::to_string(stored) + " elements where " + std::to_string(count) + " are needed");
  std::vector<Element> elements(count);
  read_floats(context, index, sizeof(Element) / sizeof(float), where, reinterpret_cast<float*>(elements.data()),
              keep_not_finite);
  return elements;
}

/// Elements of unsigned integers that are not normalised, `components` each: indices and joints.
std::vector<std::uint32_t> read_integers(const Context& context, int index, int components, std::size_t count,
                                         const std::string& where);

}  // namespace lightwell::gltf
