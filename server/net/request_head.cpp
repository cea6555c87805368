#include "server/net/request_head.h"

#include <algorithm>
#include <charconv>
#include <optional>

namespace lightwell::net {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_alpha(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_token_char(char c) {
  return is_alpha(c) || is_digit(c) || std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_token_char);
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = lower(c);
  return result;
}

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

int hex_value(char c) {
  if (is_digit(c)) return c - '0';
  c = lower(c);
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/// Whether a comma-separated list holds `item` (lower case).
bool list_holds(std::string_view list, std::string_view item) {
  while (!list.empty()) {
    const auto comma = std::min(list.find(','), list.size());
    if (lower(trim(list.substr(0, comma))) == item) return true;
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return false;
}

/// None on a bad escape or a NUL.
std::optional<std::string> percent_decoded(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result.push_back(text[i]);
      continue;
    }
    if (i + 2 >= text.size() || hex_value(text[i + 1]) < 0 || hex_value(text[i + 2]) < 0) return {};
    const int value = hex_value(text[i + 1]) * 16 + hex_value(text[i + 2]);
    if (value == 0) return {};
    result.push_back(static_cast<char>(value));
    i += 2;
  }
  return result;
}

/// Reads one head; the first thing wrong ends it.
class HeadParser {
 public:
  HeadParser(std::string_view text, const HeadLimits& limits) : rest_(text), limits_(limits) {}

  std::variant<RequestHead, Refusal> parse() {
    if (rest_.starts_with("\r\n")) rest_.remove_prefix(2);  // RFC 9112, 2.2: one empty line before is forgiven
    const bool good = parse_request_line(take_line()) && parse_fields() && check_host() && read_framing() &&
                      read_connection() && read_upgrade();
    if (!good) return std::move(refusal_);
    return std::move(head_);
  }

 private:
  bool refuse(int status, std::string detail) {
    refusal_ = {status, std::move(detail), {}};
    return false;
  }

  std::string_view take_line() {
    const auto end = rest_.find("\r\n");
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end == std::string_view::npos ? end : end + 2, rest_.size()));
    return line;
  }

  bool parse_request_line(std::string_view line) {
    const auto first = line.find(' ');
    const auto last = line.rfind(' ');
    if (first == std::string_view::npos || first == last) return refuse(400, "the request line is not three words");
    const std::string_view method = line.substr(0, first);
    if (!is_token(method)) return refuse(400, "the method is not a token");
    head_.method = method;
    return parse_version(line.substr(last + 1)) && parse_target(line.substr(first + 1, last - first - 1));
  }

  bool parse_version(std::string_view version) {
    if (version.size() != 8 || !version.starts_with("HTTP/") || !is_digit(version[5]) || version[6] != '.' ||
        !is_digit(version[7]))
      return refuse(400, "the request line does not end in an HTTP version");
    if (version[5] != '1') return refuse(505, "only HTTP/1.0 and HTTP/1.1 are spoken here");
    head_.minor_version = std::min(version[7] - '0', 1);
    return true;
  }

  bool parse_target(std::string_view target) {
    if (target.size() > limits_.max_target_bytes)
      return refuse(414, "the request target has more than " + std::to_string(limits_.max_target_bytes) + " bytes");
    const auto bad = [](char c) {
      return static_cast<unsigned char>(c) <= ' ' || static_cast<unsigned char>(c) >= 127;
    };
    if (std::any_of(target.begin(), target.end(), bad))
      return refuse(400, "the request target holds a character that must be escaped");
    if (target == "*") {
      if (head_.method != "OPTIONS") return refuse(400, "only OPTIONS may ask for *");
      head_.path = "*";
      return true;
    }
    if (!target.starts_with('/') && !strip_authority(target)) return refuse(400, "the request target is not a path");
    if (target.find('#') != std::string_view::npos) return refuse(400, "the request target holds a fragment");
    const auto question = std::min(target.find('?'), target.size());
    head_.query = target.substr(std::min(question + 1, target.size()));
    std::optional<std::string> path = percent_decoded(target.substr(0, question));
    if (!path) return refuse(400, "the request target holds a broken escape");
    head_.path = std::move(*path);
    return true;
  }

  /// The absolute form: a scheme and an authority before the path.
  static bool strip_authority(std::string_view& target) {
    const std::string start = lower(target.substr(0, 8));
    const std::size_t scheme = start.starts_with("http://") ? 7 : start == "https://" ? 8 : 0;
    const auto slash = target.find('/', scheme);
    if (scheme == 0 || slash == scheme || slash == std::string_view::npos) return false;
    target.remove_prefix(slash);
    return true;
  }

  bool parse_fields() {
    for (std::string_view line = take_line(); !line.empty(); line = take_line()) {
      if (head_.fields.size() == limits_.max_fields)
        return refuse(431, "more than " + std::to_string(limits_.max_fields) + " header fields");
      if (line.front() == ' ' || line.front() == '\t') return refuse(400, "a header field is folded over two lines");
      const auto colon = line.find(':');
      if (colon == std::string_view::npos || !is_token(line.substr(0, colon)))
        return refuse(400, "a header field's name is not a token followed by a colon");
      const std::string_view value = trim(line.substr(colon + 1));
      const auto bad = [](char c) { return (static_cast<unsigned char>(c) < ' ' && c != '\t') || c == 127; };
      if (std::any_of(value.begin(), value.end(), bad)) return refuse(400, "a header field holds a control character");
      head_.fields.push_back({lower(line.substr(0, colon)), std::string(value)});
    }
    return true;
  }

  std::size_t count(std::string_view name) const {
    return static_cast<std::size_t>(std::count_if(head_.fields.begin(), head_.fields.end(),
                                                  [&](const HeaderField& field) { return field.name == name; }));
  }

  /// Several fields of one name are one list.
  bool any_list_holds(std::string_view name, std::string_view item) const {
    return std::any_of(head_.fields.begin(), head_.fields.end(),
                       [&](const HeaderField& field) { return field.name == name && list_holds(field.value, item); });
  }

  bool check_host() {
    const std::size_t hosts = count("host");
    if (hosts > 1) return refuse(400, "more than one Host field");
    if (hosts == 0 && head_.minor_version == 1) return refuse(400, "the Host field is missing");
    const std::string_view host = head_.field("host");
    const auto bad = [](char c) {
      return !is_alpha(c) && !is_digit(c) && std::string_view("-._~!$&'()*+,;=%:[]").find(c) == std::string_view::npos;
    };
    if (std::any_of(host.begin(), host.end(), bad)) return refuse(400, "the Host field is not a host and port");
    return true;
  }

  bool read_framing() {
    const std::size_t lengths = count("content-length");
    const std::size_t encodings = count("transfer-encoding");
    if (count("content-encoding") != 0) return refuse(415, "encoded request bodies are not taken");
    if (lengths > 1) return refuse(400, "more than one Content-Length field");
    if (lengths != 0 && encodings != 0) return refuse(400, "both Content-Length and Transfer-Encoding");
    if (encodings != 0) {
      if (head_.minor_version == 0) return refuse(400, "HTTP/1.0 has no Transfer-Encoding");
      std::string codings;
      for (const HeaderField& field : head_.fields)
        if (field.name == "transfer-encoding") codings += (codings.empty() ? "" : ",") + lower(field.value);
      const auto chunked = codings.find("chunked");
      if (chunked != codings.npos && chunked + std::string_view("chunked").size() != codings.size())
        return refuse(400, "chunked is not the last Transfer-Encoding, or applied twice");  // RFC 9112, 6.1 and 6.3
      if (codings != "chunked") return refuse(501, "the only Transfer-Encoding taken is chunked");
      head_.framing = Framing::kChunked;
    }
    if (lengths != 0) return read_length(head_.field("content-length"));
    return true;
  }

  bool read_length(std::string_view text) {
    const bool digits = !text.empty() && text.size() <= 19 && std::all_of(text.begin(), text.end(), is_digit);
    if (!digits) return refuse(400, "Content-Length is not a number of bytes");
    std::from_chars(text.data(), text.data() + text.size(), head_.content_length);
    head_.framing = Framing::kLength;
    return true;
  }

  bool read_connection() {
    head_.keep_alive = head_.minor_version == 1 && !any_list_holds("connection", "close");
    if (count("expect") != 0) {
      if (lower(head_.field("expect")) != "100-continue")
        return refuse(417, "the only expectation met is 100-continue");
      head_.expects_continue = head_.minor_version == 1;
    }
    return true;
  }

  bool read_upgrade() {
    const bool asked = any_list_holds("upgrade", "websocket") && any_list_holds("connection", "upgrade");
    if (!asked) return true;  // RFC 9110, 7.8: an upgrade that is not understood is ignored
    if (head_.method != "GET" || head_.minor_version == 0 || head_.framing != Framing::kNone)
      return refuse(400, "a WebSocket handshake is an HTTP/1.1 GET without a body");
    if (count("sec-websocket-version") != 1 || head_.field("sec-websocket-version") != "13") {
      refuse(426, "the WebSocket version spoken here is 13");
      refusal_.fields = {{"Sec-WebSocket-Version", "13"}, {"Upgrade", "websocket"}, {"Connection", "Upgrade"}};
      return false;
    }
    const std::string_view key = head_.field("sec-websocket-key");
    const auto base64 = [](char c) { return is_alpha(c) || is_digit(c) || c == '+' || c == '/'; };
    if (count("sec-websocket-key") != 1 || key.size() != 24 || !key.ends_with("==") ||
        !std::all_of(key.begin(), key.end() - 2, base64))
      return refuse(400, "Sec-WebSocket-Key is not 16 bytes in base64");
    head_.wants_web_socket = true;
    return true;
  }

  std::string_view rest_;
  const HeadLimits& limits_;
  RequestHead head_;
  Refusal refusal_;
};

}  // namespace

std::string_view RequestHead::field(std::string_view name) const {
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const HeaderField& field) { return field.name == name; });
  return found == fields.end() ? std::string_view() : std::string_view(found->value);
}

Refusal head_too_large(const HeadLimits& limits) {
  return {431, "the request's head has more than " + std::to_string(limits.max_bytes) + " bytes", {}};
}

HeadScan find_head_end(std::string_view text, std::size_t scanned) {
  using State = HeadScan::State;
  for (std::size_t i = scanned; i < text.size(); ++i) {
    const char c = text[i];
    const bool text_char = static_cast<unsigned char>(c) >= ' ' || c == '\t' || c == '\r';
    if (c == '\n') {
      if (i == 0 || text[i - 1] != '\r') return {State::kBroken, 0};
      if (i >= 3 && text[i - 2] == '\n') return {State::kComplete, i + 1};
    } else if (!text_char || (i > 0 && text[i - 1] == '\r')) {
      return {State::kBroken, 0};
    }
  }
  return {};
}

std::variant<RequestHead, Refusal> parse_request_head(std::string_view text, const HeadLimits& limits) {
  if (text.size() > limits.max_bytes) return head_too_large(limits);
  return HeadParser(text, limits).parse();
}

}  // namespace lightwell::net
