// openapi.json as a part of the binary.
#pragma once

#include <string_view>

namespace lightwell::protocol {

/// The text of protocol/openapi.json: UTF-8, media type application/json.
std::string_view openapi_document();

}  // namespace lightwell::protocol
