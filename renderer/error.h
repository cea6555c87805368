// Bad input from outside is a value, never an exception across the API: Result<T> holds a T or an Error.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace lightwell {

enum class ErrorKind {
  kInvalidInput,  // what was given is wrong: exit code 3, HTTP 4xx
  kNotFound,      // a name, file or index that does not exist
  kTooLarge,      // over a stated limit
  kUnsupported,   // a required feature that is not implemented
  kNoDevice,      // no usable OpenGL device: exit code 4
  kDeviceLost,    // the context failed; the renderer must be rebuilt
  kUnwanted,      // given up, for nobody wanted it any more: no failure
  kInternal,      // anything else: exit code 1
};

/// What was wrong, where, and why.
struct Error {
  ErrorKind kind = ErrorKind::kInternal;
  std::string where;  // a file, a JSON pointer, an option: "nodes/3/mesh", "--size"; may be empty
  std::string what;   // one sentence naming the value and the reason

  /// "where: what", for people.
  std::string message() const { return where.empty() ? what : where + ": " + what; }
};

inline Error invalid_input(std::string where, std::string what) {
  return Error{ErrorKind::kInvalidInput, std::move(where), std::move(what)};
}

/// Either a value or an Error. `value()` on an error is a programmer's mistake and throws std::logic_error.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& value() & { return checked(), std::get<0>(state_); }
  const T& value() const& { return checked(), std::get<0>(state_); }
  T&& value() && { return checked(), std::get<0>(std::move(state_)); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }

  const Error& error() const { return std::get<1>(state_); }

 private:
  void checked() const {
    if (!ok()) throw std::logic_error("Result::value() on an error: " + error().message());
  }
  std::variant<T, Error> state_;
};

/// A Result with nothing to give: success, or an Error.
struct Done {};
using Status = Result<Done>;

}  // namespace lightwell
