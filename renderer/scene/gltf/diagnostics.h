// How the loader's readers refuse a file, and how they tell what they could not honour.
#pragma once

#include <cstddef>
#include <exception>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/error.h"

namespace lightwell::gltf {

/// Thrown by the loader's readers, and caught once, where load_gltf and load_glb begin: thus a reader says only what it
/// reads, and no exception leaves the loader.
class Failure : public std::exception {
 public:
  explicit Failure(Error error) : error_(std::move(error)), message_(error_.message()) {}
  const Error& error() const { return error_; }
  const char* what() const noexcept override { return message_.c_str(); }

 private:
  Error error_;
  std::string message_;
};

/// Throws a Failure. `where` is a path through the glTF document: "meshes/2/primitives/0/indices".
[[noreturn]] void fail(std::string where, std::string what, ErrorKind kind = ErrorKind::kInvalidInput);

/// `parent` and `child` (a name or an index) as one path.
std::string join(std::string_view parent, std::string_view child);
std::string join(std::string_view parent, std::size_t child);

/// `text` that may come from a file for a message: cut after `longest` bytes, without control characters.
std::string readable(std::string_view text, std::size_t longest);

/// The same in quotes, for a name or a value.
std::string in_quotes(std::string_view text);

/// The number as a message shows it.
std::string to_text(double value);

/// Collects warnings for Scene::warnings; beyond a hundred they are only counted.
class Warnings {
 public:
  void add(std::string_view where, std::string_view what);
  /// As add, but the same `what` only once, however many objects it applies to.
  void add_once(std::string_view where, std::string_view what);
  std::vector<std::string> take();

 private:
  std::vector<std::string> messages_;
  std::set<std::string, std::less<>> said_;
  std::size_t left_out_ = 0;
};

}  // namespace lightwell::gltf
