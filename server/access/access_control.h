// Who may do what: hosts, origins, tokens and rates, decided by a request's head alone.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "server/access/rate_limiter.h"
#include "server/access/token_list.h"
#include "server/net/application.h"

namespace lightwell {

struct AccessOptions {
  TokenList tokens;                          // none: everyone may do everything, and only this machine is served
  std::vector<std::string> allowed_origins;  // pages from elsewhere that may use the API, "https://example.org"
  std::vector<std::string> allowed_hosts;    // names this server goes by, besides its loopback ones
  double requests_per_second = 100.0;        // of one client; 0: no limit
  double request_burst = 400.0;
};

/// Thread-safe.
class AccessControl {
 public:
  explicit AccessControl(AccessOptions options);

  bool has_tokens() const { return !options_.tokens.empty(); }

  /// Whether the request may be looked at at all: its Host (421), its Origin (403), its client's rate (429).
  std::optional<net::Refusal> check_origin_and_rate(const net::RequestHead& head, const net::Peer& peer);

  /// The scopes of the request's token, or all of them where no tokens are asked for. A missing or unknown token (401),
  /// or one without `needed` (403), is a refusal; kPublic needs none.
  std::variant<Scopes, net::Refusal> check_token(const net::RequestHead& head, Scope needed) const;

  /// A browser's question whether a page from elsewhere may send a request (Fetch standard, CORS preflight).
  bool is_preflight(const net::RequestHead& head) const;

  /// Fields that every answer to this request needs: CORS, for pages on the list alone.
  std::vector<std::pair<std::string, std::string>> answer_fields(const net::RequestHead& head) const;
  /// And those of the answer to a preflight.
  static std::vector<std::pair<std::string, std::string>> preflight_fields();

 private:
  bool host_allowed(std::string_view host) const;
  bool origin_listed(std::string_view origin) const;
  bool origin_allowed(const net::RequestHead& head) const;

  const AccessOptions options_;
  RateLimiter rates_;
};

/// The bearer token of a request: of Authorization or, for a WebSocket of a browser, which can set no such field, of
/// the subprotocol "bearer.TOKEN". Empty if there is none.
std::string_view bearer_token(const net::RequestHead& head);

}  // namespace lightwell
