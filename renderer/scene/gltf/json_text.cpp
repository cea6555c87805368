#include "renderer/scene/gltf/json_text.h"

#include <cstdint>
#include <string>

#include "renderer/scene/gltf/diagnostics.h"

namespace lightwell::gltf {
namespace {

using nlohmann::json;

// glTF itself is nine levels deep; extras and unknown extensions may be deeper.
constexpr int kDeepest = 100;
// A value takes up to about a hundred bytes in memory. A hundred thousand nodes with a mesh each are half as many.
constexpr std::uint64_t kMostValues = 8'000'000;

constexpr std::size_t kLongestReason = 200;  // the library quotes what it read, however long that is

/// Follows a text without keeping anything of it. (A callback of the library's own parser would do too, were that not
/// quadratic in the length of arrays.)
class Bounds : public nlohmann::json_sax<json> {
 public:
  bool null() override { return count(); }
  bool boolean(bool) override { return count(); }
  bool number_integer(number_integer_t) override { return count(); }
  bool number_unsigned(number_unsigned_t) override { return count(); }
  bool number_float(number_float_t, const string_t&) override { return count(); }
  bool string(string_t&) override { return count(); }
  bool binary(binary_t&) override { return count(); }
  bool start_object(std::size_t) override { return descend(); }
  bool start_array(std::size_t) override { return descend(); }
  bool key(string_t&) override { return true; }
  bool end_object() override { return ascend(); }
  bool end_array() override { return ascend(); }
  bool parse_error(std::size_t, const std::string&, const json::exception& exception) override {
    std::string_view reason = exception.what();
    // In front stands the library's own number for it: "[json.exception.parse_error.101] ".
    if (const std::size_t end = reason.find("] "); end != std::string_view::npos) reason.remove_prefix(end + 2);
    fail("json", readable(reason, kLongestReason));
  }

 private:
  bool count() {
    if (++values_ > kMostValues)
      fail("json", "has more than " + std::to_string(kMostValues) + " values", ErrorKind::kTooLarge);
    return true;
  }
  bool descend() {
    if (++depth_ > kDeepest)
      fail("json", "is nested more than " + std::to_string(kDeepest) + " levels deep", ErrorKind::kTooLarge);
    return count();
  }
  bool ascend() {
    --depth_;
    return true;
  }

  std::uint64_t values_ = 0;
  int depth_ = 0;
};

}  // namespace

json parse_json(std::string_view text) {
  Bounds bounds;
  json::sax_parse(text.begin(), text.end(), &bounds);
  return json::parse(text.begin(), text.end());
}

}  // namespace lightwell::gltf
