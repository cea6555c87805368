#include "protocol/json_text.h"

#include <optional>
#include <vector>

namespace lightwell::protocol {
namespace {

using Json = nlohmann::json;

/// Builds the value while the parser reports its events, and stops the parser at the first thing refused.
class StrictBuilder : public nlohmann::json_sax<Json> {
 public:
  explicit StrictBuilder(const JsonLimits& limits) : limits_(limits) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return refuse(400, "binary values are not JSON"); }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    if (open_.back().value->contains(name)) {
      open_.back().name = name;
      return refuse(400, "the member \"" + name + "\" appears twice in one object");
    }
    open_.back().name = std::move(name);
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    // 406 is nlohmann's code for a number too large for a double.
    const std::string what = error.id == 406 ? "a number that is too large" : "no valid JSON";
    if (!problem_) problem_ = make_problem(400, what + " at byte " + std::to_string(position));
    return false;
  }

  const std::optional<Problem>& problem() const { return problem_; }
  Json take_root() { return std::move(root_); }

 private:
  struct Open {
    Json* value;       // the object or array being filled; its address is stable until it is closed
    std::string name;  // of the member that comes next, in an object
  };

  template <class T>
  bool add(T&& value) {
    return place(Json(std::forward<T>(value))) != nullptr;
  }

  bool open(Json container) {
    if (open_.size() >= limits_.max_depth)
      return refuse(400, "nested deeper than " + std::to_string(limits_.max_depth) + " levels");
    Json* placed = place(std::move(container));
    if (placed) open_.push_back({placed, {}});
    return placed != nullptr;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  Json* place(Json value) {
    if (++values_ > limits_.max_values) {
      refuse(413, "more than " + std::to_string(limits_.max_values) + " values");
      return nullptr;
    }
    if (open_.empty()) return &(root_ = std::move(value));
    Json& parent = *open_.back().value;
    if (parent.is_object()) return &(parent[open_.back().name] = std::move(value));
    parent.push_back(std::move(value));
    return &parent.back();
  }

  bool refuse(int status, std::string detail) {
    if (!problem_) problem_ = make_problem(status, std::move(detail), pointer());
    return false;
  }

  /// Of the value that comes next: what is open within an array is its last element already.
  std::string pointer() const {
    std::string text;
    for (const Open& level : open_) {
      const std::size_t index = level.value->size() - (&level == &open_.back() ? 0 : 1);
      text += '/' + (level.value->is_object() ? escape_pointer_token(level.name) : std::to_string(index));
    }
    return text;
  }

  const JsonLimits& limits_;
  Json root_;
  std::vector<Open> open_;
  std::size_t values_ = 0;
  std::optional<Problem> problem_;
};

}  // namespace

Decoded<Json> parse_json(std::string_view text, const JsonLimits& limits) {
  if (text.size() > limits.max_bytes)
    return make_problem(413, "more than " + std::to_string(limits.max_bytes) + " bytes of JSON");
  StrictBuilder builder(limits);
  const bool complete = Json::sax_parse(text.begin(), text.end(), &builder);
  if (builder.problem()) return *builder.problem();
  if (!complete) return make_problem(400, "no valid JSON");
  return builder.take_root();
}

std::string escape_pointer_token(std::string_view name) {
  std::string token;
  token.reserve(name.size());
  for (const char letter : name) {
    if (letter == '~')
      token += "~0";
    else if (letter == '/')
      token += "~1";
    else
      token += letter;
  }
  return token;
}

std::string json_text(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace lightwell::protocol
