#include "server/http/router.h"

#include <httplib.h>

#include <utility>

#include "server/operations/log.h"

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

constexpr std::string_view kNoLength = "Content-Length: 0\r\n";

/// RFC 9110, 8.6: 204 has no Content-Length, and 304 none but that of the file. A body that is sent as it is made has
/// its own, or none.
std::string with_true_length(std::string response, const Response& meant) {
  const auto at = response.find(kNoLength);
  if (at == std::string::npos) return response;
  if (meant.status == 204 || meant.status == 304) return response.erase(at, kNoLength.size());
  if (!meant.rest) return response;
  const std::string framing = meant.rest_bytes > 0 ? "Content-Length: " + std::to_string(meant.rest_bytes) + "\r\n"
                                                   : std::string("Transfer-Encoding: chunked\r\n");
  return response.replace(at, kNoLength.size(), framing);
}

/// What cpp-httplib's request and response have no room for, while a request is answered on this thread.
struct Current {
  const net::Request* request = nullptr;
  Response meant;  // without its body
};
thread_local Current current;

}  // namespace

struct Router::State : httplib::Server {
  State(const RouteTable& table, MoreFields fields) : more_fields(std::move(fields)) {
    set_keep_alive_timeout(60);
    set_keep_alive_max_count(1'000'000);
    for (const Route& route : table.routes()) add(route);
    set_exception_handler([this](const httplib::Request& request, httplib::Response& response,
                                 std::exception_ptr failure) { answer_exception(request, response, failure); });
  }

  void add(const Route& route) {
    const auto handler = [this, &route](const httplib::Request& request, httplib::Response& response) {
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
    result.body = current.request->body;
    result.if_none_match = current.request->head.field("if-none-match");
    result.gone = current.request->gone;
    return result;
  }

  void fill(httplib::Response& out, Response response) const {
    out.status = response.status;
    for (const auto& [name, value] : common_headers()) out.set_header(name, value);
    for (const auto& [name, value] : response.headers) out.set_header(name, value);
    for (const auto& [name, value] : more_fields(current.request->head)) out.set_header(name, value);
    if (!response.content_type.empty()) {
      out.set_header("Content-Type", response.content_type);
      out.body = std::move(response.body);
    }
    current.meant = std::move(response);
  }

  void answer_exception(const httplib::Request& request, httplib::Response& response,
                        std::exception_ptr failure) const {
    try {
      std::rethrow_exception(failure);
    } catch (const std::exception& error) {
      log_event(LogLevel::kError, "handler_failed", {{"path", request.path}, {"reason", std::string(error.what())}});
    } catch (...) {
      log_event(LogLevel::kError, "handler_failed", {{"path", request.path}, {"reason", "an unknown exception"}});
    }
    response = httplib::Response();
    fill(response, problem_response(protocol::make_problem(500, "the server failed to answer this request")));
  }

  net::Answer respond(const net::Request& request) {
    MemoryStream stream(canonical_head(request), request.peer);
    bool closed = false;
    current = {&request, {}};
    process_request(stream, !request.keep_alive, closed, nullptr);
    const Current done = std::exchange(current, Current());
    const bool head_only = request.head.method == "HEAD";
    return {with_true_length(stream.take_output(), done.meant), head_only ? nullptr : done.meant.rest};
  }

  const MoreFields more_fields;
};

Router::Router(const RouteTable& table, MoreFields more_fields)
    : state_(std::make_unique<State>(table, std::move(more_fields))) {}

Router::~Router() = default;

net::Answer Router::respond(const net::Request& request) {
  net::Answer answer = state_->respond(request);
  if (!answer.bytes.empty()) return answer;
  const auto problem = protocol::make_problem(500, "the server failed to answer this request");
  return {wire_format(problem_response(problem), false), nullptr};
}

}  // namespace lightwell::http
