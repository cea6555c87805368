#include "protocol/reader.h"

#include <algorithm>
#include <cmath>

#include "protocol/json_text.h"

namespace lightwell::protocol {

Value Value::element(std::size_t index) const {
  return Value{json[index], pointer + '/' + std::to_string(index), reading};
}

Value Value::member(std::string_view name) const {
  return Value{*json.find(name), pointer + '/' + escape_pointer_token(name), reading};
}

std::string in_words(const nlohmann::json& value) {
  constexpr std::size_t kLongest = 60;
  if (value.is_array()) return "an array of " + std::to_string(value.size());
  if (value.is_object()) return "an object";
  if (value.is_string() && value.get_ref<const std::string&>().size() > kLongest)
    return "a string of " + std::to_string(value.get_ref<const std::string&>().size()) + " bytes";
  return json_text(value);
}

void read_boolean(const Value& value, bool& out) {
  if (!value.json.is_boolean()) return value.fail("must be true or false, not " + in_words(value.json));
  out = value.json.get<bool>();
}

void ReadNumber::operator()(const Value& value, double& out) const {
  if (!value.json.is_number()) return value.fail("must be a number, not " + in_words(value.json));
  const double number = value.json.get<double>();
  const bool above = low_open ? number > low : number >= low;
  if (above && number <= high) {
    out = number;
    return;
  }
  value.fail("must be a number " + std::string(low_open ? "above " : "from ") + in_words(low) + " to " +
             in_words(high) + ", not " + in_words(value.json));
}

template <class T>
void ReadInteger<T>::operator()(const Value& value, T& out) const {
  const double number = value.json.is_number() ? value.json.get<double>() : std::nan("");
  const bool in_range = number >= static_cast<double>(low) && number <= static_cast<double>(high);
  if (!in_range || number != std::floor(number))
    return value.fail("must be a whole number from " + std::to_string(low) + " to " + std::to_string(high) + ", not " +
                      in_words(value.json));
  out = static_cast<T>(number);
}

template struct ReadInteger<int>;
template struct ReadInteger<std::uint16_t>;
template struct ReadInteger<std::uint32_t>;
template struct ReadInteger<std::uint64_t>;

void ReadString::operator()(const Value& value, std::string& out) const {
  const bool fits = value.json.is_string() && value.json.get_ref<const std::string&>().size() >= min_bytes &&
                    value.json.get_ref<const std::string&>().size() <= max_bytes;
  if (!fits)
    return value.fail("must be a string of " + std::to_string(min_bytes) + " to " + std::to_string(max_bytes) +
                      " bytes, not " + in_words(value.json));
  out = value.json.get_ref<const std::string&>();
}

ObjectReader::ObjectReader(const Value& value) : value_(value) {
  if (!value.json.is_object()) value.fail("must be an object, not " + in_words(value.json));
}

bool ObjectReader::take(std::string_view name) {
  taken_.push_back(name);
  return value_.json.is_object() && value_.json.contains(name);
}

void ObjectReader::finish() const {
  if (!value_.reading.refuses_unknown_members() || !value_.json.is_object()) return;
  for (const auto& [name, member] : value_.json.items())
    if (std::find(taken_.begin(), taken_.end(), name) == taken_.end())
      value_.reading.fail(422, "the member \"" + name.substr(0, 60) + "\" is not known here",
                          value_.pointer + '/' + escape_pointer_token(name));
}

}  // namespace lightwell::protocol
