#include <filesystem>
#include <fstream>
#include <iterator>

#include "server/services.h"
#include "web_client/files.h"

namespace lightwell {
namespace {

using http::Request;
using http::Response;

/// Nothing but what this server sends runs, and nobody frames it. Streams of one's own host count as foreign to 'self'
/// in some browsers, so connections to any WebSocket are let through.
constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self' ws: wss:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// FNV-1a, in quotes: changes when the file does.
std::string entity_tag(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return '"' + std::to_string(hash) + '"';
}

Response file_response(std::string_view bytes, std::string_view content_type, std::string_view if_none_match) {
  const std::string tag = entity_tag(bytes);
  Response response{200, std::string(content_type), {}, {}};
  response.headers = {
      {"ETag", tag}, {"Cache-Control", "no-cache"}, {"Content-Security-Policy", kContentSecurityPolicy}};
  if (if_none_match == tag) return {304, {}, {}, std::move(response.headers)};
  response.body = bytes;
  return response;
}

Response file_from_folder(const std::filesystem::path& path, std::string_view if_none_match) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return http::problem_response(protocol::make_problem(404, "the file is gone"));
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  return file_response(bytes, content_type_of(path.string()), if_none_match);
}

void add_file(http::RouteTable& table, const std::string& name, const http::Handler& handler) {
  table.add({"GET", "/" + name, Scope::kPublic, http::Effort::kQuick, 0, {}, handler, true});
  if (name == "index.html") table.add({"GET", "/", Scope::kPublic, http::Effort::kQuick, 0, {}, handler, true});
}

void add_folder(http::RouteTable& table, const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || content_type_of(entry.path().string()).empty()) continue;
    add_file(table, entry.path().lexically_relative(folder).generic_string(),
             [path = entry.path()](const Request& request) { return file_from_folder(path, request.if_none_match); });
  }
}

}  // namespace

void add_viewer_routes(http::RouteTable& table, const std::string& folder) {
  if (!folder.empty()) return add_folder(table, folder);
  for (const auto& [name, file] : web_files())
    add_file(table, name, [&file = file](const Request& request) {
      return file_response(file.bytes, file.content_type, request.if_none_match);
    });
}

}  // namespace lightwell
