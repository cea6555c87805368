// Reading JSON values into plain ones, strictly: each value knows its JSON pointer, the first thing wrong is kept and
// no member is left unread unless the caller says so.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/decoded.h"

namespace lightwell::protocol {

enum class UnknownMembers { kRefused, kIgnored };

/// The first problem found while one message is read, and how strictly it is read.
class Reading {
 public:
  explicit Reading(UnknownMembers unknown_members) : unknown_members_(unknown_members) {}

  bool refuses_unknown_members() const { return unknown_members_ == UnknownMembers::kRefused; }
  bool failed() const { return problem_.has_value(); }
  const Problem& problem() const { return *problem_; }
  void fail(int status, std::string detail, std::string pointer) {
    if (!problem_) problem_ = make_problem(status, std::move(detail), std::move(pointer));
  }

 private:
  UnknownMembers unknown_members_;
  std::optional<Problem> problem_;
};

/// A JSON value on its place in the message.
struct Value {
  const nlohmann::json& json;
  std::string pointer;
  Reading& reading;

  /// Status 422: well-formed JSON that means nothing here.
  void fail(std::string detail) const { reading.fail(422, std::move(detail), pointer); }
  Value element(std::size_t index) const;     // of an array, in range
  Value member(std::string_view name) const;  // of an object that has it
};

/// `value` in short, for a sentence: "12", "null", "an array of 3", "a string of 70000 bytes".
std::string in_words(const nlohmann::json& value);

// Readers: each sets `out`, or fails and leaves it as it was.

void read_boolean(const Value& value, bool& out);

/// A number that a 32-bit float can hold, from `low` to `high`.
struct ReadNumber {
  double low, high;
  bool low_open = false;  // `low` itself is refused
  void operator()(const Value& value, double& out) const;
};
inline constexpr double kLargestFloat = 3.4028234663852886e38;
inline constexpr ReadNumber read_any_number{-kLargestFloat, kLargestFloat};

/// A number without a fraction (5.0 counts), from `low` to `high`, which lie in T and within 2^53.
template <class T>
struct ReadInteger {
  std::int64_t low, high;
  void operator()(const Value& value, T& out) const;
};

/// A string of `min_bytes` to `max_bytes`.
struct ReadString {
  std::size_t min_bytes, max_bytes;
  void operator()(const Value& value, std::string& out) const;
};

/// An array of `min_size` to `max_size` elements, each read by `read_element`.
template <class Read>
struct ReadArray {
  std::size_t min_size, max_size;
  Read read_element;

  template <class T>
  void operator()(const Value& value, std::vector<T>& out) const;
};
template <class Read>
ReadArray(std::size_t, std::size_t, Read) -> ReadArray<Read>;

/// null, or what `read` reads.
template <class Read>
struct ReadNullable {
  Read read;

  template <class T>
  void operator()(const Value& value, std::optional<T>& out) const {
    if (value.json.is_null()) return out.reset();
    T inner{};
    read(value, inner);
    if (!value.reading.failed()) out.emplace(std::move(inner));
  }
};
template <class Read>
ReadNullable(Read) -> ReadNullable<Read>;

/// Reads an object member by member, then `finish`es.
class ObjectReader {
 public:
  /// Fails if `value` is no object.
  explicit ObjectReader(const Value& value);

  /// A member that must be there.
  template <class T, class Read>
  void required(std::string_view name, T& out, const Read& read) {
    if (take(name))
      read(value_.member(name), out);
    else
      value_.fail("the member \"" + std::string(name) + "\" is missing");
  }

  /// A member that may be left out; `out` stays as it is then.
  template <class T, class Read>
  void with_default(std::string_view name, T& out, const Read& read) {
    if (take(name)) read(value_.member(name), out);
  }

  /// A member that may be left out; `out` stays empty then.
  template <class T, class Read>
  void optional(std::string_view name, std::optional<T>& out, const Read& read) {
    if (!take(name)) return;
    T inner{};
    read(value_.member(name), inner);
    if (!value_.reading.failed()) out.emplace(std::move(inner));
  }

  /// Fails if the object has a member that no call above named, unless the reading ignores those.
  void finish() const;

 private:
  bool take(std::string_view name);  // whether the object has it

  const Value& value_;
  std::vector<std::string_view> taken_;
};

template <class Read>
template <class T>
void ReadArray<Read>::operator()(const Value& value, std::vector<T>& out) const {
  if (!value.json.is_array() || value.json.size() < min_size || value.json.size() > max_size)
    return value.fail("must be an array of " + std::to_string(min_size) + " to " + std::to_string(max_size) +
                      " elements, not " + in_words(value.json));
  std::vector<T> elements(value.json.size());
  for (std::size_t i = 0; i < elements.size() && !value.reading.failed(); ++i)
    read_element(value.element(i), elements[i]);
  if (!value.reading.failed()) out = std::move(elements);
}

}  // namespace lightwell::protocol
