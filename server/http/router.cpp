#include "server/http/router.h"

#include <httplib.h>
#include <spdlog/spdlog.h>

namespace lightwell::http {
namespace {

/// What handlers may see of a request's head. All else stays with the connection layer: framing, ranges, encodings.
constexpr std::string_view kForwarded[] = {"host", "content-type", "if-none-match"};

/// A connection as cpp-httplib sees it: a head to read, and room for the answer.
class MemoryStream : public httplib::Stream {
 public:
  MemoryStream(std::string input, const net::Peer& peer) : input_(std::move(input)), peer_(peer) {}

  bool is_readable() const override { return read_ < input_.size(); }
  bool is_writable() const override { return true; }

  ssize_t read(char* out, std::size_t size) override {
    const std::size_t count = input_.copy(out, size, read_);
    read_ += count;
    return static_cast<ssize_t>(count);
  }

  ssize_t write(const char* bytes, std::size_t size) override {
    output_.append(bytes, size);
    return static_cast<ssize_t>(size);
  }

  void get_remote_ip_and_port(std::string& ip, int& port) const override {
    ip = peer_.address;
    port = peer_.port;
  }
  void get_local_ip_and_port(std::string& ip, int& port) const override {
    ip.clear();
    port = 0;
  }
  socket_t socket() const override { return INVALID_SOCKET; }

  std::string take_output() { return std::move(output_); }

 private:
  std::string input_;
  std::size_t read_ = 0;
  const net::Peer& peer_;
  std::string output_;
};

/// The path as it may stand in a request line again.
std::string percent_encoded(std::string_view path) {
  std::string text;
  constexpr char kDigits[] = "0123456789ABCDEF";
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = std::isalnum(byte) || std::string_view("/-._~").find(c) != std::string_view::npos;
    if (plain)
      text.push_back(c);
    else
      text.append({'%', kDigits[byte >> 4], kDigits[byte & 15]});
  }
  return text;
}

/// Written anew: whatever was in doubt about the original is gone.
std::string canonical_head(const net::Request& request) {
  const net::RequestHead& head = request.head;
  std::string text = head.method + " " + percent_encoded(head.path);
  if (!head.query.empty()) text += "?" + head.query;
  text += " HTTP/1.1\r\n";
  for (const std::string_view name : kForwarded)
    if (const std::string_view value = head.field(name); !value.empty())
      text.append(name).append(": ").append(value).append("\r\n");
  return text + "content-length: 0\r\n\r\n";  // the body is handed over beside it
}

/// "/v1/scenes/{name}" as a regular expression.
std::string pattern_of(std::string_view path_template) {
  std::string pattern;
  for (std::size_t i = 0; i < path_template.size(); ++i) {
    if (path_template[i] == '{') {
      pattern += "([^/]+)";
      i = path_template.find('}', i);
    } else {
      if (path_template[i] == '.') pattern += '\\';
      pattern += path_template[i];
    }
  }
  return pattern;
}

/// RFC 9110, 8.6: 204 has no Content-Length, and 304 none but that of the file.
std::string without_length_of_nothing(std::string response) {
  const std::string_view status = std::string_view(response).substr(0, response.find("\r\n"));
  const bool nothing = status.starts_with("HTTP/1.1 204") || status.starts_with("HTTP/1.1 304");
  constexpr std::string_view kField = "Content-Length: 0\r\n";
  const auto at = nothing ? response.find(kField) : std::string::npos;
  if (at != std::string::npos) response.erase(at, kField.size());
  return response;
}

/// What cpp-httplib's request has no room for, while one is being answered on this thread.
thread_local const net::Request* current_request = nullptr;

}  // namespace

struct Router::State : httplib::Server {
  explicit State(const RouteTable& table) {
    set_keep_alive_timeout(60);
    set_keep_alive_max_count(1'000'000);
    for (const Route& route : table.routes()) add(route);
    set_exception_handler([](const httplib::Request& request, httplib::Response& response, std::exception_ptr failure) {
      answer_exception(request, response, failure);
    });
  }

  void add(const Route& route) {
    const auto handler = [&route](const httplib::Request& request, httplib::Response& response) {
      fill(response, route.handler(request_of(request)));
    };
    const std::string pattern = pattern_of(route.path);
    if (route.method == "GET")
      Get(pattern, handler);
    else if (route.method == "POST")
      Post(pattern, handler);
    else if (route.method == "PUT")
      Put(pattern, handler);
    else if (route.method == "PATCH")
      Patch(pattern, handler);
    else if (route.method == "DELETE")
      Delete(pattern, handler);
  }

  static Request request_of(const httplib::Request& request) {
    Request result;
    for (std::size_t i = 1; i < request.matches.size(); ++i) result.path_parameters.push_back(request.matches[i]);
    result.query.assign(request.params.begin(), request.params.end());
    result.body = current_request->body;
    result.if_none_match = current_request->head.field("if-none-match");
    result.gone = current_request->gone;
    return result;
  }

  static void fill(httplib::Response& out, Response response) {
    out.status = response.status;
    for (const auto& [name, value] : common_headers()) out.set_header(name, value);
    for (const auto& [name, value] : response.headers) out.set_header(name, value);
    if (response.content_type.empty()) return;
    out.set_header("Content-Type", response.content_type);
    out.body = std::move(response.body);
  }

  static void answer_exception(const httplib::Request& request, httplib::Response& response,
                               std::exception_ptr failure) {
    try {
      std::rethrow_exception(failure);
    } catch (const std::exception& error) {
      spdlog::error("{} {}: {}", request.method, request.path, error.what());
    } catch (...) {
      spdlog::error("{} {}: an unknown exception", request.method, request.path);
    }
    response = httplib::Response();
    fill(response, problem_response(protocol::make_problem(500, "the server failed to answer this request")));
  }

  std::string respond(const net::Request& request) {
    MemoryStream stream(canonical_head(request), request.peer);
    bool closed = false;
    current_request = &request;
    process_request(stream, !request.keep_alive, closed, nullptr);
    current_request = nullptr;
    return without_length_of_nothing(stream.take_output());
  }
};

Router::Router(const RouteTable& table) : state_(std::make_unique<State>(table)) {}

Router::~Router() = default;

std::string Router::respond(net::Request request) {
  std::string response = state_->respond(request);
  if (!response.empty()) return response;
  return wire_format(problem_response(protocol::make_problem(500, "the server failed to answer this request")), false);
}

}  // namespace lightwell::http
