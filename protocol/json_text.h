// JSON text from outside, strictly: what RFC 8259 leaves open (duplicate names, depth, sizes) is refused here.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "protocol/decoded.h"

namespace lightwell::protocol {

struct JsonLimits {
  std::size_t max_bytes = 1u << 20;
  std::size_t max_depth = 32;        // arrays and objects within each other
  std::size_t max_values = 200'000;  // of all kinds
};

/// The value that `text` holds. Invalid JSON or UTF-8, two members of one name, a number beyond a double and too deep a
/// nesting are problems of status 400 that say where; more bytes or values than the limits are of status 413.
Decoded<nlohmann::json> parse_json(std::string_view text, const JsonLimits& limits = {});

/// `name` as a token of a JSON pointer: ~ becomes ~0 and / becomes ~1.
std::string escape_pointer_token(std::string_view name);

/// Compact text. Strings that are not valid UTF-8 are mended with U+FFFD; never throws for that.
std::string json_text(const nlohmann::json& value);

}  // namespace lightwell::protocol
