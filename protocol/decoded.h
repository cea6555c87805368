// What is wrong with something that came from outside, as a value: an RFC 9457 problem document, and a result type.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace lightwell::protocol {

/// An RFC 9457 problem document. Empty `instance` and `pointer` do not travel.
struct Problem {
  int status = 400;                  // an HTTP status code
  std::string type = "about:blank";  // about:blank: `title` is the status code's own phrase
  std::string title;
  std::string detail;    // one sentence for people: what was wrong and why
  std::string instance;  // the resource concerned, as a path
  std::string pointer;   // JSON pointer (RFC 6901) to the bad member; empty: the whole document

  bool operator==(const Problem&) const = default;
};

/// The phrase of RFC 9110 for a status code this project uses; "Error" for others.
std::string_view status_phrase(int status);

/// A problem of type about:blank, titled with its status code's phrase.
Problem make_problem(int status, std::string detail, std::string pointer = {});

/// Either a value or a Problem. `value()` on a problem is a programmer's mistake and throws std::logic_error.
template <class T>
class [[nodiscard]] Decoded {
 public:
  Decoded(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Decoded(Problem problem) : state_(std::in_place_index<1>, std::move(problem)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& value() & { return checked(), std::get<0>(state_); }
  const T& value() const& { return checked(), std::get<0>(state_); }
  T&& value() && { return checked(), std::get<0>(std::move(state_)); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }

  const Problem& problem() const { return std::get<1>(state_); }

 private:
  void checked() const {
    if (!ok()) throw std::logic_error("Decoded::value() on a problem: " + problem().detail);
  }
  std::variant<T, Problem> state_;
};

}  // namespace lightwell::protocol
